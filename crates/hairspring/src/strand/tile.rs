//! Memory layout of eight strands: `[tile][point][component][lane]`. All substeps of a frame access one tile
//! in the L1 caches.
//!
//! Strands are sorted by their elastic model and precision, then by their number of points, then along a Morton
//! curve (`simulation/layout.rs`). Neighbors in that order share a tile. Shorter strands are padded with points of
//! rest length zero, which coincide with the tip and carry no force.

use super::tile_arrays::{access, tile_arrays};
use crate::simd::lanes::{F, Row, Simd, load};

/// Rows of state a point.
pub mod state {
    /// Vector from the previous particle to this one [m], 3 rows; 0 at the root and beyond the tip. Positions
    /// are not stored. At a meter from the root, the resolution of f32 is 60 nm, which rotates a segment of 1
    /// mm by 60 µrad. In a thousand stiff joints, such rotations whip the tip.
    pub const EDGE: usize = 0;
    /// Velocity [m/s], 3 rows.
    pub const V: usize = 3;
    /// Tension of the segment from this point to the strand's next, from the last substep [N].
    pub const TENSION: usize = 6;
    /// The frame's normal on the segment from this point to the next, 3 rows.
    pub const NORMAL: usize = 7;
    /// Contact force of a collider on this point, from the last substep; 0 without contact [N].
    pub const NORMAL_FORCE: usize = 10;
    /// Stretch of the friction spring between this point and a collider, 3 rows; 0 without contact [m].
    pub const FRICTION_STRETCH: usize = 11;
    /// Rows a point.
    pub const ROWS: usize = 14;
}

/// Rows of the rest shape a point.
pub mod rest {
    /// Rest length of the segment from this point to the strand's next [m]; 0 from the tip on.
    pub const LENGTH: usize = 0;
    /// Mass [kg].
    pub const MASS: usize = 1;
    /// Bending stiffness of the joint at this point, EI over the mean length of its two segments [N m];
    /// 0 at the root and from the tip on.
    pub const BEND: usize = 2;
    /// Rest change of tangent at this joint, in the frame of the segment before it, 3 rows [1].
    pub const TURN: usize = 3;
    /// Smallest permitted signed distance from a collider, 0 or less: the authored one [m].
    pub const CLEARANCE: usize = 6;
    /// Rest twist φ of the joint at this point, from the segment before to the one after, as 4 tan(φ/4) [1];
    /// see `rod`.
    pub const TWIST: usize = 7;
    /// Share of this point's velocity that is relative to the air [1]: 1 on a lone hair, and less where the air moves with
    /// the hair; see `simulation/carried_air.rs`.
    pub const SLIP: usize = 8;
    /// Rows a point.
    pub const ROWS: usize = 9;
}

/// Rows of the constants that vary along a strand, at each particle.
pub mod multipliers {
    /// Multiplier of `strand::DRAG` [1].
    pub const DRAG: usize = 0;
    /// Multiplier of `strand::DAMPING` [1].
    pub const DAMPING: usize = 1;
    /// Multiplier of `strand::FRICTION` [1].
    pub const FRICTION: usize = 2;
    /// Replaces `strand::TWIST_RATIO` [1].
    pub const TWIST_RATIO: usize = 3;
    /// Replaces `strand::FLAT` [1].
    pub const FLAT: usize = 4;
    /// Rows a point.
    pub const ROWS: usize = 5;
}

/// Rows of the motion of a strand's root in a frame.
pub mod root {
    /// Position relative to the anchor at the start of the frame [m], 3 rows.
    pub const START: usize = 0;
    /// Rotation since rest relative to the anchor at the start, a quaternion in 4 rows.
    pub const TURN_START: usize = 3;
    /// Position relative to the anchor at the end [m], 3 rows.
    pub const END: usize = 7;
    /// Rotation since rest relative to the anchor at the end, a quaternion in 4 rows.
    pub const TURN_END: usize = 10;
    /// Rows a strand.
    pub const ROWS: usize = 14;
}

