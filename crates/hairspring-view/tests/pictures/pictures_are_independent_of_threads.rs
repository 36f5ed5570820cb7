//! Promise: a picture does not depend on the number of threads or on what the renderer drew before.
//!
//! Sums in the shadow grid are integers. The data alone determines how strands and tiles are divided into
//! work items. Ties in depth are broken by order.

use hairspring_scene::HairLook;
use hairspring_test::on_threads;
use hairspring_view::{Frame, HairDraw, Image, Quality, Renderer};

#[test]
fn one_two_and_seven_threads() {
    let groom =
        crate::support::groom(crate::support::Style { strands: 6000, points: 14, ..crate::support::WAVY });
    let ball = crate::support::ball();
    let look = HairLook::default();
    let hair = [crate::support::hair(&groom, &look)];
    let bodies = [crate::support::body(&ball)];
    let draw = |threads: usize, warm: bool, wisp: u32| -> Image {
        let quality = Quality { wisp, ..Quality::default() };
        let frame = Frame { quality, ..crate::support::frame(&hair, &bodies) };
        on_threads(threads, || {
            let mut renderer = Renderer::new(321, 203);
            if warm {
                let other = crate::support::frame(&hair, &[]);
                renderer
                    .draw(&Frame { camera: hairspring_scene::Camera { fov: 11.0, ..other.camera }, ..other });
            }
            renderer.draw(&frame).clone()
        })
    };
    for wisp in [1, 4] {
        let one = draw(1, false, wisp);
        assert!(one.rgb.chunks(3).any(|p| p[0] > p[2] + 20), "no hair is visible");
        for (threads, warm) in [(2, false), (7, false), (1, true), (7, true)] {
            assert!(draw(threads, warm, wisp) == one, "{threads} threads, warm: {warm}, wisps of {wisp}");
        }
    }
}

#[test]
fn draw_on_reuses_the_shadows_of_the_previous_frame() {
    let groom =
        crate::support::groom(crate::support::Style { strands: 2000, points: 14, ..crate::support::WAVY });
    let (ball, look) = (crate::support::ball(), HairLook::default());
    let (hair, bodies) = ([crate::support::hair(&groom, &look)], [crate::support::body(&ball)]);
    let frame = crate::support::frame(&hair, &bodies);
    let dark = Frame { hair: &[HairDraw { width_scale: 40.0, ..hair[0] }], ..frame };
    let mut renderer = Renderer::new(160, 120);
    let lit = renderer.draw(&frame).clone();
    assert!(*renderer.draw_on(&frame) == lit);
    renderer.draw(&dark);
    assert!(*renderer.draw_on(&frame) != lit, "the shadows are not those of the previous frame");
    assert!(*renderer.draw(&frame) == lit);
    assert!(*Renderer::new(160, 120).draw_on(&frame) == lit, "a first frame does not use its own shadows");
}
