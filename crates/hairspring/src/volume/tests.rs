//! Tests of the grid methods on a synthetic bundle of strands: they do not disturb hair at rest or in common
//! motion, conserve momentum, push compressed hair apart, and leave no divergence in full cells.

use super::{AtRest, Now, Volume, conjugate::TOLERANCE, field::Field, incompressible::Projection};
use crate::settings;
use crate::{
    math::RigidTransform,
    settings::VolumeMethod,
    simd::lanes::{LANES, Row},
    strand::tile::{RootRows, StateRows, root, state},
};
use glam::{Quat, Vec3};

/// Number of points in a strand.
const POINTS: usize = 16;
/// Number of strands along a side of the bundle.
const SIDE: usize = 24;
/// Distance of adjacent strands, and of adjacent points [m].
const APART: f32 = 0.005;
/// Duration of an interval [s].
const DT: f32 = 1.0 / 60.0;

const METHODS: [VolumeMethod; 2] = [VolumeMethod::Density, VolumeMethod::Incompressible];

/// A square bundle of strands with different masses.
struct Bundle {
    roots: Vec<RootRows>,
    state: Vec<StateRows>,
    mass: Vec<Row>,
}

impl Bundle {
    /// Creates the bundle at rest.
    fn new() -> Self {
        let tiles = SIDE * SIDE / LANES;
        let mut bundle = Self {
            roots: vec![[Row::default(); root::ROWS]; tiles],
            state: vec![[Row::default(); state::ROWS]; tiles * POINTS],
            mass: vec![Row::default(); tiles * POINTS],
        };
        bundle.set(|p| (p, Vec3::ZERO), &RigidTransform::default());
        for s in 0..SIDE * SIDE {
            for i in 0..POINTS {
                bundle.mass[s / LANES * POINTS + i].0[s % LANES] = 1e-9 * (1 + s % 3) as f32;
            }
        }
        bundle
    }

    /// Returns the rest position of point `i` of strand `s`, relative to the center of the bundle.
    fn rest(s: usize, i: usize) -> Vec3 {
        // Jittered by less than the spacing, so that no plane of points coincides with cells.
        let chance =
            |k: usize| (((s * 7 + i * 3 + k) * 2_654_435_761 % 1_000) as f32 / 1_000.0 - 0.5) * APART;
        let p = Vec3::new((s % SIDE) as f32, i as f32, (s / SIDE) as f32) * APART
            + Vec3::from_array([0, 1, 2].map(chance));
        p - Vec3::new(SIDE as f32, POINTS as f32, SIDE as f32) * (0.5 * APART)
    }

    /// Sets the position and velocity of every point to `of` its rest position, in the space of `anchor`.
    fn set(&mut self, of: impl Fn(Vec3) -> (Vec3, Vec3), anchor: &RigidTransform) {
        for s in 0..SIDE * SIDE {
            let (tile, lane) = (s / LANES, s % LANES);
            let root = of(Self::rest(s, 0)).0;
            for k in 0..3 {
                self.roots[tile][root::END + k].0[lane] = root[k];
            }
            for i in 0..POINTS {
                let (x, v) = of(Self::rest(s, i));
                let before = of(Self::rest(s, i.saturating_sub(1))).0;
                let (edge, v) = (anchor.rotation * (x - before), anchor.rotation * v);
                let rows = &mut self.state[tile * POINTS + i];
                for k in 0..3 {
                    rows[state::EDGE + k].0[lane] = edge[k];
                    rows[state::V + k].0[lane] = v[k];
                }
            }
        }
    }

    /// Creates its volume, with the current state as the rest state.
    fn volume(&self, method: VolumeMethod) -> Volume {
        let at = AtRest {
            firsts: (0..=self.roots.len() as u32).map(|t| t * POINTS as u32).collect(),
            mass: self.mass.clone(),
            roots: &self.roots,
            state: &self.state,
            anchor: RigidTransform::default(),
            segment: APART,
            length: APART * POINTS as f32,
        };
        Volume::new(&settings::Volume { method, ..settings::Volume::default() }, false, at).unwrap()
    }

    /// Returns the resulting accelerations of all points.
    fn compute_accelerations(&self, volume: &mut Volume, anchor: &RigidTransform) -> Vec<Vec3> {
        let mut push = vec![[Row::default(); 3]; self.state.len()];
        let now = Now { anchor: *anchor, gone: 1.0 };
        volume.begin_frame();
        volume.measure((&self.roots, &self.state), &now);
        volume.compute_accelerations(DT, (&self.roots, &self.state), &now, (&[], DT), &mut push);
        push.iter().flat_map(|p| (0..LANES).map(|l| Vec3::new(p[0].0[l], p[1].0[l], p[2].0[l]))).collect()
    }

    fn masses(&self) -> impl Iterator<Item = f32> + '_ {
        self.mass.iter().flat_map(|m| m.0)
    }
}

