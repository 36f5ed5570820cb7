//! Promise: the graphics card renders the same picture as the CPU, which is the reference.
//!
//! Both render each scene, and the pictures are compared: structure by similarity of luminance (Wang et al.
//! 2004), brightness by the mean of every channel. Small differences are allowed. The card stores light in
//! 16-bit floating point and blends hair back to front instead of front to back. It has four samples for
//! outlines of bodies instead of eight. The CPU lets some strands represent others in dense regions.
//! Without a card or a software driver (such as Mesa's), the tests print a note and pass.

use crate::alike::{compare, compare_everywhere, mean};
use glam::Vec3;
use hairspring::{body::Mesh, settings::Effects};
use hairspring_scene::{
    Camera, Guides, HairColor, HairLook,
    builtin::{BuiltinOptions, scene},
    stage::Stage,
};
use hairspring_view::{Frame, Ground, HairDraw, Lighting, MeshDraw, gpu::GpuRenderer};

/// Strands with their points in one array.
struct Few {
    points: Vec<Vec3>,
    offsets: Vec<u32>,
    radii: Vec<f32>,
    colors: Vec<Vec3>,
    look: HairLook,
}

impl Few {
    fn new(strands: &[Vec<Vec3>], radius: f32) -> Self {
        let points = strands.concat();
        let ends = strands.iter().scan(0, |n, s| {
            *n += s.len() as u32;
            Some(*n)
        });
        let offsets = std::iter::once(0).chain(ends).collect();
        let radii = vec![radius; points.len()];
        Self { points, offsets, radii, colors: Vec::new(), look: HairLook::from(HairColor::Blonde) }
    }

    fn draw(&self) -> HairDraw<'_> {
        HairDraw {
            points: &self.points,
            offsets: &self.offsets,
            radii: &self.radii,
            colors: &self.colors,
            look: &self.look,
            width_scale: 1.0,
            follow: None,
        }
    }
}

/// A wavy strand from `from` to `to`.
fn strand(from: Vec3, to: Vec3, wave: f32) -> Vec<Vec3> {
    (0..12)
        .map(|i| {
            let s = i as f32 / 11.0;
            from.lerp(to, s) + Vec3::new(0.0, wave * (9.0 * s).sin(), 0.5 * wave * (7.0 * s).cos())
        })
        .collect()
}

fn close(hair: &[HairDraw<'static>]) -> Frame<'static> {
    let hair: &'static [HairDraw<'static>] = Box::leak(hair.to_vec().into_boxed_slice());
    let camera =
        Camera { position: Vec3::new(0.0, 0.0, 0.5), target: Vec3::ZERO, fov: 26.0, ..Camera::default() };
    Frame { camera, ..crate::support::frame(hair, &[]) }
}

fn leak(few: Few) -> &'static Few {
    Box::leak(Box::new(few))
}

#[test]
fn strands_have_the_same_place_and_width() {
    let Some(mut gpu) = crate::support::card() else { return };
    let (a, b) = (Vec3::new(-0.09, -0.04, 0.0), Vec3::new(0.08, 0.05, 0.03));
    for (name, radius) in [("wide", 2e-3), ("pixel", 4e-4), ("thin", 6e-5)] {
        let few = leak(Few::new(&[strand(a, b, 0.02), strand(b * 0.7, -b, 0.01)], radius));
        compare(&mut gpu, name, &close(&[few.draw()]), 160, 120);
    }
}

/// The CPU's hair does not flicker when it moves by fractions of a pixel (`hair_covers_its_true_area.rs`),
/// so the card's must not either.
#[test]
fn a_moving_hair_looks_the_same() {
    let Some(mut gpu) = crate::support::card() else { return };
    for step in 0..6 {
        let moved = Vec3::new(0.000_23, 0.000_31, 0.0) * step as f32;
        let few = leak(Few::new(
            &[strand(Vec3::new(-0.09, -0.03, 0.0) + moved, Vec3::new(0.09, 0.04, 0.0) + moved, 0.01)],
            5e-5,
        ));
        compare(&mut gpu, "moved", &close(&[few.draw()]), 160, 120);
    }
}

