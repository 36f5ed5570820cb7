//! Promise: a value that the definition of a parameter accepts does not overflow: no strand becomes non-finite,
//! however large or small the value is. Values that overflow are refused.

use crate::support::groom;
use glam::Vec3;
use hairspring::{
    air::{Air, Flow, Source, Turbulence, WindOcclusion},
    groom::StrandScale,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Neighbours, Setting, Solver, Validate, Volume, VolumeMethod, Wind},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{FRAME, REST, roots};

/// Values of any size. A parameter accepts some of them.
const VALUES: [f32; 18] = [
    0.0, 1e-38, 1e-30, 1e-7, 1e-4, 1e-2, 1.0, 1e3, 1e4, 1e6, 1e10, 1e15, 1e20, 1e30, 1e38, -1e3, -1e30, -1e38,
];

/// Everything that a simulation is made with.
#[derive(Clone, Default)]
struct Settings {
    material: Material,
    scale: StrandScale,
    gravity: Option<Vec3>,
    wind: Wind,
    flow: Option<Flow>,
    turbulence: Turbulence,
    volume: Volume,
    neighbours: Neighbours,
    occlusion: WindOcclusion,
}

/// Simulates half a second. Returns the number of resets, or `None` if a value is refused.
fn resets(with: &Settings, model: Model) -> Option<usize> {
    let mut groom = groom(3);
    groom.scales = vec![with.scale; 3];
    let material = Material { model, ..with.material.clone() };
    if with.flow.is_some_and(|flow| flow.table_checks().iter().any(|check| !check.holds))
        || with.wind.validate().is_err()
        || with.turbulence.validate().is_err()
    {
        return None;
    }
    let source = with.flow.map(|flow| Source { flow, pose: REST, factor: 1.0 });
    let mut hair = Simulation::builder(groom.clone())
        .materials(&[material])
        .solver(Solver { sag_free: false, ..Solver::default() })
        .gravity(with.gravity.unwrap_or(Vec3::NEG_Y * 9.81))
        .build()
        .ok()?;
    hair.set_volume(&with.volume).ok()?;
    hair.set_neighbours(&with.neighbours).ok()?;
    hair.set_wind_occlusion(&with.occlusion).ok()?;
    let mut count = 0;
    for frame in 0_u8..30 {
        let air = Air {
            wind: with.wind,
            time: f64::from(frame) * f64::from(FRAME),
            sources: source.as_slice(),
            turbulence: with.turbulence,
        };
        let roots = roots(&groom, REST);
        let input =
            StepInput { dt: FRAME, anchor: RigidTransform::default(), roots: &roots, colliders: &[], air };
        count += hair.step(&input).reset_strands;
    }
    Some(count)
}

