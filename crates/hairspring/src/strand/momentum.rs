//! Tests that the internal forces of every model conserve momentum and angular momentum: their sum and the
//! sum of their moments vanish, so a strand cannot push or rotate itself. Also tests that the stretch spring,
//! which all models share, is the gradient of its energy.

use super::{
    assemble::{Linearization, SubstepContext},
    band::Band,
    elements::Elements,
    model::{
        Model, Stretching,
        curvature::Curvature,
        rod::Rod,
        springs::Springs,
        straight::Straight,
        stretch::{Sideways, stretch},
    },
    precomputed::precompute,
    reference,
    root::Root,
    scratch::Memory,
    tests::{lane, rows, splat, vector},
    tile::{
        Elastic, RestRows, RootRows, StateRows, StrandRows, Tile, TileLayout, TileRange, rest, springs,
        state, strand,
    },
};
use crate::simd::{
    dispatch::{dispatch, dispatch_double},
    lanes::{F, LANES, Mask, Row, Simd, V3},
};
use fearless_simd::Level;
use glam::{DVec3, Mat3, Vec3};
use proptest::prelude::*;

/// Forces on the points [N], and moments on the segments' angles [N m]. Only the rod has moments.
type Forces = (Vec<DVec3>, Vec<f64>);

/// Returns the internal forces of a strand that is deformed, flat and twisted.
fn internal(s: &reference::Strand, model: Elastic) -> Forces {
    let ((root_rows, mut strand_rows), mut rest_rows, state_rows, _) = rows(s);
    strand_rows[strand::FLAT] = Row([2.0; LANES]);
    let points = rest_rows.len();
    if model == Elastic::Springs {
        let (bend, length) = (s.bend[1] as f32, s.length[1] as f32);
        for (i, row) in rest_rows.iter_mut().enumerate() {
            for (at, value, reach) in [
                (springs::K2, 1e4 * bend, 2),
                (springs::L2, 1.9 * length, 2),
                (springs::K3, 1e4 * bend, 3),
                (springs::L3, 2.7 * length, 3),
                (springs::VOLUME, 0.2 * length.powi(3), 3),
            ] {
                row[at] = Row([if i + reach < points { value } else { 0.0 }; LANES]);
            }
        }
    } else {
        rest_rows.iter_mut().for_each(|row| row[rest::TWIST] = Row([0.3; LANES]));
    }
    forces_of(s, model, ((root_rows, strand_rows), rest_rows, state_rows))
}

/// Returns the internal forces of the strand in these rows, in double precision where the model has it.
fn forces_of(
    s: &reference::Strand,
    model: Elastic,
    ((root_rows, strand_rows), rest_rows, mut state_rows): (
        (RootRows, StrandRows),
        Vec<RestRows>,
        Vec<StateRows>,
    ),
) -> Forces {
    let mut forces = Forces::default();
    let layout = TileLayout { first: 0, points: rest_rows.len() as u32, model, flat: true, double: true };
    let mut range = TileRange {
        tiles: &[layout],
        roots: &[root_rows],
        strand: &[strand_rows],
        rest: &rest_rows,
        state: &mut state_rows,
        contact_age: &mut [Row::default()],
        holds: &[Vec::new()],
        ..TileRange::default()
    };
    let mut tile = range.tile(0);
    if model == Elastic::Springs {
        dispatch!(Level::new(), simd => forces = cursor::<_, Springs, 3, 12>(simd, s, &mut tile));
        return forces;
    }
    dispatch_double!(Level::new(), simd => forces = match model {
        Elastic::Straight => cursor::<_, Straight, 3, 9>(simd, s, &mut tile),
        Elastic::Curvature => cursor::<_, Curvature<_>, 3, 9>(simd, s, &mut tile),
        Elastic::Rod => cursor::<_, Rod<_>, 4, 11>(simd, s, &mut tile),
        Elastic::Springs => unreachable!("the springs model has single precision only"),
    });
    forces
}

