//! Promise: the same bits on every run, for each elastic model, integrator and instruction set, on one
//! thread or seven.
//!
//! The golden table holds the FNV-1a hash of the positions' bits after a tenth of a second of the bench
//! scene. One column is for instruction sets without fused multiplication (SSE2), the other for those with
//! it (AVX2, AVX-512). The test detects a change of a single rounding. After an intended change, replace
//! the table by the one that the failing test prints, in the same commit. The table is valid for x86-64 and
//! glibc, whose sine drives the scene; elsewhere the test is skipped.

use hairspring::{
    material::{Material, Model},
    settings::{Integrator, Solver},
};
use hairspring_test::{on_threads, points};
use hairspring_validate::bench::Bench;

/// Model, integrator, and hash without and with fused multiplication.
///
/// The table changed once after commit da51732:
///
/// | rows | reason |
/// | --- | --- |
/// | all | drag follows measured cylinders instead of a constant coefficient |
/// | backward Euler, BDF2 | bending is the gradient of an energy up to a fold; transverse damping by tension |
/// | springs | triangles beside a short segment are stiffer, and swings are damped more |
const GOLDEN: [(Model, Integrator, [u64; 2]); 7] = [
    (Model::Springs, Integrator::BackwardEuler, [0x7691843dce188933, 0x59a32e9c3ebeb5a6]),
    (Model::Curvature, Integrator::BackwardEuler, [0x14f931d118c036c9, 0xd0d3769c86f96e9b]),
    (Model::Rod, Integrator::BackwardEuler, [0x1571e60e60fbf13b, 0xd9023d7c58cc469a]),
    (Model::Rod, Integrator::Bdf2, [0x80e585be1dfd25af, 0x6d601178db486028]),
    (Model::Curvature, Integrator::LocalGlobal, [0xc03e77c72b3fc673, 0x2210331af82bf65c]),
    (Model::Curvature, Integrator::Ftl, [0x7df72afe2d36b678, 0x282bb4d1d8d57236]),
    (Model::Curvature, Integrator::Dftl, [0x4c8de6c10c6f5465, 0x5437a7dc70e0ef57]),
];

fn hash(set: &str, model: Model, integrator: Integrator, threads: usize) -> Option<u64> {
    on_threads(threads, || {
        let material = Material { model, ..Material::default() };
        let mut bench = Bench::with_material(150, 17, material, Solver { integrator, ..Solver::default() });
        if !bench.simulation.use_instruction_set(set) {
            return None;
        }
        (0..6).for_each(|_| _ = bench.step());
        let bytes = points(&bench.simulation)
            .into_iter()
            .flat_map(|p| p.to_array())
            .flat_map(|c| c.to_bits().to_le_bytes());
        Some(bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)))
    })
}

#[test]
fn golden_hashes() {
    if !cfg!(all(target_arch = "x86_64", target_env = "gnu")) {
        println!("skipped: no golden hashes for this processor and mathematical library");
        return;
    }
    let mut now = GOLDEN;
    for (set, fused) in [("sse2", 0), ("avx2", 1), ("avx512", 1)] {
        for (row, golden) in now.iter_mut().zip(GOLDEN) {
            let (model, integrator, hashes) = row;
            let Some(one) = hash(set, *model, *integrator, 1) else {
                println!("skipped: this processor does not support {set}");
                break;
            };
            for threads in [2, 7] {
                assert_eq!(hash(set, *model, *integrator, threads), Some(one), "{set} on {threads} threads");
            }
            let before = hashes[fused];
            assert!(
                before == one || before == golden.2[fused],
                "{set} differs from the other set with fused multiplication: {model:?}, {integrator:?}"
            );
            hashes[fused] = one;
        }
    }
    let row = |(model, integrator, [plain, fused]): &(Model, Integrator, [u64; 2])| {
        format!("    (Model::{model:?}, Integrator::{integrator:?}, [{plain:#018x}, {fused:#018x}]),\n")
    };
    assert!(now == GOLDEN, "the bits changed; the new table:\n{}", now.iter().map(row).collect::<String>());
}
