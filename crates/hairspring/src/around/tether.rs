//! A tether from the root to every point: no point gets much farther from its root than it is at rest, or so many times as far.
//!
//! ```text
//! root ●~~~~~~~~~~●     at rest: a distance R along the curl's chord
//! root ●──────────────●     pulled: held at t R, though the hair is long enough to go on
//! a = −n (|x⁺| − t R) / dt²    where |x⁺| > t R,    x⁺ = x + v dt from the root,    n = x⁺/|x⁺|
//! ```
//!
//! Long range attachments (Kim, Chentanez & Müller 2012, §3), anchored to the skinned root. There they keep inextensible cloth from stretching, by moving points. Here no segment
//! stretches anyway, so that a point can never be farther than hair is long; what is left for a tether to do, and what artists use it for, is to keep curls from being
//! pulled straight. It takes in a frame what speed leads outward, and no more, so that it neither bounces nor holds a point from swinging; at rest a point that hangs on its tether
//! alone gives way by g dt², 3 mm at 60 frames a second.
//!
//! It is not physics: off by default, and in every validation.

use super::Surrounded;
use glam::Vec3;

/// Holds a strand, whose authored points are `authored` [m], within `reach` times as far from its root as they were.
pub(crate) fn hold(reach: f32, authored: &[Vec3], strand: &mut Surrounded) {
    let [start, end] = strand.roots();
    let way = end.translation - start.translation;
    let dt = strand.frame.dt;
    for ((i, p), (x, v)) in authored.iter().enumerate().zip(strand.points()).skip(2) {
        let most = reach * p.distance(authored[0]);
        // Where it would be at the frame's end: one that is on its way out is met there, not a frame later.
        let to = x + v * dt - way;
        let far = to.length();
        if far > most {
            strand.push(i, to * ((most - far) / (far * dt * dt)));
        }
    }
}
