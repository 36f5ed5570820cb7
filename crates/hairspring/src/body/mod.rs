//! The body that hair grows on and collides with: mesh, skeleton, skin weights and motion clips.

mod clip;
mod cuts;
mod keyed;
mod mesh;
mod nearest;
mod pose;
mod retarget;

pub use clip::{Clip, Trs};
pub use cuts::Cuts;
pub(crate) use cuts::is_teleport;
pub use keyed::ease;
pub use keyed::{Key, combine_clips, keyframe_clip};
pub use mesh::{Mesh, Part};
pub use nearest::{NearestPlace, NearestTree};
pub(crate) use nearest::{at as place_on, nearest_on_triangle};
pub use pose::{Body, Joint, Skin};
pub use retarget::{HeadMotion, Retargeted, Travel, head_motion, retarget};