#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn cursor<S, M, const B: usize, const N: usize>(simd: S, s: &reference::Strand, tile: &mut Tile) -> Forces
where
    S: Simd,
    M: Model<S, B, N>,
{
    let root = Root::between(simd, (tile.roots, tile.strand), 1.0, &(Mat3::IDENTITY, Vec3::ZERO));
    let step = SubstepContext {
        number: 0,
        left: 0.0,
        h: s.h as f32,
        relaxation: 1.0,
        gravity: Vec3::ZERO,
        wind: Vec3::ZERO,
        moved: root.position,
        root,
        second_order: false,
        touches: Mask::splat(simd, false),
        carried: F::splat(simd, 1.0),
        colliders: &[],
    };
    let mut memory = Memory::default();
    let mut scratch = memory.scratch(s.x.len());
    precompute(simd, step.h, Stretching::Moderate, tile, &mut scratch);
    scratch.begin(simd, tile.state);
    let mut elements = Elements::<S, M, B, N>::begin(simd, Linearization::Forces, &step, tile, &mut scratch);
    let mut forces = Forces::default();
    for i in 0..s.x.len() {
        if i + 1 < s.x.len() {
            elements.add_forces(simd, i, tile, &scratch);
        } else {
            elements.band = Band::new(simd);
        }
        elements.band.load_pending(simd, M::PROFILE, i, scratch.factors);
        forces.0.push(lane(elements.band.force()));
        forces.1.push(if B > 3 { elements.band.right(3).lane(3) as f64 } else { 0.0 });
        elements.band.skip_row(simd, M::PROFILE, i, scratch.factors);
    }
    forces
}

/// Bending and twisting up to a complete fold: the force is the negative gradient of the energy, within 0.2 %
/// of its largest value.
#[test]
fn the_force_is_the_gradient_of_the_energy_up_to_a_fold() {
    const LENGTH: f64 = 0.008;
    for degrees in [1.0, 60.0, 120.0, 138.0, 140.0, 150.0, 160.0, 170.0, 175.0, 179.0, 179.9] {
        for aside in [0.0, 0.7] {
            let angle = f64::to_radians(degrees);
            let t0 = DVec3::new(0.0, -1.0, 0.0);
            let t1 = DVec3::new(0.28, -0.96, 0.0);
            let across = DVec3::new(0.96, 0.28, 0.0);
            let t2 = t1 * angle.cos() + (across * 0.6 + DVec3::Z * 0.8) * angle.sin();
            let t3 = (t2 + DVec3::new(0.1, 0.2, 0.3)).normalize();
            let mut x = vec![DVec3::ZERO];
            for t in [t0, t1, t2, t3] {
                x.push((x[x.len() - 1] + t * LENGTH).as_vec3().as_dvec3());
            }
            let n = x.len();
            let length: Vec<f64> =
                (0..n).map(|i| if i + 1 < n { x[i].distance(x[i + 1]) } else { 0.0 }).collect();
            let strand = reference::Strand {
                v: vec![DVec3::ZERO; n],
                mass: vec![4e-8; n],
                bend: (0..n).map(|i| if i == 0 || i + 1 == n { 0.0 } else { 4e-6f32 as f64 }).collect(),
                turn: vec![DVec3::new(0.3, -0.2, 0.0).as_vec3().as_dvec3(); n],
                tension: vec![0.0; n],
                along: vec![[1.0; 2]; n],
                drag: 0.0,
                reynolds: 0.0,
                damping: 0.0,
                wind: DVec3::ZERO,
                moved: DVec3::ZERO,
                gravity: DVec3::ZERO,
                h: 1.0 / 240.0,
                length,
                x: x.clone(),
            };
            let (strand_rows, rest_rows, mut state_rows, mut normals) = rows(&strand);
            // Frames that are rotated relative to each other.
            for i in 1..n - 1 {
                let u = (x[i + 1] - x[i]).normalize();
                normals[i] = glam::DQuat::from_axis_angle(u, aside * i as f64) * normals[i];
                for (k, v) in normals[i].as_vec3().to_array().into_iter().enumerate() {
                    state_rows[i][state::NORMAL + k] = Row([v; LANES]);
                }
            }
            let (forces, _) = forces_of(&strand, Elastic::Rod, (strand_rows, rest_rows, state_rows));
            let energy = |y: &[DVec3]| reference::elastic_energy(&strand, &normals, &x, y);
            let gradient: Vec<DVec3> = (0..n)
                .map(|i| {
                    DVec3::from_array([0, 1, 2].map(|c| {
                        let step = 1e-4 * LENGTH * (1.0 - angle / 3.15).max(0.01);
                        let at = |s: f64| {
                            let mut y = x.clone();
                            y[i][c] += s;
                            energy(&y)
                        };
                        (at(step) - at(-step)) / (2.0 * step)
                    }))
                })
                .collect();
            let largest = gradient.iter().map(|g| g.length()).fold(0.0, f64::max);
            for i in 0..n {
                let error = (forces[i] + gradient[i]).length();
                assert!(
                    error < 2e-3 * largest,
                    "{degrees} degrees, turned {aside}: point {i} has {} and not {}",
                    forces[i],
                    -gradient[i]
                );
            }
        }
    }
}

