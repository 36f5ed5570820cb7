//! Promise: no hair of a head of curls in the springs model whips while it settles: the fastest tip stays
//! below 1 m/s.
//!
//! The springs model is a truss that can fold. If the matrix resists a fold in another way than the springs
//! do, a rotation there is not damped. All other tests once passed while a few hairs of ten thousand
//! whipped at 4 m/s. The trusses of curls are folded in many places, so the test measures the fastest hair
//! and not the mean.

use glam::Vec3;
use hairspring::material::Model;
use hairspring_scene::{
    Guides, Scene,
    builtin::{BuiltinOptions, Style, scene},
    stage::Stage,
};
use hairspring_validate::bench::FRAME;

#[test]
fn a_head_of_curls_settles_without_whipping() {
    let options = BuiltinOptions { strands: 2_000, guides: Guides::All, ..BuiltinOptions::new(Style::Curly) };
    let mut head = Scene { clip: None, ..scene(&options) };
    for material in head.grooms.iter_mut().flat_map(|groom| &mut groom.materials) {
        material.model = Model::Springs;
    }
    let mut stage = Stage::new(head).unwrap();
    let tips = |stage: &Stage| -> Vec<Vec3> {
        let tip = |end: u32, points: &[Vec3]| points[end as usize - 1];
        stage
            .strands()
            .flat_map(|s| s.groom.offsets[1..].iter().map(move |end| tip(*end, s.points)))
            .collect()
    };
    let mut before = tips(&stage);
    assert!(before.len() > 1_900, "only {} hairs", before.len());
    let (mut fastest, mut of) = (0.0f32, (0, 0));
    for frame in 1..=60 {
        stage.step(FRAME);
        let now = tips(&stage);
        for (strand, (a, b)) in before.iter().zip(&now).enumerate() {
            let speed = a.distance(*b) / FRAME;
            assert!(speed.is_finite(), "strand {strand} in frame {frame}");
            if speed > fastest {
                (fastest, of) = (speed, (strand, frame));
            }
        }
        before = now;
    }
    println!("the fastest tip: {fastest} m/s, strand {} in frame {}", of.0, of.1);
    // Measured: 0.3 m/s, and 4 m/s with the faulty matrix.
    assert!(fastest < 1.0, "the tip of strand {} moves at {fastest} m/s in frame {}", of.0, of.1);
}
