//! Promises of scenes and their playback. Each file is one promise.

mod builtin_head_is_sound;
mod cameras_hold_the_subject;
mod colliders_push_hair_out_at_the_start;
mod cuts_in_a_clip_carry_hair_along;
mod far_and_large_scenes_are_exact_or_refused;
mod follow_hairs_may_be_placed_by_the_viewer;
mod grooms_collide_with_each_other;
mod hands_grab_and_release_hair;
mod live_body_and_collider_move_hair;
mod points_and_strands_report_their_values;
mod preroll_ends_at_rest;
mod props_and_limbs_collide_with_hair;
mod scenes_made_by_code_are_checked_like_files;
mod settings_change_during_playback;
mod stages_return_to_a_state;
mod support;
mod time_counts_frames;
