//! A picture does not depend on how many threads drew it, nor on what the renderer drew before.
//!
//! Sums in the shadow grid are integers, runs of strands and tiles are cut by the data alone, and ties in depth are broken by order.

mod support;

use hairspring::scene::HairLook;
use hairspring_view::{Image, Renderer};

#[test]
fn one_two_and_seven_threads() {
    let groom = support::groom(support::Style { strands: 6000, points: 14, ..support::WAVY });
    let ball = support::ball();
    let look = HairLook::default();
    let hair = [support::hair(&groom, &look)];
    let bodies = [support::body(&ball)];
    let frame = support::frame(&hair, &bodies);
    let draw = |threads: usize, warm: bool| -> Image {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut renderer = Renderer::new(321, 203);
            if warm {
                let other = support::frame(&hair, &[]);
                renderer.draw(&hairspring_view::Frame {
                    camera: hairspring::scene::Camera { fov: 11.0, ..other.camera },
                    ..other
                });
            }
            renderer.draw(&frame).clone()
        })
    };
    let one = draw(1, false);
    assert!(one.rgb.chunks(3).any(|p| p[0] > p[2] + 20), "there is hair to see");
    for (threads, warm) in [(2, false), (7, false), (1, true), (7, true)] {
        assert!(draw(threads, warm) == one, "{threads} threads, warm: {warm}");
    }
}
