//! A contact of two segments: the impulse that separates them, with friction and stiction.
//!
//! n is the normal from the second segment to the first, g the gap [m], and u their relative velocity at the
//! closest points. W is the change of that velocity for a unit of impulse (`response`), and d is how far they
//! have slid since they last stuck [m]. Both are those at the start of the substep; for segments that would meet in
//! the next one, g is that at its end, so that fast segments do not pass through each other:
//!
//! ```text
//! along n     P ← max(least, P − (u·n + G) / W)        G = g/h ahead of contact, RECOVERY g/h inside
//! across it   Q ← Q − (u_across + RECOVERY d/h) / W,   clamped to |Q| ≤ μ max(P, 0) + h S
//! ```
//!
//! P and Q are the impulses of the whole substep, including its load. A bond can also pull: least is −h S for
//! segments that stick together, with the stiction S [N], and 0 for others. A bond that is at such a bound in
//! two consecutive substeps breaks.

use super::{closest::closest, hair::Hair, response::Response};
use glam::{Mat3, Vec3};

/// Share of an overlap, or of a slip, that is corrected in a substep [1].
const RECOVERY: f32 = 0.2;

/// Share of an impulse that is added to the load when it increases the load [1]. An impulse that decreases
/// the load counts in full, so that a segment that is released is not thrown.
const LOAD_GAIN: f32 = 0.5;

/// Relative speed from which a contact carries no load [m/s]. A load acts along the normal of the substep before, so
/// between segments that move it does work, and drives them; between segments at rest it is carried in full.
const LOADED_SPEED_LIMIT: f32 = 0.1;

/// Gap, over the sum of the radii, up to which segments are near each other and bonds hold [1].
pub const MAX_NEAR_GAP: f32 = 0.15;

/// Cosine between the normals of consecutive substeps below which an end of a segment has passed through the
/// other segment [1]. For segments that cross, any rotation by more than a right angle is a passage.
const MIN_NORMAL_COSINE: f32 = -0.7;

/// Parameters that all contacts share.
pub struct SolverParams {
    /// Length of a substep [s].
    pub h: f32,
    /// Coulomb friction [1].
    pub friction: f32,
    /// Force that holds two segments together [N].
    pub stiction: f32,
}

/// A contact of two segments that are near each other.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Contact {
    /// The segments, the lower index first.
    pub pair: [u32; 2],
    /// Closest point on each, as a fraction of its length.
    at: [f32; 2],
    /// Unit normal from the second segment to the first.
    normal: Vec3,
    /// Gap between their surfaces, negative inside [m]: at the start of the substep while impulses are solved, and at
    /// its end after [`Contact::carry`]. For segments that would meet in the next substep, one substep later.
    gap: f32,
    /// How far the first has slid along the second since they last stuck, at the same time as the gap [m].
    slip: Vec3,
    /// The carried force on the first segment, along the normal and across it [N].
    load: Force,
    /// The force of the last substep [N].
    last: Force,
    /// The impulse of this substep, in addition to the load [N s].
    impulse: Force,
    bond: Bond,
    /// Whether the contact slides, or its bond is at its limit, in this substep.
    at_bound: bool,
}

/// Responses of the two sides of a contact to an impulse, within one substep.
pub struct ContactResponse {
    each: [Response; 2],
    /// W [1/kg]; 0 if neither can move.
    give: f32,
}

impl ContactResponse {
    /// Computes the responses of a contact in a substep of `h` [s].
    pub fn of(contact: &Contact, hair: &Hair, h: f32) -> Self {
        let sides = [0, 1].map(|k| (contact.pair[k], contact.at[k]));
        let each = sides.map(|(i, s)| Response::of(i, s, hair, h));
        Self {
            each,
            give: sides.iter().zip(&each).map(|((i, s), side)| side.inverse_effective_mass(*i, *s)).sum(),
        }
    }

