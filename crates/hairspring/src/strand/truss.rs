//! The rest shape of a strand of the springs model, in f64: positions of the extra particles, lengths,
//! stiffnesses, and the sag-free start.
//!
//! Between two points of the strand, an extra particle next to the center makes a rigid triangle. Consecutive
//! triangles are a quarter turn apart. Three springs span a joint between two triangles. Together they
//! provide the joint's bending stiffness B = EI/L̄ and twisting stiffness C = GJ/L̄.
//!
//! Let x̂ be the direction of a straight strand, n₀ and n₁ the directions of the extra particles e₀ and e₁
//! before and after the joint at p₁, ε L their offsets, and w = ε L₀ L₁. A rotation φ of the joint lengthens
//! a spring of length ℓ by J·φ/ℓ:
//! ```text
//! p₀ e₁   J = −w x̂×n₁                     alone resists bending toward n₁:       k = B ℓ²/w²
//! e₀ p₂   J = −w x̂×n₀                     alone resists bending toward n₀:       k = B ℓ²/w²
//! e₀ e₁   J = −½w x̂×(n₀ + n₁) + εw x̂      with the others resists twist:         k = ℓ²/w² / (ε²/C − ¼(1/B₀ + 1/B₁))
//! ```
//!
//! The truss is statically determinate, so compliances add: 1/C = [ℓ²/k + ¼(ℓ²/k + ℓ²/k)] / (εw)², which
//! gives the third line.
//!
//! The same holds for the start under gravity. The springs (k−1, k), (k−2, k) and (k−3, k) hold particle k
//! from three directions. From the tip to the root, three tensions balance the forces on each particle, and
//! the rest lengths follow from the tensions.

use super::{
    model::{
        bend::transport_normal,
        springs::{BEND, Progressive, TORSION},
    },
    rest_shape::{Fiber, RestPoint, RestShape, Start, fine, rest_shape},
};
use crate::simd::lanes::{F, Simd, V3};
use glam::{DMat3, DVec3, Vec3};

/// Offset of an extra particle over the length of its segment, ε [1]. A larger offset gives bending more
/// digits in single precision, and the levers of the springs change less as a joint bends (see `springs`,
/// whose law is derived for this value).
pub const ASIDE: f64 = 1.5;

/// Signs of the extra particles' offsets along the frame's normal and binormal, alternately [1]. Each side
/// occurs as often as the other, and there are as many left turns as right turns. With right turns only, a
/// loaded curl would wind itself up.
const SIDES: [f64; 8] = [1.0, 1.0, -1.0, 1.0, 1.0, -1.0, -1.0, -1.0];

/// Share of a segment's mass in its extra particle [1]. The extra particle is not part of the fiber and does
/// not lie on it.
const EXTRA: f64 = 1.0 / 1024.0;

/// Bounds of ε²/C − ¼(1/B₀ + 1/B₁) over 1/B [1]. A round fiber with GJ/EI above 4 or below 0.3 gets the
/// closest value that the truss can provide. A joint that twists too easily rotates the levers of its springs
/// away from the bend, and folds.
const TWISTING: (f64, f64) = (0.05, 7.0);

/// Stiffness of the triangles relative to the joints in the matrix, over B/L² [1]. Softer triangles bend
/// instead of the joints, and a cantilever collapses. The two values are the minimum, and the one that
/// suffices where single precision can represent it.
const BRACED: [f64; 2] = [8.0, 30.0];

/// Smallest lever of a spring on its joint, relative to that in a straight strand [1].
const LEAST_LEVER: f64 = 0.5;

/// Largest rotation of a joint from its natural one at the sag-free start [rad]. It is smaller than the
/// rod's, because a truss folds sooner.
const LARGEST_ROTATION: f64 = 0.15;

/// Largest relative change of a spring's rest length at the sag-free start [1]. The spring is stiffened if it
/// would be exceeded.
const LARGEST_STRAIN: f64 = 0.2;

