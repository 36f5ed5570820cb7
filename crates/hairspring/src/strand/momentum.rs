//! Internal forces of every model add up to nothing, and so do their moments: a strand cannot push or turn itself. And the stretch
//! spring, which all models share, is the gradient of its energy.

use super::{
    assemble::{Step, Sweep},
    band::Band,
    dispatch::dispatch,
    elements::Elements,
    fixed::fix,
    lanes::{F, LANES, Row},
    model::{
        Model, Stretching, curvature::Curvature, rod::Rod, springs::Springs, straight::Straight,
        stretch::stretch,
    },
    reference,
    root::Root,
    scratch::Memory,
    tests::{lane, rows, splat, vector},
    tile::{Elastic, Tile, rest, springs, strand},
};
use fearless_simd::{Level, prelude::*};
use glam::{DVec3, Mat3, Vec3};
use proptest::prelude::*;

/// Forces on the points [N], and moments on the segments' angles [N m], of which only the rod has any.
type Forces = (Vec<DVec3>, Vec<f64>);

/// The internal forces of a strand whose rest shape is another one.
fn internal(s: &reference::Strand, model: Elastic) -> Forces {
    let (mut strand_rows, mut rest_rows, mut state_rows, _) = rows(s);
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
    let mut tile = Tile {
        model,
        flat: true,
        strand: &strand_rows,
        rest: &rest_rows,
        state: &mut state_rows,
        history: &mut [],
        push: &[],
        grip: &[],
        tines: &[],
        air: &[],
        sunk: &[],
        spans: &mut [],
        tethers: &[],
        holds: &[],
    };
    dispatch!(Level::new(), simd => match model {
        Elastic::Straight => walk::<_, Straight, 3, 9>(simd, s, &mut tile),
        Elastic::Curvature => walk::<_, Curvature<_>, 3, 9>(simd, s, &mut tile),
        Elastic::Rod => walk::<_, Rod<_>, 4, 11>(simd, s, &mut tile),
        Elastic::Springs => walk::<_, Springs, 3, 12>(simd, s, &mut tile),
    })
}

#[inline(always)]
fn walk<S, M, const B: usize, const N: usize>(simd: S, s: &reference::Strand, tile: &mut Tile) -> Forces
where
    S: Simd,
    M: Model<S, B, N>,
{
    let root = Root::between(simd, tile.strand, 1.0, &(Mat3::IDENTITY, Vec3::ZERO));
    let step = Step {
        number: 0,
        left: 0.0,
        h: s.h as f32,
        gravity: Vec3::ZERO,
        wind: Vec3::ZERO,
        moved: root.position,
        root,
        second_order: false,
        obstacles: &[],
    };
    let mut memory = Memory::default();
    let mut scratch = memory.scratch(s.x.len());
    fix(simd, step.h, Stretching::Moderate, tile, &mut scratch);
    scratch.begin(tile.state);
    let mut elements = Elements::<S, M, B, N>::begin(simd, Sweep::Forces, &step, tile, &mut scratch);
    let mut forces = Forces::default();
    for i in 0..s.x.len() {
        if i + 1 < s.x.len() {
            elements.add_forces(simd, i, tile, &scratch);
        } else {
            elements.band = Band::new(simd);
        }
        elements.band.take_up(simd, M::PROFILE, i, scratch.factors);
        forces.0.push(lane(elements.band.force()));
        forces.1.push(if B > 3 { elements.band.right(3)[3] as f64 } else { 0.0 });
        elements.band.pass(simd, M::PROFILE, i, scratch.factors);
    }
    forces
}

proptest! {
    /// Stretch: the gradient of T (ℓ − L) + ½ k (ℓ − L)², and a matrix that is never negative.
    #[test]
    fn the_stretch_force_is_the_gradient_of_its_energy(
        e in vector(1.0), rest in 0.5..1.5, k in 1.0..100.0, tension in -1.0..10.0,
    ) {
        prop_assume!(e.length() > 0.3);
        let ((ours, block), u) = dispatch!(Level::new(), simd => {
            let f = |v: f64| F::splat(simd, v as f32);
            let (l, u) = splat(simd, e).length_and_unit();
            let (force, block) = stretch((l, u), l - f(rest), f(k), f(tension), f(0.0));
            let m = [block.xx, block.xy, block.xz, block.yy, block.yz, block.zz].map(|v| v[3] as f64);
            ((lane(force), m), lane(u))
        });
        // Of the nearer point, whose move shortens the segment.
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

    /// A strand of the right length, else far from its rest shape: forces add up to nothing, and so do moments where frames are unknowns or there are none. (The
    /// curvature model's frame takes up what is about its segments: its moments are not checked.)
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
        // Four points in a line have no height; the truss keeps its particles out of line.
        let volume = |w: &[DVec3]| (w[1] - w[0]).dot((w[2] - w[0]).cross(w[3] - w[0])).abs();
        prop_assume!(x.windows(4).all(|w| volume(w) > 0.02 * 0.008f64.powi(3)));
        let strand = reference::Strand {
            v: vec![DVec3::ZERO; n],
            mass: vec![4e-8; n],
            bend: (0..n).map(|i| if i == 0 || i + 1 == n { 0.0 } else { 4e-6 }).collect(),
            turn: turns[..n].to_vec(),
            tension: vec![tension; n],
            drag: 0.0, damping: 0.0, wind: DVec3::ZERO, moved: DVec3::ZERO, gravity: DVec3::ZERO,
            h: 1.0 / 240.0,
            length: (0..n).map(|i| if i + 1 < n { 0.008 } else { 0.0 }).collect(),
            x: x.clone(),
        };
        for model in [Elastic::Straight, Elastic::Curvature, Elastic::Rod, Elastic::Springs] {
            let (forces, moments) = internal(&strand, model);
            let size: f64 = forces.iter().map(|f| f.length()).sum();
            prop_assert!(size > 1e-8, "{model:?}: no force to speak of");
            let sum: DVec3 = forces.iter().sum();
            prop_assert!(sum.length() < 1e-5 * size, "{model:?}: pushes itself by {sum} of {size}");
            if matches!(model, Elastic::Straight | Elastic::Curvature) {
                continue;
            }
            // A rigid turn by ω swings each segment, and turns it about itself by ω·u.
            let mut torque: DVec3 = x.iter().zip(&forces).map(|(x, f)| x.cross(*f)).sum();
            for (w, moment) in x.windows(2).zip(&moments) {
                torque += (w[1] - w[0]).normalize() * *moment;
            }
            let reach = x.iter().map(|x| x.length()).fold(0.0, f64::max);
            prop_assert!(torque.length() < 1e-4 * size * reach, "{model:?}: turns itself by {torque} of {}", size * reach);
        }
    }
}
