//! Promise: the ground receives the shadow of the objects on it and is otherwise invisible. Without shadow
//! it equals the backdrop, bit for bit. In the distance it fades to the backdrop, whatever its color. From
//! below it is invisible, and it hides what is under it. The graphics card renders the same ground
//! (`gpu_draws_what_the_cpu_draws.rs`).

use glam::Vec3;
use hairspring::{
    body::{Body, Mesh},
    groom::Groom,
};
use hairspring_scene::{Camera, HairLook, Scene};
use hairspring_view::{Background, Frame, Ground, Image, Lighting, MeshDraw, Renderer};

const SIZE: [u32; 2] = [160, 120];

fn draw(frame: &Frame) -> Image {
    Renderer::new(SIZE[0], SIZE[1]).draw(frame).clone()
}

/// A camera that looks at the origin from above, from the side of the lamps.
fn above() -> Camera {
    Camera { position: Vec3::new(0.0, 1.2, 1.6), target: Vec3::ZERO, fov: 40.0, ..Camera::default() }
}

fn ground_at(height: f32) -> Option<Ground> {
    Some(Ground { height, color: None })
}

/// A horizontal plate at a height, with half-width `half`.
fn plate(half: f32, height: f32) -> Mesh {
    let corner = |x: f32, z: f32| Vec3::new(half * x, height, half * z);
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A mat of hair: threads along X, side by side, so dense that no light passes.
fn mat(half: f32, height: f32) -> Groom {
    let n = 1500;
    let across = |s: usize| half * (2.0 * (s as f32 + 0.5) / n as f32 - 1.0);
    let thread = |s| (0..12).map(move |k| Vec3::new(half * (k as f32 / 5.5 - 1.0), height, across(s)));
    Groom::from_strands((0..n).map(|s| thread(s).collect::<Vec<_>>()), 2e-4)
}

/// Projects a point into the picture [pixels].
fn pixel_of(camera: &Camera, p: Vec3) -> [u32; 2] {
    let forward = (camera.target - camera.position).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let (way, focal) = (p - camera.position, 0.5 * SIZE[1] as f32 / (0.5 * camera.fov.to_radians()).tan());
    let scale = focal / way.dot(forward);
    let x = 0.5 * SIZE[0] as f32 + scale * way.dot(right);
    let y = 0.5 * SIZE[1] as f32 - scale * way.dot(right.cross(forward));
    [x as u32, y as u32]
}

/// The brightness of a point of the ground [codes], and that of the picture without the ground.
fn codes(with: &Image, without: &Image, p: Vec3) -> (i32, i32) {
    let [x, y] = pixel_of(&above(), p);
    let sum = |image: &Image| image.pixel(x, y).iter().map(|c| i32::from(*c)).sum();
    (sum(with), sum(without))
}

/// The shadow of a point from the key light on the ground at height 0.
fn cast(p: Vec3) -> Vec3 {
    let key = Lighting::default().key.direction;
    p - key * (p.y / key.y)
}

#[test]
fn the_ground_is_dark_in_shadows_only() {
    let look = HairLook::default();
    let groom = mat(0.15, 0.25);
    let body = plate(0.15, 0.25);
    for (name, hair, bodies) in [
        ("hair", vec![crate::support::hair(&groom, &look)], vec![]),
        ("body", vec![], vec![crate::support::body(&body)]),
    ] {
        let frame = Frame { camera: above(), ..crate::support::frame(&hair, &bodies) };
        let (without, with) = (draw(&frame), draw(&Frame { ground: ground_at(0.0), ..frame }));
        let (dark, wall) = codes(&with, &without, cast(Vec3::Y * 0.25));
        assert!(dark < wall * 2 / 3, "{name}: {dark} in the shadow, {wall} without ground");
        for place in [Vec3::new(0.6, 0.0, 0.5), Vec3::new(-0.8, 0.0, -0.3), Vec3::new(0.0, 0.0, 0.75)] {
            let (lit, wall) = codes(&with, &without, place);
            assert_eq!(lit, wall, "{name}: outside the shadow, at {place}");
        }
        // All changed pixels are darker, up to rounding.
        let brighter = with.rgb.iter().zip(&without.rgb).map(|(with, without)| with.saturating_sub(*without));
        assert!(brighter.max().unwrap() <= 1, "{name}: the ground brightens pixels");
    }
}

/// The map in which the shadow is blurred ends with the body. The shadow must not be cut off with a hard
/// line there.
#[test]
fn a_shadow_has_a_soft_edge_on_all_sides() {
    // The edges of the plate are parallel to those of the map.
    let key = Lighting::default().key.direction.normalize();
    let (right, up) = (key.any_orthonormal_vector(), key.cross(key.any_orthonormal_vector()));
    let corner = |x: f32, y: f32| Vec3::Y * 0.4 + 0.1 * (right * x + up * y);
    let mesh = Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let bodies = [crate::support::body(&mesh)];
    let quality = hairspring_view::Quality { shadow_texels: 64, ..Default::default() };
    let middle = cast(Vec3::Y * 0.4);
    let background = Background { center: Vec3::splat(0.3), edge: Vec3::splat(0.3) };
    let camera = Camera {
        position: middle + Vec3::new(0.0, 1.0, 0.01),
        target: middle,
        fov: 30.0,
        ..Camera::default()
    };
    let ground = ground_at(0.0);
    let image = draw(&Frame { camera, ground, quality, background, ..crate::support::frame(&[], &bodies) });
    let code = |x: u32, y: u32| i32::from(image.pixel(x, y)[1]);
    let steps = (0..SIZE[1]).flat_map(|y| (1..SIZE[0]).map(move |x| (code(x, y) - code(x - 1, y)).abs()));
    let down = (1..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (code(x, y) - code(x, y - 1)).abs()));
    let whole = i32::from(*image.rgb.iter().max().unwrap()) - i32::from(*image.rgb.iter().min().unwrap());
    let steepest = steps.chain(down).max().unwrap();
    // A texel is about as wide as a pixel, and the shadow is blurred over eight texels.
    assert!(whole > 40 && 10 * steepest < 4 * whole, "a step of {steepest} codes in a shadow of {whole}");
}

