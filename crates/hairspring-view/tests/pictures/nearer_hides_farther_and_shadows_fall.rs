//! Promise: nearer objects hide farther ones, and objects between a lamp and others cast shadows on them.

use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_scene::{Camera, HairLook};
use hairspring_view::{Frame, HairDraw, Image, Light, Lighting, MeshDraw, Renderer};

const SIDE: u32 = 128;

fn camera() -> Camera {
    Camera { position: Vec3::Z, target: Vec3::ZERO, fov: 12.0, ..Camera::default() }
}

/// A curtain of `n` upright strands over 10 cm at depth `z`, shifted sideways by `x`.
fn curtain(n: usize, x: f32, z: f32) -> Groom {
    let at = |s: usize| x + 0.1 * ((s as f32 + 0.5) / n as f32 - 0.5);
    Groom::from_strands(
        (0..n).map(|s| (0..12).map(|k| Vec3::new(at(s), 0.05 - 0.009 * k as f32, z)).collect::<Vec<_>>()),
        60e-6,
    )
}

fn draw(hair: &[HairDraw], bodies: &[MeshDraw]) -> Image {
    let mut renderer = Renderer::new(SIDE, SIDE);
    renderer.draw(&Frame { camera: camera(), ..crate::support::frame(hair, bodies) }).clone()
}

fn flat(color: [f32; 3]) -> HairLook {
    HairLook {
        root_color: Vec3::from(color),
        tip_color: Vec3::from(color),
        variation: 0.0,
        ..HairLook::default()
    }
}

fn middle(image: &Image) -> [f32; 3] {
    let mut sum = [0.0; 3];
    for y in SIDE / 2 - 8..SIDE / 2 + 8 {
        for x in SIDE / 2 - 8..SIDE / 2 + 8 {
            let p = image.pixel(x, y);
            (0..3).for_each(|i| sum[i] += p[i] as f32 / 256.0);
        }
    }
    sum
}

#[test]
fn nearer_hair_hides_farther_hair_in_any_order_of_the_input() {
    let (front, back) = (curtain(4000, 0.0, 0.02), curtain(4000, 0.0, -0.02));
    let (red, blue) = (flat([0.7, 0.05, 0.05]), flat([0.05, 0.05, 0.7]));
    let (front, back) = (crate::support::hair(&front, &red), crate::support::hair(&back, &blue));
    let alone = middle(&draw(&[front], &[]));
    for hair in [[front, back], [back, front]] {
        let both = middle(&draw(&hair, &[]));
        assert!(both[0] > 3.0 * both[2], "the red curtain is not in front: {both:?}");
        assert!(
            (both[0] - alone[0]).abs() < 0.25 * alone[0],
            "the back curtain shines through: {both:?}, alone {alone:?}"
        );
    }
}

#[test]
fn a_body_hides_only_hair_behind_it() {
    let ball = crate::support::ball();
    let body = [crate::support::body(&ball)];
    let bare = draw(&[], &body);
    let look = flat([0.05, 0.6, 0.05]);
    let behind = curtain(3000, 0.0, -0.2);
    assert_eq!(middle(&draw(&[crate::support::hair(&behind, &look)], &body)), middle(&bare));
    let before = curtain(3000, 0.0, 0.15);
    let seen = middle(&draw(&[crate::support::hair(&before, &look)], &body));
    assert!(seen[1] > 1.5 * seen[0], "green hair in front of the ball is hidden: {seen:?}");
}