    /// Changes velocities by an impulse on the first segment [N s] and the opposite one on the second.
    fn apply_impulse(&self, impulse: Vec3, hair: &mut Hair) {
        self.each[0].apply_impulse(impulse, hair);
        self.each[1].apply_impulse(-impulse, hair);
    }
}

/// A force or impulse on the first segment of a pair.
#[derive(Clone, Copy, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Force {
    along: f32,
    across: Vec3,
}

#[derive(Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Bond {
    None,
    Holds,
    /// Has been at its limit for one substep.
    Torn,
}

impl Contact {
    /// Returns the contact of two segments after a substep of `h` [s]. `old` is their contact before it.
    /// Returns `None` if they are not near each other.
    pub fn find(pair: [u32; 2], old: Option<&Contact>, hair: &Hair, h: f32) -> Option<Self> {
        let [a, b] = pair.map(|s| hair.ends(s));
        let (s, t) = closest(a, b);
        let apart = a[0].lerp(a[1], s) - b[0].lerp(b[1], t);
        let mut distance = apart.length();
        let within = hair.radius[pair[0] as usize] + hair.radius[pair[1] as usize];
        let across = || (a[1] - a[0]).cross(b[1] - b[0]).try_normalize().unwrap_or(Vec3::Y);
        let mut normal = if distance > 1e-6 * within {
            apart / distance
        } else {
            old.map_or_else(across, |old| old.normal)
        };
        if let Some(old) = old {
            let inner = |s: f32| s > 0.0 && s < 1.0;
            let turned = normal.dot(old.normal);
            // Segments that have passed by more than their thickness stay on the new side.
            if distance < within && turned < if inner(s) && inner(t) { 0.0 } else { MIN_NORMAL_COSINE } {
                (distance, normal) = (-distance, -normal);
            }
        }
        let mut contact = Self {
            pair,
            at: [s, t],
            normal,
            gap: distance - within,
            slip: Vec3::ZERO,
            load: Force::default(),
            last: Force::default(),
            impulse: Force::default(),
            bond: Bond::None,
            at_bound: false,
        };
        let (gap, moved) = (contact.gap, h * normal.dot(contact.velocity(hair)));
        if gap <= 0.0 || gap >= -moved {
            contact.gap -= moved;
        }
        if let Some(old) = old {
            let flat = |v: Vec3| v - normal * normal.dot(v);
            contact.bond = old.bond;
            contact.last = Force { across: flat(old.last.across), ..old.last };
            contact.load = Force { across: flat(old.load.across), ..old.load };
            if old.last.along > 0.0 || old.bond != Bond::None {
                contact.slip = flat(old.slip);
            }
        }
        let near = gap < MAX_NEAR_GAP * within || gap < -moved;
        near.then_some(contact)
    }

    /// Velocity of the first segment relative to the second, at the closest points [m/s].
    fn velocity(&self, hair: &Hair) -> Vec3 {
        let v = |segment: u32, s: f32| hair.v[segment as usize].lerp(hair.v[segment as usize + 1], s);
        v(self.pair[0], self.at[0]) - v(self.pair[1], self.at[1])
    }

    /// Changes velocities by an impulse on the first segment [N s] and the opposite one on the second.
    fn strike(&self, impulse: Vec3, hair: &mut Hair) {
        for (side, (segment, s)) in [1.0, -1.0].into_iter().zip(self.pair.into_iter().zip(self.at)) {
            for (i, share) in [(segment as usize, 1.0 - s), (segment as usize + 1, s)] {
                hair.v[i] += impulse * (side * share * hair.inverse_mass[i]);
            }
        }
    }

    /// Adds the effect of the load in a substep of `h` [s] to the velocities.
    pub fn apply_warm_start(&self, h: f32, hair: &mut Hair) {
        let force = self.normal * self.load.along + self.load.across;
        if force != Vec3::ZERO {
            self.strike(force * h, hair);
        }
    }