#[test]
fn a_rest_is_left_alone_in_every_pose_of_the_head() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        let push = bundle.compute_accelerations(&mut volume, &RigidTransform::default());
        assert!(push.iter().all(|a| *a == Vec3::ZERO), "{method:?}: hair at rest is pushed");
        for k in 1..20 {
            let rotation = Quat::from_euler(glam::EulerRot::XYZ, 0.3 * k as f32, 0.7, -0.2 * k as f32);
            let anchor = RigidTransform { rotation, translation: Vec3::new(1.0, 2.0, 30.0) };
            bundle.set(|p| (p, Vec3::ZERO), &anchor);
            let push = bundle.compute_accelerations(&mut volume, &anchor);
            let most = push.iter().map(|a| a.length()).fold(0.0, f32::max);
            // Where rounding moves a point to the next cell, that is overfull by a few hundredths: a tenth of
            // gravity.
            assert!(most < 1.0, "{method:?}, pose {k}: {most} m/s²");
        }
    }
}

#[test]
fn common_motion_is_not_braked() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        bundle.set(|p| (p, Vec3::new(3.0, -1.0, 2.0)), &RigidTransform::default());
        let most = bundle
            .compute_accelerations(&mut volume, &RigidTransform::default())
            .iter()
            .map(|a| a.length())
            .fold(0.0, f32::max);
        // Stopping all motion in one frame would take 220 m/s².
        assert!(most < 0.05, "{method:?}: {most} m/s²");
    }
}

#[test]
fn strands_that_cross_stop_each_other_and_slide_along_each_other() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        // Half of the points move one way and half the other, regardless of position. Returns the fraction of
        // their velocity that is removed in an interval [1].
        let mut taken = |direction: Vec3| {
            let side = |p: Vec3| if (1e5 * (p.x + p.z)) as i32 & 1 == 0 { 1.0 } else { -1.0 };
            bundle.set(|p| (p, direction * side(p)), &RigidTransform::default());
            let push = bundle.compute_accelerations(&mut volume, &RigidTransform::default());
            let velocity = |k: usize| {
                let rows = &bundle.state[k / LANES];
                Vec3::from([0, 1, 2].map(|c| rows[state::V + c].0[k % LANES]))
            };
            let sum: f32 = push.iter().enumerate().map(|(k, a)| a.dot(velocity(k))).sum();
            -DT * sum / push.len() as f32 / direction.length_squared()
        };
        // With λ of 5 mm, the spacing of the strands, u dt / (λ + u dt) is 3/4 at 1 m/s and 1/4 at 0.1 m/s.
        let (fast, slow, along) = (taken(Vec3::X), taken(0.1 * Vec3::Z), taken(Vec3::Y));
        println!("{method:?}: {fast} at 1 m/s, {slow} at 0.1 m/s, {along} along");
        assert!((0.5..0.85).contains(&fast), "{method:?}: {fast} at 1 m/s");
        assert!((0.12..0.4).contains(&slow), "{method:?}: {slow} at 0.1 m/s");
        assert!(along < 0.5 * fast, "{method:?}: {along} along the strands");
    }
}

#[test]
fn pressure_and_friction_keep_momentum() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        let swirl = |p: Vec3| Vec3::new((90.0 * p.z).sin(), (150.0 * p.x).cos(), -20.0 * p.x) + Vec3::Y;
        bundle.set(|p| (p * Vec3::new(0.7, 1.0, 0.8), swirl(p)), &RigidTransform::default());
        let push = bundle.compute_accelerations(&mut volume, &RigidTransform::default());
        let (mut sum, mut size) = (Vec3::ZERO, 0.0);
        for (m, a) in bundle.masses().zip(&push) {
            (sum, size) = (sum + m * *a, size + m * a.length());
        }
        assert!(size > 0.0);
        println!("{method:?}: {} of what acts", sum.length() / size);
        assert!(sum.length() < 2e-4 * size, "{method:?}: {sum} N of {size} N");
    }
}

#[test]
fn squeezed_hair_is_pushed_apart() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        bundle.set(|p| (p * Vec3::new(0.6, 1.0, 1.0), Vec3::ZERO), &RigidTransform::default());
        let push = bundle.compute_accelerations(&mut volume, &RigidTransform::default());
        let share = volume.report().volume_ratio;
        assert!((0.55..0.75).contains(&share), "{method:?}: {share} of the volume at 0.6 of the width");
        for (side, outward) in [(0..SIDE / 4, -1.0), (3 * SIDE / 4..SIDE, 1.0)] {
            let of = |k: usize| side.contains(&((k / (POINTS * LANES) * LANES + k % LANES) % SIDE));
            let all: Vec<f32> = (0..push.len()).filter(|k| of(*k)).map(|k| push[k].x * outward).collect();
            let mean = all.iter().sum::<f32>() / all.len() as f32;
            assert!(mean > 0.5, "{method:?}: {mean} m/s² outward");
        }
    }
}

