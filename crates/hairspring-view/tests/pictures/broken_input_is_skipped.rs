//! Promise: any input gives a picture, including non-finite strands, a mesh with an invalid index, and an
//! empty scene.

use crate::support::{
    BROKEN_BODY, BROKEN_QUALITY, NO_BODY, break_points, broken_cameras, broken_hair, broken_look, frame,
    no_hair,
};
use glam::Vec3;
use hairspring_scene::{Camera, HairLook};
use hairspring_view::{Frame, HairDraw, Light, Lighting, Renderer, frame_camera};

#[test]
fn an_empty_scene_is_the_backdrop() {
    let mut renderer = Renderer::new(64, 36);
    let image = renderer.draw(&frame(&[], &[]));
    assert!(image.rgb.iter().all(|c| *c > 5));
    let look = HairLook::default();
    let nothing = no_hair(&look);
    let zero = HairDraw { offsets: &[0], ..nothing };
    let before = renderer.image().clone();
    assert_eq!(*renderer.draw(&frame(&[nothing, zero], &[NO_BODY])), before);
}

#[test]
fn non_finite_points_affect_nothing_else() {
    let style = crate::support::Style { strands: 2000, points: 12, ..crate::support::STRAIGHT };
    let groom = crate::support::groom(style);
    let look = HairLook::default();
    let draw = |groom: &hairspring::groom::Groom| {
        let hair = [crate::support::hair(groom, &look)];
        Renderer::new(160, 90).draw(&frame(&hair, &[])).clone()
    };
    let good = draw(&groom);
    let mut broken = groom.clone();
    break_points(&mut broken);
    broken.points[12 * 600 + 5] = Vec3::new(1e8, 0.1, 1e8);
    let seen = draw(&broken);
    let different = good
        .rgb
        .chunks(3)
        .zip(seen.rgb.chunks(3))
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24))
        .count();
    assert!(different < 160 * 90 / 100, "{different} pixels changed");
    broken.points.fill(Vec3::NAN);
    draw(&broken);
}

#[test]
fn arrays_of_different_lengths_are_truncated() {
    let look = broken_look();
    let hair = broken_hair(&look);
    let dark = Light { direction: Vec3::ZERO, color: Vec3::NAN };
    let broken = Lighting { key: dark, fill: dark, rim: dark, exposure: f32::NAN, ..Lighting::default() };
    for camera in broken_cameras() {
        for lighting in [Lighting::default(), broken] {
            let frame = Frame { camera, lighting, quality: BROKEN_QUALITY, ..frame(&hair, &[BROKEN_BODY]) };
            let picture = Renderer::new(70, 40).draw(&frame).clone();
            assert_eq!((picture.width, picture.height, picture.rgb.len()), (70, 40, 70 * 40 * 3));
        }
    }
}

#[test]
fn the_automatic_camera_sees_the_whole_box() {
    for aspect in [0.5, 1.0, 16.0 / 9.0] {
        let bounds = (Vec3::new(-0.2, 1.0, -0.1), Vec3::new(0.1, 1.9, 0.3));
        let camera = frame_camera(bounds, aspect);
        let forward = (camera.target - camera.position).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let half = (0.5 * camera.fov.to_radians()).tan();
        for i in 0..8 {
            let corner = Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), bounds.0, bounds.1)
                - camera.position;
            let depth = corner.dot(forward);
            assert!(depth > 0.1);
            assert!((corner.dot(right) / depth).abs() <= half * aspect, "aspect {aspect}");
            assert!((corner.dot(right.cross(forward)) / depth).abs() <= half, "aspect {aspect}");
        }
    }
    assert_eq!(frame_camera((Vec3::NAN, Vec3::ONE), 1.0), Camera::default());
}