/// Returns the particles of a strand: its points, and one next to the center of each segment, a quarter turn
/// from the previous one. Shape `[2 points − 1]`.
pub fn particles(points: &[Vec3]) -> Vec<Vec3> {
    let mut out = Vec::with_capacity(2 * points.len() - 1);
    let mut normal = DVec3::ZERO;
    let mut before = DVec3::ZERO;
    for (k, w) in points.windows(2).enumerate() {
        let (a, b) = (w[0].as_dvec3(), w[1].as_dvec3());
        let t = (b - a).normalize_or(DVec3::Y);
        // The frame of `rest_shape`.
        normal = if k == 0 { t.any_orthonormal_vector() } else { transport_normal(normal, before, t) };
        before = t;
        let aside = side(k, t, normal);
        out.push(w[0]);
        out.push((0.5 * (a + b) + aside * (ASIDE * a.distance(b))).as_vec3());
    }
    out.extend(points.last());
    out
}

/// Direction from segment `k` to its extra particle. `t` is the unit vector along the segment and `normal`
/// the frame's normal.
pub fn side(k: usize, t: DVec3, normal: DVec3) -> DVec3 {
    SIDES[k % 8] * if k.is_multiple_of(2) { normal } else { t.cross(normal) }
}

/// The frame's normal on segment `k` along `t`, from the direction `side` of its extra particle.
pub fn normal_of(k: usize, t: DVec3, side: DVec3) -> DVec3 {
    SIDES[k % 8] * if k.is_multiple_of(2) { side } else { side.cross(t) }
}

