//! The rest shape of one strand, in f64: rest lengths, masses, bending stiffness and rest turns, and the
//! sag-free start.
//!
//! A groom is authored as it hangs: under gravity, in balance. If its shape were taken as the stress-free
//! one, it would bend in the first second. The sag-free start solves for the rest turns d that make every net
//! force exactly zero, from tip to root. With B the stiffness of a joint, m = B r its moment vector, and W
//! the weight that hangs from a segment,
//!
//! ```text
//! dE/de_i = (m_i − P_{i+1}ᵀ m_{i+1}) / L_i  ,   W_i = T_i û_i + dE/de_i      (segment i in balance; see `bend`)
//! m_i = (I − ûûᵀ)(L_i W_i + P_{i+1}ᵀ m_{i+1}),   d_i = t_i − t_{i−1} − m_i / B_i
//! ```
//!
//! The moment of a bend also rotates the frame of the segment before it. Rest twists balance that torque (see
//! `rod`), from tip to root:
//!
//! ```text
//! T_{i−1} = T_i + m_i · (û_{i−1} × κ_i),      τ⁰_i = −T_i / (GJ/L̄)_i
//! ```
//!
//! Rest lengths do not change; the tension T along the segment balances the component that stretch carries.
//! Where a single fiber cannot hold the shape, the bending stiffness is raised by the smallest sufficient
//! amount. Hsu et al. 2023, *Sag-Free Initialization for Strand-Based Hybrid Hair Simulation*, raise it too.
//! In reality, wax and neighboring hair hold such a style.

use super::{
    mass::masses,
    model::{
        bend::{FOLDED, transport_normal},
        rod::{FOLDING, curved_joint},
    },
    section::Section,
};
use crate::material::profile_at;
use glam::{DVec3, Vec3};

/// Largest |m|/B of a joint at the sag-free start [rad]. Beyond it, the linear moment no longer represents a
/// fiber.
const LARGEST_BEND: f64 = 0.5;

// The next three constants make the initial equilibrium stable, with a margin. At the exact thresholds, soft
// strands left it, growing by a factor of e every 60 ms, and were 20 cm away after two seconds. With these
// values, none of 64 strands of every preset moved by 0.01 mm in three seconds.

/// Largest rest twist of a joint at the sag-free start [rad]. A strand that holds its shape by more twist
/// buckles sideways (the bend-twist instability of a heavy curl). Long straight hair with bends in it is
/// affected first.
const LARGEST_TWIST: f64 = 0.03;

/// Largest natural curvature that the sag-free start gives a joint, times the fiber's bending length
/// (EI/ρgA)^⅓ [1]. A heavy strand that is held out by more curvature turns over sideways. The bend-twist
/// threshold Γ* = 0.41 (κL)³ at GJ/EI = 0.46, which does not depend on the length, is at 1.35.
const LARGEST_CURVATURE: f64 = 0.9;

/// Safety factor of bending stiffness over the load of what stands above a joint: B·L̄ ≥ 2 (weight moment of
/// the upright part) × (its length). For a straight column, the threshold of Greenhill 1881, ρgAL³/EI < 7.84,
/// is a quarter of that. A fiber that leans over or curls buckles sooner.
const STANDING_SAFETY: f64 = 2.0;

/// Number of points of a strand above which the largest stiffness of joints is reduced.
const LONG_STRAND: f64 = 512.0;

/// Largest bending stiffness of a joint over the largest stiffness of a spring on its point, times L² [1]. A joint acts
/// on its middle point with both segments, 4 B/L² in all, a spring with one only. A quarter of the stiffness preserves
/// the precision.
const JOINT_SHARE: f64 = 0.25;

/// Smallest share of twist in a joint that is nearly folded which the sag-free start assumes [1]. With a smaller one,
/// the joint would need unbounded stiffness.
const MIN_TWIST_SHARE: f64 = 0.1;

/// Smallest length of a segment that is divided by [m].
const MIN_LENGTH: f64 = 1e-9;

/// Properties of a fiber along one strand.
pub struct Fiber<'a> {
    /// Radius at each point [m].
    pub radii: &'a [f32],
    /// Density [kg/m³].
    pub density: f64,
    /// Distribution of the mass along the strand: weights at equal spacing from root to tip. Empty for a
    /// uniform distribution.
    pub mass_profile: &'a [f32],
    /// Young's modulus times the style's multiplier, at the root of a round fiber [Pa].
    pub young: f64,
    /// Multiplier of Young's modulus along the strand, from root to tip.
    pub bend_profile: &'a [f32],
    /// Cross section at each point.
    pub sections: &'a [Section],
    /// Whether the model has twist.
    pub twists: bool,
    /// Length of a substep [s].
    pub substep: f64,
    /// Largest relaxation time of bending along the strand [s].
    pub damping: f64,
    /// Whether the strand is solved in double precision.
    pub double: bool,
}

