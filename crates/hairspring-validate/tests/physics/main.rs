//! Promises held against closed forms and measurements. Each file is one promise.

mod drag_follows_measured_cylinders;
mod hair_keeps_its_volume;
mod mass_follows_its_profile;
mod profiles_vary_along_the_strand;
mod strand_contacts_carry_weight_and_rub;
mod strands_agree_with_closed_forms;
