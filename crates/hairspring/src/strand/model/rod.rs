//! The discrete elastic rod: the curvature model in frames that twist, one angle a segment, solved together with the points.
//!
//! ```text
//!        m_{j-1}       m_j
//!          ▲             ▲  φ_j     E = Σ ½ B |r|² + ½ ΔB (m·r)²  +  ½ GJ/L̄ s² (τ − τ⁰)²
//!   x_{j-1} ───► x_j ───► x_{j+1}   r = κ − d,  κ the change of tangent,  d the rest turn, fixed in the frame of segment j−1
//! ```
//!
//! Bergou et al. 2008, *Discrete Elastic Rods*: the centre line by its points, the material frame by an angle against a
//! frame carried in time. Where we deviate: the frame of the segment before a joint carries its whole rest turn (half-bandwidth 2, no
//! averaged vertex frame), the measure of a twist φ is τ = 4 tan(φ/4), which grows up to the half turn, and the angles are unknowns of the same
//! linear system instead of being minimised before it, so that motion and twist see each other within a substep.
//! An angle has no inertia worth its name (a hair's own is a millionth of its stiffness at any frame rate).
//!
//! Bending is bounded and smooth at any angle: |r| is the distance between two unit vectors. Twist is not defined in a joint that is folded back on itself, so
//! its strain fades out from 139° to 180° by the factor s = z (2 − z), z = (1 + cos θ) / ¼. All forces are the gradient of E, that factor included, and
//! all matrices are Gauss–Newton's.
//!
//! Where a strand is curved at rest its segments are chords, and a polygon of rods is stiffer than the curve: twisting stiffness is less by (1 − cos θ⁰)/8 where a
//! joint turns by θ⁰ at rest. That is calibrated: a helical spring of eight segments a turn gives way along its axis, about it and across it as the wire does, within 5 %.
//!
//! A flat fibre bends more easily across its short axis: ΔB is the stiffness that it has more in the direction of its frame's normal.

use super::{
    At, Model, Solved,
    bend::{Bend, FOLDED, bend, transport},
    curvature::turn_in_frame,
};
use crate::{
    simd::{
        dispatch::{dispatch, dispatch_double},
        lanes::{F, Simd, V3, load},
    },
    strand::{
        band::Band,
        frame_context::FrameContext,
        integrate::run_tile,
        precomputed::Precomputed,
        root::Root,
        scratch::{Memory, Scratch},
        system::System,
        tile::{Tile, rest, state, strand},
    },
};
use fearless_simd::Level;

/// Largest turn of a frame about its segment in a substep [rad]: a Newton step is not to be believed beyond.
const LARGEST_TURN: f32 = 0.5;

/// 1 + cos θ of a joint's angle θ below which its twist fades out, see above [1]; 139°.
pub const FOLDING: f32 = 0.25;

/// By how much natural curvature softens a joint's twisting stiffness, over 1 − cos θ⁰ of its rest turn θ⁰ [1].
const CURVED: f32 = 0.125;

/// Least factor of a joint's twisting stiffness for its natural curvature [1].
const MOST_CURVED: f32 = 0.5;

/// Factor of a joint's twisting stiffness for its natural curvature: 1 − (1 − cos θ⁰)/8 with the rest turn θ⁰, of which `along` is the part along the segment before,
/// cos θ⁰ − 1 [1].
#[inline(always)]
pub fn curved<S: Simd>(along: F<S>) -> F<S> {
    let one = F::<S>::splat(along.simd, 1.0);
    along.mul_add(CURVED, one).max(MOST_CURVED)
}

/// The same for one joint in double precision.
pub fn curved_joint(along: f64) -> f64 {
    (1.0 + f64::from(CURVED) * along).max(f64::from(MOST_CURVED))
}

/// Polar inertia of a frame over mass [m²], as a floor under the diagonal of the angles; that of a hair of 40 µm, r²/2.
const INERTIA: f32 = 8e-10;

