//! Tests of the kernel's parts against scalar f64 implementations.

use super::{
    assemble::{Linearization, SubstepContext, assemble},
    band::{Band, back_substitute},
    bordered::BorderedConstraint,
    model::{
        Stretching,
        altitude::altitude,
        bend::bend,
        curvature::Curvature,
        rod::Rod,
        springs::{BEND, Springs, TORSION},
        straight::Straight,
    },
    precomputed::precompute,
    profile::Profile,
    reference::{self, dense_solve},
    root::Root,
    scratch::{Memory, Scratch},
    substitute::substitute,
    system::System,
    tile::{
        Elastic, MultiplierRows, RestRows, RootRows, StateRows, StrandRows, Tile, TileLayout, TileRange,
        rest, root, state, strand,
    },
    truss::ASIDE,
};
use crate::simd::{
    dispatch::{dispatch, dispatch_double},
    lanes::{F, LANES, Mask, Row, Simd, V3, Work},
};
use fearless_simd::Level;
use glam::{DVec3, Mat3, Vec3};
use proptest::{array::uniform4, prelude::*};

pub fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    (-size..size, -size..size, -size..size).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// A vector that is the same in all lanes.
pub fn splat<S: Simd>(simd: S, v: DVec3) -> V3<S> {
    V3::splat(simd, v.as_vec3())
}

pub fn lane<S: Simd>(v: V3<S>) -> DVec3 {
    DVec3::new(v.x.lane(3) as f64, v.y.lane(3) as f64, v.z.lane(3) as f64)
}

/// Springs that begin at a point of a band with long-range springs: for `far`, the direction, the stiffness
/// and the tension; for `across`, which spans four points, the direction, the coefficients of the gradient,
/// the stiffness and the extension.
#[derive(Clone, Copy, Debug)]
struct Held {
    far: (DVec3, f64, f64),
    across: Option<(DVec3, [f64; 4], f64, f64)>,
}

/// Solves a banded system of `B` unknowns a point with the kernel's band. The first `driven` points do not
/// move.
fn band_solve<S: Simd, const B: usize, const N: usize>(
    simd: S,
    profile: Profile<B, N>,
    (a, b): (&[Vec<f64>], &[f64]),
    (driven, held): (usize, &[Held]),
) -> Vec<f64> {
    let (n, rows, reach) = (b.len() / B, profile.rows(), Profile::<B, N>::REACH);
    let f = |v: f64| F::<S>::splat(simd, v as f32);
    let mut factors = vec![Work::default(); (n + 2 * reach) * rows];
    let mut eliminated = Vec::new();
    for i in 0..n {
        let mut band = Band::<S, B, N>::new(simd);
        // All elements whose first point is i.
        for r in i * B..(i + 1) * B {
            for (c, value) in a[r].iter().enumerate().take(n * B).skip(r) {
                if *value != 0.0 {
                    band.add((0, r - i * B), (c / B - i, c % B), f(*value));
                }
            }
            band.add_right((0, r - i * B), f(b[r]));
        }
        if let Some(Held { far: (u, k, pull), .. }) = held.get(i) {
            band.add_long_range_spring(splat(simd, *u), f(*k), f(*pull));
        }
        if i < driven {
            band.skip_row(simd, profile, i, &mut factors);
        } else {
            band.eliminate(simd, profile, i, &mut factors);
        }
        if let Some((u, c, k, extension)) = held.get(i).and_then(|held| held.across) {
            let gradient = c.map(|c| splat(simd, u * c));
            let across = BorderedConstraint { gradient, extension: f(extension), stiffness: f(k) };
            eliminated.push(across.eliminate(simd, profile, i, &mut factors));
        }
    }
    let mut unknowns = [f(0.0); N];
    let mut out = vec![0.0; n * B];
    for i in (driven..n).rev() {
        if let Some(across) = eliminated.pop_if(|across| across.point == i) {
            across.back_substitute(simd, profile, &unknowns, &mut factors);
        }
        back_substitute(simd, profile, &factors[(i + reach) * rows..], &mut unknowns);
        (0..B).for_each(|k| out[i * B + k] = unknowns[k].lane(3) as f64);
    }
    out
}

/// A random positive definite band matrix LLᵀ + I with half-bandwidth `half`. The unknowns of a point are not
/// coupled to any beyond its window.
fn banded(points: usize, [block, window, half]: [usize; 3], noise: &[f64]) -> Vec<Vec<f64>> {
    let n = points * block;
    let l = |i: usize, j: usize| {
        let met = i >= j && i - j <= half && i - j / block * block < window;
        if met { noise[(i * 31 + j * 17) % noise.len()] } else { 0.0 }
    };
    (0..n)
        .map(|i| {
            (0..n)
                .map(|j| (0..n).map(|k| l(i, k) * l(j, k)).sum::<f64>() + if i == j { 1.0 } else { 0.0 })
                .collect()
        })
        .collect()
}

