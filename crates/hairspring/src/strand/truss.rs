//! The rest shape of a strand of the springs model, in f64: where its extra particles are, lengths, stiffness, and the sag-free start.
//!
//! Springs (k−1, k), (k−2, k), (k−3, k) hold particle k from three directions, so the truss is statically determinate: from the tip to the
//! root, three tensions balance what pulls on each particle, and the rest lengths that give them follow. Exact wherever the
//! three directions span space, which the extra particles see to.

use super::rest_shape::{Fibre, RestPoint, RestShape};
use glam::{DMat3, DVec3, Vec3};

/// How far an extra particle is set aside over the length of its segment [1]: far enough that single precision tells bending from noise
/// (at 0.1 a cantilever of 64 points stays where rounding leaves it).
const ASIDE: f64 = 0.25;

/// EI of the truss over k·ℓ·ε², its springs' stiffness, spacing and offset squared [1]: what the extra particles' bend and torsion springs
/// resist. Fitted to the elastica; `bending_is_material` holds it.
const EI_OF_TRUSS: f64 = 0.475;

/// Largest relative change of a spring's rest length at the sag-free start [1]; beyond it the spring is stiffened.
const LARGEST_STRAIN: f64 = 0.05;

/// The particles of a strand: its points, and one beside the middle of each segment, a third of a turn after the last. Shape `[2 points − 1]`.
pub fn particles(points: &[Vec3]) -> Vec<Vec3> {
    let mut out = Vec::with_capacity(2 * points.len() - 1);
    let mut normal = DVec3::ZERO;
    let mut before = DVec3::ZERO;
    for (k, w) in points.windows(2).enumerate() {
        let (a, b) = (w[0].as_dvec3(), w[1].as_dvec3());
        let t = (b - a).normalize_or(DVec3::Y);
        normal = if k == 0 {
            t.any_orthonormal_vector()
        } else {
            let scale = normal.dot(t) / (1.0 + before.dot(t)).max(1e-3);
            (normal - (before + t) * scale).normalize_or(normal)
        };
        before = t;
        let angle = k as f64 * std::f64::consts::TAU / 3.0;
        let aside = normal * angle.cos() + t.cross(normal) * angle.sin();
        out.push(w[0]);
        out.push((0.5 * (a + b) + aside * (ASIDE * a.distance(b))).as_vec3());
    }
    out.extend(points.last());
    out
}

/// The rest shape of the truss through `particles` [m] with the fibre's radii at them, in balance under `gravity` [m/s²] or stress-free.
///
/// In the rest points `bend` is the stiffness of the spring to the particle after the next [N/m], `twist` that to the third
/// after, `turn` their rest lengths [m] and six times the volume of the tetrahedron [m³].
pub fn truss(particles: &[Vec3], fibre: &Fibre, gravity: DVec3) -> RestShape {
    let n = particles.len();
    let x: Vec<DVec3> = particles.iter().map(|p| p.as_dvec3()).collect();
    let mut rest = vec![RestPoint::default(); n];
    let total: f64 = x.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut along = 0.0;
    for i in 0..n {
        let before = if i > 0 { x[i].distance(x[i - 1]) } else { 0.0 };
        let after = if i + 1 < n { x[i].distance(x[i + 1]) } else { 0.0 };
        let r = fibre.radii[i] as f64;
        rest[i].mass = fibre.density * std::f64::consts::PI * r * r * 0.5 * (before + after);
        rest[i].length = after;
        let young = fibre.young * (1.0 + (fibre.tip - 1.0) * along / total);
        let ei = young * std::f64::consts::FRAC_PI_4 * r.powi(4);
        along += after;
        if i + 2 < n {
            let spacing = 0.5 * x[i].distance(x[i + 2]).max(1e-9);
            let aside = 2.0 * spacing * ASIDE;
            rest[i].bend = (ei / (EI_OF_TRUSS * spacing * aside * aside)).min(fibre.stiffest(rest[i].mass));
            rest[i].turn.x = x[i].distance(x[i + 2]);
        }
        if i + 3 < n {
            rest[i].twist = rest[i].bend;
            rest[i].turn.y = x[i].distance(x[i + 3]);
            rest[i].turn.z = (x[i + 1] - x[i]).dot((x[i + 2] - x[i]).cross(x[i + 3] - x[i]));
        }
    }
    let mut stiffened = 0;
    if gravity != DVec3::ZERO {
        let mut pull: Vec<DVec3> = rest.iter().map(|p| gravity * p.mass).collect();
        for k in (3..n).rev() {
            let way = [1, 2, 3].map(|j| x[k - j] - x[k]);
            let towards = way.map(|w| w.normalize_or_zero());
            let tension = tensions(towards, -pull[k]);
            for j in 0..3 {
                pull[k - j - 1] -= towards[j] * tension[j];
            }
            rest[k - 1].tension = tension[0];
            for (j, length) in [(1, way[1].length()), (2, way[2].length())] {
                let at = &mut rest[k - j - 1];
                let needed = tension[j].abs() / (LARGEST_STRAIN * length);
                let stiffness = if j == 1 { &mut at.bend } else { &mut at.twist };
                if needed > *stiffness {
                    *stiffness = needed;
                    stiffened += 1;
                }
                let rest_length = length - tension[j] / *stiffness;
                if j == 1 { at.turn.x = rest_length } else { at.turn.y = rest_length }
            }
        }
    }
    // The frame of the root, in which the third particle is driven.
    rest[0].normal = (x[1] - x[0]).normalize_or(DVec3::Y).any_orthonormal_vector();
    RestShape { points: rest, stiffened }
}

/// The tensions along three directions that add up to `force`; the least ones where the directions do not span space.
fn tensions(towards: [DVec3; 3], force: DVec3) -> DVec3 {
    let d = DMat3::from_cols(towards[0], towards[1], towards[2]);
    if d.determinant().abs() > 1e-6 {
        return d.inverse() * force;
    }
    let t = d.transpose();
    t * ((d * t + DMat3::IDENTITY * 1e-6).inverse() * force)
}
