//! Promise: a distance field from an array of samples gives the same bits as one made from a mesh. Invalid
//! arrays are refused with a one-sentence error.

use crate::support::{shake_in_contact, simulation};
use glam::{UVec3, Vec3};
use hairspring::{
    collide::{ColliderShape, FieldError, MovingCollider, SignedDistanceField, voxelize},
    material::Material,
    settings::Solver,
};
use hairspring_test::{REST, points};
use std::sync::Arc;

/// An octahedron below the strands.
fn mesh() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (center, size) = (Vec3::new(0.03, -0.07, 0.04), 0.04);
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let corner = |x: u32, y: u32, z: u32| if (x + y + z).is_multiple_of(2) { [x, y, z] } else { [y, x, z] };
    let faces = (0..8).map(|k| corner(k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2)));
    (axes.map(|a| center + a * size).to_vec(), faces.collect())
}

#[test]
fn the_same_samples_give_the_same_bits() {
    let (positions, triangles) = mesh();
    let made = voxelize(&positions, &triangles, 0.004);
    let given =
        SignedDistanceField::from_samples(made.origin(), made.cell(), made.size(), made.distances().to_vec());
    let [from_mesh, from_samples] = [made, given.unwrap()].map(|field| {
        let shape = ColliderShape::Field(Arc::new(field));
        let colliders = [MovingCollider::at_rest(shape, REST)];
        let mut hair = simulation(10, Material::default(), Solver::default());
        shake_in_contact(&mut hair, &colliders);
        points(&hair)
    });
    assert_eq!(from_mesh, from_samples);
}

#[test]
fn invalid_samples_are_refused() {
    let field =
        |cell, size, samples: Vec<f32>| SignedDistanceField::from_samples(Vec3::ZERO, cell, size, samples);
    let two = UVec3::splat(2);
    assert_eq!(field(0.0, two, vec![0.0; 8]), Err(FieldError::Cell(0.0)));
    assert_eq!(
        field(0.1, UVec3::new(1, 2, 2), vec![0.0; 4]).unwrap_err(),
        FieldError::Size(UVec3::new(1, 2, 2))
    );
    let huge = UVec3::splat(u32::MAX);
    assert_eq!(field(0.1, huge, vec![]), Err(FieldError::Size(huge)));
    assert_eq!(field(0.1, two, vec![0.0; 7]), Err(FieldError::Count { nodes: 8, samples: 7 }));
    let mut samples = vec![0.0; 8];
    samples[5] = f32::NAN;
    let error = field(0.1, two, samples).unwrap_err();
    assert_eq!((error, error.to_string().as_str()), (FieldError::NotFinite(5), "sample 5 is not finite"));
    let origin = Vec3::new(f32::INFINITY, 0.0, 0.0);
    assert_eq!(SignedDistanceField::from_samples(origin, 0.1, two, vec![0.0; 8]), Err(FieldError::Origin));
}
