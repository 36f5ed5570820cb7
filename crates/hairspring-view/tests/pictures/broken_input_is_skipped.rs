//! Promise: any input gives a picture, including non-finite strands, a mesh with an invalid index, and an
//! empty scene.

use glam::Vec3;
use hairspring_scene::{Camera, HairLook};
use hairspring_view::{Frame, HairDraw, Light, Lighting, MeshDraw, Quality, Renderer, frame_camera};

#[test]
fn an_empty_scene_is_the_backdrop() {
    let mut renderer = Renderer::new(64, 36);
    let image = renderer.draw(&crate::support::frame(&[], &[]));
    assert!(image.rgb.iter().all(|c| *c > 5));
    let look = HairLook::default();
    let nothing = HairDraw {
        points: &[],
        offsets: &[],
        radii: &[],
        colors: &[],
        look: &look,
        width_scale: 1.0,
        follow: None,
    };
    let zero = HairDraw { offsets: &[0], ..nothing };
    let body = MeshDraw { positions: &[], normals: &[], triangles: &[], parts: &[] };
    let before = renderer.image().clone();
    assert_eq!(*renderer.draw(&crate::support::frame(&[nothing, zero], &[body])), before);
}

#[test]
fn non_finite_points_affect_nothing_else() {
    let style = crate::support::Style { strands: 2000, points: 12, ..crate::support::STRAIGHT };
    let groom = crate::support::groom(style);
    let look = HairLook::default();
    let draw = |groom: &hairspring::groom::Groom| {
        let hair = [crate::support::hair(groom, &look)];
        Renderer::new(160, 90).draw(&crate::support::frame(&hair, &[])).clone()
    };
    let good = draw(&groom);
    let mut broken = groom.clone();
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, 1e8].into_iter().enumerate() {
        broken.points[12 * 100 * (i + 1) + i] = Vec3::new(bad, 0.1, bad);
    }
    broken.radii[7] = f32::NAN;
    broken.radii[80] = -1.0;
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
    let points = [Vec3::ZERO, Vec3::Y * 0.1, Vec3::Y * 0.2];
    let look = HairLook { root_color: Vec3::NAN, roughness: f32::NAN, ..HairLook::default() };
    let hair = [
        HairDraw {
            points: &points,
            offsets: &[0, 3, 900, 2, u32::MAX],
            radii: &[1e-3; 2],
            colors: &[Vec3::NAN],
            look: &look,
            width_scale: 1.0,
            follow: None,
        },
        HairDraw {
            points: &points,
            offsets: &[0, 3],
            radii: &[1e-3; 3],
            colors: &[],
            look: &look,
            width_scale: f32::INFINITY,
            follow: None,
        },
    ];
    let bodies = [MeshDraw {
        positions: &[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN],
        normals: &[Vec3::Z],
        triangles: &[[0, 1, 2], [0, 1, 3], [0, 1, 77], [1, 1, 1]],
        parts: &[],
    }];
    let dark = Light { direction: Vec3::ZERO, color: Vec3::NAN };
    for camera in [
        Camera::default(),
        Camera { position: Vec3::ZERO, target: Vec3::ZERO, fov: f32::NAN },
        Camera { position: Vec3::NAN, target: Vec3::INFINITY, fov: -3.0 },
        Camera { position: Vec3::Y * 0.1001, target: Vec3::ZERO, fov: 170.0 },
    ] {
        let quality = Quality { shadow_voxels: 0, shadow_texels: 0, smoothness: f32::NAN, wisp: u32::MAX };
        for lighting in [
            Lighting::default(),
            Lighting { key: dark, fill: dark, rim: dark, exposure: f32::NAN, ..Lighting::default() },
        ] {
            Renderer::new(70, 40).draw(&Frame {
                camera,
                quality,
                lighting,
                ..crate::support::frame(&hair, &bodies)
            });
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