/// How many roundings of a joint's twisting stiffness hold its angle to that of the last substep [1]. Beyond a joint that is folded back on itself nothing else does but
/// inertia, which rounding outweighs; a twist that changes takes a substep more at most.
const HELD: f32 = 16.0;

/// Curvature and twist; see above.
#[derive(Clone, Copy)]
pub struct Rod<S: Simd> {
    /// The frame's normal on segment i.
    normal: V3<S>,
    /// GJ/EI.
    twist_ratio: F<S>,
    /// ΔB/B.
    flat: F<S>,
}

impl<S: Simd> Model<S, 4, 11> for Rod<S> {
    #[inline(always)]
    fn begin(simd: S, tile: &Tile, root: &Root<S>) -> Self {
        Self {
            normal: root.normal,
            twist_ratio: load(simd, &tile.strand[strand::TWIST_RATIO]),
            flat: load(simd, &tile.strand[strand::FLAT]),
        }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, at: &At<S>, _: &Scratch, tile: &mut Tile, band: &mut Band<S, 4, 11>) {
        let one = F::<S>::splat(simd, 1.0);
        let own = &tile.rest[at.i + 1];
        let [u0, u1] = at.u;
        let [alpha, beta] = at.inverse_length;
        let m0 = self.normal;

        // The frame of segment i+1 as the last substep left it, swung onto the segment.
        let carried = transport(m0, u0, u1);
        let row = &mut tile.state[at.i + 1][state::NORMAL..];
        let was = V3::load(simd, row);
        let across = was - u1 * was.dot(u1);
        let size = across.dot(across);
        let m1 = V3::select(size.simd_gt(1e-6), across * (one / size.max(1e-6).sqrt()), carried);
        m1.store(row);

        let stiffness = load(simd, &own[rest::BEND]);
        let turn = V3::load(simd, &own[rest::TURN..]);
        let d = turn_in_frame(turn, m0, u0);
        let Bend { mut joint, moment } =
            bend([at.e, at.drift], u0, at.inverse_length, d, stiffness, stiffness * at.damped);
        // The rest turn turns with the frame: ∂r/∂θ = −s.
        let s = u0.cross(d);
        let implicit = s * (stiffness * at.damped);
        let mut angle = Angle {
            segments: [implicit * (u0.dot(d) + 1.0) * alpha, implicit * -beta],
            own: implicit.dot(s),
            moment: moment.dot(s),
        };

        // Twist: how a change of the two segments turns their frames against each other is ∂φ/∂e = κb / 2ℓ on either side,
        // κb = 2 û₀×û₁ / (1 + û₀·û₁) (Bergou et al. 2010, *Discrete Viscous Threads*, §4.2.2). ∂φ/∂θ is −1 and 1. The strain is
        // s (τ − τ⁰), s = 1 but near a fold.
        let half = carried.cross(m1).dot(u1) / (carried.dot(m1) + 1.0).max(FOLDED);
        let tau = half * 4.0 / (half.mul_add(half, one).sqrt() + 1.0);
        let slope = (tau * tau).mul_add(0.0625, one);
        let sum = u0 + u1;
        let unfolded = sum.dot(sum) * 0.5;
        let z = (unfolded * (1.0 / FOLDING)).min(1.0);
        let fade = z * (2.0 - z);
        let twist = tau - load(simd, &own[rest::TWIST]);
        let (strain, turning) = (fade * twist, fade * slope);
        let direction = u0.cross(u1) * (turning / unfolded.max(FOLDED));
        // ∂s/∂e, where the joint is nearly folded: 1 + û₀·û₁ grows by (û₁ − û₀ cos θ)/ℓ₀ and (û₀ − û₁ cos θ)/ℓ₁.
        let opening = twist * ((1.0 - z) * (2.0 / FOLDING));
        let cosine = unfolded - 1.0;
        let gradient = [
            ((u1 - u0 * cosine) * opening + direction) * alpha,
            ((u0 - u1 * cosine) * opening + direction) * beta,
        ];
        let twisting = stiffness * self.twist_ratio * curved(turn.z);
        let k = twisting * at.damped;
        let [d0, d1] = at.drift;
        let drift = gradient[0].dot(d0) + gradient[1].dot(d1);
        let force = k.mul_add(drift, twisting * strain);
        joint.add_strain(gradient, force, k);
        let kt = k * turning;
        let columns = gradient.map(|g| g * kt);
        angle.segments = [angle.segments[0] - columns[0], angle.segments[1] - columns[1]];
        let (own_angle, moment) = (kt * turning, force * turning);
        angle.own += own_angle;
        angle.moment += moment;
        band.add_column(1, (1, 3), columns[0] - columns[1]);
        band.add_column(0, (1, 3), -columns[0]);
        band.add_column(2, (1, 3), columns[1]);
        band.add((0, 3), (1, 3), -own_angle);
        band.add((1, 3), (1, 3), own_angle * (1.0 + HELD * S::ROUNDING));
        band.add_right((1, 3), -moment);

        if tile.flat {
            // m·κ against its rest value; κ = e₁/L₁ − û₀.
            let kappa = at.e[1] * beta - u0;
            let a1 = u0.dot(kappa) + 1.0;
            let stiffer = stiffness * self.flat;
            let along = [-(alpha * a1), beta];
            let [d0, d1] = at.drift;
            let drift = m0.dot(d0 * along[0] + d1 * along[1]);
            let k = stiffer * at.damped;
            let force = k.mul_add(drift, stiffer * (m0.dot(kappa) - turn.x));
            joint.add_rank_one(m0, along, force, k);
            let turned = -(m0.dot(u0.cross(kappa)));
            let column = m0 * (k * turned);
            angle.segments =
                [column.mul_add(along[0], angle.segments[0]), column.mul_add(along[1], angle.segments[1])];
            angle.own += k * turned * turned;
            angle.moment -= force * turned;
        }
        joint.add_to(band);
        angle.add_to(band);

        let inertia = load(simd, &own[rest::MASS]) * (INERTIA / (at.h * at.h));
        let real = load(simd, &own[rest::LENGTH]).simd_gt(0.0);
        band.add((1, 3), (1, 3), real.select(inertia, one));
        self.normal = V3::select(real, m1, m0);
    }