    /// Runs one iteration of the contact. `response` is computed when it is first needed.
    pub fn solve(&mut self, response: &mut Option<ContactResponse>, rules: &SolverParams, hair: &mut Hair) {
        let SolverParams { h, friction, stiction } = *rules;
        let velocity = self.velocity(hair);
        let along = self.normal.dot(velocity);
        let bound = if self.bond == Bond::None { 0.0 } else { stiction * h };
        let ahead = self.gap > 0.0 && self.bond == Bond::None;
        let aim = self.gap / h * if ahead { 1.0 } else { RECOVERY };
        let before = self.load.along * h + self.impulse.along;
        let rubbed = self.load.across * h + self.impulse.across;
        if bound == 0.0 && before == 0.0 && rubbed == Vec3::ZERO && along + aim >= 0.0 {
            return;
        }
        let response = response.get_or_insert_with(|| ContactResponse::of(self, hair, h));
        if response.give <= 0.0 {
            return;
        }
        let wanted = before - (along + aim) / response.give;
        let now = wanted.max(-bound);

        let across = velocity - self.normal * along + self.slip * (RECOVERY / h);
        let wanted_across = rubbed - across / response.give;
        let cone = friction * now.max(0.0) + bound;
        let held = wanted_across.clamp_length_max(cone);
        // Without normal force there is no friction, and the contact does not count as sliding.
        self.at_bound =
            (bound > 0.0 && wanted < -bound) || (cone > 0.0 && wanted_across.length_squared() > cone * cone);

        let change = self.normal * (now - before) + (held - rubbed);
        if change.is_finite() {
            self.impulse.along += now - before;
            self.impulse.across += held - rubbed;
            response.apply_impulse(change, hair);
        }
    }

    /// Ends the substep. The load of the next is what acted both in this substep and in the one before, less for
    /// segments that move.
    pub fn carry(&mut self, rules: &SolverParams, hair: &Hair) {
        let velocity = self.velocity(hair);
        let along = self.normal.dot(velocity);
        self.gap += rules.h * along;
        self.slip += rules.h * (velocity - self.normal * along);
        let share = if self.impulse.along < 0.0 { 1.0 } else { LOAD_GAIN };
        let total = Force {
            along: self.load.along + self.impulse.along * (share / rules.h),
            across: self.load.across + self.impulse.across * (LOAD_GAIN / rules.h),
        };
        let Force { along, across } = self.last;
        self.load.along =
            if total.along * along > 0.0 { total.along.abs().min(along.abs()).copysign(along) } else { 0.0 };
        self.load.across = if total.across.dot(across) > 0.0 {
            total.across.clamp_length_max(across.length())
        } else {
            Vec3::ZERO
        };
        let still = 1.0 - (velocity.length() / LOADED_SPEED_LIMIT).min(1.0);
        self.load.along *= still;
        self.load.across *= still;
        (self.last, self.impulse) = (total, Force::default());
        self.bond = match (self.bond, self.at_bound) {
            (Bond::None, false) if rules.stiction > 0.0 && total.along > 0.0 && self.gap <= 0.0 => {
                Bond::Holds
            }
            (Bond::None, _) | (Bond::Torn, true) => Bond::None,
            (_, true) => Bond::Torn,
            (_, false) => Bond::Holds,
        };
        if self.at_bound {
            self.slip = Vec3::ZERO;
        }
    }

    /// Rotates the contact with the pair.
    pub fn turn(&mut self, by: &Mat3) {
        for v in [&mut self.normal, &mut self.slip, &mut self.load.across, &mut self.last.across] {
            *v = *by * *v;
        }
    }

    /// Whether the two push each other apart.
    pub fn presses(&self) -> bool {
        self.last.along > 0.0
    }

    /// Whether they stick together.
    pub fn holds(&self) -> bool {
        self.bond != Bond::None
    }

    /// Force along the normal in the last substep; negative if it pulls [N].
    pub fn force(&self) -> f32 {
        self.last.along
    }

    /// Depth of the overlap [m].
    pub fn depth(&self) -> f32 {
        (-self.gap).max(0.0)
    }
}
