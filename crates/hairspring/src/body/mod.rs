//! The body that hair grows on and collides with: mesh, skeleton, skin weights and motion clips.
//!
//! # Example
//! ```
//! use glam::{Quat, Vec3};
//! use hairspring::body::{Body, KEYED_RATE, Key, Mesh, keyframe_clip};
//!
//! // A rigid triangle that moves by 10 cm in a second.
//! let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
//! let mut mesh = Mesh { positions, triangles: vec![[0, 2, 1]], ..Default::default() };
//! mesh.compute_normals();
//! let body = Body::rigid(mesh);
//! let key = |time, x| Key { time, position: Vec3::X * x, rotation: Quat::IDENTITY };
//! let clip = keyframe_clip(&[key(0.0, 0.0), key(1.0, 0.1)], Vec3::ZERO, KEYED_RATE, 1.0);
//! let (mut positions, mut normals) = (Vec::new(), Vec::new());
//! body.skinned(&body.world(&clip.sample(1.0)), &mut positions, &mut normals);
//! assert!(positions[0].distance(Vec3::X * 0.1) < 1e-6 && normals[0].distance(Vec3::Y) < 1e-6);
//! ```

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
pub use keyed::{KEYED_RATE, Key, combine_clips, keyframe_clip};
pub use mesh::{Mesh, Part};
pub use nearest::{NearestPlace, NearestTree};
pub(crate) use nearest::{at as place_on, nearest_on_triangle};
pub use pose::{Body, Joint, Skin};
pub use retarget::{HeadMotion, Retargeted, Travel, head_motion, retarget};
