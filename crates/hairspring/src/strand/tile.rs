//! How eight strands lie in memory: `[tile][point][component][lane]`, so that one tile's whole life in an exchange
//! interval happens in the first-level caches.
//!
//! Strands of different point counts share a tile when neighbours in the order of counts; the shorter ones are padded
//! with points of rest length zero, which lie on the tip and carry no force.

use crate::simd::lanes::Row;

/// Rows of state a point.
pub mod state {
    /// From the particle before to this one [m], 3 rows; 0 at the root and beyond the tip. Not where it is: in f32 a place a metre from the
    /// root is known to 60 nm, which turns a segment of 1 mm by 60 µrad, and a thousand stiff joints so turned whip the tip.
    pub const EDGE: usize = 0;
    /// Velocity [m/s], 3 rows.
    pub const V: usize = 3;
    /// Tension of the segment from this point to the strand's next, found by the last substep [N].
    pub const TENSION: usize = 6;
    /// The frame's normal on the segment from this point to the next, 3 rows.
    pub const NORMAL: usize = 7;
    /// Force with which a collider holds this point out, found by the last substep; 0 without contact [N].
    pub const NORMAL_FORCE: usize = 10;
    /// Rows a point.
    pub const ROWS: usize = 11;
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
    /// Rest change of tangent at this joint, in the frame carried to the segment before it, 3 rows [1].
    pub const TURN: usize = 3;
    /// How deep this point may be inside a collider, 0 or less: the depth it was authored at [m].
    pub const CLEARANCE: usize = 6;
    /// Rest twist of the joint at this point, from the segment before to the one after, as 2 tan(τ/2) [1].
    pub const TWIST: usize = 7;
    /// Share of the velocity of the air outside the hair, relative to this point, that reaches it [1]; 1 on a lone hair.
    pub const EXPOSURE: usize = 8;
    /// Rows a point.
    pub const ROWS: usize = 9;
}

/// Rows of a whole strand.
pub mod strand {
    /// Root position relative to the anchor at the start of the interval [m], 3 rows.
    pub const ROOT_START: usize = 0;
    /// Rotation since rest relative to the anchor at the start, 4 rows.
    pub const TURN_START: usize = 3;
    /// Root position relative to the anchor at the end [m], 3 rows.
    pub const ROOT_END: usize = 7;
    /// Rotation since rest relative to the anchor at the end, 4 rows.
    pub const TURN_END: usize = 10;
    /// The first segment in the rest pose, root to second point [m], 3 rows.
    pub const FIRST: usize = 14;
    /// The frame's normal on the first segment in the rest pose, 3 rows.
    pub const NORMAL: usize = 17;
    /// Viscosity of the air, times the material's multiplier over drag [Pa s].
    pub const DRAG: usize = 20;
    /// Relaxation time of bending [s].
    pub const DAMPING: usize = 21;
    /// Coulomb friction against the body, static.
    pub const FRICTION: usize = 22;
    /// Twisting over bending stiffness, GJ/EI [1].
    pub const TWIST_RATIO: usize = 23;
    /// How much stiffer the fibre bends in the plane of its frame's normal, ΔB/B; 0 for a round one [1].
    pub const FLAT: usize = 24;
    /// Stretching stiffness EA [N].
    pub const AXIAL: usize = 25;
    /// The third point in the rest pose, from the root [m], 3 rows: driven too in the springs model.
    pub const THIRD: usize = 26;
    /// Points of the strand, extra particles not counted [1].
    pub const POINTS: usize = 29;
    /// How many times stiffer its segments are than most strands', see `stiffening` [1].
    pub const STIFFENING: usize = 30;
    /// Kinetic friction over static [1].
    pub const FRICTION_KINETIC: usize = 31;
    /// Reynolds number over the speed of the air across the fiber, d/ν [s/m].
    pub const REYNOLDS: usize = 32;
    /// Rows a strand.
    pub const ROWS: usize = 33;
}

