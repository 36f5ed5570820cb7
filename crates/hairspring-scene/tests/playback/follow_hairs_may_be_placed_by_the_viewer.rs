//! Promise: a viewer may interpolate follow hairs itself, on a graphics card. The stage then does not
//! interpolate them in every step. Queries to the stage still return the same results: the strand that a
//! ray finds, the figures of a strand, and values to color by. The stage interpolates the points on
//! request, with the same bits.

use glam::Vec3;
use hairspring::settings::Effects;
use hairspring_scene::{
    Guides,
    builtin::{BuiltinOptions, scene},
    stage::{Stage, Value},
};
use hairspring_test::FRAME;

fn stage() -> Stage {
    let options =
        BuiltinOptions { strands: 600, points: 16, guides: Guides::Count(60), ..BuiltinOptions::default() };
    let mut scene = scene(&options);
    for groom in &mut scene.grooms {
        groom.effects = Effects { clump: 0.5, curl_radius: 0.003, noise: 0.004, ..Effects::default() };
    }
    Stage::new(scene).unwrap()
}

fn points(stage: &Stage) -> Vec<Vec<Vec3>> {
    stage.strands().map(|s| s.points.to_vec()).collect()
}

#[test]
fn skipped_follow_hairs_are_interpolated_on_request() {
    let (mut here, mut left) = (stage(), stage());
    left.set_external_interpolation(true);
    let before = points(&left);
    for _ in 0..20 {
        here.step(FRAME);
        left.step(FRAME);
    }
    let head = |stage: &Stage| stage.strands().next().unwrap().follow.is_some();
    assert!(left.strands().len() > 1 && head(&left) && here.strands().all(|s| s.follow.is_none()));
    // Follow hairs are not interpolated; the brows, which are not follow hairs, are updated.
    assert_eq!(points(&left)[0], before[0]);
    assert_eq!(points(&left)[1], points(&here)[1]);
    assert_ne!(points(&here)[0], before[0]);

    let target = points(&here)[0][300 * 16 + 8];
    for from in [Vec3::new(0.0, 1.6, 1.0), Vec3::new(1.0, 1.7, 0.2), Vec3::new(-0.3, 2.5, -0.8)] {
        let found = here.nearest_strand(from, target - from).unwrap();
        assert_eq!(left.nearest_strand(from, target - from), Some(found));
        let (groom, strand) = (found.groom, found.strand);
        assert_eq!(left.strand_figures(groom, strand), here.strand_figures(groom, strand));
    }
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for value in Value::ALL {
        here.values(value, 0, &mut a);
        left.values(value, 0, &mut b);
        assert_eq!(a, b, "{value:?} differs");
    }

    left.place_follow_hairs();
    assert_eq!(points(&left), points(&here));
    left.step(FRAME);
    here.step(FRAME);
    left.set_external_interpolation(false);
    assert_eq!(points(&left), points(&here));
    assert!(left.strands().all(|s| s.follow.is_none()));
}