fn agree<const B: usize, const N: usize>(
    half: usize,
    points: usize,
    noise: &[f64],
) -> Result<(), TestCaseError> {
    let a = banded(points, [B, N, half], noise);
    let right: Vec<f64> = (0..points * B).map(|i| noise[(i * 7) % noise.len()]).collect();
    let exact = dense_solve(&a, &right);
    let ours = dispatch!(Level::new(), simd => band_solve(simd, Profile::<B, N>::within(half), (&a, &right), (0, &[])));
    let size = exact.iter().map(|v| v.abs()).fold(1.0, f64::max);
    for (e, o) in exact.iter().zip(&ours) {
        prop_assert!((*e - *o).abs() < 2e-4 * size, "{e} and {o}");
    }
    Ok(())
}

proptest! {
    /// The band solver agrees with a dense Cholesky in f64, for the block and the bandwidth of every model.
    #[test]
    fn the_band_solver_is_a_dense_cholesky(points in 3usize..20, noise in proptest::collection::vec(-1.0..1.0, 97)) {
        agree::<1, 3>(2, points, &noise)?;
        agree::<3, 9>(6, points, &noise)?;
        agree::<3, 9>(8, points, &noise)?;
        agree::<4, 11>(10, points, &noise)?;
        agree::<3, 12>(11, points, &noise)?;
    }

    /// The band solver also agrees where a point and the third after it are coupled by a spring in one
    /// direction, of any stiffness. Some points also have a spring across all four points, whose force is an
    /// unknown of its own, and some points at the root are driven.
    #[test]
    fn springs_to_the_third_point_are_their_blocks_of_the_matrix(
        points in 4usize..20,
        driven in 0usize..4,
        noise in proptest::collection::vec(-1.0..1.0, 97),
        far in proptest::collection::vec((vector(1.0), 0.0f64..1e3, -1.0..1.0), 20),
        across in proptest::collection::vec(proptest::option::of((vector(1.0), uniform4(-1.0..1.0), 0.0f64..1e3, -1.0..1.0)), 20),
    ) {
        let mut a = banded(points, [3, 9, 8], &noise);
        let mut right: Vec<f64> = (0..points * 3).map(|i| noise[(i * 7) % noise.len()]).collect();
        // The kernel receives the numbers in f32.
        let rounded = |v: f64| v as f32 as f64;
        let unit = |u: DVec3| u.normalize_or_zero().as_vec3().as_dvec3();
        let held: Vec<Held> = far.into_iter().zip(across).take(points - 3).map(|((u, k, pull), across)| Held {
            far: (unit(u), rounded(k), pull),
            across: across.map(|(u, c, k, extension)| (unit(u), c.map(rounded), rounded(k), extension)),
        }).collect();
        let alone = (a.clone(), right.clone());
        for (i, Held { far: (u, k, pull), across }) in held.iter().enumerate() {
            let far = (*u, [1.0, 0.0, 0.0, -1.0], *k, *pull);
            let across = across.map(|(u, c, k, extension)| (u, c, k, -k * extension));
            for (u, c, k, force) in [Some(far), across].into_iter().flatten() {
                let g = |r: usize| c[r / 3] * u[r % 3];
                for r in 0..12 {
                    right[i * 3 + r] += g(r) * force;
                    (0..12).for_each(|c| a[i * 3 + r][i * 3 + c] += k * g(r) * g(c));
                }
            }
        }
        for r in 0..driven * 3 {
            a.iter_mut().for_each(|row| row[r] = 0.0);
            a[r].fill(0.0);
            (a[r][r], right[r]) = (1.0, 0.0);
        }
        let exact = dense_solve(&a, &right);
        let ours = dispatch!(Level::new(), simd => {
            band_solve(simd, Profile::<3, 12>::far(), (&alone.0, &alone.1), (driven, &held))
        });
        let size = exact.iter().map(|v| v.abs()).fold(1.0, f64::max);
        for (e, o) in exact.iter().zip(&ours) {
            prop_assert!((*e - *o).abs() < 2e-3 * size, "{e} and {o}");
        }
    }

    /// The bending force is the negative gradient of its energy. It conserves momentum, and angular momentum
    /// except for the twist about the segment that carries the frame.
    #[test]
    fn the_bending_force_is_the_gradient_of_its_energy(
        e0 in vector(1.0), e1 in vector(1.0), turn in vector(0.8), stiffness in 0.1..10.0,
    ) {
        prop_assume!(e0.length() > 0.2 && e1.length() > 0.2);
        // The rotation assumes an inextensible segment (see `bend`); the outer one may be stretched.
        let lengths = [e0.length(), e1.length() * 0.97];
        let x = [DVec3::ZERO, e0, e0 + e1];
        let was = e0.normalize();
        let ours = dispatch!(Level::new(), simd => {
            let f = |v: f64| F::splat(simd, v as f32);
            let [p0, p1] = bend(
                [[splat(simd, e0), splat(simd, e1)], [V3::zero(simd); 2]],
                splat(simd, was),
                [f(1.0 / lengths[0]), f(1.0 / lengths[1])],
                splat(simd, turn),
                f(stiffness),
                f(stiffness),
            )
            .joint
            .pull
            .map(lane);
            [-p0, p0 - p1, p1]
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

    /// The altitude spring's gradient is that of the height, and the spring conserves momentum and angular
    /// momentum.
    #[test]
    fn the_altitude_spring_is_the_gradient_of_a_height(x in [vector(1.0), vector(1.0), vector(1.0), vector(1.0)]) {
        let volume = |x: [DVec3; 4]| (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0]));
        let rest = volume(x);
        prop_assume!(rest.abs() > 0.05);
        let at = |x: [DVec3; 4]| dispatch!(Level::new(), simd => {
            let (n, c, strain) = altitude(simd, x.map(|x| splat(simd, x)), F::splat(simd, rest as f32));
            (lane(n), c.map(|c| c.lane(3) as f64), strain.lane(3) as f64)
        });
        let (n, c, strain) = at(x);
        prop_assert!(strain.abs() < 1e-5, "at rest: {strain}");
        prop_assert!(c.iter().sum::<f64>().abs() < 1e-4 && (n.length() - 1.0).abs() < 1e-4);
        let torque: DVec3 = x.iter().zip(c).map(|(x, c)| x.cross(n * c)).sum();
        prop_assert!(torque.length() < 1e-3, "torque {torque}");
        // The gradient of the volume over the area |n| that belongs to the height: Σ over points along any
        // direction.
        for k in 0..4 {
            let gradient = DVec3::from([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                let mut y = x;
                y[k] += axis * 1e-3;
                (volume(y) - rest) / 1e-3
            }));
            // Along n, the height grows by c_k a meter while the area stays constant (n is perpendicular to
            // it), so the volume grows by c_k |area|.
            let area = (rest / c.iter().zip(x).map(|(c, x)| x.dot(n) * c).sum::<f64>()).abs();
            let grows = gradient.dot(n) * rest.signum();
            let height_sign = c.iter().zip(x).map(|(c, x)| x.dot(n) * c).sum::<f64>().signum();
            prop_assert!((grows - height_sign * c[k] * area).abs() < 2e-2 * area, "point {k}: {grows} and {}", c[k] * area);
        }
    }

    /// A whole substep of eight lanes agrees with the dense f64 solve, including gravity, wind, drag,
    /// damping, tension and a moving root.
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
        more in proptest::array::uniform2(0.0f32..0.5),
    ) {
        let n = steps.len() + 1;
        let h = 1.0 / 240.0;
        let mut x = vec![DVec3::ZERO];
        let mut length = Vec::new();
        for (i, s) in steps.iter().enumerate() {
            let e = (DVec3::new(0.3, -1.0, 0.2) + *s).normalize() * 0.008;
            // The rows hold the rest length in f32, so the reference uses the same rounded value.
            let rest = (e.length() * if i == 0 { 1.0 } else { 1.0 + 0.0005 * s.x }) as f32 as f64;
            length.push(rest);
            x.push(x[i] + e);
        }
        // Rest turns close to the current turns. Otherwise the frames have to twist far, which takes several
        // steps.
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
            along: (0..n).map(|i| [1.0 + more[0] * i as f32, 1.0 + more[1] * i as f32].map(f64::from)).collect(),
            drag: drag * mass / 0.008, reynolds: 4.6, damping, wind, moved, h,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            length: length.iter().copied().chain([0.0]).collect(),
            x: x.clone(),
        };
        for model in [Elastic::Straight, Elastic::Curvature, Elastic::Rod] {
        let straight = reference::Strand { turn: vec![DVec3::ZERO; n], ..reference.clone() };
        let reference = if model == Elastic::Straight { &straight } else { &reference };
        for double in [false, true] {
            let (ours, normals) = kernel(reference, model, double);
            let exact = reference.solve(&normals, model == Elastic::Rod);
            for i in 2..n {
                let error = (exact[i] - ours[i]).length();
                let way = (0..n).map(|i| (exact[i] - x[i]).length()).fold(0.0, f64::max);
                prop_assert!(error < 1e-3 * way + 5e-7, "{model:?}, double {double}, point {i} of {n}: off by {error} m of {way} m");
            }
        }
        }
    }
}

