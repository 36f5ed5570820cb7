//! What is known of single points and strands, to colour them by and to show figures of the one that is pointed at.

use super::{Stage, hair::StagedHair};
use glam::Vec3;
use rayon::prelude::*;
use std::cmp::Ordering;

/// A number that every point has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Value {
    /// The strand (index of the groom) that is simulated for it.
    #[default]
    Guide,
    /// Tension of the segment from the point, below 0 where it is pushed [N].
    Tension,
    /// How far the joint is turned from the groom's, which the root carries along [rad].
    Turn,
    /// How much longer the segment from the point is than at rest, over its length [1].
    Stretch,
    /// Speed in the world [m/s].
    Speed,
    /// How full of hair its cell is, over what it is at rest [1]; 0 where nothing asks for the hair's volume.
    Density,
    /// Force with which a collider holds it out [N].
    Contact,
}

impl Value {
    /// All of them.
    pub const ALL: [Value; 7] =
        [Self::Guide, Self::Tension, Self::Turn, Self::Stretch, Self::Speed, Self::Density, Self::Contact];

    /// Its name, a word of lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Guide => "guide",
            Self::Tension => "tension",
            Self::Turn => "turn",
            Self::Stretch => "stretch",
            Self::Speed => "speed",
            Self::Density => "density",
            Self::Contact => "contact",
        }
    }

    /// Its unit; "1" for a ratio, and for the guide, which is a number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Guide | Self::Stretch | Self::Density => "1",
            Self::Tension | Self::Contact => "N",
            Self::Turn => "rad",
            Self::Speed => "m/s",
        }
    }
}

/// The strand that a ray points at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Index of its groom in the scene.
    pub groom: usize,
    /// The strand, as an index of the groom.
    pub strand: usize,
    /// The point of it that the ray comes nearest to.
    pub point: usize,
    /// How far that is from the origin of the ray [m].
    pub distance: f32,
}

/// Figures of one strand. Of a follow hair, what only a simulated strand has is that of its first guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrandFigures {
    /// Whether it is simulated; else it follows its guides.
    pub simulated: bool,
    /// The strand that it follows first, as an index of the groom; itself where it is simulated.
    pub guide: u32,
    /// Points that it has.
    pub points: usize,
    /// Length as authored [m].
    pub length: f32,
    /// Largest |ℓ/L − 1| of a segment [1].
    pub stretch_max: f32,
    /// Largest tension of a segment [N].
    pub tension_max: f32,
    /// Largest turn of a joint from the groom's [rad].
    pub turn_max: f32,
    /// Speed of the fastest point [m/s].
    pub speed_max: f32,
    /// Largest force with which a collider holds a point out [N].
    pub contact_max: f32,
    /// How deep its deepest point but the root is inside a collider as it is drawn; 0: none is [m].
    pub depth: f32,
}

/// What a ray hits well [1]: the tangent of 0.2°, three pixels of a picture of 1080 lines at 30° from top to bottom.
const NEAR: f32 = 0.0035;

/// A point before a ray's origin.
#[derive(Clone, Copy)]
struct Candidate {
    picked: Picked,
    /// Tangent of the angle between the ray and the way to it [1].
    aside: f32,
}

impl Candidate {
    /// What is hit well comes first, by its distance; then what is off, by its angle; what is alike, by its place in the scene.
    fn order(&self, other: &Self) -> Ordering {
        let key = |c: &Self| if c.aside <= NEAR { (0, c.picked.distance) } else { (1, c.aside) };
        let place = |c: &Self| (c.picked.groom, c.picked.strand, c.picked.point);
        let ((a, by), (b, than)) = (key(self), key(other));
        a.cmp(&b).then(by.total_cmp(&than)).then(place(self).cmp(&place(other)))
    }
}

impl Stage {
    /// Writes into `out` one number a point of all strands of a groom (index of the scene's) as they are drawn; follow hairs have that of their first guide
    /// where they ride on it. Empty where there is no such groom.
    pub fn values(&self, what: Value, groom: usize, out: &mut Vec<f32>) {
        out.clear();
        if let Some(hair) = self.hair.get(groom) {
            hair.values(|k, strand, of_guide| self.write(hair, what, (k, strand), of_guide), out);
        }
    }