#[test]
fn strands_on_the_skin_are_visible() {
    // Strands that lie exactly on the front of the ball must not flicker with its triangles: every pixel
    // that they cover changes.
    let ball = crate::support::ball();
    let on_skin = |a: f32, b: f32| {
        Vec3::new(b.sin() * a.cos() * 0.93, a.sin(), a.cos() * b.cos() * 0.98) * crate::support::RADIUS
    };
    let groom = Groom::from_strands(
        (0..40).map(|s| {
            (0..24).map(|k| on_skin(0.04 * k as f32 - 0.5, 0.02 * s as f32 - 0.4)).collect::<Vec<_>>()
        }),
        1e-3,
    );
    let look = flat([0.05, 0.6, 0.05]);
    let bare = draw(&[], &[crate::support::body(&ball)]);
    let hair = draw(&[crate::support::hair(&groom, &look)], &[crate::support::body(&ball)]);
    let changed = (SIDE / 2 - 20..SIDE / 2 + 20)
        .filter(|x| bare.pixel(*x, SIDE / 2) != hair.pixel(*x, SIDE / 2))
        .count();
    assert_eq!(changed, 40);
}

#[test]
fn more_hair_toward_the_lamp_is_darker() {
    let look = flat([0.4, 0.3, 0.2]);
    let lit = curtain(4000, 0.0, 0.0);
    let mut last = f32::MAX;
    let mut first = 0.0;
    for n in [0, 300, 1000, 3000, 9000, 30_000] {
        // The second curtain is between the first one and the key light, outside the picture.
        let key = hairspring_view::Lighting::default().key.direction.normalize();
        let mut shade = curtain(n, 0.0, 0.0);
        shade.points.iter_mut().for_each(|p| *p = *p * 1.2 + key * 0.17);
        let hair = [crate::support::hair(&lit, &look), crate::support::hair(&shade, &look)];
        let light: f32 = middle(&draw(&hair[..if n > 0 { 2 } else { 1 }], &[])).iter().sum();
        assert!(light < last + 1.0, "with {n} strands in between {light}, with fewer {last}");
        if n == 0 {
            first = light;
        }
        last = light;
    }
    assert!(last < 0.8 * first, "a dense curtain leaves {last} of {first}");
}

#[test]
fn bodies_and_hair_shade_each_other() {
    let look = flat([0.4, 0.3, 0.2]);
    let key = hairspring_view::Lighting::default().key.direction.normalize();
    let mut ball = crate::support::ball();
    ball.positions.iter_mut().for_each(|p| *p = *p * 0.7 + key * 0.4);
    let hair = curtain(4000, 0.0, 0.0);
    let sum = |image: &Image| middle(image).iter().sum::<f32>();
    let open = sum(&draw(&[crate::support::hair(&hair, &look)], &[]));
    let shaded = sum(&draw(&[crate::support::hair(&hair, &look)], &[crate::support::body(&ball)]));
    assert!(shaded < 0.8 * open, "{shaded} of {open}");

    let skin = crate::support::ball();
    let mut shade = curtain(20_000, 0.0, 0.0);
    shade.points.iter_mut().for_each(|p| *p = *p * 1.4 + Vec3::Z * crate::support::RADIUS + key * 0.2);
    let open = sum(&draw(&[], &[crate::support::body(&skin)]));
    let shaded = sum(&draw(&[crate::support::hair(&shade, &look)], &[crate::support::body(&skin)]));
    assert!(shaded < 0.8 * open, "{shaded} of {open}");
}