/// Returns the rows of a tile whose lanes all hold this strand, and the normals of its segments, transported
/// from the root.
pub fn rows(s: &reference::Strand) -> ((RootRows, StrandRows), Vec<RestRows>, Vec<StateRows>, Vec<DVec3>) {
    let n = s.x.len();
    let mut root_rows = [Row::default(); root::ROWS];
    let mut strand_rows = [Row::default(); strand::ROWS];
    let mut rest_rows = vec![[Row::default(); rest::ROWS]; n];
    let mut state_rows = vec![[Row::default(); state::ROWS]; n];
    let set = |rows: &mut [Row], at: usize, v: &[f32]| {
        for (row, v) in rows[at..].iter_mut().zip(v) {
            *row = Row([*v; LANES]);
        }
    };
    set(&mut root_rows, root::END, &s.moved.as_vec3().to_array());
    for at in [root::TURN_START, root::TURN_END] {
        set(&mut root_rows, at, &[0.0, 0.0, 0.0, 1.0]);
    }
    let mut normals = Vec::new();
    let first = s.x[1] - s.x[0];
    let mut normal = first.normalize().any_orthonormal_vector();
    set(&mut strand_rows, strand::FIRST, &first.as_vec3().to_array());
    set(&mut strand_rows, strand::NORMAL, &normal.as_vec3().to_array());
    set(&mut strand_rows, strand::STIFFENING, &[1.0]);
    set(&mut strand_rows, strand::DRAG, &[s.drag as f32]);
    set(&mut strand_rows, strand::REYNOLDS, &[s.reynolds as f32]);
    set(&mut strand_rows, strand::DAMPING, &[s.damping as f32]);
    set(&mut strand_rows, strand::TWIST_RATIO, &[reference::TWIST_RATIO as f32]);
    let tangent: Vec<DVec3> = s.x.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
    for i in 0..n {
        set(&mut rest_rows[i], rest::SLIP, &[1.0]);
        set(&mut rest_rows[i], rest::LENGTH, &[s.length[i] as f32]);
        set(&mut rest_rows[i], rest::MASS, &[s.mass[i] as f32]);
        set(&mut rest_rows[i], rest::BEND, &[s.bend[i] as f32]);
        if (1..n - 1).contains(&i) {
            let (t0, t1) = (tangent[i - 1], tangent[i]);
            set(&mut rest_rows[i], rest::TURN, &s.turn[i].as_vec3().to_array());
            normal -= (t0 + t1) * (normal.dot(t1) / (1.0 + t0.dot(t1)));
        }
        set(&mut state_rows[i], state::EDGE, &(s.x[i] - s.x[i.saturating_sub(1)]).as_vec3().to_array());
        // Driven points have the velocity of the root.
        let v = s.v[if i < 2 { 0 } else { i }];
        set(&mut state_rows[i], state::V, &v.as_vec3().to_array());
        normals.push(normal);
        set(&mut state_rows[i], state::NORMAL, &normal.as_vec3().to_array());
        set(&mut state_rows[i], state::TENSION, &[s.tension[i] as f32]);
    }
    ((root_rows, strand_rows), rest_rows, state_rows, normals)
}