/// Rows of the constants of a whole strand.
pub mod strand {
    /// The first segment in the rest pose, root to second point [m], 3 rows.
    pub const FIRST: usize = 0;
    /// The frame's normal on the first segment in the rest pose, 3 rows.
    pub const NORMAL: usize = 3;
    /// Viscosity of the air, times the material's multiplier over drag [Pa s].
    pub const DRAG: usize = 6;
    /// Relaxation time of bending [s].
    pub const DAMPING: usize = 7;
    /// Coulomb friction against the body, static.
    pub const FRICTION: usize = 8;
    /// Twisting over bending stiffness, GJ/EI [1].
    pub const TWIST_RATIO: usize = 9;
    /// Relative additional bending stiffness in the plane of the frame's normal, ΔB/B; 0 for a round fiber
    /// [1].
    pub const FLAT: usize = 10;
    /// Stretching stiffness EA [N].
    pub const AXIAL: usize = 11;
    /// The third point in the rest pose, from the root [m], 3 rows; driven as well in the springs model.
    pub const THIRD: usize = 12;
    /// Points of the strand, without extra particles [1].
    pub const POINTS: usize = 15;
    /// Stiffness of its segments relative to most strands'; see `stiffening` [1].
    pub const STIFFENING: usize = 16;
    /// Kinetic friction over static [1].
    pub const FRICTION_KINETIC: usize = 17;
    /// Reynolds number over the speed of the air across the fiber, d/ν [s/m].
    pub const REYNOLDS: usize = 18;
    /// Rows a strand.
    pub const ROWS: usize = 19;
}

/// Meaning of the rows in the springs model. The points of a strand are its even particles. Values of a
/// segment are stored at its first point.
pub mod springs {
    use super::{rest, state};
    /// Stiffness of the spring from this extra particle to the next [N/m].
    pub const K2: usize = rest::BEND;
    /// Stiffness of a triangle's sides in addition to that of all segments, at its first point (see `truss`)
    /// [N/m].
    pub const BRACE: usize = rest::BEND;
    /// Rest length of the spring from this extra particle to the next [m].
    pub const L2: usize = rest::TURN;
    /// Rest length of the spring to the third particle after [m].
    pub const L3: usize = rest::TURN + 1;
    /// Six times the rest volume of the tetrahedron that begins here [m³].
    pub const VOLUME: usize = rest::TURN + 2;
    /// Stiffness of the spring to the third particle after, and of the altitude spring [N/m].
    pub const K3: usize = rest::TWIST;
    /// Rest length of the two sides that a triangle has besides the strand's segment, at its extra particle
    /// [m].
    pub const SIDES: usize = rest::LENGTH;
    /// Row of state: tension of the triangle's side from this particle to the next, from the last substep
    /// [N].
    pub const SIDE: usize = state::NORMAL;
}

/// Rows of a segment contact, carried from substep to substep.
pub mod segment_contact {
    /// Contact force of a collider [N]; 0 without contact.
    pub const FORCE: usize = 0;
    /// Place on the segment: 0 at its start, 1 at its end.
    pub const AT: usize = 1;
    /// Stretch of the friction spring there, along the segment and across it; 2 rows, 0 without contact [m].
    pub const FRICTION_STRETCH: usize = 2;
    /// Rows a point.
    pub const ROWS: usize = 4;
}

/// Rows a point of the state that the second-order integrator carries.
pub mod history {
    /// Velocity before the last substep [m/s], 3 rows.
    pub const V: usize = 0;
    /// Displacement in the last substep, in the world [m], 3 rows.
    pub const DISPLACEMENT: usize = 3;
    /// Rows a point.
    pub const ROWS: usize = 6;
}

/// Rows of a hold.
pub mod hold {
    /// Target position at the end of the frame, in the world [m], 3 rows.
    pub const TARGET: usize = 0;
    /// Force on the point [N], 3 rows.
    pub const FORCE: usize = 3;
    /// 1 where the point is pinned, else 0.
    pub const PINNED: usize = 6;
    /// 1 where the frame of the segment from this point is held, else 0.
    pub const CLAMPED: usize = 7;
    /// Stiffness of the spring to the target where the point is not pinned [N/m].
    pub const STIFFNESS: usize = 8;
    /// Displacement of the target in the frame [m], 3 rows.
    pub const DISPLACEMENT: usize = 9;
    /// Rows.
    pub const ROWS: usize = 12;
}

/// Rows of a position spring.
pub mod position_spring {
    /// Stiffness of the spring, over the point's mass [1/s²].
    pub const STIFFNESS: usize = 0;
    /// Rate at which the point adopts the target's velocity [1/s].
    pub const BRAKE: usize = 1;
    /// Displacement of the target in the frame, times the stiffness [m/s²], 3 rows.
    pub const DISPLACEMENT: usize = 2;
    /// Rows a point.
    pub const ROWS: usize = 5;
}

