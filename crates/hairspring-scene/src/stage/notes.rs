//! What a user should know about a scene before it plays.

use super::{Stage, hair::StagedHair};
use crate::InitialContact;
use glam::Vec3;
use hairspring::{collide::ColliderShape, simulation::VolumeReport};

/// Thickness below which hair may pass through a hull [m]. The side on which hair was is remembered for boxes, capsules
/// and sheets only.
const THIN_HULL: f32 = 5e-3;

/// Radius of a rod or ball below which hair may pass through it, over the length of a segment [1]. Found by trial.
const THIN_ROD: f32 = 0.0075;

/// Half thickness of a box below which hair may pass through it, over the length of a segment [1]: the depth that the contact
/// of segments permits.
const THIN_BOX: f32 = 0.015;

/// Depth of the shallowest root in a collider from which on it is reported [m]. Roots lie less deep in a shape that stands
/// for the head.
const DEEP_ROOT: f32 = 0.01;

/// Ratio above which cells are reported as larger than the hair needs [1]. With twice the size, results change by less
/// than a tenth.
const MUCH_COARSER: f32 = 1.5;

impl Stage {
    /// Returns a sentence for each thing that cannot be as the scene asks: a collision mesh that is too thin for its
    /// distance field, thin rods, boxes and hulls, hair that starts inside colliders, colliders around all roots, more
    /// guides than asked for, and a volume whose cells are enlarged.
    /// It describes the current state, so it is called before the first step.
    pub fn notes(&self) -> Vec<String> {
        let thin = self.thin_mesh().map(|thin| thin.to_string());
        let inside = self.starts_inside().map(|inside| inside.to_string());
        let guides = self.hair.iter().filter_map(|hair| hair.more_than_asked());
        let colliders = self
            .thin_solids()
            .into_iter()
            .chain(self.thin_hull())
            .chain(inside)
            .chain(self.around_all_roots());
        guides.chain(thin).chain(colliders).chain(self.enlarged_cells()).collect()
    }

    /// Describes the thinnest capsule or sphere and the thinnest box, if hair may pass through it.
    fn thin_solids(&self) -> Vec<String> {
        let strands = self.hair.iter().flat_map(StagedHair::simulated_points);
        let segments = strands.flat_map(|points| points.windows(2).map(|p| p[0].distance(p[1])));
        let longest = segments.fold(0.0, f32::max);
        let [mut rod, mut thin_box] = [f32::INFINITY; 2];
        for collider in self.scene_colliders() {
            match collider.shape {
                ColliderShape::Capsule { radius, .. } | ColliderShape::Sphere { radius, .. } => {
                    rod = rod.min(radius);
                }
                ColliderShape::Cuboid { half, .. } => thin_box = thin_box.min(half.min_element()),
                _ => {}
            }
        }
        let solids = [
            ("a capsule or sphere has a radius", rod, 1.0, THIN_ROD),
            ("a box has a thickness", thin_box, 2.0, THIN_BOX),
        ];
        let thin = solids.into_iter().filter(|(_, half, _, share)| *half < share * longest);
        thin.map(|(what, half, sides, share)| {
            let [size, least] = [half, share * longest].map(|half| 1e3 * sides * half);
            format!(
                "{what} of {size:.2} mm, and the longest segment of the hair has {:.0} mm; hair may pass through shapes with less \
                 than {least:.2} mm; give the strands more points",
                1e3 * longest
            )
        })
        .collect()
    }

    /// Describes the thinnest hull, if hair may pass through it.
    fn thin_hull(&self) -> Option<String> {
        let hulls = self.scene_colliders().iter().filter_map(|collider| match &collider.shape {
            ColliderShape::Hull(hull) => Some(hull.thickness()),
            _ => None,
        });
        let thinnest = hulls.fold(f32::INFINITY, f32::min);
        (thinnest < THIN_HULL).then(|| {
            format!(
                "a hull is {:.1} mm thick, and hair may pass through hulls of less than {:.0} mm; give it as a box, or as a \
                 [[sheet]] with a thickness",
                1e3 * thinnest,
                1e3 * THIN_HULL
            )
        })
    }

