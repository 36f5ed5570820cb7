//! Values of single points and strands, for color display and for the figures of a picked strand.

use super::{Stage, hair::StagedHair};
use glam::Vec3;
use rayon::prelude::*;
use std::cmp::Ordering;

/// A value that every point has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Value {
    /// The simulated strand (index of the groom) that the point belongs to or follows.
    #[default]
    Guide,
    /// Tension of the segment after the point [N]; negative in compression.
    Tension,
    /// Angle of the joint from that of the groom, which moves with the root [rad].
    Turn,
    /// Relative elongation of the segment after the point [1].
    Stretch,
    /// Speed in world space [m/s].
    Speed,
    /// Fill ratio of its grid cell relative to rest [1]; 0 if the hair's volume is not computed.
    Density,
    /// Contact force from a collider [N].
    Contact,
}

impl Value {
    /// All values.
    pub const ALL: [Value; 7] =
        [Self::Guide, Self::Tension, Self::Turn, Self::Stretch, Self::Speed, Self::Density, Self::Contact];

    /// Returns the name, a lowercase word.
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

    /// Returns the unit: "1" for a ratio, and for the guide, which is an index.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Guide | Self::Stretch | Self::Density => "1",
            Self::Tension | Self::Contact => "N",
            Self::Turn => "rad",
            Self::Speed => "m/s",
        }
    }
}

/// The strand that a ray picks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Index of its groom in the scene.
    pub groom: usize,
    /// The strand, as an index of the groom.
    pub strand: usize,
    /// The point of it that is nearest to the ray.
    pub point: usize,
    /// Distance of that point from the origin of the ray [m].
    pub distance: f32,
}

/// Figures of one strand. For a follow hair, values that only simulated strands have are those of its first
/// guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrandFigures {
    /// Whether it is simulated; otherwise it follows its guides.
    pub simulated: bool,
    /// Its first guide, as an index of the groom; the strand itself if it is simulated.
    pub guide: u32,
    /// Number of points.
    pub points: usize,
    /// Length in the groom [m].
    pub length: f32,
    /// Largest relative length error |ℓ/L − 1| of a segment [1].
    pub stretch_max: f32,
    /// Largest tension of a segment [N].
    pub tension_max: f32,
    /// Largest angle of a joint from that of the groom [rad].
    pub turn_max: f32,
    /// Largest speed of a point [m/s].
    pub speed_max: f32,
    /// Largest contact force on a point [N].
    pub contact_max: f32,
    /// Penetration of its deepest point, except the root, into a collider [m], as drawn; 0 if there is none.
    pub depth: f32,
}

/// Tolerance of a hit [1]: the tangent of 0.2°, three pixels in an image of 1080 lines with a vertical field
/// of view of 30°.
const NEAR: f32 = 0.0035;

/// A point in front of a ray's origin.
#[derive(Clone, Copy)]
struct Candidate {
    picked: Picked,
    /// Tangent of the angle between the ray and the direction to the point [1].
    aside: f32,
}

impl Candidate {
    /// Orders candidates: first those within the tolerance, by distance; then the others, by angle; ties by
    /// their index in the scene.
    fn order(&self, other: &Self) -> Ordering {
        let key = |c: &Self| if c.aside <= NEAR { (0, c.picked.distance) } else { (1, c.aside) };
        let place = |c: &Self| (c.picked.groom, c.picked.strand, c.picked.point);
        let ((a, by), (b, than)) = (key(self), key(other));
        a.cmp(&b).then(by.total_cmp(&than)).then(place(self).cmp(&place(other)))
    }
}

impl Stage {
    /// Writes one value for each point of all strands of a groom (index of the scene) into `out`. Follow
    /// hairs have the values of their first guide at the same coordinate. `out` is empty if there is no such
    /// groom.
    pub fn values(&self, what: Value, groom: usize, out: &mut Vec<f32>) {
        out.clear();
        if let Some(hair) = self.hair.get(groom) {
            hair.values(|k, strand, of_guide| self.write(hair, what, (k, strand), of_guide), out);
        }
    }

    /// Returns the strand whose points are nearest to a ray from `origin` [m] along `direction` (any length
    /// above 0). The body does not occlude. Of the points within 0.2° of the ray, the one nearest to the
    /// origin is chosen, otherwise the one nearest in angle. Returns `None` if there is no hair in that
    /// direction.
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

    /// Returns the first guide of a strand (index of the groom), or the strand itself if it is simulated.
    ///
    /// # Panics
    /// Panics if the scene has no such groom or the groom has no such strand.
    pub fn guide_of(&self, groom: usize, strand: usize) -> u32 {
        let hair = &self.hair[groom];
        hair.simulated_strands()[hair.first_guide(strand)]
    }

    /// Returns the figures of a strand (index of the groom).
    ///
    /// # Panics
    /// Panics under the same conditions as [`Stage::guide_of`].
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
            let depth = |o: &hairspring::collide::MovingCollider| {
                -o.shape.distance(o.end.inverse_transform_point(*p))
            };
            self.body.colliders().iter().map(depth).fold(0.0, f32::max)
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

    /// Writes one value for each point of a simulated strand, given by its index among the simulated strands
    /// and in the groom.
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