#[test]
fn sky_shadow_on_skin_ends_softly() {
    // A wall of skin passes through dense hair and extends below it, out of the volume that holds the
    // shadow of the hair. Lit by the sky alone, it brightens from row to row. There must be no visible line
    // where the wall leaves the volume.
    let look = flat([0.1, 0.08, 0.06]);
    let curtains: Vec<Groom> = (0..9).map(|k| curtain(1500, 0.0, 0.02 - 0.01 * k as f32)).collect();
    let hair: Vec<HairDraw> = curtains.iter().map(|c| crate::support::hair(c, &look)).collect();
    let (half, z) = (0.3, -0.02);
    let positions =
        [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| Vec3::new(x, y, z));
    let triangles = [[0, 1, 2], [0, 2, 3]];
    let wall = [MeshDraw { positions: &positions, normals: &[], triangles: &triangles, parts: &[] }];
    let dark = |light: Light| Light { color: Vec3::ZERO, ..light };
    let lamps = Lighting::default();
    let lighting = Lighting { key: dark(lamps.key), fill: dark(lamps.fill), rim: dark(lamps.rim), ..lamps };
    let mut renderer = Renderer::new(SIDE, SIDE);
    let image =
        renderer.draw(&Frame { camera: camera(), lighting, ..crate::support::frame(&hair, &wall) }).clone();
    let row = |y: u32| {
        let columns = SIDE / 2 - 16..SIDE / 2 + 16;
        columns.map(|x| f32::from(image.pixel(x, y)[0])).sum::<f32>() / 32.0
    };
    // The hair ends three quarters down, and the volume two rows below it.
    let rows: Vec<f32> = (SIDE * 3 / 4..SIDE).map(row).collect();
    let change = rows[rows.len() - 1] - rows[0];
    assert!(change > 20.0, "the skin does not brighten below the hair: {rows:?}");
    for pair in rows.windows(2) {
        assert!(pair[1] - pair[0] < 0.2 * change, "there is a line across the skin: {rows:?}");
    }
}

#[test]
fn the_shadow_of_a_farther_edge_is_softer() {
    // The lamp shines at 45° from the left. A screen parallel to a wall ends where its shadow ends in the middle.
    let rectangle = |x: [f32; 2], z: f32| {
        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| Vec3::new(x[i], [-0.2, 0.2][j], z))
    };
    let width = |distance: f32| {
        let wall = rectangle([-0.2, 0.2], 0.0);
        let screen = rectangle([-0.4, -distance], distance);
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let bodies = [&wall, &screen].map(|positions| MeshDraw {
            positions,
            normals: &[],
            triangles: &triangles,
            parts: &[],
        });
        let dark = |light: Light| Light { color: Vec3::ZERO, ..light };
        let lamps = Lighting::default();
        let key = Light { direction: Vec3::new(-1.0, 0.0, 1.0), ..lamps.key };
        let lighting = Lighting { key, fill: dark(lamps.fill), rim: dark(lamps.rim), ..lamps };
        let mut renderer = Renderer::new(512, 64);
        let camera = Camera { fov: 0.7, ..camera() };
        let image = renderer.draw(&Frame { camera, lighting, ..crate::support::frame(&[], &bodies) }).clone();
        let row: Vec<f32> = (0..512).map(|x| f32::from(image.pixel(x, 32)[1])).collect();
        // Outside of the shadow, the wall does not shadow itself.
        let lit = row[511];
        assert!(row[400..].iter().all(|x| (x - lit).abs() <= 2.0), "{row:?}");
        let dark = row.iter().copied().fold(f32::MAX, f32::min);
        let within = |share: f32| row.iter().filter(|x| **x < dark + share * (lit - dark)).count();
        within(0.9) - within(0.1)
    };
    let [near, far] = [0.02, 0.07].map(width);
    assert!(near > 0 && far > 2 * near, "the edge is {near} pixels wide if near, and {far} if far");
}

#[test]
fn a_body_does_not_shadow_itself_at_any_resolution() {
    let ball = crate::support::ball();
    let bodies = [crate::support::body(&ball)];
    for shadow_texels in [64, 128, 384, 1024] {
        let quality = hairspring_view::Quality { shadow_texels, ..Default::default() };
        let mut renderer = Renderer::new(SIDE, SIDE);
        let frame = Frame { camera: camera(), quality, ..crate::support::frame(&[], &bodies) };
        let image = renderer.draw(&frame).clone();
        let at = |x: u32, y: u32| f32::from(image.pixel(x, y)[1]);
        for y in 32..SIDE - 32 {
            for x in 32..SIDE - 32 {
                // A speckle is darker than both of its neighbors.
                let speckle = at(x - 1, y).min(at(x + 1, y)) - at(x, y);
                assert!(speckle < 4.0, "{shadow_texels} texels: a speckle of {speckle} at {x}, {y}");
            }
        }
    }
}