    /// Describes each collider that all roots lie deep inside. Those that push hair out first are in [`super::StartsInside`].
    fn around_all_roots(&self) -> Vec<String> {
        let strands = self.hair.iter().flat_map(StagedHair::simulated_points);
        let roots: Vec<Vec3> = strands.map(|points| points[0]).collect();
        let named = self.scene.colliders.iter().enumerate();
        let used = named.filter(|(_, collider)| collider.shape.collider_shape().is_some());
        let mut notes = Vec::new();
        for ((k, collider), moving) in used.zip(self.scene_colliders()) {
            let pose = moving.end_pose();
            let is_around = roots.iter().all(|root| pose.distance(*root) < -DEEP_ROOT);
            if collider.initial == InitialContact::Keep && is_around && !roots.is_empty() {
                let remedy = match moving.shape {
                    ColliderShape::Plane { .. } => "turn its `normal` round, or move it",
                    _ => "make it smaller, or move it",
                };
                notes.push(format!(
                    "the roots of all {} simulated strands lie inside [[collider]] {}, which does not push out hair that \
                     starts inside; {remedy}",
                    roots.len(),
                    k + 1
                ));
            }
        }
        notes
    }

    /// Describes cells of the volume that are larger than the scene asks for, or much larger than suits the hair.
    fn enlarged_cells(&self) -> Option<String> {
        let VolumeReport { cell, requested_cell, .. } = self.volume()?;
        let bearable = self.scene.volume.cell.map_or(MUCH_COARSER, |_| 1.0);
        (cell > bearable * requested_cell).then(|| match self.scene.volume.cell {
            Some(requested) => format!(
                "volume.cell = {requested} would need more cells than a grid can have; cells of {cell:.3} m are used"
            ),
            None => {
                // Rounded up, so that a scene can ask for it.
                let cell = (1e3 * cell).ceil() * 1e-3;
                format!(
                    "the volume's grid holds everything that strands can reach, and would have more than two million cells \
                     of the size that suits their density; cells of {cell:.3} m are used, in which hair acts on hair more \
                     coarsely; shorten the longest strands, or set volume.cell = {cell:.3} to accept it"
                )
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        Collider, Guides, InitialContact, Scene, Shape,
        builtin::{BuiltinOptions, scene},
        stage::Stage,
    };
    use glam::Vec3;
    use hairspring::settings::{Volume, VolumeMethod};

    #[test]
    fn thin_hulls_are_reported() {
        let head = scene(&BuiltinOptions { strands: 100, ..BuiltinOptions::default() });
        let notes = |thickness: f32| {
            let corner =
                |k: usize| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, thickness * (k >> 2) as f32);
            let shape = Shape::Hull { points: (0..8).map(corner).collect(), file: None, scale: None };
            let colliders = vec![Collider { joint: None, initial: InitialContact::Keep, shape }];
            Stage::new(Scene { colliders, ..head.clone() }).unwrap().notes()
        };
        assert!(notes(0.006).iter().all(|note| !note.contains("hull")));
        let thin = notes(0.002);
        assert!(thin.iter().any(|note| note.starts_with("a hull is 2.0 mm thick")), "{thin:?}");
    }

    #[test]
    fn thin_rods_and_boxes_are_reported() {
        let head = scene(&BuiltinOptions { strands: 100, ..BuiltinOptions::default() });
        let points = &head.grooms[0].groom.points;
        let longest = points.windows(2).map(|p| p[0].distance(p[1])).fold(0.0, f32::max);
        let notes = |shape: Shape, start: &str| {
            let colliders = vec![Collider { joint: None, initial: InitialContact::Keep, shape }];
            let notes = Stage::new(Scene { colliders, ..head.clone() }).unwrap().notes();
            notes.into_iter().filter(|note| note.starts_with(start)).count()
        };
        for (size, count) in [(1e-5, 1), (0.02 * longest, 0)] {
            let rod = Shape::Capsule { a: Vec3::ZERO, b: Vec3::X, radius: size };
            assert_eq!(notes(rod, "a capsule or sphere has a radius"), count);
            let plate = Shape::Box {
                center: Vec3::ZERO,
                size: Vec3::new(0.1, 0.1, 2.0 * size),
                rotation: Vec3::ZERO,
            };
            assert_eq!(notes(plate, "a box has a thickness"), count);
        }
    }

    #[test]
    fn colliders_around_all_roots_are_reported() {
        let head = scene(&BuiltinOptions { strands: 100, ..BuiltinOptions::default() });
        let root = head.grooms[0].groom.points[0];
        let notes = |shape: Shape, initial: InitialContact| {
            let small = Shape::Sphere { center: root + Vec3::X, radius: 0.1 };
            let keep = |shape| Collider { joint: None, initial: InitialContact::Keep, shape };
            let colliders = vec![keep(small), Collider { initial, ..keep(shape) }];
            let notes = Stage::new(Scene { colliders, ..head.clone() }).unwrap().notes();
            notes.into_iter().filter(|note| note.contains("the roots of all ")).collect::<Vec<_>>()
        };
        let plane = |normal: Vec3| Shape::Plane { point: root - 2.0 * Vec3::Y, normal };
        assert_eq!(notes(plane(Vec3::Y), InitialContact::Keep), Vec::<String>::new());
        let turned = notes(plane(Vec3::NEG_Y), InitialContact::Keep);
        assert_eq!(turned.len(), 1, "{turned:?}");
        assert!(turned[0].contains("inside [[collider]] 2") && turned[0].contains("`normal`"), "{turned:?}");
        let ball = |radius: f32| Shape::Sphere { center: root, radius };
        let large = notes(ball(1.0), InitialContact::Keep);
        assert!(large.len() == 1 && large[0].contains("make it smaller"), "{large:?}");
        assert_eq!(notes(ball(0.02), InitialContact::Keep), Vec::<String>::new());
        assert_eq!(notes(ball(1.0), InitialContact::Push), Vec::<String>::new());
    }

    #[test]
    fn cells_that_are_larger_than_requested_are_reported() {
        let head = scene(&BuiltinOptions { strands: 100, ..BuiltinOptions::default() });
        let notes = |cell: f32| {
            let volume = Volume { method: VolumeMethod::Density, cell: Some(cell), ..Volume::default() };
            Stage::new(Scene { volume, ..head.clone() }).unwrap().notes()
        };
        assert!(notes(0.02).iter().all(|note| !note.contains("volume.cell")));
        let small = notes(1e-5);
        assert!(small.iter().any(|note| note.starts_with("volume.cell = 0.00001 would need")), "{small:?}");
    }

    #[test]
    fn enlarged_cells_name_a_size_that_is_accepted() {
        let head = scene(&BuiltinOptions { strands: 400, guides: Guides::All, ..BuiltinOptions::default() });
        let notes = |cell: Option<f32>| {
            let volume = Volume { method: VolumeMethod::Density, cell, ..Volume::default() };
            Stage::new(Scene { volume, ..head.clone() }).unwrap().notes()
        };
        let (found, named) = notes(None)
            .into_iter()
            .find_map(|note| Some((note.clone(), note.split_once("set volume.cell = ")?.1.to_owned())))
            .expect("the grid holds more than the strands at rest");
        assert!(found.contains("everything that strands can reach"), "{found}");
        let cell = named.split(' ').next().unwrap().parse().unwrap();
        assert!(notes(Some(cell)).iter().all(|note| !note.contains("volume")), "{named}");
    }
}
