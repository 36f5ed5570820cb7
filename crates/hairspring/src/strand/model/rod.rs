//! The discrete elastic rod: the curvature model in frames that can twist. Each segment has one angle, solved
//! together with the points.
//!
//! ```text
//!        m_{j-1}       m_j
//!          ▲             ▲  φ_j     E = Σ ½ B |r|² + ½ ΔB (m·r)²  +  ½ GJ/L̄ s² (τ − τ⁰)²
//!   x_{j-1} ───► x_j ───► x_{j+1}   r = κ − d,  κ the change of tangent,
//!                                   d the rest turn, fixed in the frame of segment j−1
//! ```
//!
//! Bergou et al. 2008, *Discrete Elastic Rods*: points represent the centerline, and an angle against a
//! time-parallel frame represents the material frame. This implementation deviates in three ways:
//!
//! - The frame of the segment before a joint carries its whole rest turn. There is no averaged vertex frame,
//!   and the half-bandwidth is 2.
//! - The measure of a twist φ is τ = 4 tan(φ/4), which increases up to the half turn.
//! - The angles are unknowns of the same linear system instead of being minimized before it, so motion and
//!   twist are coupled within a substep.
//!
//! The inertia of an angle is negligible: that of a hair is a millionth of its stiffness at any frame rate.
//!
//! Bending is bounded and smooth at any angle, because |r| is the distance between two unit vectors. Twist is
//! undefined in a joint that is folded back on itself. Its strain therefore fades out from 139° to 180° by
//! the factor s = z (2 − z), z = (1 + cos θ) / ¼. All forces are the gradient of E, including that factor.
//! All matrices are Gauss–Newton approximations.
//!
//! The segments of a strand that is curved at rest are chords, and a polygon of rods is stiffer than the
//! curve. The twisting stiffness of a joint is therefore reduced by the share (1 − cos θ⁰)/8, where θ⁰ is its
//! rest turn. The share is calibrated: a helical spring of eight segments a turn has the compliance of the
//! wire along its axis, about it and across it, within 5 %.
//!
//! A flat fiber bends more easily across its short axis. ΔB is its additional stiffness in the direction of
//! the frame's normal.

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
        integrate::{Implicit, run_tile},
        precomputed::Precomputed,
        root::Root,
        scratch::{Memory, Scratch},
        system::System,
        tile::{Tile, multipliers, rest, state, strand},
    },
};
use fearless_simd::Level;

/// Largest rotation of a frame about its segment in a substep [rad]. A Newton step is not reliable beyond it.
const LARGEST_TURN: f32 = 0.5;

/// 1 + cos θ below which the twist of a joint with angle θ fades out; see the module documentation [1].
/// Corresponds to 139°.
pub const FOLDING: f32 = 0.25;

/// Relative reduction of a joint's twisting stiffness by natural curvature, divided by 1 − cos θ⁰ of its rest
/// turn θ⁰ [1].
const CURVED: f32 = 0.125;

/// Lower bound of the factor of a joint's twisting stiffness for natural curvature [1].
const MAX_CURVED: f32 = 0.5;

/// Factor of a joint's twisting stiffness for natural curvature: 1 − (1 − cos θ⁰)/8 with the rest turn θ⁰
/// [1]. `along` is the component of the rest turn along the segment before, cos θ⁰ − 1.
#[inline(always)]
pub fn curved<S: Simd>(along: F<S>) -> F<S> {
    let one = F::<S>::splat(along.simd, 1.0);
    along.mul_add(CURVED, one).max(MAX_CURVED)
}

/// Factor of a joint's twisting stiffness for natural curvature, for one joint in double precision; see [`curved`].
pub fn curved_joint(along: f64) -> f64 {
    (1.0 + f64::from(CURVED) * along).max(f64::from(MAX_CURVED))
}

/// Polar inertia of a frame over mass [m²], which bounds the diagonal of the angles from below: r²/2 of a
/// hair with r = 40 µm.
const INERTIA: f32 = 8e-10;