/// Solves one substep on a tile whose lanes all hold this strand. Returns the solved positions and the
/// normals of the segments before the solve, transported from the root.
fn kernel(s: &reference::Strand, model: Elastic, double: bool) -> (Vec<DVec3>, Vec<DVec3>) {
    let n = s.x.len();
    let ((root_rows, strand_rows), rest_rows, mut state_rows, normals) = rows(s);
    let multiplier_rows: Vec<MultiplierRows> = s
        .along
        .iter()
        .map(|at| [at[0], at[1], 1.0, reference::TWIST_RATIO, 0.0].map(|x| Row([x as f32; LANES])))
        .collect();
    let mut memory = Memory::default();
    let mut scratch = memory.scratch(n);
    let layout = TileLayout { first: 0, points: rest_rows.len() as u32, model, flat: false, double };
    let mut range = TileRange {
        tiles: &[layout],
        roots: &[root_rows],
        strand: &[strand_rows],
        rest: &rest_rows,
        state: &mut state_rows,
        multipliers: &multiplier_rows,
        contact_age: &mut [Row::default()],
        holds: &[Vec::new()],
        ..TileRange::default()
    };
    let mut tile = range.tile(0);
    let mut edges = vec![DVec3::ZERO; n];
    if double {
        dispatch_double!(Level::new(), simd => solve_substep(simd, s, &mut tile, &mut scratch, &mut edges));
    } else {
        dispatch!(Level::new(), simd => solve_substep(simd, s, &mut tile, &mut scratch, &mut edges));
    }
    let solved = edges.into_iter().scan(DVec3::ZERO, |x, e| {
        *x += e;
        Some(*x)
    });
    (solved.collect(), normals)
}

