//! What a scene stands on in its picture: settings only, the drawing itself lives in `hairspring-view`.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A level plane that takes the shadow of body and hair. It is a matter of the picture alone: what hair meets is a
/// [`Collider`](super::Collider).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Ground {
    /// Whether there is one. Default false: a portrait of a head sits on nothing.
    pub on: bool,
    /// Where it lies on the axis that points up [m]. `None`, the default: at the lowest point of the body at rest; 0 without a body.
    pub height: Option<f32>,
    /// Linear RGB, 0 to 1, of a floor under the key lamp and the sky. `None`, the default: the backdrop's own light, which shadow alone tells from
    /// the rest of it.
    pub color: Option<Vec3>,
}
