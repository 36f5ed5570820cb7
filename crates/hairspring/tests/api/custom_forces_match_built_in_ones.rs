//! Promise: user-defined forces match their built-in counterparts: a global shape with the same bits, and
//! wind to rounding.

use crate::support::{groom, shake, simulation};
use glam::Vec3;
use hairspring::{
    air::Air,
    forces::{ForceField, StrandView},
    groom::Groom,
    material::{GlobalShape, Material, profile_at},
    settings::{Solver, Wind},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{FRAME, REST, farthest, points, roots};
use std::{f32::consts::TAU, sync::Arc};

/// The global shape, implemented outside of the library.
struct Pull {
    groom: Groom,
    shape: GlobalShape,
}

impl ForceField for Pull {
    fn apply(&self, strand: &mut StrandView) {
        let authored = self.groom.strand(strand.index());
        let [start, end] = strand.roots();
        let way = end.translation - start.translation;
        let rate = 1.0 / strand.dt();
        let whole: f32 = authored.windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut along = authored[0].distance(authored[1]);
        for (i, p) in authored.iter().enumerate().skip(2) {
            along += p.distance(authored[i - 1]);
            let curve = profile_at(&self.shape.profile, f64::from(along / whole)) as f32;
            let omega = TAU * self.shape.pull * 1.0 * curve;
            let [from, to] = [start, end].map(|root| root.rotation * (*p - authored[0]));
            strand.add_position_spring(i, [from, to], omega * omega);
            strand.add_velocity_drag(i, (way + (to - from)) * rate, 2.0 * self.shape.damping * omega);
        }
    }
}

#[test]
fn a_custom_global_shape_has_the_same_bits() {
    let shape = GlobalShape { pull: 2.0, profile: vec![1.0, 0.5], damping: 0.7 };
    let material = Material { global_shape: shape.clone(), ..Material::default() };
    let mut built_in = simulation(10, material, Solver::default());
    let mut custom = simulation(10, Material::default(), Solver::default());
    let id = custom.add_force(Arc::new(Pull { groom: groom(10), shape }));
    for frame in 0..30 {
        shake(&mut built_in, frame, &[]);
        shake(&mut custom, frame, &[]);
    }
    assert_eq!(points(&custom), points(&built_in));
    assert!(custom.remove_force(id).is_some() && custom.remove_force(id).is_none());
    let mut without = simulation(10, Material::default(), Solver::default());
    without.restore(&custom.snapshot()).unwrap();
    for frame in 30..60 {
        shake(&mut custom, frame, &[]);
        shake(&mut without, frame, &[]);
    }
    assert_eq!(points(&custom), points(&without), "the removed force still acts");
}

/// Wind as an air velocity at each point.
struct Breeze(Vec3);

impl ForceField for Breeze {
    fn apply(&self, strand: &mut StrandView) {
        (2..strand.point_count()).for_each(|i| strand.add_wind(i, self.0));
    }
}

#[test]
fn a_custom_wind_agrees() {
    let velocity = Vec3::new(1.0, 0.0, 0.5);
    let step = |hair: &mut Simulation, wind: Wind| {
        let roots = roots(&groom(10), REST);
        let air = Air { wind, ..Air::default() };
        hair.step(&StepInput { dt: FRAME, anchor: REST, roots: &roots, colliders: &[], air });
    };
    let mut built_in = simulation(10, Material::default(), Solver::default());
    let mut custom = simulation(10, Material::default(), Solver::default());
    custom.add_force(Arc::new(Breeze(velocity)));
    for _ in 0..60 {
        step(&mut built_in, Wind { velocity, ..Wind::default() });
        step(&mut custom, Wind::default());
    }
    let difference = farthest(&points(&custom), &points(&built_in));
    assert!(difference < 1e-6, "{difference} m apart");
}