#[test]
fn distant_ground_fades_to_the_backdrop() {
    let roof = plate(0.4, 3.0);
    let bodies = [crate::support::body(&roof)];
    // The camera is low above the ground, with the horizon in the middle of the picture.
    let camera = Camera {
        position: Vec3::new(0.0, 0.3, 1.2),
        target: Vec3::new(0.0, 0.3, 0.0),
        fov: 40.0,
        ..Camera::default()
    };
    let frame = Frame { camera, ..crate::support::frame(&[], &bodies) };
    let ground = Some(Ground { height: -0.2, color: Some(Vec3::splat(0.6)) });
    let (without, with) = (draw(&frame), draw(&Frame { ground, ..frame }));
    let row =
        |image: &Image, y: u32| image.rgb[(y * SIZE[0] * 3) as usize..][..SIZE[0] as usize * 3].to_vec();
    let horizon = SIZE[1] / 2;
    for y in 0..horizon + 8 {
        assert_eq!(row(&with, y), row(&without, y), "row {y}; the horizon is row {horizon}");
    }
    // Adjacent rows differ by no more than in a soft edge.
    let mean = |y: u32| row(&with, y).iter().take(60).map(|c| f32::from(*c)).sum::<f32>() / 60.0;
    let steepest = (1..SIZE[1]).map(|y| (mean(y) - mean(y - 1)).abs()).fold(0.0, f32::max);
    assert!(mean(SIZE[1] - 1) > mean(0) + 60.0, "nearby ground does not have its color");
    assert!(steepest < 25.0, "a step of {steepest} codes from row to row");
}

#[test]
fn the_ground_is_invisible_from_below() {
    let (ball, look) = (crate::support::ball(), HairLook::default());
    let groom = crate::support::groom(crate::support::Style {
        strands: 2000,
        points: 16,
        ..crate::support::STRAIGHT
    });
    let (hair, bodies) = ([crate::support::hair(&groom, &look)], [crate::support::body(&ball)]);
    let frame = Frame {
        camera: Camera { fov: 40.0, ..crate::support::camera() },
        ..crate::support::frame(&hair, &bodies)
    };
    let without = draw(&frame);
    for ground in [0.5, f32::NAN, f32::INFINITY].map(ground_at) {
        assert!(draw(&Frame { ground, ..frame }) == without, "{ground:?} is visible");
    }
}