/// Rows of anisotropic drag, which acts across the strand.
pub mod anisotropic_drag {
    /// Rate at which the point adopts a velocity [1/s].
    pub const BRAKE: usize = 0;
    /// That velocity times the rate [m/s²], 3 rows.
    pub const ACCELERATION: usize = 1;
    /// Rows a point.
    pub const ROWS: usize = 4;
}

/// A hold on one point of eight strands.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HoldRows {
    /// The point.
    pub point: u32,
    /// See `hold`.
    pub rows: [Row; hold::ROWS],
}

/// Motion of the roots of eight strands.
pub type RootRows = [Row; root::ROWS];
/// Constants of eight whole strands.
pub type StrandRows = [Row; strand::ROWS];
/// The rest shape at one point of eight strands.
pub type RestRows = [Row; rest::ROWS];
/// The state of one point of eight strands.
pub type StateRows = [Row; state::ROWS];
/// The constants at one particle of eight strands.
pub type MultiplierRows = [Row; multipliers::ROWS];

/// The contact of the segment that ends at one point, for eight strands.
pub type SegmentContactRows = [Row; segment_contact::ROWS];

/// History of the second-order integrator at one point.
pub type HistoryRows = [Row; history::ROWS];

tile_arrays! {
    /// Eight strands, as slices of the simulation's arrays.
    tile Tile;
    /// The arrays of consecutive tiles.
    range TileRange;
    per tile {
        roots: shared RootRows,
        strand: shared StrandRows,
        /// Remaining time for which each strand still counts as touching [s].
        contact_age: unique Row,
        /// Holds, sorted by point.
        holds: shared Vec<HoldRows>,
    }
    per point {
        /// Rest shapes, with the points of the longest strand; as long as `state`.
        rest: shared RestRows,
        state: unique StateRows,
        /// Constants that vary along the strands, see `multipliers`; not in use if no material has such a profile.
        multipliers: shared MultiplierRows,
        /// Only for the second-order integrator.
        history: unique HistoryRows,
        /// External acceleration, constant over the frame [m/s²]. For a point with a position spring, it holds
        /// the value at the root's position, at rest in the world, at the end of the frame. It includes
        /// stiffness times the target position relative to the root, and the brake rate times the target
        /// velocity.
        external_acceleration: shared [Row; 3],
        /// Position springs, constant over the frame, see `position_spring`.
        position_spring: shared [Row; position_spring::ROWS],
        /// Anisotropic drag, constant over the frame, see `anisotropic_drag`.
        anisotropic_drag: shared [Row; anisotropic_drag::ROWS],
        /// Velocity of the air relative to the uniform wind, constant over the frame [m/s].
        wind_delta: shared [Row; 3],
        /// Authored depth of the segment that ends at each point, 0 or less [m]; not in use if no segment was
        /// authored inside a collider.
        rest_penetration: shared Row,
        /// Collider that each point does not touch, see [`super::contact::passes`]; not in use if every point touches
        /// all of them.
        passes: shared Row,
        /// Contacts of the segment that ends at each point, see `segment_contact`; not in use if segments are
        /// not tested.
        segment_contacts: unique SegmentContactRows,
        /// Largest distance of each point from its root [m]; not in use if there are no tethers.
        tether_lengths: shared Row,
    }
}

impl Tile<'_> {
    /// Returns a constant of the strands at particle `i`: `value` times the row `row` of its multipliers.
    #[inline(always)]
    pub fn at_particle<S: Simd>(&self, value: F<S>, i: usize, row: usize) -> F<S> {
        match self.multipliers.get(i) {
            Some(rows) => value * load(value.simd, &rows[row]),
            None => value,
        }
    }
}

/// The elastic model of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Elastic {
    /// The curvature model without rest turns.
    Straight,
    Curvature,
    Rod,
    Springs,
}

impl Elastic {
    /// Particles for each point of the strand except the last.
    pub fn stride(self) -> usize {
        if self == Self::Springs { 2 } else { 1 }
    }

    /// Driven particles at the root: those of the strand's first segment.
    pub fn driven(self) -> usize {
        self.stride() + 1
    }
}

/// Location of a tile's points, and how they are solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileLayout {
    /// Index of its first point in the points of all tiles.
    pub first: u32,
    /// Points of its longest strand.
    pub points: u32,
    /// The elastic model of all its strands.
    pub model: Elastic,
    /// Whether any fiber is flat.
    pub flat: bool,
    /// Whether its strands are solved in double precision.
    pub double: bool,
}
