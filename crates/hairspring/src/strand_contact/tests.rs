//! Tests of strand contact on free hair: impulses conserve momentum, and the broad phase finds every pair
//! once.

use super::{Neighbours, closest::closest, grid::Grid, hair::Hair, propagation::Propagation};
use crate::settings;
use glam::{DVec3, Vec3};

/// A heap of strands with free points of 60 µg or more.
fn heap(strands: usize, points: usize) -> Hair {
    let mut hair = Hair::default();
    (0..strands).for_each(|_| hair.add_strand(points));
    let mut seed = 1_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    let mut vector = || Vec3::new(random(), random(), random());
    for range in hair.strands().collect::<Vec<_>>() {
        let mut x = vector() * 0.03;
        for i in range.clone() {
            x += vector().normalize_or(Vec3::Y) * 0.006;
            hair.x[i] = x;
            hair.v[i] = vector();
            hair.inverse_mass[i] = 1.0 / (6e-8 * (1.5 + vector().x));
            hair.radius[i] = if i + 1 < range.end { 0.001 } else { 0.0 };
            hair.inverse_length[i] = 1.0 / 0.006;
            hair.bend[i] = if i > range.start && i + 1 < range.end { 1e-6 } else { 0.0 };
        }
    }
    hair
}

#[test]
fn momentum_is_kept() {
    let hair = heap(30, 16);
    let momentum = |hair: &Hair| -> DVec3 {
        hair.v.iter().zip(&hair.inverse_mass).map(|(v, w)| v.as_dvec3() / f64::from(*w)).sum()
    };
    let all: f64 = hair.v.iter().zip(&hair.inverse_mass).map(|(v, w)| f64::from(v.length() / w)).sum();
    let before = (momentum(&hair), hair.v.clone());
    let segments = hair.segments().count();
    let mut neighbours = Neighbours {
        settings: settings::Neighbours { on: true, stiction: 1e-6, ..Default::default() },
        radius: 0.001,
        crowded: 0,
        grid: Grid::new(segments),
        propagation: Propagation::new(&hair),
        hair,
        contacts: Vec::with_capacity(16 * segments),
        before: Vec::with_capacity(16 * segments),
        responses: Vec::with_capacity(16 * segments),
    };
    for substep in 0..5 {
        neighbours.solve_contacts(1.0 / 240.0);
        let report = neighbours.report();
        let error = momentum(&neighbours.hair).distance(before.0) / all;
        println!("{substep}: {error} of all, {report:?}");
        assert!(report.touching_pairs > 50, "{report:?}");
        assert!(error < 1e-6, "momentum changed by {error} of the total");
    }
    let changed = neighbours.hair.v.iter().zip(&before.1).filter(|(a, b)| a.distance(**b) > 0.01).count();
    assert!(changed > 100, "{changed} points got an impulse");
    // Carried loads act on both sides with opposite signs as well.
    neighbours.apply_warm_start(1.0 / 240.0);
    let error = momentum(&neighbours.hair).length() / all;
    assert!(error < 1e-6, "loads changed momentum by {error} of the total");
}

#[test]
fn no_pair_is_missed_and_none_shown_twice() {
    let mut hair = heap(40, 12);
    hair.v.fill(Vec3::ZERO);
    let mut grid = Grid::new(hair.segments().count());
    grid.sort(&hair, 1.0 / 240.0);
    let mut found = Vec::new();
    grid.pairs(&hair, |pair| found.push(pair));
    assert!(found.windows(2).all(|w| w[0] < w[1]), "pairs come in order, once");
    let segments: Vec<u32> = hair.segments().collect();
    let mut near = 0;
    for (k, a) in segments.iter().enumerate() {
        for b in &segments[k + 1..] {
            let ([a0, a1], [b0, b1]) = (hair.ends(*a), hair.ends(*b));
            let (s, t) = closest([a0, a1], [b0, b1]);
            let apart = a0.lerp(a1, s).distance(b0.lerp(b1, t));
            if hair.of[*a as usize] != hair.of[*b as usize] && apart < 0.002 {
                near += 1;
                assert!(found.binary_search(&[*a, *b]).is_ok(), "{a} and {b} are {apart} m apart");
            }
        }
    }
    assert!(near > 100, "{near} pairs are near");
}
