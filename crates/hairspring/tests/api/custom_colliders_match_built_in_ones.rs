//! Promise: a user-defined collider keeps hair out like its built-in counterpart. With point contacts all
//! points agree within 0.1 mm. With segment contacts, whose deepest points are found by another search, the
//! penetration is no deeper.

use crate::support::{points, shake, simulation};
use glam::Vec3;
use hairspring::{
    collide::{Collider, ColliderShape, MovingCollider},
    material::Material,
    math::RigidTransform,
    settings::Solver,
};

#[derive(Debug)]
struct Capsule {
    a: Vec3,
    b: Vec3,
    radius: f32,
}

impl Collider for Capsule {
    fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let axis = self.b - self.a;
        let t = ((p - self.a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        let d = p - (self.a + axis * t);
        (d.length() - self.radius, d.normalize_or(Vec3::Y))
    }

    fn bounds(&self) -> (Vec3, f32) {
        (self.a.midpoint(self.b), 0.5 * self.a.distance(self.b) + self.radius)
    }

    fn half_thickness(&self) -> f32 {
        self.radius
    }
}

#[test]
fn a_custom_capsule_keeps_hair_out() {
    let (a, b, radius) = (Vec3::new(-0.1, -0.08, 0.09), Vec3::new(0.2, -0.08, 0.09), 0.03);
    for segment_contacts in [false, true] {
        let solver = Solver { segment_contacts, ..Solver::default() };
        let still = RigidTransform::default();
        let shapes =
            [ColliderShape::Capsule { a, b, radius }, ColliderShape::custom(Capsule { a, b, radius })];
        let [built_in, custom] = shapes.map(|shape| {
            let colliders = [MovingCollider::at_rest(shape, still)];
            let mut hair = simulation(10, Material::default(), solver);
            let mut touched = 0;
            for frame in 0..60 {
                shake(&mut hair, frame, &colliders);
                let contacts = hair.contacts(&colliders);
                touched += contacts.points + contacts.segments;
            }
            assert!(touched > 20, "only {touched} contacts");
            (points(&hair), hair.measure(&colliders))
        });
        let off = built_in.0.iter().zip(&custom.0).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        println!("segments: {segment_contacts}: {off} m apart; {:?}", custom.1);
        assert!(off < if segment_contacts { 5e-3 } else { 1e-4 }, "{off} m apart");
        let [depth, of_custom] = [built_in.1, custom.1].map(|m| m.max_depth);
        assert!(of_custom < depth + 1e-5, "{of_custom} m deep instead of {depth}");
    }
}
