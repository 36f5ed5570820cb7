//! Two segments that touch: with what force they press, rub and hold, and how a frame changes it.
//!
//! With n from b to a, g the gap [m], u the velocity of a relative to b at the end of the free frame, K [kg/s] and shares λ that add up to 1:
//!
//! ```text
//! asked      Δ = n (u* − u·n) − u_across      u* = −g/2dt ahead of contact, −g min(regain, 1/dt) inside
//! point i    a_i = (K wᵢ / m̄) P (vᵢ ± λ Δ − v)      implicit in v; v_i the free frame's last velocity
//! found      R = Σ mᵢ (K wᵢ / m̄) P (vᵢ ± λ Δ − way / dt)      less what both sides gain alike
//! carried    F ← F + the lesser of the two sides' R,   F·n ≥ 0,   |F across| ≤ μ F·n
//! ```
//!
//! F acts on both sides, equal and opposite; the brake only corrects it, and asks nothing where strands are in balance. So what presses is state
//! as against colliders (`strand/press.rs`; Alart & Curnier 1991), static friction holds to the cone, and momentum is kept where nothing strikes.
//! P takes what acts along n whole, and across it as far as friction goes (the lagged secant of Li et al. 2020, *Incremental Potential Contact*).
//!
//! A bond keeps its two places of the strands and their distance, pulls as well as it pushes, and breaks at |F| = stiction.

use super::{closest::closest, hair::Hair};
use crate::scene;
use glam::{Mat3, Vec3};

/// Mass that a contact asks for in a frame, over what moves there [1]: eight ninths of an approach are stopped in the first. Above ten, a strand
/// that is struck could gain more than the other loses, where their masses are not known well.
const STRENGTH: f32 = 8.0;

/// Contacts of a segment among which it shares its strength without loss [1]: those of two strands that cross at a joint. Where there are more, each is
/// worth less, and what it carries less still: carried forces of a crowd feed each other, and it would not come to rest.
const CROWD: f32 = 4.0;

/// Share of a gap that a frame may close [1]: what comes fast is met before it is there.
const CLOSED: f32 = 0.5;

/// Cosine of the angle that the normal turns by in a frame where two segments have passed each other [1].
const PASSED: f32 = -0.7;

/// Largest change of velocity that is asked for [m/s].
const MOST_ASKED: f32 = 10.0;

/// Largest force over the mass that moves there [m/s²]: fifteen times weight.
const MOST_FORCE: f32 = 150.0;

/// Share of a carried force that a frame forgets [1]: where more strands are pressed together than there is room for, no force could part them, and
/// forces would grow for ever.
const FORGOTTEN: f32 = 0.05;

/// Gap or overlap, over the distance, up to which segments touch and do not press yet [1]: hair that creeps from its authored start is not pushed.
const TOUCH: f32 = 0.02;

/// Relative velocity below which segments rest against each other [m/s].
const AT_REST: f32 = 0.01;

/// Two segments that touch.
#[derive(Clone, Copy, Default)]
pub struct Contact {
    /// The segments, the lesser index first.
    pub pair: [u32; 2],
    /// Force on the first [N]; on the second the opposite.
    force: Vec3,
    bond: Option<Bond>,
    /// Where on each segment, as a share of its length.
    at: [f32; 2],
    /// From the second to the first.
    normal: Vec3,
    plan: Plan,
}

/// Two places that hold together.
#[derive(Clone, Copy)]
struct Bond {
    at: [f32; 2],
    /// How far they are apart [m].
    length: f32,
}

/// What a contact does in a frame.
#[derive(Clone, Copy, Default)]
struct Plan {
    /// K [kg/s].
    strength: f32,
    /// P along n and across it [1].
    share: [f32; 2],
    /// Change of relative velocity that is asked for [m/s].
    asked: Vec3,
    /// λ of each side.
    part: [f32; 2],
    /// Axis to axis, negative where strands have passed each other [m].
    distance: f32,
    /// Distance at which nothing presses [m].
    rest: f32,
    /// Largest force that is carried on [N].
    most: f32,
    /// Whether the free frame leaves a gap.
    open: bool,
}

/// What came of a frame's contacts.
#[derive(Clone, Copy, Default)]
pub struct Sum {
    /// Sum of what brakes gave each side [N]; 0 where they gave each what they took of the other.
    pub unbalanced: Vec3,
    /// Sum of the larger of the two sides' forces, carried ones too [N].
    pub forces: f32,
    pub bonds: usize,
    pub broken: usize,
}

impl Contact {
    /// Two segments that have not touched.
    pub fn new(pair: [u32; 2]) -> Self {
        Self { pair, ..Self::default() }
    }

