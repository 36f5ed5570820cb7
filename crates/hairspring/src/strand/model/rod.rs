//! The discrete elastic rod: the curvature model in frames that twist, one angle a segment, solved together with the points.
//!
//! ```text
//!        m_{j-1}       m_j
//!          ▲             ▲  τ_j     E = Σ ½ B |r|² + ½ ΔB (m·r)²  +  ½ GJ/L̄ (τ − τ⁰)²
//!   x_{j-1} ───► x_j ───► x_{j+1}   r = κ − d,  κ the change of tangent,  d the rest turn, fixed in the frame of segment j−1
//! ```
//!
//! Bergou et al. 2008, *Discrete Elastic Rods*: the centre line by its points, the material frame by an angle against a
//! frame carried in time. Where we deviate: the frame of the segment before a joint carries its whole rest turn (half-bandwidth 2, no
//! averaged vertex frame), the measure of twist is 2 tan(τ/2), which grows to the half turn, and the angles are unknowns of the same
//! linear system instead of being minimised before it, so that motion and twist see each other within a substep.
//! An angle has no inertia worth its name (a hair's own is a millionth of its stiffness at any frame rate).
//!
//! A flat fibre bends more easily across its short axis: ΔB is the stiffness that it has more in the direction of its frame's normal.

use super::{At, Model, Solved, bend::bend, bend::transport, curvature::turn_in_frame};
use crate::strand::{
    band::Band,
    lanes::{F, Row, Sym3, V3, load},
    root::Root,
    tile::{Tile, rest, state, strand},
};
use fearless_simd::prelude::*;

/// Largest turn of a frame about its segment in a substep [rad]: a Newton step is not to be believed beyond.
const LARGEST_TURN: f32 = 0.5;

/// Polar inertia of a frame over mass [m²], as a floor under the diagonal of the angles; that of a hair of 40 µm, r²/2.
const INERTIA: f32 = 8e-10;

/// Curvature and twist; see above.
pub struct Rod<S: Simd> {
    /// The frame's normal on segment i.
    normal: V3<S>,
    /// GJ/EI.
    twist_ratio: F<S>,
    /// ΔB/B.
    flat: F<S>,
}