/// Returns the rest shape of the truss through `particles` [m], with the fiber's radii at the strand's
/// points, in balance under `gravity` [m/s²] or stress-free.
///
/// `tile::springs` documents the rows of the rest points. `tension` is that of the strand's segment, and
/// `normal.x` that of the side to the next particle [N].
pub fn truss(particles: &[Vec3], fiber: &Fiber, gravity: DVec3) -> RestShape {
    let points: Vec<Vec3> = particles.iter().step_by(2).copied().collect();
    let strand = rest_shape(&points, fiber, gravity);
    let n = particles.len();
    let x: Vec<DVec3> = particles.iter().map(|p| p.as_dvec3()).collect();
    let mut rest = vec![RestPoint::default(); n];
    for (i, at) in rest.iter_mut().enumerate() {
        let RestPoint { length, mass, segment_mass, .. } = strand.points[i / 2];
        (at.length, at.mass) = if i % 2 == 0 {
            (length, (1.0 - EXTRA) * mass)
        } else {
            (length * (0.25 + ASIDE * ASIDE).sqrt(), EXTRA * segment_mass)
        };
        if i + 3 < n {
            at.turn.y = x[i].distance(x[i + 3]);
            at.turn.z = (x[i + 1] - x[i]).dot((x[i + 2] - x[i]).cross(x[i + 3] - x[i]));
        }
    }
    let mut start = Start { held_back: 0, ..strand.start };
    for j in 1..points.len() - 1 {
        let lengths = [strand.points[j - 1].length, strand.points[j].length];
        let shorter = lengths[0].min(lengths[1]);
        let stiffest = fiber.stiffest(strand.points[j].mass);
        let hardest = 1.0 + fiber.flat(j);
        let (before, at) = (&strand.points[j - 1], &strand.points[j]);
        let t = [2 * j, 2 * j + 2].map(|k| (x[k] - x[k - 2]).normalize_or_zero());
        let natural = before.normal * at.turn.x + t[0].cross(before.normal) * at.turn.y + t[0] * at.turn.z;
        let rotation = (t[1] - t[0] - natural).length();
        let bend = at.bend * (rotation / LARGEST_ROTATION).max(1.0);
        let most = stiffest * shorter * shorter / (BRACED[0] * hardest);
        // At most the stiffness that the rod may have. The rod's joint may have been reduced to exactly that.
        start.held_back += usize::from(bend >= most);
        let bend = bend.min(most);
        // A flat fiber is stiffer toward its frame's normal, the side of every other extra particle.
        let harder = [j - 1, j].map(|segment| if segment % 2 == 0 { hardest } else { 1.0 });
        let easier = 0.25 * (1.0 / harder[0] + 1.0 / harder[1]);
        let twisting = fiber.twist_ratio(j).map_or(0.0, |ratio| ASIDE * ASIDE / ratio - easier);
        let (p0, e0, p1, e1, p2) = (2 * j - 2, 2 * j - 1, 2 * j, 2 * j + 1, 2 * j + 2);
        let straight = |from: usize, to: usize| ASIDE * lengths[0] * lengths[1] / x[from].distance(x[to]);
        // In the strand's actual shape.
        let lever = |from: usize, to: usize| {
            let along = (x[to] - x[from]).normalize_or_zero();
            (x[to] - x[p1]).cross(along).length().max(LEAST_LEVER * straight(from, to))
        };
        rest[p0].twist = bend * harder[1] / lever(p0, e1).powi(2);
        rest[e0].twist = bend * harder[0] / lever(e0, p2).powi(2);
        rest[e0].bend = bend / twisting.clamp(TWISTING.0, TWISTING.1) / straight(e0, e1).powi(2);
        rest[e0].turn.x = x[e0].distance(x[e1]);
        // The same for both triangles: the shorter of them determines the levers at the joint.
        let brace = (BRACED[1] * hardest * bend / (shorter * shorter)).min(fine(points.len()) * stiffest);
        for point in [p0, p1] {
            rest[point].bend = rest[point].bend.max(brace);
        }
    }
    rest[0].normal = strand.points[0].normal;
    if gravity != DVec3::ZERO {
        let mut pull: Vec<DVec3> = rest.iter().map(|p| gravity * p.mass).collect();
        for k in (3..n).rev() {
            let spans = [1, 2, 3].map(|j| x[k - j] - x[k]);
            let towards = spans.map(|w| w.normalize_or_zero());
            let tension = tensions(towards, -pull[k]);
            for j in 0..3 {
                pull[k - j - 1] -= towards[j] * tension[j];
            }
            rest[k - 1].normal.x = tension[0];
            let mut rest_length = |j: usize, stiffness: &mut f64, law: Progressive| {
                let length = spans[j].length();
                let needed = tension[j].abs() / (LARGEST_STRAIN * length);
                if needed > *stiffness {
                    *stiffness = needed;
                    start.stiffened += 1;
                }
                length - law.lengthened(tension[j] / stiffness.max(f64::MIN_POSITIVE), length)
            };
            rest[k - 3].turn.y = rest_length(2, &mut rest[k - 3].twist, TORSION);
            if k % 2 == 0 {
                rest[k - 2].tension = tension[1];
            } else {
                rest[k - 2].turn.x = rest_length(1, &mut rest[k - 2].bend, BEND);
            }
        }
    }
    RestShape { points: rest, start }
}

/// Returns the position of an extra particle, currently at `p`, at the apex of its triangle over the segment
/// `e`, relative to the segment's start. The pair holds the segment's rest length and its inverse.
#[inline(always)]
pub fn beside<S: Simd>(simd: S, p: V3<S>, e: V3<S>, [length, inverse]: [F<S>; 2]) -> V3<S> {
    let middle = e * F::splat(simd, 0.5);
    let offset = p - middle;
    // Only the direction of the offset matters: w (u·u) − u (u·w) needs no division. Scaling by the rest
    // length keeps squares of short segments above zero.
    let u = e * inverse;
    let (_, aside) = (offset * u.dot(u) - u * u.dot(offset)).length_and_unit();
    aside.mul_add(length * ASIDE as f32, middle)
}

/// Returns the tensions along three directions that add up to `force`; the least-norm solution where the
/// directions do not span space.
fn tensions(towards: [DVec3; 3], force: DVec3) -> DVec3 {
    let d = DMat3::from_cols(towards[0], towards[1], towards[2]);
    if d.determinant().abs() > 1e-6 {
        return d.inverse() * force;
    }
    let t = d.transpose();
    t * ((d * t + DMat3::IDENTITY * 1e-6).inverse() * force)
}