#[test]
fn nearer_hair_hides_farther_hair() {
    let Some(mut gpu) = crate::support::card() else { return };
    let mut far = Few::new(&[strand(Vec3::new(-0.1, -0.06, -0.02), Vec3::new(0.1, 0.06, -0.02), 0.0)], 5e-3);
    far.look = HairLook::from(HairColor::Black);
    let near = Few::new(&[strand(Vec3::new(-0.1, 0.06, 0.02), Vec3::new(0.1, -0.06, 0.02), 0.0)], 5e-3);
    let (far, near) = (leak(far), leak(near));
    compare(&mut gpu, "crossing", &close(&[far.draw(), near.draw()]), 160, 120);
    compare(&mut gpu, "crossing-back", &close(&[near.draw(), far.draw()]), 160, 120);
}

#[test]
fn points_have_their_own_colors() {
    let Some(mut gpu) = crate::support::card() else { return };
    let mut few = Few::new(&[strand(Vec3::NEG_X * 0.1, Vec3::X * 0.1, 0.03)], 4e-3);
    few.colors = (0..12).map(|i| [Vec3::X, Vec3::Y, Vec3::Z][i / 4] * 0.7 + 0.05).collect();
    compare(&mut gpu, "colored", &close(&[leak(few).draw()]), 160, 120);
}

#[test]
fn hair_on_a_body_looks_the_same() {
    let Some(mut gpu) = crate::support::card() else { return };
    let ball = crate::support::ball();
    for (name, style, color) in [
        ("straight", crate::support::STRAIGHT, HairColor::Brown),
        ("wavy", crate::support::WAVY, HairColor::Blonde),
    ] {
        let groom = crate::support::groom(crate::support::Style { strands: 8000, points: 20, ..style });
        let look = HairLook::from(color);
        let hair = [HairDraw { width_scale: 4.0, ..crate::support::hair(&groom, &look) }];
        let bodies = [crate::support::body(&ball)];
        compare(&mut gpu, name, &crate::support::frame(&hair, &bodies), 200, 150);
    }
}

/// Interpolated positions on a surface must be exact at the triangles' edges: 1 mm deeper, a point is in
/// the surface's own shadow. Narrow pleats seen at a slant have many edges. They are far from the origin,
/// so that a relative error of a thousandth is several millimeters.
#[test]
fn slivers_have_no_speckles() {
    let Some(mut gpu) = crate::support::card() else { return };
    let (rows, columns, far) = (60, 9, Vec3::new(0.3, 1.5, -0.2));
    let mut mesh = Mesh::default();
    for (j, i) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
        let (v, u) = (j as f32 / rows as f32 - 0.5, i as f32 / columns as f32 - 0.5);
        // Five pleats with a slope of one half; their creases cross the rows of pixels.
        let phase = (5.0 * (v + 0.5)).fract() - 0.5;
        let place = Vec3::new(0.2 * u, 0.02 * (0.5 - phase.abs()), 0.2 * v + 0.03 * u);
        mesh.positions.push(far + place);
        mesh.normals.push(Vec3::Y);
        if j < rows && i < columns {
            let at = (j * (columns + 1) + i) as u32;
            let next = at + columns as u32 + 1;
            mesh.triangles.extend([[at, next, at + 1], [at + 1, next, next + 1]]);
        }
    }
    let bodies = [crate::support::body(&mesh)];
    for (name, y) in [("pleats-low", 0.34), ("pleats", 0.37), ("pleats-high", 0.5)] {
        let camera =
            Camera { position: far + Vec3::new(0.05, y, 0.5), target: far, fov: 26.0, ..Camera::default() };
        compare_everywhere(
            &mut gpu,
            name,
            &Frame { camera, ..crate::support::frame(&[], &bodies) },
            200,
            150,
        );
    }
}

