//! The kernel's pieces, each held against scalar f64.

use super::{
    band::{Band, FACTOR_ROWS, back_substitute},
    bend::bend,
    interval::{Interval, Substep},
    lanes::{F, LANES, M3, Row, Sym3, V3},
    reference::{self, dense_solve},
    substep::{Scratch, run_tile},
    tile::{Tile, rest, state, strand},
};
use fearless_simd::{Level, dispatch, prelude::*};
use glam::{DMat3, DVec3, Mat3, Vec3};
use proptest::prelude::*;

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    (-size..size, -size..size, -size..size).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn matrix() -> impl Strategy<Value = DMat3> {
    [vector(1.0), vector(1.0), vector(1.0)].prop_map(|[x, y, z]| DMat3::from_cols(x, y, z))
}

/// All lanes the same vector.
fn splat<S: Simd>(simd: S, v: DVec3) -> V3<S> {
    V3::splat(simd, v.as_vec3())
}

fn full<S: Simd>(simd: S, m: DMat3) -> M3<S> {
    M3 { rows: [0, 1, 2].map(|r| splat(simd, m.row(r))) }
}

fn symmetric<S: Simd>(simd: S, m: DMat3) -> Sym3<S> {
    let f = |r: usize, c: usize| F::splat(simd, m.row(r)[c] as f32);
    Sym3 { xx: f(0, 0), xy: f(0, 1), xz: f(0, 2), yy: f(1, 1), yz: f(1, 2), zz: f(2, 2) }
}

fn lane<S: Simd>(v: V3<S>) -> DVec3 {
    DVec3::new(v.x[3] as f64, v.y[3] as f64, v.z[3] as f64)
}

fn band_solve<S: Simd>(simd: S, a: &[Vec<DMat3>], b: &[DVec3]) -> Vec<DVec3> {
    let n = b.len();
    let mut factors = vec![[Row::default(); FACTOR_ROWS]; n];
    let mut band = Band::new(simd);
    let block = |i: usize, j: usize| if i < n && j < n { a[i][j] } else { DMat3::ZERO };
    let right = |i: usize| b.get(i).copied().unwrap_or(DVec3::ZERO);
    for k in 0..2 {
        band.diag[k] = symmetric(simd, block(k, k));
        band.rhs[k] = splat(simd, right(k));
    }
    band.upper[0] = full(simd, block(0, 1));
    for (i, factors) in factors.iter_mut().enumerate() {
        band.diag[2] = symmetric(simd, block(i + 2, i + 2));
        band.rhs[2] = splat(simd, right(i + 2));
        band.upper[1] = full(simd, block(i + 1, i + 2));
        band.far = full(simd, block(i, i + 2));
        band.eliminate(factors);
        band.shift(simd);
    }
    let (mut next, mut after) = (V3::zero(simd), V3::zero(simd));
    let mut out = vec![DVec3::ZERO; n];
    for i in (0..n).rev() {
        let x = back_substitute(simd, &factors[i], next, after);
        out[i] = lane(x);
        (next, after) = (x, next);
    }
    out
}

