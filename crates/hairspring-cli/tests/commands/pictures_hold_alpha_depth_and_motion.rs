//! Promise: pictures can be composited. A PNG with a transparent background has alpha, an EXR file has linear
//! color with alpha, depth and motion, and a shutter blurs what moves and nothing else. The light can be
//! turned, and the backdrop has the colors of the scene. The automatic camera keeps a moving subject in view.

use crate::common::{fail, names, succeed, write_groom, write_scene};
use exr::prelude::{ReadChannels, ReadLayers, *};
use hairspring_view::read_png;
use std::{collections::BTreeMap, path::Path};

const SIZE: [&str; 2] = ["--size", "160x96"];

fn draw(folder: &Path, scene: &str, name: &str, more: &[&str]) {
    succeed(folder, &[&["render", scene, "-o", name], &SIZE[..], more].concat());
}

/// The channels of an EXR file by name, row by row.
fn channels(path: &Path) -> BTreeMap<String, Vec<f32>> {
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = image.all_attributes().from_file(path).unwrap();
    assert_eq!(image.layer_data.size, Vec2(160, 96));
    let channel = |c: &AnyChannel<FlatSamples>| (c.name.to_string(), c.sample_data.values_as_f32().collect());
    image.layer_data.channel_data.list.iter().map(channel).collect()
}

#[test]
fn a_transparent_picture_has_alpha_and_the_same_hair() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 600);
    draw(f, "groom.hair", "opaque.png", &[]);
    draw(f, "groom.hair", "clear.png", &["--background", "transparent"]);
    let [opaque, clear] = ["opaque.png", "clear.png"].map(|name| read_png(&f.join(name)).unwrap());
    assert!(opaque.alpha.is_empty());
    assert_eq!((clear.alpha[0], clear.alpha.iter().max()), (0, Some(&255)));
    for (i, _) in clear.alpha.iter().enumerate().filter(|(_, a)| **a == 255) {
        let [a, b] = [&opaque, &clear].map(|image| &image.rgb[3 * i..3 * i + 3]);
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1), "pixel {i}: {a:?} and {b:?}");
    }
    let jpeg = crate::common::run(f, &["render", "groom.hair", "-o", "a.jpg", "--background", "transparent"]);
    let stderr = String::from_utf8_lossy(&jpeg.stderr).into_owned();
    assert!(jpeg.status.success() && stderr.contains("have no transparency"), "{stderr}");
    let stderr = fail(f, &["render", "groom.hair", "-o", "a.exr", "--gpu"], 2);
    assert!(stderr.contains("without --gpu"), "{stderr}");
}

#[test]
fn an_exr_file_has_color_alpha_depth_and_motion() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 300);
    let camera = ["--frames", "6-7", "--camera", "0,0.1,1.5", "--target", "0,0,0"];
    draw(f, "scene.toml", "f.##.exr", &camera);
    assert!(names(f).contains(&"f.render.exr.json".to_owned()), "{:?}", names(f));
    let c = channels(&f.join("f.07.exr"));
    assert_eq!(
        c.keys().map(String::as_str).collect::<Vec<_>>(),
        ["A", "B", "G", "R", "Z", "backward.u", "backward.v"]
    );
    let covered: Vec<usize> = (0..160 * 96).filter(|i| c["A"][*i] > 0.5).collect();
    assert!(covered.len() > 100 && c["A"][0] == 0.0, "{} pixels", covered.len());
    assert!((0..160 * 96).all(|i| c["R"][i] >= 0.0 && c["A"][i] <= 1.0));
    assert!(covered.iter().all(|i| (0.5..2.5).contains(&c["Z"][*i])), "hair is 1.5 m away");
    assert!(c["Z"][0] > 1e9 && c["backward.u"][0] == 0.0);
    assert!(covered.iter().any(|i| c["backward.u"][*i].hypot(c["backward.v"][*i]) > 0.05), "nothing moves");
    // A still is the frame of the same number, and the first frame has no motion.
    draw(f, "scene.toml", "still.exr", &["--frames", "7", "--camera", "0,0.1,1.5", "--target", "0,0,0"]);
    assert!(std::fs::read(f.join("still.exr")).unwrap() == std::fs::read(f.join("f.07.exr")).unwrap());
    draw(f, "scene.toml", "first.exr", &["--background", "backdrop"]);
    let first = channels(&f.join("first.exr"));
    assert!(first["A"].iter().all(|a| *a == 1.0) && first["backward.u"].iter().all(|u| *u == 0.0));
}

