//! Promises of the two renderers. Each file is one promise.

#[path = "../support/alike.rs"]
mod alike;
#[path = "../support/mod.rs"]
mod support;

mod broken_input_is_skipped;
mod clips_play_back;
mod gpu_draws_what_the_cpu_draws;
mod gpu_places_what_the_cpu_places;
mod ground_receives_shadow;
mod hair_covers_its_true_area;
mod nearer_hides_farther_and_shadows_fall;
mod pictures_are_independent_of_threads;
mod pictures_match_the_golden_ones;