proptest! {
    /// A random band LLᵀ + I is positive definite; the band solver agrees with a dense Cholesky.
    #[test]
    fn the_band_solver_is_a_dense_cholesky(
        blocks in proptest::collection::vec([matrix(), matrix(), matrix()], 3..24),
        right in proptest::collection::vec(vector(1.0), 24),
    ) {
        let n = blocks.len();
        let l = |i: usize, j: usize| if i >= j && i - j < 3 { blocks[i][i - j] } else { DMat3::ZERO };
        let a: Vec<Vec<DMat3>> = (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| {
                        let one = if i == j { DMat3::IDENTITY } else { DMat3::ZERO };
                        (0..n).fold(one, |sum, k| sum + l(i, k) * l(j, k).transpose())
                    })
                    .collect()
            })
            .collect();
        let exact = dense_solve(&a, &right[..n]);
        let ours = dispatch!(Level::new(), simd => band_solve(simd, &a, &right[..n]));
        let size = exact.iter().map(|v| v.length()).fold(1.0, f64::max);
        for (e, o) in exact.iter().zip(&ours) {
            prop_assert!((*e - *o).length() < 2e-4 * size, "{e} and {o}");
        }
    }

    /// The bending force is minus the gradient of its energy, keeps momentum, and keeps angular momentum but for the twist
    /// about the segment that carries the frame.
    #[test]
    fn the_bending_force_is_the_gradient_of_its_energy(
        e0 in vector(1.0), e1 in vector(1.0), turn in vector(0.8), stiffness in 0.1..10.0,
    ) {
        prop_assume!(e0.length() > 0.2 && e1.length() > 0.2);
        // The swing is that of an inextensible segment (see `bend`); the outer one may be stretched.
        let lengths = [e0.length(), e1.length() * 0.97];
        let x = [DVec3::ZERO, e0, e0 + e1];
        let was = e0.normalize();
        let ours = dispatch!(Level::new(), simd => {
            let f = |v: f64| F::splat(simd, v as f32);
            bend(
                (splat(simd, e0), splat(simd, e1)),
                splat(simd, was),
                (f(1.0 / lengths[0]), f(1.0 / lengths[1])),
                splat(simd, turn),
                f(stiffness),
                f(stiffness),
            )
            .force
            .map(lane)
        });
        let size = stiffness * 10.0;
        for k in 0..3 {
            let gradient = DVec3::from([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                let at = |s: f64| {
                    let mut y = x;
                    y[k] += axis * s;
                    reference::bend_energy(y, lengths, was, turn, stiffness)
                };
                (at(1e-5) - at(-1e-5)) / 2e-5
            }));
            prop_assert!((ours[k] + gradient).length() < 1e-4 * size, "point {k}: {} and {}", ours[k], -gradient);
        }
        let sum: DVec3 = ours.iter().sum();
        prop_assert!(sum.length() < 1e-5 * size);
        let torque: DVec3 = x.iter().zip(&ours).map(|(x, f)| x.cross(*f)).sum();
        prop_assert!(torque.reject_from_normalized(was).length() < 1e-4 * size, "torque {torque}");
    }

    /// A whole substep of eight lanes is the dense f64 solve: gravity, wind, drag, damping, tension and a moving root included.
    #[test]
    fn the_kernel_solves_what_the_reference_solves(
        steps in proptest::collection::vec(vector(0.5), 5..20),
        turns in proptest::collection::vec(vector(0.1), 20),
        velocities in proptest::collection::vec(vector(0.5), 20),
        tension in 0.0..2e-6,
        moved in vector(0.003),
        wind in vector(2.0),
        drag in 0.0..20.0,
        damping in 0.0..0.02,
    ) {
        let n = steps.len() + 1;
        let h = 1.0 / 240.0;
        let mut x = vec![DVec3::ZERO];
        let mut length = Vec::new();
        for (i, s) in steps.iter().enumerate() {
            let e = (DVec3::new(0.3, -1.0, 0.2) + *s).normalize() * 0.008;
            // f32 rows hold the rest length: round alike.
            let rest = (e.length() * if i == 0 { 1.0 } else { 1.0 + 0.0005 * s.x }) as f32 as f64;
            length.push(rest);
            x.push(x[i] + e);
        }
        // Rest turns near the turns that there are: far from them, frames have far to twist, which takes many steps.
        let tangent: Vec<DVec3> = x.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
        let mut normal = tangent[0].any_orthonormal_vector();
        let mut turn = vec![DVec3::ZERO; n];
        for i in 1..n - 1 {
            let (t0, t1) = (tangent[i - 1], tangent[i]);
            let d = t1 - t0;
            turn[i] = DVec3::new(d.dot(normal), d.dot(t0.cross(normal)), d.dot(t0)) + turns[i];
            normal -= (t0 + t1) * (normal.dot(t1) / (1.0 + t0.dot(t1)));
        }
        let mass = 4e-8f32 as f64;
        let reference = reference::Strand {
            v: velocities[..n].to_vec(),
            mass: vec![mass; n],
            bend: (0..n).map(|i| if i == 0 || i + 1 == n { 0.0 } else { 4e-6f32 as f64 }).collect(),
            turn,
            tension: vec![tension; n],
            drag, damping, wind, moved, h,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            length: length.iter().copied().chain([0.0]).collect(),
            x: x.clone(),
        };
        // Each run turns the frames nearer to balance; the torque is then known to more than first order.
        let mut run = kernel(&reference, None);
        for _ in 0..8 {
            run = kernel(&reference, Some(&run.1));
        }
        let (ours, normals) = run;
        let exact = reference.solve(&normals);
        for i in 2..n {
            let error = (exact[i] - ours[i]).length();
            let way = (0..n).map(|i| (exact[i] - x[i]).length()).fold(0.0, f64::max);
            prop_assert!(error < 2e-3 * way + 1e-6, "point {i} of {n}: off by {error} m of {way} m");
        }
    }
}

