//! Promise: the scalar build runs the same algorithm: its results equal those of SSE2 bit for bit.
//!
//! The scalar column of `hairspring bench --table` measures the benefit of SIMD only if both builds do the
//! same work. Neither build uses fused multiply-add, so every rounding is the same. The test is skipped on
//! a processor without SSE2.

use glam::Vec3;
use hairspring::material::Model;

/// Positions after a tenth of a second of the bench scene, for each model, in one of the two builds of the
/// library.
macro_rules! positions {
    ($library:ident, $scene:ident, $prepare:expr) => {{
        use $library::{
            material::{Material, Model},
            settings::{Integrator, Solver},
        };
        use $scene::bench::Bench;
        let cases = Model::ALL.map(|model| (model, Integrator::BackwardEuler));
        cases
            .into_iter()
            .chain([(Model::Rod, Integrator::Bdf2), (Model::Curvature, Integrator::LocalGlobal)])
            .map(|(model, integrator)| {
                let material = Material { model, ..Material::default() };
                let mut bench =
                    Bench::with_material(60, 17, material, Solver { integrator, ..Solver::default() });
                $prepare(&mut bench);
                (0..6).for_each(|_| _ = bench.step());
                let mut points = vec![Vec3::ZERO; bench.simulation.point_count()];
                bench.simulation.write_points(&mut points);
                (format!("{model:?}, {integrator:?}"), points)
            })
            .collect::<Vec<_>>()
    }};
}

#[test]
fn scalar_has_the_bits_of_sse2() {
    let mut supported = true;
    let mut set = |bench: &mut hairspring_validate::bench::Bench| {
        supported &= bench.simulation.use_instruction_set("sse2");
    };
    let simd = positions!(hairspring, hairspring_validate, set);
    if !supported {
        println!("skipped: this processor has no SSE2");
        return;
    }
    let is_scalar = |bench: &mut hairspring_scalar::bench::Bench| {
        assert_eq!(bench.simulation.instruction_set(), "scalar");
    };
    let scalar = positions!(hairspring_scalar, hairspring_scalar, is_scalar);
    assert_eq!(simd.len(), Model::ALL.len() + 2);
    for ((name, simd), (_, scalar)) in simd.iter().zip(&scalar) {
        assert_eq!(simd.len(), scalar.len(), "{name}");
        let different = simd.iter().zip(scalar).filter(|(a, b)| a != b).count();
        assert!(different == 0, "{name}: {different} of {} points differ", simd.len());
    }
}