/// A parameter, and how it is set to a value.
type Parameter = (&'static str, fn(&mut Settings, f32));

const PARAMETERS: &[Parameter] = &[
    ("material.radius", |s, x| s.material.radius = Some(x)),
    ("material.radius_profile", |s, x| {
        s.material.radius = Some(35e-6);
        s.material.radius_profile = vec![1.0, x];
    }),
    ("material.density", |s, x| s.material.density = x),
    ("material.mass_profile", |s, x| s.material.mass_profile = vec![x, x]),
    ("material.young", |s, x| s.material.young = x),
    ("material.shear", |s, x| s.material.shear = x),
    ("material.bend", |s, x| s.material.bend = x),
    ("material.bend_profile", |s, x| s.material.bend_profile = vec![1.0, x]),
    ("material.damping", |s, x| s.material.damping = x),
    ("material.damping_profile", |s, x| s.material.damping_profile = vec![1.0, x]),
    ("material.drag", |s, x| s.material.drag = x),
    ("material.drag_profile", |s, x| s.material.drag_profile = vec![1.0, x]),
    ("strand.bend", |s, x| s.scale.bend = x),
    ("strand.radius", |s, x| {
        s.material.radius = Some(35e-6);
        s.scale.radius = x;
    }),
    ("strand.drag", |s, x| s.scale.drag = x),
    ("strand.damping", |s, x| s.scale.damping = x),
    ("gravity", |s, x| s.gravity = Some(Vec3::new(0.3, 1.0, 0.0) * x)),
    ("wind.velocity", |s, x| s.wind.velocity = Vec3::X * x),
    ("wind.gust_rate", |s, x| s.wind = Wind { velocity: Vec3::X, gust: 1.0, gust_rate: x }),
    ("turbulence.strength", |s, x| s.turbulence.strength = x),
    ("turbulence.size", |s, x| s.turbulence = Turbulence { strength: 1.0, size: x, ..Turbulence::default() }),
    ("point.speed", |s, x| s.flow = Some(Flow::Point { center: Vec3::X, radius: 0.1, speed: x })),
    ("point.radius", |s, x| s.flow = Some(Flow::Point { center: Vec3::X, radius: x, speed: 1.0 })),
    ("point.center", |s, x| s.flow = Some(Flow::Point { center: Vec3::X * x, radius: 0.1, speed: 1.0 })),
    ("vortex.speed", |s, x| {
        s.flow = Some(Flow::Vortex { center: Vec3::X, axis: Vec3::Y, radius: 0.1, speed: x });
    }),
    ("vortex.radius", |s, x| {
        s.flow = Some(Flow::Vortex { center: Vec3::X, axis: Vec3::Y, radius: x, speed: 1.0 });
    }),
    ("vortex.center", |s, x| {
        s.flow = Some(Flow::Vortex { center: Vec3::X * x, axis: Vec3::Y, radius: 0.1, speed: 1.0 });
    }),
    ("fan.speed", |s, x| {
        s.flow = Some(Flow::Fan { center: Vec3::Z, axis: -Vec3::Z, radius: 0.1, speed: x, spread: 12.0 });
    }),
    ("fan.radius", |s, x| {
        s.flow = Some(Flow::Fan { center: Vec3::Z, axis: -Vec3::Z, radius: x, speed: 1.0, spread: 12.0 });
    }),
    ("fan.center", |s, x| {
        s.flow =
            Some(Flow::Fan { center: Vec3::Z * x, axis: -Vec3::Z, radius: 0.1, speed: 1.0, spread: 12.0 });
    }),
    ("volume.friction", |s, x| s.volume = Volume { friction: x, ..density() }),
    ("volume.pressure", |s, x| s.volume = Volume { pressure: x, ..density() }),
    ("volume.cell", |s, x| s.volume = Volume { cell: Some(x), ..density() }),
    ("volume.recovery_rate", |s, x| {
        s.volume = Volume { method: VolumeMethod::Incompressible, recovery_rate: x, ..density() };
    }),
    ("neighbours.radius", |s, x| {
        s.neighbours = Neighbours { on: true, radius: Some(x), ..Default::default() }
    }),
    ("neighbours.friction", |s, x| s.neighbours = Neighbours { on: true, friction: x, ..Default::default() }),
    ("neighbours.stiction", |s, x| s.neighbours = Neighbours { on: true, stiction: x, ..Default::default() }),
    ("wind_occlusion.hair", |s, x| {
        (s.wind.velocity, s.occlusion.hair) = (Vec3::X, x);
    }),
    ("wind_occlusion.reach", |s, x| {
        s.wind.velocity = Vec3::X;
        s.occlusion = WindOcclusion { hair: 50.0, reach: x, ..WindOcclusion::default() };
    }),
];

fn density() -> Volume {
    Volume { method: VolumeMethod::Density, ..Volume::default() }
}

#[test]
fn what_is_accepted_does_not_overflow() {
    let mut overflows = Vec::new();
    for (name, set) in PARAMETERS {
        for value in VALUES {
            for model in [Model::Auto, Model::Rod] {
                let mut settings = Settings::default();
                set(&mut settings, value);
                if let Some(count) = resets(&settings, model).filter(|count| *count > 0) {
                    overflows.push(format!("{name} = {value:e}, {model:?}: {count} resets"));
                }
            }
        }
    }
    assert!(overflows.is_empty(), "{overflows:#?}");
}

#[test]
fn values_that_overflow_are_refused() {
    for (name, value) in [
        ("material.radius", 1e-30),
        ("material.shear", 1e38),
        ("material.young", 1e38),
        ("material.bend", 1e38),
        ("gravity", -1e20),
        ("wind.velocity", 1e30),
        ("turbulence.strength", 1e30),
        ("vortex.speed", 1e30),
    ] {
        let (_, set) = PARAMETERS.iter().find(|(known, _)| *known == name).unwrap();
        let mut settings = Settings::default();
        set(&mut settings, value);
        assert_eq!(resets(&settings, Model::Auto), None, "{name} = {value:e}");
    }
}