impl<S: Simd> Model<S, 4, 12> for Rod<S> {
    #[inline(always)]
    fn begin(simd: S, tile: &Tile, root: &Root<S>) -> Self {
        Self {
            normal: root.normal,
            twist_ratio: load(simd, &tile.strand[strand::TWIST_RATIO]),
            flat: load(simd, &tile.strand[strand::FLAT]),
        }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, at: &At<S>, _: &[[Row; 3]], tile: &mut Tile, band: &mut Band<S, 4, 12>) {
        let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
        let joint = &tile.rest[at.i + 1];
        let [u0, u1] = at.u;
        let [alpha, beta] = at.inverse_length;
        let m0 = self.normal;

        // The frame of segment i+1 as the last substep left it, swung onto the segment.
        let carried = transport(m0, u0, u1);
        let row = &mut tile.state[at.i + 1][state::NORMAL..];
        let own = V3::load(simd, row);
        let across = own - u1 * own.dot(u1);
        let size = across.dot(across);
        let m1 = V3::select(size.simd_gt(1e-6), across * (one / size.max(1e-6).sqrt()), carried);
        m1.store(row);

        let stiffness = load(simd, &joint[rest::BEND]);
        let turn = V3::load(simd, &joint[rest::TURN..]);
        let d = turn_in_frame(turn, m0, u0);
        let joint_bend = bend(at.e, u0, at.inverse_length, d, stiffness, stiffness * at.damped);
        joint_bend.add_to(band);
        // The rest turn turns with the frame: ∂r/∂θ = −s.
        let s = u0.cross(d);
        let implicit = s * (stiffness * at.damped);
        let along = implicit * (u0.dot(d) + 1.0) * alpha;
        band.add_column(0, (0, 3), -along);
        band.add_column(1, (0, 3), implicit.mul_add(beta, along));
        band.add_column(2, (0, 3), implicit * -beta);
        band.add((0, 3), (0, 3), implicit.dot(s));
        band.add_right((0, 3), joint_bend.moment.dot(s));

        // Twist: how a change of the two segments turns their frames against each other is ∂τ/∂e = κb / 2ℓ on either side,
        // κb = 2 û₀×û₁ / (1 + û₀·û₁) (Bergou et al. 2010, *Discrete Viscous Threads*, §4.2.2).
        let sine = carried.cross(m1).dot(u1);
        // Bounded near the half turn, where the measure would grow without end.
        let tau = (sine + sine) / (carried.dot(m1) + 1.0).max(0.5);
        let slope = (tau * tau).mul_add(0.25, one);
        let twisting = stiffness * self.twist_ratio * slope;
        let element = RankOne {
            direction: u0.cross(u1) * (one / (u0.dot(u1) + 1.0).max(0.1)),
            points: [-alpha, alpha - beta, beta],
            angles: [-one, one],
            force: twisting * (tau - load(simd, &joint[rest::TWIST])),
            stiffness: twisting * slope * at.damped,
        };
        element.add_to(band);

        if tile.flat {
            // m·κ against its rest value; κ = e₁/L₁ − û₀.
            let kappa = at.e[1] * beta - u0;
            let a1 = u0.dot(kappa) + 1.0;
            let stiffer = stiffness * self.flat;
            let element = RankOne {
                direction: m0,
                points: [alpha * a1, -(alpha * a1) - beta, beta],
                angles: [-(m0.dot(u0.cross(kappa))), zero],
                force: stiffer * (m0.dot(kappa) - turn.x),
                stiffness: stiffer * at.damped,
            };
            element.add_to(band);
        }

        let inertia = load(simd, &joint[rest::MASS]) * (INERTIA / (at.h * at.h));
        let real = load(simd, &joint[rest::LENGTH]).simd_gt(0.0);
        band.add((1, 3), (1, 3), real.select(inertia, one));
        self.normal = V3::select(real, m1, m0);
    }

    #[inline(always)]
    fn take(simd: S, solved: &Solved<S, 12>, tile: &mut Tile) {
        let u = (solved.x[1] - solved.x[0]).length_and_unit().1;
        let turn = solved.unknowns[3].max(-LARGEST_TURN).min(LARGEST_TURN);
        let row = &mut tile.state[solved.i][state::NORMAL..];
        let m = V3::load(simd, row);
        u.cross(m).mul_add(turn, m).length_and_unit().1.store(row);
    }
}

/// An element with one strain: its gradient is `points[k]` times `direction` at the three points, and `angles` at the two angles.
struct RankOne<S: Simd> {
    direction: V3<S>,
    points: [F<S>; 3],
    angles: [F<S>; 2],
    /// Stiffness times strain.
    force: F<S>,
    /// Stiffness, with damping.
    stiffness: F<S>,
}

impl<S: Simd> RankOne<S> {
    #[inline(always)]
    fn add_to(&self, band: &mut Band<S, 4, 12>) {
        let Self { direction, points, angles, force, stiffness } = self;
        let block = Sym3::outer(*direction, *stiffness);
        for p in 0..3 {
            let scaled = block * points[p];
            band.add_diagonal(p, scaled * points[p]);
            for (q, c) in points.iter().enumerate().skip(p + 1) {
                band.add_block(p, q, &(scaled * *c).full());
            }
            band.add_force(p, *direction * -(*force * points[p]));
            for (q, angle) in angles.iter().enumerate() {
                band.add_column(p, (q, 3), *direction * (*stiffness * points[p] * *angle));
            }
        }
        for (p, a) in angles.iter().enumerate() {
            for (q, b) in angles.iter().enumerate().skip(p) {
                band.add((p, 3), (q, 3), *stiffness * *a * *b);
            }
            band.add_right((p, 3), -(*force * *a));
        }
    }
}
