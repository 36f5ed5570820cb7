//! Promise: a simulation that cannot be built is refused with a one-sentence error that names the place,
//! and never panics.

use crate::support::groom;
use glam::Vec3;
use hairspring::{
    groom::{Groom, StrandScale},
    material::Material,
    math::RigidTransform,
    settings::Solver,
    simulation::{BuildError, Simulation},
};

#[test]
fn invalid_grooms_are_refused() {
    let error = Simulation::builder(groom(3)).strands(&[0, 7]).build().err().unwrap();
    assert_eq!(error.to_string(), "strand 7 was requested, but the groom has only 3");
    let short = Groom::from_strands([vec![Vec3::ZERO, Vec3::Y]], 40e-6);
    let error = Simulation::builder(short).build().err().unwrap();
    assert_eq!(error, BuildError::TooFewPoints { strand: 0, points: 2 });
    let mut broken = groom(3);
    broken.points[20].x = f32::NAN;
    assert_eq!(Simulation::builder(broken).build().err(), Some(BuildError::NotFinite { strand: 1 }));
    let mut broken = groom(3);
    broken.radii.pop();
    let error = Simulation::builder(broken).build().err().unwrap();
    assert_eq!(error, BuildError::GroomArray { array: "radii", length: 47, expected: 48 });
    let mut broken = groom(3);
    broken.offsets[1] = 40;
    let error = Simulation::builder(broken).build().err().unwrap();
    assert_eq!(error, BuildError::GroomArray { array: "offsets", length: 32, expected: 40 });
    let nothing = Simulation::builder(groom(3)).strands(&[]).build().unwrap();
    assert_eq!((nothing.strand_count(), nothing.point_count()), (0, 0));
}

#[test]
fn fibers_without_a_valid_thickness_or_multiplier_are_refused() {
    for radius in [0.0, -1e-5, f32::NAN, f32::INFINITY] {
        let mut broken = groom(3);
        broken.radii[20] = radius;
        let error = Simulation::builder(broken.clone()).build().err();
        assert!(matches!(error, Some(BuildError::Radius { strand: 1, .. })), "{radius}: {error:?}");
        // The radius of a material replaces those of the groom.
        let material = Material { radius: Some(40e-6), ..Material::default() };
        assert!(Simulation::builder(broken).materials(&[material]).build().is_ok(), "{radius}");
    }
    for value in [-1.0, f32::NAN, f32::INFINITY] {
        let one = StrandScale::default();
        for (scale, key) in [
            (StrandScale { bend: value, ..one }, "bend"),
            (StrandScale { drag: value, ..one }, "drag"),
            (StrandScale { damping: value, ..one }, "damping"),
            (StrandScale { global_shape: value, ..one }, "global_shape"),
            (StrandScale { friction: value, ..one }, "friction"),
            (StrandScale { charge: value, ..one }, "charge"),
            (StrandScale { radius: value, ..one }, "radius"),
            (StrandScale { flatness: value, ..one }, "flatness"),
            (StrandScale { tether: value, ..one }, "tether"),
        ] {
            let broken = Groom { scales: vec![one, one, scale], ..groom(3) };
            let error = Simulation::builder(broken).build().err().unwrap();
            let BuildError::Scale { strand, error } = error else { panic!("{key}: {error}") };
            assert_eq!((strand, &*error.key), (2, key), "{value}");
        }
    }
}

#[test]
fn invalid_settings_are_refused() {
    let solver = Solver { substeps: 0, ..Solver::default() };
    let error = Simulation::builder(groom(3)).solver(solver).build().err().unwrap();
    assert_eq!(error.to_string(), "solver: `substeps` must be 1 to 1024");
    let materials = [Material::default(), Material { young: f32::NAN, ..Material::default() }];
    let error = Simulation::builder(groom(3)).materials(&materials).build().err().unwrap();
    assert_eq!(error.to_string(), "material 1: `young` must be 1 to 1e25 [Pa]");
    let error = Simulation::builder(groom(3)).gravity(Vec3::NAN).build().err().unwrap();
    assert_eq!(error.to_string(), "`gravity` must be three numbers from -10000 to 10000 [m/s²]");
    let anchor = RigidTransform { translation: Vec3::NAN, ..RigidTransform::default() };
    let error = Simulation::builder(groom(3)).anchor(anchor).build().err().unwrap();
    assert_eq!(error, BuildError::Anchor);
}