/// Largest stiffness of an element of the matrix relative to the inertia m/h² of its points, in single
/// precision [1].
///
/// The matrix entry of a point is its inertia plus the stiffness k of its elements. Rounding the sum to 24
/// bits changes it by 2⁻²⁴ k. While that is well below m/h², the strand moves according to its mass; above,
/// rounding accelerates and brakes the points. 2⁻²⁴ · 4·10⁶ is a quarter. A hair of 40 µm is at 4 in segments
/// of 8 mm, at 10⁴ in segments of 1 mm, and at 10⁸ in segments of 0.1 mm; its damping τ multiplies that by 1
/// + τ/h.
const STIFFEST_SINGLE: f64 = 4e6;

/// Largest stiffness of an element of the matrix relative to the inertia of its points, in double precision, whose
/// significand is 29 bits longer [1].
const STIFFEST_DOUBLE: f64 = STIFFEST_SINGLE * (1u64 << 29) as f64;

impl Fiber<'_> {
    /// Relative additional bending stiffness of joint `j` in the plane of the frame's normal, ΔB/B [1].
    pub fn flat(&self, j: usize) -> f64 {
        self.sections[j].flat.into()
    }

    /// Twisting over bending stiffness of joint `j`, GJ/EI [1]; `None` for a model without twist.
    pub fn twist_ratio(&self, j: usize) -> Option<f64> {
        self.twists.then(|| self.sections[j].twist_ratio.into())
    }

    /// Returns the largest stiffness [N/m] of a spring on a point of this mass [kg] that the matrix can
    /// represent together with its damping.
    pub fn stiffest(&self, mass: f64) -> f64 {
        let most = if self.double { STIFFEST_DOUBLE } else { STIFFEST_SINGLE };
        most * mass / (self.substep * self.substep * (1.0 + self.damping / self.substep))
    }
}

/// Reduction of the largest stiffness of joints and triangles in a strand of `points`, relative to a shorter
/// one [1]. A rounding error at one of them rotates everything beyond it.
pub fn fine(points: usize) -> f64 {
    (LONG_STRAND / points as f64).min(1.0)
}

/// One point of a rest shape.
#[derive(Clone, Copy, Debug, Default)]
pub struct RestPoint {
    /// Rest length to the next point [m].
    pub length: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Mass of the segment that begins here [kg].
    pub segment_mass: f64,
    /// Bending stiffness of the joint at this point [N m].
    pub bend: f64,
    /// Rest turn of the joint, in the frame (normal, binormal, tangent) of the segment before.
    pub turn: DVec3,
    /// Rest twist of the joint.
    pub twist: f64,
    /// Tension of the segment that begins here, at the start [N].
    pub tension: f64,
    /// The frame's normal on the segment that begins here.
    pub normal: DVec3,
}

/// The rest shape of a strand.
pub struct RestShape {
    /// Shape `[points]`.
    pub points: Vec<RestPoint>,
    /// Changes to the fiber that the shape required.
    pub start: Start,
}

/// Changes to fibers that were needed so that strands start as authored, and changes that were not possible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Start {
    /// Joints whose bending stiffness the sag-free start raised, by the smallest amount that holds the shape:
    /// no fiber of the material could hold it.
    pub stiffened: usize,
    /// Joints that are softer than the material, or than the shape requires, because the precision of the solve
    /// cannot represent stiffer ones in a substep of this length. More substeps help. (Springs that hold the extra
    /// particles of a truss are not counted.)
    pub held_back: usize,
    /// Strands with the curvature model that are simulated as rods, because they turn by more than half a turn
    /// and that model has no twist.
    pub coils: usize,
}

impl std::ops::Add for Start {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            stiffened: self.stiffened + other.stiffened,
            held_back: self.held_back + other.held_back,
            coils: self.coils + other.coils,
        }
    }
}

impl std::iter::Sum for Start {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, one| sum + one)
    }
}

