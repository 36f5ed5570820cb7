//! Joint indices of a scene's colliders, wind sources, charged bodies and hands. All are resolved before
//! anything changes, so that an error leaves the stage as it was.

use super::StageError;
use crate::Scene;
use hairspring::body::Body;

/// Joint index of each item; `None` if it names no joint.
pub(super) struct Joints {
    pub(super) colliders: Vec<Option<usize>>,
    pub(super) wind: Vec<Option<usize>>,
    pub(super) charged: Vec<Option<usize>>,
    pub(super) hands: Vec<Option<usize>>,
}

impl Joints {
    /// Resolves the joints named in `settings`.
    pub(super) fn new(settings: &Scene, body: Option<&Body>) -> Result<Self, StageError> {
        let colliders = settings.colliders.iter().map(|c| &c.joint);
        let wind = settings.wind_sources.iter().map(|s| &s.joint);
        let charged = settings.charged.iter().map(|c| &c.joint);
        let hands = settings.hands.iter().map(|h| &h.joint);
        Ok(Self {
            colliders: find(body, "a collider", colliders)?,
            wind: find(body, "a source of wind", wind)?,
            charged: find(body, "a charged body", charged)?,
            hands: find(body, "a hand", hands)?,
        })
    }
}

/// Returns the joints with these names; `what` describes the items in the error.
fn find<'a>(
    body: Option<&Body>,
    what: &'static str,
    names: impl Iterator<Item = &'a Option<String>>,
) -> Result<Vec<Option<usize>>, StageError> {
    let find = |name: &Option<String>| {
        let Some(name) = name else { return Ok(None) };
        let joint = body.and_then(|body| body.joint(name));
        joint.map(Some).ok_or_else(|| StageError::NoSuchJoint { what, joint: name.clone() })
    };
    names.map(find).collect()
}