    /// The segments' indices, first ends and signs of the force.
    fn sides(&self) -> [(usize, f32, f32, f32); 2] {
        let [a, b] = self.pair.map(|i| i as usize);
        [(a, self.at[0], 1.0, self.plan.part[0]), (b, self.at[1], -1.0, self.plan.part[1])]
    }

    /// Adds the carried force to what acts on the points.
    pub fn carry(&self, hair: &mut Hair) {
        for (i, at, sign, _) in self.sides() {
            for (i, weight) in [(i, 1.0 - at), (i + 1, at)] {
                hair.met[i].push += self.force * (sign * weight / hair.mass[i]);
            }
        }
    }

    /// Looks at a frame of `dt` [s] as it would be if nothing met anew; false where there is nothing between the two.
    pub fn plan(&mut self, hair: &Hair, settings: &scene::Neighbours, dt: f32) -> bool {
        let [a, b] = self.pair.map(|i| i as usize);
        let ends = [hair.ends(a), hair.ends(b)];
        self.at = self.bond.map_or_else(|| closest(ends[0], ends[1]).into(), |bond| bond.at);
        let [s, t] = self.at;
        let apart = ends[0][0].lerp(ends[0][1], s) - ends[1][0].lerp(ends[1][1], t);
        // Segments that cross exactly part along what is across both.
        let across_both = || (ends[0][1] - ends[0][0]).cross(ends[1][1] - ends[1][0]).normalize_or(Vec3::Y);
        let before = self.normal;
        self.normal = apart.try_normalize().unwrap_or_else(across_both);
        let plan = &mut self.plan;
        *plan = Plan { distance: apart.length(), ..Plan::default() };
        if self.bond.is_none() && before.dot(self.normal) < PASSED {
            // They have passed each other: back.
            (self.normal, plan.distance) = (-self.normal, -plan.distance);
        }
        plan.rest = self.bond.map_or(hair.radius[a] + hair.radius[b], |bond| bond.length);
        let gap = plan.distance - plan.rest;
        let n = self.normal;

        let free = |i: usize, at: f32| {
            let (low, high) = (hair.free[i], hair.free[i + 1]);
            [low.velocity.lerp(high.velocity, at), low.way.lerp(high.way, at) / dt]
        };
        let ([va, mean_a], [vb, mean_b]) = (free(a, s), free(b, t));
        let (u, mean) = (va - vb, mean_a - mean_b);
        let mobility = |i: usize, at: f32| match hair.is_driven(i) {
            true => 0.0,
            false => hair.mobility[i] + (hair.mobility[i + 1] - hair.mobility[i]) * at,
        };
        let mobility = [mobility(a, s), mobility(b, t)];
        let both = mobility[0] + mobility[1];
        if both <= 0.0 {
            return false;
        }
        plan.part = mobility.map(|m| m / both);
        let crowd = (CROWD / hair.contacts[a].max(hair.contacts[b]).max(1) as f32).min(1.0);
        let strength = crowd * STRENGTH * 2.0 / (both * dt);
        plan.most = MOST_FORCE * crowd * crowd * 2.0 / both;
        let regained = -gap * settings.regain.min(1.0 / dt);
        let along = n.dot(u);
        let sliding = u - n * along;
        if self.bond.is_some() {
            let asked = n * (regained - along) - sliding;
            // A bond pulls no harder in a frame than it may.
            let pressed = n * n.dot(asked).max(0.0);
            let most = (2.0 * settings.stiction + self.force.length()) / strength;
            plan.asked = pressed.clamp_length_max(MOST_ASKED) + (asked - pressed).clamp_length_max(most);
            (plan.strength, plan.share) = (strength, [1.0, 1.0]);
            return true;
        }
        let force = n.dot(self.force).max(0.0);
        // The gap that the frame may leave.
        let least = if gap > 0.0 { gap * (1.0 - CLOSED) } else { -TOUCH * plan.rest };
        if force <= 0.0 && gap + dt * along.min(n.dot(mean)) >= least {
            self.force = Vec3::ZERO;
            return settings.stiction > 0.0 && gap < TOUCH * plan.rest;
        }
        plan.open = gap + dt * along.max(n.dot(mean)) > 0.0;
        let wanted = if gap > 0.0 { -gap * CLOSED / dt } else { regained };
        // What pressed too hard is taken back, and no more: strands do not cling.
        let asked = (wanted - along).clamp(-force / strength, MOST_ASKED);
        let friction = settings.friction * force.max(force + 0.5 * strength * asked);
        let speed = sliding.length();
        let across = if speed > 0.0 {
            let braked = -self.force.dot(sliding) / speed;
            ((friction - braked).max(0.0) / (strength * speed)).min(1.0)
        } else {
            0.0
        };
        plan.asked = n * asked - sliding;
        (plan.strength, plan.share) = (strength, [1.0, across]);
        true
    }

