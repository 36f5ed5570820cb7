//! Promise: `step` allocates no memory after its first call.
//!
//! A counting allocator wraps the system allocator. The test uses one thread, because the queues of a
//! thread pool also allocate.

use glam::Vec3;
use hairspring::{
    air::{Air, Flow, Source, Turbulence, WindOcclusion},
    forces::{Manipulator, charge::ChargedBall, comb::Comb, grab::Grab, tie::Tie},
    material::{GlobalShape, Material},
    settings::{Neighbours, Solver, Volume, VolumeMethod, Wind},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{REST, on_threads, roots};
use hairspring_validate::bench::{self, Bench};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
};

struct Counting;

thread_local! {
    /// Allocations of this thread; the test harness has another thread, which allocates at any time.
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is forwarded unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller upholds the system allocator's requirements.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A single test, because the harness allocates when a test ends.
#[test]
fn steps_after_the_first_do_not_allocate() {
    hair_on_hair_allocates_nothing();
    wind_and_charge_allocate_nothing();
}

fn hair_on_hair_allocates_nothing() {
    for method in VolumeMethod::ALL {
        let counted = on_threads(1, || {
            let mut bench = Bench::new(200, 16, Solver::default());
            bench.simulation.set_volume(&Volume { method, ..Volume::default() }).unwrap();
            bench.step();
            let before = COUNT.get();
            for _ in 0..20 {
                bench.step();
            }
            COUNT.get() - before
        });
        assert_eq!(counted, 0, "{counted} allocations in 20 steps with the volume method {}", method.name());
    }
    // Dense hair, which carries air.
    let counted = on_threads(1, || {
        let mut bench = Bench::new(200, 16, Solver::default());
        bench.simulation.set_hair_multiplicity(vec![500.0; 200]);
        bench.simulation.set_self_occlusion(&[]);
        bench.step();
        let before = COUNT.get();
        for _ in 0..20 {
            bench.step();
        }
        COUNT.get() - before
    });
    assert_eq!(counted, 0, "{counted} allocations in 20 steps of dense hair");
    // Strand contact.
    let counted = on_threads(1, || {
        let mut bench = Bench::new(200, 16, Solver::default());
        bench
            .simulation
            .set_neighbours(&Neighbours { on: true, stiction: 1e-6, ..Neighbours::default() })
            .unwrap();
        bench.step();
        let before = COUNT.get();
        for _ in 0..40 {
            bench.step();
        }
        let report = bench.simulation.neighbours().unwrap();
        assert!(report.touching_pairs > 50, "too few strands are in contact: {report:?}");
        COUNT.get() - before
    });
    assert_eq!(counted, 0, "{counted} allocations in 40 steps with strand contact");
    // Manipulators and a global shape, while a tie is still gathering.
    let counted = on_threads(1, || {
        let material = Material {
            global_shape: GlobalShape { pull: 2.0, ..GlobalShape::default() },
            ..Material::default()
        };
        let mut bench = Bench::with_material(200, 16, material, Solver::default());
        let center = Vec3::Y * 0.2;
        let (axis, half) = (Vec3::Y, Vec3::X * 0.1);
        for tool in [
            Manipulator::Grab(Grab { center: Vec3::X * 0.2, radius: 0.1, pull: 60.0, damping: 1.0 }),
            Manipulator::Comb(Comb {
                a: center - half,
                b: center + half,
                radius: 0.05,
                grip: 1000.0,
                friction: 3.0,
            }),
            Manipulator::Tie(Tie {
                center,
                axis,
                radius: 0.02,
                reach: 0.3,
                gather: 0.5,
                pull: 60.0,
                damping: 1.0,
            }),
        ] {
            let id = bench.simulation.add_manipulator(tool, REST);
            let holds = bench.simulation.attached_points(id).count();
            assert!(matches!(tool, Manipulator::Comb(_)) || holds > 10, "{tool:?} holds only {holds} points");
        }
        bench.step();
        let before = COUNT.get();
        for _ in 0..40 {
            bench.step();
        }
        COUNT.get() - before
    });
    assert_eq!(counted, 0, "{counted} allocations in 40 steps with manipulators");
}

fn wind_and_charge_allocate_nothing() {
    let counted = on_threads(1, || {
        let groom = bench::groom(200, 16);
        let roots = roots(&groom, REST);
        let material = Material { charge: 1e-9, ..Material::default() };
        let mut simulation = Simulation::builder(groom).materials(&[material]).build().unwrap();
        simulation.set_wind_occlusion(&WindOcclusion { hair: 50.0, ..WindOcclusion::default() }).unwrap();
        let flow = Flow::Point { center: Vec3::ZERO, radius: 0.1, speed: 1.0 };
        let sources = [Source { flow, pose: REST, factor: 1.0 }];
        let ball = ChargedBall { centers: [Vec3::Z; 2], radius: 0.1, charge: 1e-7 };
        let mut step = |frame: u32| {
            simulation.set_charged([ball]);
            simulation.step(&StepInput {
                dt: bench::FRAME,
                anchor: REST,
                roots: &roots,
                colliders: &[],
                air: Air {
                    wind: Wind { velocity: Vec3::X, gust: 0.5, gust_rate: 1.0 },
                    time: f64::from(frame as f32 * bench::FRAME),
                    sources: &sources,
                    turbulence: Turbulence { strength: 0.5, ..Turbulence::default() },
                },
            });
        };
        step(0);
        let before = COUNT.get();
        (1..20).for_each(step);
        COUNT.get() - before
    });
    assert_eq!(counted, 0, "{counted} allocations in 19 steps with wind and charge");
}