/// What rows hold in the springs model. The points of a strand are its even particles; what is said of a segment is said at them.
pub mod springs {
    use super::{rest, state};
    /// Stiffness of the spring from this extra particle to the next [N/m].
    pub const K2: usize = rest::BEND;
    /// Stiffness of a triangle's sides besides what all segments have, at its first point (see `truss`) [N/m].
    pub const BRACE: usize = rest::BEND;
    /// Its rest length [m].
    pub const L2: usize = rest::TURN;
    /// Rest length of the spring to the third particle after [m].
    pub const L3: usize = rest::TURN + 1;
    /// Six times the rest volume of the tetrahedron that begins here [m³].
    pub const VOLUME: usize = rest::TURN + 2;
    /// Stiffness of the spring to the third particle after, and of the altitude spring [N/m].
    pub const K3: usize = rest::TWIST;
    /// Length of a triangle's two sides beside the strand's segment, at its extra particle [m].
    pub const SIDES: usize = rest::LENGTH;
    /// Row of state: tension of the triangle's side from this particle to the next, found by the last substep [N].
    pub const SIDE: usize = state::NORMAL;
}

/// Rows of what presses a segment between its ends, carried from substep to substep.
pub mod segment_contact {
    /// Force with which a collider holds it out there; 0 without contact [N].
    pub const FORCE: usize = 0;
    /// Where: 0 at the segment's beginning, 1 at its end.
    pub const AT: usize = 1;
    /// Rows a point.
    pub const ROWS: usize = 2;
}

/// Rows a point of what the second-order integrator remembers.
pub mod history {
    /// Velocity before the last substep [m/s], 3 rows.
    pub const V: usize = 0;
    /// Displacement in the last substep, in the world [m], 3 rows.
    pub const WAY: usize = 3;
    /// Rows a point.
    pub const ROWS: usize = 6;
}

/// Rows of a hold.
pub mod hold {
    /// Where the point is held at the end of the interval, in the world [m], 3 rows.
    pub const TARGET: usize = 0;
    /// Force on it [N], 3 rows.
    pub const FORCE: usize = 3;
    /// 1 where the point is held fast, else 0.
    pub const PINNED: usize = 6;
    /// 1 where the frame of the segment from this point is held, else 0.
    pub const CLAMPED: usize = 7;
    /// Stiffness of the spring that pulls it to the target where it is not held fast [N/m].
    pub const STIFFNESS: usize = 8;
    /// How far the target moves in the interval [m], 3 rows.
    pub const WAY: usize = 9;
    /// Rows.
    pub const ROWS: usize = 12;
}

/// Rows of how a point is gripped.
pub mod position_spring {
    /// Stiffness of the spring that pulls it to a place, over its mass [1/s²].
    pub const STIFFNESS: usize = 0;
    /// How fast it takes on a velocity [1/s].
    pub const BRAKE: usize = 1;
    /// How far its place goes in the interval, times that stiffness [m/s²], 3 rows.
    pub const WAY: usize = 2;
    /// Rows a point.
    pub const ROWS: usize = 5;
}

/// Rows of how a point is taken along across its strand.
pub mod anisotropic_drag {
    /// How fast it takes on a velocity [1/s].
    pub const BRAKE: usize = 0;
    /// That velocity, times how fast [m/s²], 3 rows.
    pub const ACCELERATION: usize = 1;
    /// Rows a point.
    pub const ROWS: usize = 4;
}

/// What holds or pulls one point of eight strands from outside.
#[derive(Clone)]
pub struct HoldRows {
    /// The point.
    pub point: u32,
    /// See `hold`.
    pub rows: [Row; hold::ROWS],
}

/// What is known of eight whole strands.
pub type StrandRows = [Row; strand::ROWS];
/// The rest shape at one point of eight strands.
pub type RestRows = [Row; rest::ROWS];
/// The state of one point of eight strands.
pub type StateRows = [Row; state::ROWS];

/// What presses the segment to one point of eight strands between its ends.
pub type SegmentContactRows = [Row; segment_contact::ROWS];

/// What the integrator of second order remembers of one point.
pub type HistoryRows = [Row; history::ROWS];