/// A card that travels to the right moves by the same number of pixels everywhere, and points back to where
/// it was: to the left.
#[test]
fn motion_vectors_lead_back_to_the_previous_frame() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    std::fs::write(f.join("card.obj"), "v -0.2 0 0\nv 0.2 0 0\nv 0.2 0.2 0\nv -0.2 0.2 0\nf 1 2 3 4\n")
        .unwrap();
    std::fs::write(
        f.join("card.toml"),
        "[body]\nfile = \"card.obj\"\nscale = 1.0\n[[groom]]\ngrow = { strands = 20, length = 0.01 }\n\
         [clip]\nkeys = [{ time = 0.0, position = [0.0, 0.0, 0.0] }, { time = 1.0, position = [0.9, 0.3, 0.0] }]\n",
    )
    .unwrap();
    let camera = ["--camera", "0.4,0.2,2", "--target", "0.4,0.2,0", "--frames", "15"];
    draw(f, "card.toml", "card.exr", &camera);
    let c = channels(&f.join("card.exr"));
    let middle: Vec<usize> = (0..160 * 96).filter(|i| c["A"][*i] > 0.99).collect();
    assert!(middle.len() > 500);
    let mean = |name: &str| middle.iter().map(|i| c[name][*i]).sum::<f32>() / middle.len() as f32;
    let (u, v, depth) = (mean("backward.u"), mean("backward.v"), mean("Z"));
    assert!(u < -1.0 && v < -0.3 && (u / v - 3.0).abs() < 0.2, "{u}, {v}");
    assert!((depth - 2.0).abs() < 0.01, "{depth}");
}

/// Paint programs show the same color. A shutter and a ground do not change it.
#[test]
fn a_plain_backdrop_has_its_color() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 300);
    let scene = std::fs::read_to_string(f.join("scene.toml")).unwrap();
    for (name, color) in [("#ffffff", [255u8; 3]), ("#000000", [0; 3]), ("#e01b24", [0xe0, 0x1b, 0x24])] {
        let picture =
            format!("{scene}\n[picture]\nbackdrop_center = \"{name}\"\nbackdrop_edge = \"{name}\"\n");
        std::fs::write(f.join("plain.toml"), &picture).unwrap();
        std::fs::write(f.join("ground.toml"), format!("{picture}[ground]\non = true\n")).unwrap();
        for (file, more) in [
            ("plain.toml", &["--frames", "2"][..]),
            ("plain.toml", &["--frames", "2", "--shutter", "180"]),
            ("ground.toml", &[]),
        ] {
            draw(f, file, "plain.png", more);
            let image = read_png(&f.join("plain.png")).unwrap();
            for corner in [image.pixel(0, 0), image.pixel(159, 0)] {
                let near = corner.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 1);
                assert!(near, "{file} {more:?}: {corner:?} instead of {name}");
            }
        }
        // The hair is that of a transparent picture.
        draw(f, "plain.toml", "plain.png", &[]);
        draw(f, "plain.toml", "clear.png", &["--background", "transparent"]);
        let [plain, clear] = ["plain.png", "clear.png"].map(|name| read_png(&f.join(name)).unwrap());
        for (i, _) in clear.alpha.iter().enumerate().filter(|(_, a)| **a == 255) {
            let [a, b] = [&plain, &clear].map(|image| &image.rgb[3 * i..3 * i + 3]);
            // An alpha of 255 may leave a five hundredth open.
            assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 8), "pixel {i}: {a:?} and {b:?}");
        }
    }
}

#[test]
fn a_shutter_blurs_only_moving_hair() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 300);
    let still = ["--frames", "8", "--background", "transparent"];
    draw(f, "scene.toml", "sharp.png", &still);
    draw(f, "scene.toml", "blurred.png", &[&still[..], &["--shutter", "360"]].concat());
    let [sharp, blurred] = ["sharp.png", "blurred.png"].map(|name| read_png(&f.join(name)).unwrap());
    let covered = |image: &hairspring_view::Image| image.alpha.iter().filter(|a| **a > 0).count();
    assert!(covered(&blurred) > covered(&sharp), "{} and {}", covered(&blurred), covered(&sharp));
    // The first frame does not move.
    draw(f, "scene.toml", "a.png", &["--frames", "1", "--background", "transparent"]);
    draw(f, "scene.toml", "b.png", &["--frames", "1", "--background", "transparent", "--shutter", "180"]);
    assert!(std::fs::read(f.join("a.png")).unwrap() == std::fs::read(f.join("b.png")).unwrap());
    let stderr = fail(f, &["render", "scene.toml", "-o", "a.png", "--shutter", "361"], 2);
    assert!(stderr.contains("expected degrees from 0 to 360"), "{stderr}");
}

#[test]
fn the_light_turns_and_the_backdrop_has_its_colors() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 300);
    let scene = std::fs::read_to_string(f.join("scene.toml")).unwrap();
    let picture =
        "[picture]\nlight_angle = 90.0\nbackdrop_center = \"#336699\"\nbackdrop_edge = \"#336699\"\n";
    std::fs::write(f.join("lit.toml"), format!("{scene}\n{picture}")).unwrap();
    draw(f, "lit.toml", "lit.png", &[]);
    draw(f, "lit.toml", "front.png", &["--light-angle", "0"]);
    let [lit, front] = ["lit.png", "front.png"].map(|name| read_png(&f.join(name)).unwrap());
    assert_eq!(lit.pixel(0, 0), front.pixel(0, 0));
    // A plain backdrop, up to the dither of one code.
    let [left, right] = [lit.pixel(0, 0), lit.pixel(159, 0)];
    assert!(left.iter().zip(right).all(|(a, b)| a.abs_diff(b) <= 1), "{left:?} and {right:?}");
    assert!(left.iter().zip([0x33u8, 0x66, 0x99]).all(|(a, b)| a.abs_diff(b) <= 1), "{left:?}");
    let different = lit.rgb.iter().zip(&front.rgb).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    assert!(different > 100, "{different} values differ");
}