/// The ground with the backdrop's color and with its own, cut by bodies and below them. It is compared
/// pixel by pixel with bodies alone, and by `compare` with hair.
#[test]
fn the_ground_looks_the_same() {
    let Some(mut gpu) = crate::support::card() else { return };
    let ball = crate::support::ball();
    let bodies = [crate::support::body(&ball)];
    let groom = crate::support::groom(crate::support::Style {
        strands: 8000,
        points: 20,
        ..crate::support::STRAIGHT
    });
    let look = HairLook::from(HairColor::Brown);
    let hair = [HairDraw { width_scale: 4.0, ..crate::support::hair(&groom, &look) }];
    let camera = Camera {
        position: Vec3::new(0.3, 0.35, 1.2),
        target: Vec3::new(0.1, -0.12, 0.0),
        fov: 36.0,
        ..Camera::default()
    };
    let card = Some(Vec3::new(0.5, 0.45, 0.4));
    for (height, color) in [(-0.12, None), (-0.11, card), (-0.05, card), (0.0, None)] {
        let ground = Some(Ground { height, color });
        let frame = Frame { camera, ground, ..crate::support::frame(&[], &bodies) };
        let name = format!("ground{height}");
        // Where the ground cuts a body, both are darker in that pixel than around it, and four samples
        // differ from eight.
        match height < -0.1 {
            true => compare_everywhere(&mut gpu, &name, &frame, 200, 150),
            false => compare(&mut gpu, &name, &frame, 200, 150),
        }
        compare(&mut gpu, &format!("hair-on-ground{height}"), &Frame { hair: &hair, ..frame }, 200, 150);
    }
    // Seen from below.
    let under = Frame {
        camera,
        ground: Some(Ground { height: 1.0, color: None }),
        ..crate::support::frame(&hair, &bodies)
    };
    compare(&mut gpu, "under-ground", &under, 200, 150);
}

#[test]
fn a_head_looks_the_same() {
    let Some(mut gpu) = crate::support::card() else { return };
    let options = BuiltinOptions { strands: 4000, ..BuiltinOptions::default() };
    let stage = Stage::new(scene(&options)).unwrap();
    let hair: Vec<HairDraw> =
        stage.strands().map(|s| HairDraw { width_scale: 5.0, ..HairDraw::of(s) }).collect();
    let body = stage.body().map(MeshDraw::of);
    let camera = stage.scene().camera.unwrap();
    let lighting = Lighting::facing(&camera);
    let frame = Frame { camera, lighting, ..crate::support::frame(&hair, body.as_slice()) };
    compare(&mut gpu, "head", &frame, 320, 240);
}

#[test]
fn a_moving_head_with_hair_interpolated_on_the_gpu_looks_the_same() {
    let Some(mut gpu) = crate::support::card() else { return };
    let options = BuiltinOptions { strands: 4000, guides: Guides::Count(400), ..BuiltinOptions::default() };
    let mut scene = scene(&options);
    for groom in &mut scene.grooms {
        groom.effects = Effects { clump: 0.4, curl_radius: 0.002, noise: 0.004, ..Effects::default() };
    }
    let mut stage = Stage::new(scene).unwrap();
    stage.set_external_interpolation(true);
    for _ in 0..100 {
        stage.step(1.0 / 60.0);
    }
    // The CPU draws these points; the card interpolates its own.
    stage.place_follow_hairs();
    let hair: Vec<HairDraw> =
        stage.strands().map(|s| HairDraw { width_scale: 5.0, ..HairDraw::of(s) }).collect();
    assert!(hair.iter().any(|h| h.follow.is_some()));
    let body = stage.body().map(MeshDraw::of);
    let camera = stage.scene().camera.unwrap();
    let frame = Frame {
        camera,
        lighting: Lighting::facing(&camera),
        ..crate::support::frame(&hair, body.as_slice())
    };
    compare(&mut gpu, "moving", &frame, 320, 240);
}