/// Eight strands: borrowed pieces of the simulation's arrays.
pub struct Tile<'a> {
    pub model: Elastic,
    /// Whether any of the strands is flat.
    pub flat: bool,
    /// Whether the strands are solved in double precision.
    pub double: bool,
    pub strand: &'a StrandRows,
    /// Shape `[points]`, the points of the longest strand; as long as `state`.
    pub rest: &'a [RestRows],
    pub state: &'a mut [StateRows],
    /// Shape `[points]` for the integrator of second order, else empty.
    pub history: &'a mut [HistoryRows],
    /// Acceleration from outside, frozen for the interval [m/s²]: shape `[points]`, empty where there is none. Where a point is gripped, it is
    /// that at the root, at rest in the world, at the end of the interval: stiffness times the place, from the root, that it is pulled to, and
    /// brake times the velocity that it takes on are part of it.
    pub external_acceleration: &'a [[Row; 3]],
    /// How points are gripped, frozen for the interval, see `position_spring`: shape `[points]`, empty where none is.
    pub position_spring: &'a [[Row; position_spring::ROWS]],
    /// How points are taken along across their strands, frozen for the interval, see `anisotropic_drag`: shape `[points]`, empty where none is.
    pub anisotropic_drag: &'a [[Row; anisotropic_drag::ROWS]],
    /// Velocity of the air besides the wind of all points, frozen for the interval [m/s]: shape `[points]`, empty where there is none.
    pub wind_delta: &'a [[Row; 3]],
    /// How deep some place of the segment to each point was authored inside a collider, 0 or less [m]: shape `[points]`, empty where none
    /// was.
    pub rest_penetration: &'a [Row],
    /// For how much longer each strand counts as one that touches something [s].
    pub contact_age: &'a mut Row,
    /// What presses the segment to each point between its ends, see `segment_contact`: shape `[points]`, empty where segments are no contacts.
    pub segment_contacts: &'a mut [SegmentContactRows],
    /// How far each point may be from its root [m]: shape `[points]`, empty where none is held so.
    pub tether_lengths: &'a [Row],
    /// What holds or pulls points, sorted by point.
    pub holds: &'a [HoldRows],
}

impl Tile<'_> {
    /// The same tile, of which the compiler knows that its arrays are equally long.
    #[inline(always)]
    pub fn with_equal_lengths(&mut self) -> Tile<'_> {
        let points = self.rest.len();
        let all_or_none = |none: bool| if none { 0 } else { points };
        let history = all_or_none(self.history.is_empty());
        let spans = all_or_none(self.segment_contacts.is_empty());
        Tile {
            state: &mut self.state[..points],
            history: &mut self.history[..history],
            external_acceleration: &self.external_acceleration
                [..all_or_none(self.external_acceleration.is_empty())],
            position_spring: &self.position_spring[..all_or_none(self.position_spring.is_empty())],
            anisotropic_drag: &self.anisotropic_drag[..all_or_none(self.anisotropic_drag.is_empty())],
            wind_delta: &self.wind_delta[..all_or_none(self.wind_delta.is_empty())],
            rest_penetration: &self.rest_penetration[..all_or_none(self.rest_penetration.is_empty())],
            contact_age: self.contact_age,
            segment_contacts: &mut self.segment_contacts[..spans],
            tether_lengths: &self.tether_lengths[..all_or_none(self.tether_lengths.is_empty())],
            ..*self
        }
    }

    /// The same tile, for a function that is no part of the walk. Were the walk's own lent out, the compiler would look up in memory where its arrays are, and how
    /// long, at every point again.
    #[inline(always)]
    pub fn reborrow(&mut self) -> Tile<'_> {
        let Self { state, history, contact_age: touched, segment_contacts: spans, .. } = self;
        Tile { state, history, contact_age: touched, segment_contacts: spans, ..*self }
    }
}

/// The elastic model of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Elastic {
    /// The curvature model where no rest turn is needed.
    Straight,
    Curvature,
    Rod,
    Springs,
}

impl Elastic {
    /// Simulated points for each point of the strand but the last.
    pub fn stride(self) -> usize {
        if self == Self::Springs { 2 } else { 1 }
    }

    /// Simulated points at the root that are driven: the strand's first segment.
    pub fn driven(self) -> usize {
        self.stride() + 1
    }
}

/// Where a tile's points are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TilePlace {
    /// Index of its first point, counting the points of all tiles before it.
    pub first: u32,
    /// Points of its longest strand.
    pub points: u32,
    /// The elastic model of all its strands.
    pub model: Elastic,
    /// Whether any fibre is flat.
    pub flat: bool,
    /// Whether its strands are solved in double precision.
    pub double: bool,
}