/// Returns the rest shape of the strand through `points` [m], in balance under `gravity` [m/s²], or
/// stress-free if that is zero. Requires three or more points, with no two consecutive ones equal.
pub fn rest_shape(points: &[Vec3], fiber: &Fiber, gravity: DVec3) -> RestShape {
    let n = points.len();
    let x: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let e: Vec<DVec3> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let lengths: Vec<f64> = e.iter().map(|e| e.length().max(MIN_LENGTH)).collect();
    let t: Vec<DVec3> = e.iter().zip(&lengths).map(|(e, l)| *e / *l).collect();
    let total: f64 = lengths.iter().sum();

    let mut rest = vec![RestPoint::default(); n];
    for (i, (at, mass)) in rest.iter_mut().zip(masses(&lengths, fiber)).enumerate() {
        (at.mass, at.segment_mass) = (mass.point, mass.segment);
        at.length = lengths.get(i).copied().unwrap_or(0.0);
    }
    let mut along = 0.0;
    for j in 1..n - 1 {
        along += lengths[j - 1];
        let r = fiber.radii[j] as f64;
        let young = fiber.young * profile_at(fiber.bend_profile, along / total);
        let ei = young * f64::from(fiber.sections[j].bend) * std::f64::consts::FRAC_PI_4 * r.powi(4);
        // The driven first segment is rigid. Its compliance is added to the first joint, so that the strand
        // bends like one clamped at its root.
        let mean = if j == 1 { lengths[0] + 0.5 * lengths[1] } else { 0.5 * (lengths[j - 1] + lengths[j]) };
        rest[j].bend = ei / mean;
    }
    let mut start = Start::default();
    // Limits the stiffness of a joint. Returns 1 if it had to be reduced, else 0.
    let hold_back = |j: usize, at: &mut RestPoint| {
        let shorter = lengths[j - 1].min(lengths[j]);
        let stiffest = JOINT_SHARE * fine(n) * fiber.stiffest(at.mass) * shorter * shorter;
        let wanted = at.bend;
        at.bend = wanted.min(stiffest);
        usize::from(wanted > stiffest)
    };

    // The parallel-transported frame of the strand.
    rest[0].normal = t[0].any_orthonormal_vector();
    for i in 1..n - 1 {
        rest[i].normal = transport_normal(rest[i - 1].normal, t[i - 1], t[i]);
    }

    if gravity != DVec3::ZERO {
        let up = -gravity.normalize();
        let g = gravity.length();
        // The weight that hangs beyond a joint, its moment about the joint where it stands above, and the arc
        // length beyond.
        let (mut weight, mut below) = (DVec3::ZERO, DVec3::ZERO);
        let (mut mass, mut height, mut arc) = (0.0, 0.0, 0.0);
        let (mut torque, mut torque_after) = (0.0f64, DVec3::ZERO);
        for i in (1..n - 1).rev() {
            weight += gravity * rest[i + 1].mass;
            mass += rest[i + 1].mass;
            height += mass * e[i].dot(up);
            arc += lengths[i];
            // The twist torques of the joints at both ends also act on this segment (see `rod`).
            let unfolded = |j: usize| 0.5 * (t[j - 1] + t[j]).length_squared();
            let binormal = |j: usize| t[j - 1].cross(t[j]) / unfolded(j).max(FOLDED as f64);
            // The remaining share of twist in a joint that is nearly folded (see `rod`).
            let fade = |j: usize| {
                let z = (unfolded(j) / FOLDING as f64).min(1.0);
                (z * (2.0 - z)).max(MIN_TWIST_SHARE)
            };
            let carried = weight * lengths[i] + below - binormal(i) * torque - torque_after;
            let axial = carried.dot(t[i]);
            let moment = carried - t[i] * axial;
            rest[i].tension = axial / lengths[i];
            let mean =
                if i == 1 { lengths[0] + 0.5 * lengths[1] } else { 0.5 * (lengths[i - 1] + lengths[i]) };
            // The local weight per length. With the mean over everything beyond, strands with heavy tips were
            // unstable.
            let weight_per_length = g * rest[i].mass / mean;
            let curving = (moment.length() / LARGEST_CURVATURE).powf(1.5) / weight_per_length.sqrt() / mean;
            let twisting = fiber.twist_ratio(i).map_or(0.0, |ratio| {
                let along = t[i - 1].dot(t[i]) - 1.0;
                torque.abs() / (ratio * curved_joint(along) * fade(i).powi(2) * LARGEST_TWIST)
            });
            let bending = (moment.length() / LARGEST_BEND).max(twisting);
            let needed = bending.max(curving).max(STANDING_SAFETY * g * height.max(0.0) * arc / mean);
            if needed > rest[i].bend {
                rest[i].bend = needed;
                start.stiffened += 1;
            }
            start.held_back += hold_back(i, &mut rest[i]);
            let frame = rest[i - 1].normal;
            let flat = fiber.flat(i);
            let stiff = frame * (frame.dot(moment) * flat / (1.0 + flat));
            let kappa = t[i] - t[i - 1];
            // A joint without stiffness has no moment: only a strand that hangs straight down may have one.
            let bend = rest[i].bend.max(f64::MIN_POSITIVE);
            rest[i].turn = kappa - (moment - stiff) / bend;
            below = moment * (1.0 + t[i - 1].dot(kappa)) - kappa * t[i - 1].dot(moment);
            if let Some(ratio) = fiber.twist_ratio(i) {
                let twisting = ratio * bend * curved_joint(rest[i].turn.dot(t[i - 1]));
                rest[i].twist = -torque / (twisting * fade(i).powi(2));
                torque_after = binormal(i) * torque;
                torque += moment.dot(t[i - 1].cross(kappa));
            }
        }
    } else {
        for i in 1..n - 1 {
            start.held_back += hold_back(i, &mut rest[i]);
            rest[i].turn = t[i] - t[i - 1];
        }
    }

    // Converts the rest turns to the frames.
    for i in 1..n - 1 {
        let (d, frame) = (rest[i].turn, rest[i - 1].normal);
        rest[i].turn = DVec3::new(d.dot(frame), d.dot(t[i - 1].cross(frame)), d.dot(t[i - 1]));
    }
    RestShape { points: rest, start }
}