    #[inline(always)]
    fn take(simd: S, solved: &Solved<S, 11>, tile: &mut Tile, _: &[Precomputed]) {
        let u = solved.edges[0].length_and_unit().1;
        let turn = solved.unknowns[3].max(-LARGEST_TURN).min(LARGEST_TURN);
        let row = &mut tile.state[solved.i][state::NORMAL..];
        let m = V3::load(simd, row);
        u.cross(m).mul_add(turn, m).length_and_unit().1.store(row);
    }
}

/// One tile through an interval, on the widest lanes that there are.
pub fn run(level: Level, interval: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    if tile.double {
        dispatch_double!(level, simd => run_tile::<_, Rod<_>, 4, 11>(simd, interval, tile, memory));
    } else {
        dispatch!(level, simd => run_tile::<_, Rod<_>, 4, 11>(simd, interval, tile, memory));
    }
}

/// What the elements of a joint say of the angle of its first segment.
struct Angle<S: Simd> {
    /// Its column of the matrix, by the joint's two segments.
    segments: [V3<S>; 2],
    /// Its own entry.
    own: F<S>,
    /// The moment on it [N m].
    moment: F<S>,
}

impl<S: Simd> Angle<S> {
    #[inline(always)]
    fn add_to(&self, band: &mut Band<S, 4, 11>) {
        let [c0, c1] = self.segments;
        band.add_column(0, (0, 3), -c0);
        band.add_column(1, (0, 3), c0 - c1);
        band.add_column(2, (0, 3), c1);
        band.add((0, 3), (0, 3), self.own);
        band.add_right((0, 3), self.moment);
    }
}