    /// P [1].
    fn shares(&self) -> Mat3 {
        let [along, across] = self.plan.share;
        let n = self.normal;
        let outer = Mat3::from_cols(n * n.x, n * n.y, n * n.z);
        outer * (along - across) + Mat3::from_diagonal(Vec3::splat(across))
    }

    /// Both points of each side: index, rate [1/s], and what is asked of it [m/s].
    fn braked(&self, hair: &Hair) -> [[(usize, f32, Vec3); 2]; 2] {
        self.sides().map(|(i, at, sign, part)| {
            let mean = hair.mass[i] * (1.0 - at) + hair.mass[i + 1] * at;
            let rate = self.plan.strength / mean;
            [(i, rate * (1.0 - at)), (i + 1, rate * at)]
                .map(|(i, rate)| (i, rate, self.plan.asked * (sign * part)))
        })
    }

    /// Adds its brake to what acts on the points.
    pub fn brake(&self, hair: &mut Hair) {
        if self.plan.strength <= 0.0 {
            return;
        }
        let shares = self.shares();
        for (i, rate, asked) in self.braked(hair).into_iter().flatten() {
            if !hair.is_driven_point(i) {
                let velocity = hair.free[i].velocity + asked;
                hair.brake(i, shares * rate, velocity);
            }
        }
    }

    /// Finds the force that the frame of `dt` [s] has brought, and whether the two hold together from now on.
    pub fn find(&mut self, hair: &Hair, settings: &scene::Neighbours, dt: f32, sum: &mut Sum) {
        let shares = self.shares();
        let n = self.normal;
        // By how much velocities gain in the free frame on their mean. What both gain alike is no part of the force between them.
        let gain = |i: usize| hair.free[i].velocity - hair.free[i].way / dt;
        let [gain_a, gain_b] = self.sides().map(|(i, at, ..)| gain(i).lerp(gain(i + 1), at));
        let alike = gain_a * self.plan.part[1] + gain_b * self.plan.part[0];
        let found = self.braked(hair).map(|points| {
            let on = |(i, rate, asked): (usize, f32, Vec3)| {
                let taken = (hair.way[i] - hair.free[i].way) / dt;
                shares * (asked + gain(i) - alike - taken) * (rate * hair.mass[i])
            };
            points.into_iter().map(on).sum::<Vec3>()
        });
        let [a, b] = [found[0], -found[1]];
        let [part_a, part_b] = self.plan.part;
        let change = match () {
            // The skin takes what it is given.
            () if part_a <= 0.0 => b,
            () if part_b <= 0.0 => a,
            () => {
                let [along_a, along_b] = [n.dot(a), n.dot(b)];
                let along = if along_a * along_b > 0.0 {
                    along_a.signum() * along_a.abs().min(along_b.abs())
                } else {
                    0.0
                };
                let [across_a, across_b] = [a - n * along_a, b - n * along_b];
                let least = across_a.length().min(across_b.length());
                sum.unbalanced += a - b;
                n * along + (0.5 * (across_a + across_b)).clamp_length_max(least)
            }
        };
        sum.forces += self.force.length() + a.length().max(b.length());
        self.force = (self.force * (1.0 - FORGOTTEN) + change).clamp_length_max(self.plan.most);
        if !self.force.is_finite() {
            self.force = Vec3::ZERO;
        }
        if self.plan.open {
            // The two sides may not agree that it was too much.
            self.force *= 0.5;
        }
        let pressed = n * n.dot(self.force).max(0.0);
        if self.bond.is_some() && (self.force - pressed).length() > settings.stiction {
            self.bond = None;
            sum.broken += 1;
        }
        if self.bond.is_some() {
            sum.bonds += 1;
            return;
        }
        let across =
            (self.force - n * n.dot(self.force)).clamp_length_max(settings.friction * pressed.length());
        self.force = pressed + across;
        let touching = self.plan.distance < (1.0 + TOUCH) * self.plan.rest;
        if settings.stiction > 0.0 && touching && self.speed(hair, dt) < AT_REST {
            self.bond = Some(Bond { at: self.at, length: self.plan.distance.max(self.plan.rest) });
            sum.bonds += 1;
        }
    }

    /// Relative velocity of the two places in the frame that was [m/s].
    fn speed(&self, hair: &Hair, dt: f32) -> f32 {
        let [a, b] = self.sides().map(|(i, at, ..)| hair.way[i].lerp(hair.way[i + 1], at));
        (a - b).length() / dt
    }
}
