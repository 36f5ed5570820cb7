//! The body that hair grows on and meets: mesh, skeleton, skin weights, clips of motion.

mod clip;
mod mesh;
mod pose;

pub use clip::{Clip, Trs};
pub use mesh::{Mesh, Part};
pub use pose::{Body, Joint, Skin};