proptest! {
    /// Stretch: the force is the gradient of T (ℓ − L) + ½ k (ℓ − L)², and the matrix is positive
    /// semi-definite.
    #[test]
    fn the_stretch_force_is_the_gradient_of_its_energy(
        e in vector(1.0), rest in 0.5..1.5, k in 1.0..100.0, tension in -1.0..10.0,
    ) {
        prop_assume!(e.length() > 0.3);
        let ((ours, block), u) = dispatch!(Level::new(), simd => {
            let f = |v: f64| F::splat(simd, v as f32);
            let (l, u) = splat(simd, e).length_and_unit();
            let still = Sideways::new(simd, 0.0, 1.0, Mask::splat(simd, false));
            let (force, block) = stretch((l, u), l - f(rest), (f(k), f(tension), f(1.0)), V3::zero(simd), &still);
            let m = [block.xx, block.xy, block.xz, block.yy, block.yz, block.zz].map(|v| v.lane(3) as f64);
            ((lane(force), m), lane(u))
        });
        // The force on the nearer point is the positive gradient, because a move along e shortens the
        // segment.
        let energy = |e: DVec3| tension * (e.length() - rest) + 0.5 * k * (e.length() - rest).powi(2);
        let gradient = DVec3::from([DVec3::X, DVec3::Y, DVec3::Z].map(|a| (energy(e + a * 1e-5) - energy(e - a * 1e-5)) / 2e-5));
        prop_assert!((ours - gradient).length() < 1e-4 * (k + tension.abs()), "{ours} and {gradient}");
        let product = |v: DVec3| {
            let [xx, xy, xz, yy, yz, zz] = block;
            DVec3::new(xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z)
        };
        let along = product(u).dot(u);
        prop_assert!((along - k).abs() < 1e-3 * k, "stiffness along {along}, not {k}");
        let across = u.any_orthonormal_vector();
        let side = product(across).dot(across);
        prop_assert!((-1e-3 * k..=1.001 * k).contains(&side), "stiffness across {side}");
    }

    /// For a strand with segments at rest length in an otherwise random shape, the forces sum to zero. So do
    /// the moments in models whose frames are unknowns or that have no frames. The curvature models are not
    /// checked for moments: their frame absorbs the moment about a segment.
    #[test]
    fn a_strand_cannot_push_or_turn_itself(
        steps in proptest::collection::vec(vector(0.3), 4..12),
        turns in proptest::collection::vec(vector(0.3), 12),
        tension in 0.0..2e-6,
    ) {
        let n = steps.len() + 1;
        let mut x = vec![DVec3::ZERO];
        for (i, s) in steps.iter().enumerate() {
            let (aside, along) = (2.1 * i as f64).sin_cos();
            x.push(x[i] + (DVec3::new(aside, -1.0, along) + *s).normalize() * 0.008);
        }
        // Four collinear points have no height. The truss never has four collinear particles.
        let volume = |w: &[DVec3]| (w[1] - w[0]).dot((w[2] - w[0]).cross(w[3] - w[0])).abs();
        prop_assume!(x.windows(4).all(|w| volume(w) > 0.02 * 0.008f64.powi(3)));
        let strand = reference::Strand {
            v: vec![DVec3::ZERO; n],
            mass: vec![4e-8; n],
            bend: (0..n).map(|i| if i == 0 || i + 1 == n { 0.0 } else { 4e-6 }).collect(),
            turn: turns[..n].to_vec(),
            tension: vec![tension; n],
            along: vec![[1.0; 2]; n],
            drag: 0.0, reynolds: 0.0, damping: 0.0, wind: DVec3::ZERO, moved: DVec3::ZERO, gravity: DVec3::ZERO,
            h: 1.0 / 240.0,
            length: (0..n).map(|i| if i + 1 < n { 0.008 } else { 0.0 }).collect(),
            x: x.clone(),
        };
        for model in [Elastic::Straight, Elastic::Curvature, Elastic::Rod, Elastic::Springs] {
            let (forces, moments) = internal(&strand, model);
            let size: f64 = forces.iter().map(|f| f.length()).sum();
            prop_assert!(size > 1e-8, "{model:?}: forces are too small to test");
            let sum: DVec3 = forces.iter().sum();
            prop_assert!(sum.length() < 1e-5 * size, "{model:?}: net force {sum} of {size}");
            if matches!(model, Elastic::Straight | Elastic::Curvature) {
                continue;
            }
            // A rigid rotation by ω swings each segment and rotates it about itself by ω·u.
            let mut torque: DVec3 = x.iter().zip(&forces).map(|(x, f)| x.cross(*f)).sum();
            for (w, moment) in x.windows(2).zip(&moments) {
                torque += (w[1] - w[0]).normalize() * *moment;
            }
            let reach = x.iter().map(|x| x.length()).fold(0.0, f64::max);
            prop_assert!(torque.length() < 1e-4 * size * reach, "{model:?}: net torque {torque} of {}", size * reach);
        }
    }
}