/// Regularization of an angle toward its last value, in roundings of its joint's twisting stiffness [1].
/// Beyond a joint that is folded back on itself, only inertia constrains the angle otherwise, and rounding
/// exceeds inertia. A twist that changes takes at most one substep longer.
const HELD: f32 = 16.0;

/// Curvature and twist; see the module documentation.
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

    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn add(&mut self, simd: S, at: &At<S>, _: &Scratch, tile: &mut Tile, band: &mut Band<S, 4, 11>) {
        let one = F::<S>::splat(simd, 1.0);
        let own = &tile.rest[at.i + 1];
        let (twist_ratio, flat) = match tile.multipliers.get(at.i + 1) {
            Some(rows) => (load(simd, &rows[multipliers::TWIST_RATIO]), load(simd, &rows[multipliers::FLAT])),
            None => (self.twist_ratio, self.flat),
        };
        let [u0, u1] = at.u;
        let [alpha, beta] = at.inverse_length;
        let m0 = self.normal;

        // The frame of segment i+1 after the last substep, made perpendicular to the segment.
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
        // The rest turn rotates with the frame: ∂r/∂θ = −s.
        let s = u0.cross(d);
        let implicit = s * (stiffness * at.damped);
        let mut angle = Angle {
            segments: [implicit * (u0.dot(d) + 1.0) * alpha, implicit * -beta],
            own: implicit.dot(s),
            moment: moment.dot(s),
        };

        // Twist. ∂φ/∂e = κb / 2ℓ on both sides is the relative rotation of the two frames when the segments
        // change, with κb = 2 û₀×û₁ / (1 + û₀·û₁) (Bergou et al. 2010, *Discrete Viscous Threads*, §4.2.2).
        // ∂φ/∂θ is −1 and 1. The strain is s (τ − τ⁰), where s = 1 except near a fold.
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
        // ∂s/∂e of a joint that is nearly folded: the gradients of 1 + û₀·û₁ are (û₁ − û₀ cos θ)/ℓ₀ and (û₀ −
        // û₁ cos θ)/ℓ₁.
        let opening = twist * ((1.0 - z) * (2.0 / FOLDING));
        let cosine = unfolded - 1.0;
        let gradient = [
            ((u1 - u0 * cosine) * opening + direction) * alpha,
            ((u0 - u1 * cosine) * opening + direction) * beta,
        ];
        let twisting = stiffness * twist_ratio * curved(turn.z);
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

        if tile.layout.flat {
            // m·κ minus its rest value; κ = e₁/L₁ − û₀.
            let kappa = at.e[1] * beta - u0;
            let a1 = u0.dot(kappa) + 1.0;
            let stiffer = stiffness * flat;
            let gradient = [-(alpha * a1), beta];
            let [d0, d1] = at.drift;
            let drift = m0.dot(d0 * gradient[0] + d1 * gradient[1]);
            let k = stiffer * at.damped;
            let force = k.mul_add(drift, stiffer * (m0.dot(kappa) - turn.x));
            joint.add_rank_one(m0, gradient, force, k);
            let turned = -(m0.dot(u0.cross(kappa)));
            let column = m0 * (k * turned);
            angle.segments = [
                column.mul_add(gradient[0], angle.segments[0]),
                column.mul_add(gradient[1], angle.segments[1]),
            ];
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

/// Advances one tile through a frame with the implicit integrators, and the widest available SIMD
/// instructions.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    if tile.layout.double {
        dispatch_double!(level, simd => run_tile::<_, Rod<_>, Implicit, 4, 11>(simd, frame, tile, memory));
    } else {
        dispatch!(level, simd => run_tile::<_, Rod<_>, Implicit, 4, 11>(simd, frame, tile, memory));
    }
}

/// Entries of a joint's elements for the angle of its first segment.
struct Angle<S: Simd> {
    /// Column of the matrix, with respect to the joint's two segments.
    segments: [V3<S>; 2],
    /// Diagonal entry.
    own: F<S>,
    /// Moment on the angle [N m].
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