/// One substep of the kernel without projection, on a tile whose lanes all hold this strand: the solved positions, and the
/// segments' normals that it solved with.
fn kernel(s: &reference::Strand, normals: Option<&[DVec3]>) -> (Vec<DVec3>, Vec<DVec3>) {
    let n = s.x.len();
    let mut strand_rows = [Row::default(); strand::ROWS];
    let mut rest_rows = vec![[Row::default(); rest::ROWS]; n];
    let mut state_rows = vec![[Row::default(); state::ROWS]; n];
    let set = |rows: &mut [Row], at: usize, v: &[f32]| {
        for (row, v) in rows[at..].iter_mut().zip(v) {
            *row = Row([*v; LANES]);
        }
    };
    set(&mut strand_rows, strand::ROOT_END, &s.moved.as_vec3().to_array());
    for at in [strand::TURN_START, strand::TURN_END] {
        set(&mut strand_rows, at, &[0.0, 0.0, 0.0, 1.0]);
    }
    // The frame on the first segment, carried along; the kernel's twist takes it from there.
    let first = s.x[1] - s.x[0];
    let mut normal = first.normalize().any_orthonormal_vector();
    set(&mut strand_rows, strand::FIRST, &first.as_vec3().to_array());
    set(&mut strand_rows, strand::NORMAL, &normal.as_vec3().to_array());
    set(&mut strand_rows, strand::DRAG, &[s.drag as f32]);
    set(&mut strand_rows, strand::DAMPING, &[s.damping as f32]);
    set(&mut strand_rows, strand::TWIST_RATIO, &[reference::TWIST_RATIO as f32]);
    let tangent: Vec<DVec3> = s.x.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
    for i in 0..n {
        set(&mut rest_rows[i], rest::LENGTH, &[s.length[i] as f32]);
        set(&mut rest_rows[i], rest::MASS, &[s.mass[i] as f32]);
        set(&mut rest_rows[i], rest::BEND, &[s.bend[i] as f32]);
        if (1..n - 1).contains(&i) {
            let (t0, t1) = (tangent[i - 1], tangent[i]);
            set(&mut rest_rows[i], rest::TURN, &s.turn[i].as_vec3().to_array());
            normal -= (t0 + t1) * (normal.dot(t1) / (1.0 + t0.dot(t1)));
        }
        set(&mut state_rows[i], state::X, &s.x[i].as_vec3().to_array());
        set(&mut state_rows[i], state::V, &s.v[i].as_vec3().to_array());
        let start = normals.map_or(normal, |n| n[i]);
        set(&mut state_rows[i], state::NORMAL, &start.as_vec3().to_array());
        set(&mut state_rows[i], state::TENSION, &[s.tension[i] as f32]);
    }
    let interval = Interval {
        h: s.h as f32,
        projections: 0,
        gravity: s.gravity.as_vec3(),
        anchor: (Mat3::IDENTITY, Vec3::ZERO),
        substeps: vec![Substep {
            fraction: 1.0,
            anchor: (Mat3::IDENTITY, Vec3::ZERO),
            wind: s.wind.as_vec3(),
            obstacles: Vec::new(),
        }],
    };
    let mut scratch = Scratch::default();
    let mut tile = Tile { strand: &strand_rows, rest: &rest_rows, state: &mut state_rows };
    dispatch!(Level::new(), simd => run_tile(simd, &interval, &mut tile, &mut scratch));
    let normals = state_rows.iter().map(|r| DVec3::from([0, 1, 2].map(|k| r[state::NORMAL + k].0[0] as f64)));
    ((0..n).map(|i| scratch.solved(i).as_dvec3()).collect(), normals.collect())
}
