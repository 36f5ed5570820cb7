//! Promise: a scene made by code is checked by the same rules as a scene file. The error names the place,
//! the setting and its range.

use glam::Vec3;
use hairspring::{material::Material, settings::Solver};
use hairspring_scene::{
    Collider, InitialContact, Scene, Shape,
    builtin::{BuiltinOptions, scene},
    stage::{Stage, StageError},
};

/// A change that makes a scene invalid, and the beginning of the error.
type Fault = (fn(&mut Scene), &'static str);

#[test]
fn every_part_of_a_scene_is_checked() {
    let faults: [Fault; 9] = [
        (|s| s.solver.substeps = 1025, "solver: `substeps` must be 1 to 1024"),
        (|s| s.wind.gust = -0.1, "wind: `gust` must be 0 to 1"),
        (|s| s.volume.cell = Some(0.0), "volume: `cell` must be above 0, at most 1 [m]"),
        (|s| s.volume.cell = Some(1e30), "volume: `cell` must be above 0, at most 1 [m]"),
        (|s| s.gravity = Vec3::NAN, "scene: `gravity` must be three numbers from -10000 to 10000 [m/s²]"),
        (|s| s.grooms[1].look.shadow = 5.0, "groom 1, look: `shadow` must be 0 to 4"),
        (
            |s| {
                s.grooms[0].materials =
                    vec![Material::default(), Material { friction: 2.0, ..Material::default() }]
            },
            "groom 0, material 1: `friction` must be 0 to 1",
        ),
        (|s| s.wind_occlusion.reach = 0.0, "wind_occlusion: `reach` must be above 0 [m]"),
        (
            |s| {
                let shape = Shape::Sphere { center: Vec3::ZERO, radius: -1.0 };
                s.colliders = vec![Collider { joint: None, initial: InitialContact::Keep, shape }];
            },
            "collider 0: `shape.sphere.radius` must be above 0 [m]",
        ),
    ];
    let good = scene(&BuiltinOptions { strands: 50, ..Default::default() });
    good.validate().unwrap();
    for (change, message) in faults {
        let mut bad = good.clone();
        change(&mut bad);
        let error = Stage::new(bad).err().expect(message);
        assert!(
            matches!(error, StageError::Settings(_)) && error.to_string().starts_with(message),
            "{error}"
        );
    }
    let mut stage = Stage::new(good.clone()).unwrap();
    let bad = Scene { solver: Solver { inertia: 2.0, ..good.solver }, ..good };
    let error = stage.update_settings(bad).unwrap_err();
    assert_eq!(error.to_string(), "solver: `inertia` must be 0 to 1");
}

#[test]
fn a_joint_without_size_that_carries_the_hair_is_named() {
    let good = scene(&BuiltinOptions { strands: 50, ..Default::default() });
    let mut bad = good.clone();
    bad.body.as_mut().unwrap().joints.iter_mut().for_each(|joint| joint.rest.scale.y = 0.0);
    let error = Stage::new(bad).err().unwrap().to_string();
    assert!(error.contains("carries the hair and has a scale of 0: give it a scale above 0"), "{error}");
    let mut bad = good;
    let clip = bad.clip.as_mut().unwrap();
    clip.samples[3 * clip.joint_count..4 * clip.joint_count].iter_mut().for_each(|joint| joint.scale.y = 0.0);
    let error = Stage::new(bad).err().unwrap().to_string();
    assert!(error.contains("has a scale of 0 in frame 3 of the clip"), "{error}");
}