    /// The strand whose points come nearest to a ray from `origin` [m] along `direction` (any length above 0), whether the body is in between or not: of
    /// those within 0.2° the one nearest to the origin, else the one nearest in angle. `None`: no hair lies that way.
    pub fn nearest_strand(&self, origin: Vec3, direction: Vec3) -> Option<Picked> {
        let direction = direction.try_normalize()?;
        let of_strand = |groom: usize, strand: usize, points: &[Vec3]| {
            let seen = |(point, p): (usize, &Vec3)| {
                let way = *p - origin;
                let along = way.dot(direction);
                let picked = Picked { groom, strand, point, distance: way.length() };
                (along > 0.0).then(|| Candidate {
                    picked,
                    aside: way.reject_from_normalized(direction).length() / along,
                })
            };
            points.iter().enumerate().filter_map(seen).min_by(Candidate::order)
        };
        let of_groom = |(g, hair): (usize, &StagedHair)| {
            let found = |s: usize, points: &[Vec3]| of_strand(g, s, points);
            hair.each_strand(&self.body, 0..hair.groom().strand_count(), found)
                .flatten()
                .min_by(Candidate::order)
        };
        self.hair.iter().enumerate().filter_map(of_groom).min_by(Candidate::order).map(|c| c.picked)
    }

    /// The strand (index of the groom) that a strand follows first; itself where it is simulated.
    ///
    /// # Panics
    /// If the scene has no such groom or the groom no such strand.
    pub fn guide_of(&self, groom: usize, strand: usize) -> u32 {
        let hair = &self.hair[groom];
        hair.simulated_strands()[hair.first_guide(strand)]
    }

    /// Figures of a strand (index of the groom).
    ///
    /// # Panics
    /// As [`Stage::guide_of`].
    pub fn strand_figures(&self, groom: usize, strand: usize) -> StrandFigures {
        let hair = &self.hair[groom];
        let (k, guide) = (hair.first_guide(strand), self.guide_of(groom, strand));
        let groom = hair.groom();
        let mut values = vec![0.0; groom.range(guide as usize).len()];
        let mut most = |what: Value| {
            self.write(hair, what, (k, guide as usize), &mut values);
            values.iter().copied().fold(f32::NEG_INFINITY, f32::max)
        };
        let depth = |p: &Vec3| {
            let depth = |o: &hairspring::collide::MovingCollider| -o.shape.distance(o.end.inverse_point(*p));
            self.body.obstacles().iter().map(depth).fold(0.0, f32::max)
        };
        let deepest = |_, points: &[Vec3]| points.iter().skip(1).map(depth).fold(0.0, f32::max);
        StrandFigures {
            simulated: hair.simulated(strand).is_some(),
            guide,
            points: groom.range(strand).len(),
            length: groom.strand_length(strand),
            tension_max: most(Value::Tension),
            turn_max: most(Value::Turn),
            speed_max: most(Value::Speed),
            contact_max: most(Value::Contact),
            stretch_max: {
                let of = |i: usize| self.simulation.stretch_at(hair.first() + k, i).abs();
                (0..groom.range(guide as usize).len()).map(of).fold(0.0, f32::max)
            },
            depth: hair.each_strand(&self.body, strand..strand + 1, deepest).sum(),
        }
    }

    /// Writes one number for each point of a simulated strand: its place among its groom's, and its number in that.
    fn write(&self, hair: &StagedHair, what: Value, (k, strand): (usize, usize), out: &mut [f32]) {
        let (simulation, of_all) = (&self.simulation, hair.first() + k);
        let each = |out: &mut [f32], of: &dyn Fn(usize) -> f32| {
            out.iter_mut().enumerate().for_each(|(i, value)| *value = of(i));
        };
        match what {
            Value::Guide => out.fill(strand as f32),
            Value::Tension => each(out, &|i| simulation.tension_at(of_all, i)),
            Value::Turn => hair.turns(k, strand, out),
            Value::Stretch => each(out, &|i| simulation.stretch_at(of_all, i)),
            Value::Speed => each(out, &|i| simulation.speed_at(of_all, i)),
            Value::Density => {
                let points = hair.guide_points(k, strand);
                each(out, &|i| simulation.density_at(points[i]));
            }
            Value::Contact => each(out, &|i| simulation.contact_at(of_all, i)),
        }
    }
}
