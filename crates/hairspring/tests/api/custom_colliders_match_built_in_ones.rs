//! Promise: a user-defined collider keeps hair out like its built-in counterpart. With point contacts all
//! points agree within 0.1 mm. With segment contacts, whose deepest points are found by another search, the
//! penetration is no deeper.

use crate::support::{shake_in_contact, simulation};
use glam::Vec3;
use hairspring::{
    collide::{Collider, ColliderShape, MovingCollider},
    material::Material,
    settings::Solver,
};
use hairspring_test::{REST, farthest, points};

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
        let shapes =
            [ColliderShape::Capsule { a, b, radius }, ColliderShape::custom(Capsule { a, b, radius })];
        let [built_in, custom] = shapes.map(|shape| {
            let colliders = [MovingCollider::at_rest(shape, REST)];
            let mut hair = simulation(10, Material::default(), solver);
            shake_in_contact(&mut hair, &colliders);
            (points(&hair), hair.measure(&colliders))
        });
        let difference = farthest(&built_in.0, &custom.0);
        println!("segments: {segment_contacts}: {difference} m apart; {:?}", custom.1);
        assert!(difference < if segment_contacts { 5e-3 } else { 1e-4 }, "{difference} m apart");
        let [depth, custom_depth] = [built_in.1, custom.1].map(|m| m.max_depth);
        assert!(custom_depth < depth + 1e-5, "{custom_depth} m deep instead of {depth}");
    }
}
