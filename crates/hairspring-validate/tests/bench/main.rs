//! Promises on the bench scene and the built-in head. Each file is one promise.

mod bench_hair_keeps_its_length_and_place;
mod curls_in_springs_come_to_rest;
mod identical_strands_cost_linearly;
mod results_are_independent_of_threads;
mod the_same_bits_as_before;