#[test]
fn the_ground_hides_objects_under_it() {
    let ball = crate::support::ball();
    let look = HairLook::default();
    let groom = mat(0.1, -0.05);
    let (hair, bodies) = ([crate::support::hair(&groom, &look)], [crate::support::body(&ball)]);
    // If the ground is above all objects, only the ground is visible.
    let empty = draw(&Frame { camera: above(), ..crate::support::frame(&[], &[]) });
    let frame = Frame { camera: above(), ground: ground_at(0.2), ..crate::support::frame(&hair, &bodies) };
    let buried = draw(&frame);
    assert!(buried.rgb.iter().zip(&empty.rgb).all(|(a, b)| a <= b));
    // A ball that is half under the ground is cut in a clean line; its upper half is visible.
    let half = draw(&Frame { hair: &[], ground: ground_at(0.0), ..frame });
    let whole = draw(&Frame { hair: &[], ground: None, ..frame });
    let [x, y] = pixel_of(&above(), Vec3::new(0.0, 0.08, 0.0));
    assert_eq!(half.pixel(x, y), whole.pixel(x, y));
    let red = |image: &Image| image.rgb.chunks(3).filter(|p| p[0] > p[2] + 20).count();
    assert!(red(&half) < red(&whole) * 9 / 10, "{} of {}", red(&half), red(&whole));
}

/// Ambient occlusion: near an object on it, the ground receives less light from the sky. An object higher
/// than a seventh of its own size has no effect.
#[test]
fn the_ground_is_dark_where_bodies_touch_it() {
    let dark = hairspring_view::Light { color: Vec3::ZERO, ..Lighting::default().key };
    let lighting = Lighting { key: dark, fill: dark, rim: dark, sky: Vec3::ONE, ..Lighting::default() };
    let background = Background { center: Vec3::splat(0.3), edge: Vec3::splat(0.3) };
    let brightness_beside = |height: f32| {
        let mesh = plate(0.2, height);
        let bodies = [crate::support::body(&mesh)];
        let frame = Frame {
            camera: above(),
            lighting,
            background,
            ground: ground_at(0.0),
            ..crate::support::frame(&[], &bodies)
        };
        let image = draw(&frame);
        [0.22, 0.3, 0.6].map(|z| {
            let [x, y] = pixel_of(&above(), Vec3::new(0.0, 0.0, z));
            i32::from(image.pixel(x, y)[1])
        })
    };
    let ([near, a_little_away, far], hovering) = (brightness_beside(0.001), brightness_beside(0.07));
    assert!(near < far - 5, "{near} beside a plate on the ground, {far} far from it");
    assert!((a_little_away - far).abs() <= 1, "{a_little_away} a little away, {far} far from the plate");
    assert!(
        hovering.iter().all(|code| (code - far).abs() <= 1),
        "{hovering:?} under a hovering plate, {far} far from one"
    );
}

#[test]
fn the_ground_of_a_scene_is_under_its_body() {
    let body = |height| Some(Body { mesh: plate(1.0, height), ..Body::default() });
    let scene = |ground, body| Scene { ground, body, ..Scene::default() };
    let visible = hairspring_scene::Ground { on: true, ..hairspring_scene::Ground::default() };
    assert_eq!(Ground::of(&scene(hairspring_scene::Ground::default(), body(1.0))), None);
    let height = |scene: Scene| Ground::of(&scene).unwrap().height;
    assert_eq!(height(scene(visible, body(-0.3))), -0.3);
    assert_eq!(height(scene(visible, None)), 0.0);
    assert_eq!(height(scene(hairspring_scene::Ground { height: Some(0.5), ..visible }, body(-0.3))), 0.5);
}

#[test]
fn empty_and_broken_scenes_with_a_ground_are_drawn() {
    let broken = Mesh {
        positions: vec![Vec3::NAN, Vec3::ONE, Vec3::INFINITY, Vec3::splat(1e30), Vec3::ZERO],
        triangles: vec![[0, 1, 2], [1, 3, 4], [7, 8, 9]],
        ..Mesh::default()
    };
    for color in [None, Some(Vec3::NAN), Some(Vec3::splat(-1.0))] {
        for height in [0.0, -1e30, 1e-3] {
            let ground = Some(Ground { height, color });
            let picture = |bodies: &[MeshDraw]| {
                draw(&Frame { camera: above(), ground, ..crate::support::frame(&[], bodies) })
            };
            let alone = picture(&[]);
            assert!(picture(&[crate::support::NO_BODY]) == alone, "a body without triangles is visible");
            let huge = picture(&[crate::support::body(&broken)]);
            assert_eq!((huge.width, huge.height), (SIZE[0], SIZE[1]));
        }
    }
}
