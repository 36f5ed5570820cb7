//! A tether from the root to every point: no point gets farther from its root than it is at rest, or so many times as far.
//!
//! ```text
//! root ●~~~~~~~~~~●     at rest: a distance R along the curl's chord
//! root ●──────────────●     pulled: held at t R, though the hair is long enough to go on
//! a = ω² (T − x) + 2ω (Ṫ − v)    where |x + v dt| > t R,    T on the sphere of t R about the root
//! ```
//!
//! Long range attachments (Kim, Chentanez & Müller 2012, §3), anchored to the skinned root. There they keep inextensible cloth from stretching, by moving points. Here no segment
//! stretches anyway, so that a point can never be farther than hair is long; what is left for a tether to do, and what artists use it for, is to keep curls from being
//! pulled straight. It is a spring on the point's own diagonal, not a projection, so that tension, bending and contact have their say in the same solve.
//!
//! It is not physics: off by default, and in every validation.

use super::Surrounded;
use glam::Vec3;

/// How fast a lone point would swing about its place on the sphere [Hz]: that of a hand's firm hold, at which it gives way by 0.07 mm under its own weight.
const FIRM: f32 = 60.0;

/// Holds a strand, whose authored points are `authored` [m], within `reach` times as far from its root as they were.
pub(crate) fn hold(reach: f32, authored: &[Vec3], strand: &mut Surrounded) {
    let [start, end] = strand.roots();
    let way = end.translation - start.translation;
    let dt = strand.frame.dt;
    let omega = std::f32::consts::TAU * FIRM;
    for ((i, p), (x, v)) in authored.iter().enumerate().zip(strand.points()).skip(2) {
        let most = reach * p.distance(authored[0]);
        // Where it would be at the frame's end: one that is on its way out is met there, not a frame later.
        let to = x + v * dt - way;
        if to.length() <= most {
            continue;
        }
        let places = [x, to].map(|x| x.normalize_or(Vec3::NEG_Y) * most);
        strand.pull(i, places, omega * omega);
        strand.carry(i, (way + (places[1] - places[0])) / dt, 2.0 * omega);
    }
}