/// Stores the solved edges of one lane in `edges`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn solve_substep<S: Simd>(
    simd: S,
    s: &reference::Strand,
    tile: &mut Tile,
    scratch: &mut Scratch,
    edges: &mut [DVec3],
) {
    let root = Root::between(simd, (tile.roots, tile.strand), 1.0, &(Mat3::IDENTITY, Vec3::ZERO));
    let step = SubstepContext {
        number: 0,
        left: 0.0,
        h: s.h as f32,
        relaxation: 1.0,
        gravity: s.gravity.as_vec3(),
        wind: s.wind.as_vec3(),
        moved: root.position,
        root,
        second_order: false,
        touches: Mask::splat(simd, false),
        carried: F::splat(simd, 1.0),
        colliders: &[],
    };
    scratch.begin(simd, tile.state);
    precompute(simd, step.h, Stretching::Moderate, tile, scratch);
    solve_once(simd, &step, tile, scratch);
    for (edge, row) in edges.iter_mut().zip(&*scratch.edges) {
        *edge = lane(V3::load(simd, row));
    }
}

#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn solve_once<S: Simd>(simd: S, step: &SubstepContext<S>, tile: &mut Tile, scratch: &mut Scratch) {
    let whole = (Linearization::Initial, F::splat(simd, 1.0));
    match tile.layout.model {
        Elastic::Straight => {
            assemble::<S, Straight, 3, 9>(simd, Linearization::Initial, step, tile, scratch);
            substitute::<S, Straight, 3, 9>(simd, whole, step, tile, scratch);
        }
        Elastic::Curvature => {
            assemble::<S, Curvature<S>, 3, 9>(simd, Linearization::Initial, step, tile, scratch);
            substitute::<S, Curvature<S>, 3, 9>(simd, whole, step, tile, scratch);
        }
        Elastic::Rod => {
            assemble::<S, Rod<S>, 4, 11>(simd, Linearization::Initial, step, tile, scratch);
            substitute::<S, Rod<S>, 4, 11>(simd, whole, step, tile, scratch);
        }
        Elastic::Springs => {
            assemble::<S, Springs, 3, 12>(simd, Linearization::Initial, step, tile, scratch);
            substitute::<S, Springs, 3, 12>(simd, whole, step, tile, scratch);
        }
    }
}

/// The nonlinear spring laws compensate for their levers: a joint that bends or twists by φ resists with B φ
/// or C φ.
#[test]
fn a_joint_of_springs_is_linear() {
    // Bending: arms to p₂ and to e₀ with the angle θ₀ + φ between them. Twisting: e₀ and e₁ a quarter turn +
    // φ apart, separated by a segment's length along the axis.
    let arm = (0.25 + ASIDE * ASIDE).sqrt();
    let start = std::f64::consts::PI - (2.0 * ASIDE).atan();
    let bend = |phi: f64| (1.0 + arm * arm - 2.0 * arm * (start + phi).cos()).sqrt();
    let twist = |phi: f64| (1.0 + 2.0 * ASIDE * ASIDE * (1.0 + phi.sin())).sqrt();
    for (law, length) in [(TORSION, &bend as &dyn Fn(f64) -> f64), (BEND, &twist)] {
        let rest = length(0.0);
        let energy = |phi: f64| law.pull(length(phi) - rest, rest).1;
        let moment = |phi: f64| (energy(phi + 1e-4) - energy(phi - 1e-4)) / 2e-4;
        let stiffness = moment(1e-3) / 1e-3;
        for phi in [-0.3, -0.15, 0.15, 0.3] {
            let error = (moment(phi) / (stiffness * phi) - 1.0).abs();
            assert!(error < 0.07 * (phi / 0.3f64).abs().powi(2), "{error} at {phi}");
        }
        let pulled = law.lengthened(law.pull(0.1, rest).0, rest + 0.1);
        assert!((pulled - 0.1).abs() < 1e-9, "{pulled}");
    }
}