#[test]
fn drawing_a_frame_again_gives_the_same_picture() {
    let Some(mut gpu) = crate::support::card() else { return };
    let groom =
        crate::support::groom(crate::support::Style { strands: 3000, points: 16, ..crate::support::WAVY });
    let (look, ball) = (HairLook::default(), crate::support::ball());
    let (hair, bodies) = ([crate::support::hair(&groom, &look)], [crate::support::body(&ball)]);
    let frame = crate::support::frame(&hair, &bodies);
    let mut draw = |width, height| {
        gpu.draw(&frame, width, height);
        gpu.read().unwrap()
    };
    let first = draw(120, 90);
    assert!(draw(120, 90) == first);
    assert_eq!(draw(61, 47).rgb.len(), 61 * 47 * 3);
    assert_eq!(draw(300, 1).rgb.len(), 900);
    assert!(draw(120, 90) == first);
}

#[test]
fn changed_arrays_are_uploaded_again() {
    let Some(mut gpu) = crate::support::card() else { return };
    let mut few = Few::new(&[strand(Vec3::NEG_X * 0.1, Vec3::X * 0.1, 0.03)], 4e-3);
    let close = |few: &Few, gpu: &mut GpuRenderer| {
        let hair = [few.draw()];
        let camera =
            Camera { position: Vec3::new(0.0, 0.0, 0.5), target: Vec3::ZERO, fov: 26.0, ..Camera::default() };
        gpu.draw(&Frame { camera, ..crate::support::frame(&hair, &[]) }, 80, 60);
        gpu.read().unwrap()
    };
    let first = close(&few, &mut gpu);
    few.radii.fill(1e-3);
    assert!(close(&few, &mut gpu) != first);
    few.radii.fill(4e-3);
    assert!(close(&few, &mut gpu) == first);
    few.colors = vec![Vec3::new(0.9, 0.1, 0.1); 12];
    assert!(close(&few, &mut gpu) != first);
    few.points[5].y += 0.02;
    few.colors.clear();
    assert!(close(&few, &mut gpu) != first);
}

#[test]
fn an_empty_scene_is_the_backdrop() {
    let Some(mut gpu) = crate::support::card() else { return };
    let look = HairLook::default();
    let nothing = crate::support::no_hair(&look);
    let body = crate::support::NO_BODY;
    compare(&mut gpu, "empty", &crate::support::frame(&[], &[]), 64, 36);
    compare(
        &mut gpu,
        "nothing",
        &crate::support::frame(&[nothing, HairDraw { offsets: &[0], ..nothing }], &[body]),
        64,
        36,
    );
}

#[test]
fn broken_input_is_skipped() {
    let Some(mut gpu) = crate::support::card() else { return };
    let mut groom = crate::support::groom(crate::support::Style {
        strands: 2000,
        points: 12,
        ..crate::support::STRAIGHT
    });
    let look = HairLook::default();
    crate::support::break_points(&mut groom);
    let hair = [HairDraw { width_scale: 3.0, ..crate::support::hair(&groom, &look) }];
    compare(&mut gpu, "broken", &crate::support::frame(&hair, &[]), 160, 90);
    // Points too far apart for a shadow volume: the hair is still drawn.
    groom.points[700].x = 1e8;
    let hair = [HairDraw { width_scale: 3.0, ..crate::support::hair(&groom, &look) }];
    let seen = |gpu: &mut GpuRenderer, hair: &[HairDraw]| {
        gpu.draw(&crate::support::frame(hair, &[]), 160, 90);
        mean(&gpu.read().unwrap())
    };
    assert!(seen(&mut gpu, &hair)[0] > seen(&mut gpu, &[])[0] + 2.0);

    let look = crate::support::broken_look();
    let hair = crate::support::broken_hair(&look);
    let bodies = [crate::support::BROKEN_BODY];
    let quality = crate::support::BROKEN_QUALITY;
    for camera in crate::support::broken_cameras() {
        gpu.draw(&Frame { camera, quality, ..crate::support::frame(&hair, &bodies) }, 70, 40);
        assert_eq!(gpu.read().unwrap().rgb.len(), 70 * 40 * 3);
    }
}