#[test]
fn no_divergence_is_left_where_hair_is_full() {
    let mut bundle = Bundle::new();
    let mut volume = bundle.volume(VolumeMethod::Incompressible);
    // The bundle collapses, and is heavier on one side than on the other.
    bundle.set(|p| (p, Vec3::new(-4.0, 1.0, -2.0) * p), &RigidTransform::default());
    bundle.compute_accelerations(&mut volume, &RigidTransform::default());
    let field: &Field = &volume.field;
    let mut projection = Projection::default();
    let found = projection.project(field, |_, v| (Vec3::new(v[0], v[1], v[2]), false), |_| 0.0);
    assert!(found.cells > 500 && found.left < TOLERANCE, "{found:?}");
    // Independent check: the net outflow of each full cell.
    let corners = field.bounds.corners();
    let out = |cell: usize, projected: bool| -> f64 {
        let flow = |(k, corner): (usize, &usize)| {
            let n = cell + corner;
            let [x, y, z, _] = field.nodes[n];
            let v = Vec3::new(x, y, z) + if projected { projection.change(n) } else { Vec3::ZERO };
            let sign = |bit: usize| if k & bit == 0 { -1.0 } else { 1.0 };
            f64::from(v.dot(Vec3::new(sign(1), sign(2), sign(4))))
        };
        corners.iter().enumerate().map(flow).sum()
    };
    let full = (0..field.bounds.nodes()).filter(|c| field.fill[*c] > 0.95);
    let (mut before, mut after) = (0.0, 0.0);
    for cell in full {
        (before, after) = (before + out(cell, false).powi(2), after + out(cell, true).powi(2));
    }
    let left = (after / before).sqrt();
    println!("{found:?}, by hand {left}");
    assert!(left < 0.1, "{left} of the divergence is left");
}

#[test]
fn threads_do_not_show() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        bundle.set(|p| (p * 0.8, Vec3::new(p.z, -p.x, p.y) * 20.0), &RigidTransform::default());
        let mut run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bundle.compute_accelerations(&mut volume, &RigidTransform::default()))
        };
        let one = run(1);
        assert!(one == run(2), "{method:?}: two threads give other bits than one");
        assert!(one == run(7), "{method:?}: seven threads give other bits than one");
    }
}

#[test]
fn non_finite_points_do_not_count() {
    for method in METHODS {
        let mut bundle = Bundle::new();
        let mut volume = bundle.volume(method);
        bundle.set(|p| (p * 0.8, p * -3.0), &RigidTransform::default());
        for (point, row, x) in [
            (3, state::EDGE, f32::NAN),
            (40, state::V + 1, f32::INFINITY),
            (90, state::EDGE + 2, f32::INFINITY),
        ] {
            bundle.state[point][row].0[5] = x;
        }
        bundle.roots[7][root::END].0[2] = f32::NAN;
        let push = bundle.compute_accelerations(&mut volume, &RigidTransform::default());
        assert!(push.iter().all(|a| a.is_finite()), "{method:?}");
        assert!(push.iter().any(|a| a.length() > 0.1), "{method:?}: the others are pushed");
        for k in [3 * LANES + 5, 40 * LANES + 5, 90 * LANES + 5, 7 * POINTS * LANES + 2] {
            assert_eq!(push[k], Vec3::ZERO, "{method:?}");
        }
    }
}

#[test]
fn points_stretched_beyond_their_reach_do_not_count() {
    for method in METHODS {
        for stretch in [1.5, 2.0, 3.0, 10.0, 1e4] {
            let mut bundle = Bundle::new();
            let mut volume = bundle.volume(method);
            bundle.set(|p| (p * stretch, p * -3.0), &RigidTransform::default());
            let push = bundle.compute_accelerations(&mut volume, &RigidTransform::default());
            assert!(push.iter().all(|a| a.is_finite()), "{method:?}, stretched by {stretch}");
        }
    }
}

#[test]
fn two_bundles_apart_on_a_diagonal_take_a_bounded_grid_and_rest_as_one_does() {
    for method in METHODS {
        let alone = Bundle::new().volume(method);
        let mut bundle = Bundle::new();
        // The second half of the strands is three meters away along each axis.
        let tiles = bundle.roots.len();
        for rows in &mut bundle.roots[tiles / 2..] {
            rows[root::END..root::END + 3]
                .iter_mut()
                .for_each(|row| row.0.iter_mut().for_each(|x| *x += 3.0));
        }
        let volume = bundle.volume(method);
        assert!(volume.report().cell > volume.report().requested_cell);
        let most = super::MAX_NODES as usize;
        let nodes = volume.sums.iter().map(|sums| sums.rest_volumes.capacity()).max().unwrap();
        assert!(nodes <= most, "{method:?}: {nodes} nodes");
        // The volume of the hair does not depend on the cells of the grid, except where the two halves were in contact.
        let filled = |volume: &Volume| -> f32 {
            let all = volume.own.iter().flat_map(|own| own[super::own::REST_VOLUME].0);
            all.sum::<f32>() / super::splat::REST_VOLUME_UNITS * volume.cell.powi(3)
        };
        let ratio = filled(&volume) / filled(&alone);
        assert!((0.95..1.15).contains(&ratio), "{method:?}: {ratio} of the volume of one bundle");
    }
}
