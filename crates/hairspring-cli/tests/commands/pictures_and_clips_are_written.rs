//! Promise: `hairspring render` and `hairspring demo` write pictures and clips that open and show hair.
//!
//! Pictures are read back: they have the requested size and are not an empty backdrop. The clip is read by
//! a demuxer and a decoder that share no code with the writer, and has every frame. A resumed sequence
//! equals an uninterrupted one, and a still equals the frame of the same number.

use crate::common::{contents, fail, names, play, succeed, text, write_groom, write_scene};
use hairspring_test::{data, farthest};
use hairspring_view::{Image, read_png};

const SIZE: [&str; 2] = ["--size", "160x96"];

/// The number of pixels that differ from the row's first pixel by more than the shading of the backdrop.
fn drawn_pixels(image: &Image) -> usize {
    let rows = image.rgb.chunks(3 * image.width as usize);
    rows.map(|row| {
        row.chunks(3).filter(|p| p.iter().zip(&row[..3]).any(|(a, b)| a.abs_diff(*b) > 24)).count()
    })
    .sum()
}

/// The same still on the graphics card. It is skipped where the machine has neither a card nor a software
/// driver.
#[test]
fn a_still_is_rendered_on_the_graphics_card() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 400);
    let still = |name, more: &[&str]| {
        let arguments = [&["render", "groom.hair", "-o", name], &SIZE[..], more].concat();
        crate::common::run(f, &arguments)
    };
    let drawn = still("card.png", &["--gpu"]);
    if drawn.status.code() == Some(7) {
        return eprintln!("skipped: {}", String::from_utf8_lossy(&drawn.stderr));
    }
    assert!(drawn.status.success() && still("cpu.png", &[]).status.success());
    let [card, cpu] = ["card.png", "cpu.png"].map(|name| read_png(&f.join(name)).unwrap());
    assert_eq!((card.width, card.height), (160, 96));
    let different = card.rgb.iter().zip(&cpu.rgb).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    assert!(drawn_pixels(&card) > 100 && different < card.rgb.len() / 100, "{different} values differ");
}

#[test]
fn a_groom_alone_renders_as_a_still() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 800);
    succeed(folder.path(), &[&["render", "groom.hair", "-o", "a.png"], &SIZE[..]].concat());
    let image = read_png(&folder.path().join("a.png")).unwrap();
    assert_eq!((image.width, image.height), (160, 96));
    assert!(drawn_pixels(&image) > 300, "{} pixels of hair", drawn_pixels(&image));
    // A JPEG of the same picture: it has the JPEG signature, and its frame header states the size.
    succeed(folder.path(), &[&["render", "groom.hair", "-o", "a.jpg"], &SIZE[..]].concat());
    let jpeg = std::fs::read(folder.path().join("a.jpg")).unwrap();
    let header = jpeg.windows(2).position(|w| w == [0xFF, 0xC0]).unwrap();
    assert_eq!((&jpeg[..2], &jpeg[header + 5..header + 9]), (&[0xFF, 0xD8][..], &[0, 96, 0, 160][..]));
    // A groom alone does not move.
    succeed(folder.path(), &[&["render", "groom.hair", "-o", "b.png", "--frames", "20"], &SIZE[..]].concat());
    let later = read_png(&folder.path().join("b.png")).unwrap();
    let moved = image.rgb.iter().zip(&later.rgb).filter(|(a, b)| a.abs_diff(**b) > 24).count();
    assert!(moved * 100 < image.rgb.len(), "{moved} of {} values changed", image.rgb.len());
}

#[test]
fn a_scene_renders_as_numbered_pictures_that_resume() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 300);
    let frames = folder.path().join("frames");
    std::fs::create_dir(&frames).unwrap();
    let render =
        [&["render", "scene.toml", "-o", "frames/f.##.png", "--frames", "2-6", "--json"], &SIZE[..]].concat();
    let report = crate::common::json(&succeed(folder.path(), &render));
    assert_eq!((&report["frames"], &report["strands"]), (&5.into(), &300.into()));
    assert_eq!(
        names(&frames),
        ["f.02.png", "f.03.png", "f.04.png", "f.05.png", "f.06.png", "f.render.png.json"]
    );
    let whole = contents(&frames);
    assert!(whole[0].1 != whole[4].1, "nothing moved");

    std::fs::remove_file(frames.join("f.04.png")).unwrap();
    std::fs::write(frames.join("f.05.png"), &whole[3].1[..200]).unwrap();
    let report = crate::common::json(&succeed(folder.path(), &[&render[..], &["--resume"]].concat()));
    assert_eq!((&report["frames"], &report["skipped"]), (&2.into(), &3.into()));
    assert!(contents(&frames) == whole);

    succeed(
        folder.path(),
        &[&["render", "scene.toml", "-o", "still.png", "--frames", "5"], &SIZE[..]].concat(),
    );
    assert!(std::fs::read(folder.path().join("still.png")).unwrap() == whole[3].1);
}

/// A turntable is one full turn: the first frame is the view of the given camera, and the frame at half of
/// the turn is the view from the opposite side. A frame that is rendered again is the same.
#[test]
fn a_turntable_is_one_full_turn() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 400);
    let draw = |name, more: &[&str]| {
        let target = ["--target", "0.1,0,0.1"];
        let arguments = [&["render", "groom.hair", "-o", name], &SIZE[..], &target, more].concat();
        succeed(f, &arguments);
    };
    draw("turn.#.png", &["--turntable", "--frames", "1-4", "--camera", "0.1,0.2,0.9"]);
    let turn = |n: u32| std::fs::read(f.join(format!("turn.{n}.png"))).unwrap();
    draw("front.png", &["--frames", "1", "--camera", "0.1,0.2,0.9"]);
    assert!(turn(1) == std::fs::read(f.join("front.png")).unwrap());
    let [second, third] = [turn(2), turn(3)];
    assert!(second != third && third != turn(4));
    // The scene plays during the turn, so frame 3 is compared with frame 3 from behind.
    draw("back.png", &["--frames", "3", "--camera", "0.1,0.2,-0.7"]);
    let [turned, still] = ["turn.3.png", "back.png"].map(|name| read_png(&f.join(name)).unwrap());
    let different = turned.rgb.iter().zip(&still.rgb).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    assert!(drawn_pixels(&still) > 100 && different < turned.rgb.len() / 100, "{different} values differ");
    std::fs::remove_file(f.join("turn.2.png")).unwrap();
    draw("turn.#.png", &["--turntable", "--frames", "1-4", "--resume", "--camera", "0.1,0.2,0.9"]);
    assert!(turn(2) == second);
    let stderr = fail(f, &["render", "groom.hair", "-o", "still.png", "--turntable"], 2);
    assert!(stderr.contains("--turntable needs a clip"), "{stderr}");
}

#[test]
fn a_scene_renders_as_a_clip() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 100);
    let render = ["render", "scene.toml", "-o", "clip.mp4", "--frames", "1-7", "--fps", "24"];
    succeed(folder.path(), &[&render[..], &SIZE[..]].concat());
    assert_eq!(play(&folder.path().join("clip.mp4")), (7, (160, 96)));
    assert_eq!(names(folder.path()), ["clip.mp4", "groom.hair", "scene.toml"]);
}

#[test]
fn a_clip_of_an_odd_size_is_extended_with_a_note() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 20);
    let render = |size: &str| {
        let render = ["render", "groom.hair", "-o", "a.mp4", "--frames", "1-2", "--json", "--size", size];
        let output = crate::common::run(folder.path(), &render);
        let stderr = String::from_utf8(output.stderr).unwrap();
        let report = crate::common::json(&String::from_utf8(output.stdout).unwrap());
        (report["size"].clone(), stderr.contains("a clip has an even width and height"))
    };
    assert_eq!(render("65x33"), ([66, 34].as_slice().into(), true));
    assert_eq!(play(&folder.path().join("a.mp4")).1, (66, 34));
    assert_eq!(render("64x34"), ([64, 34].as_slice().into(), false));
}

#[test]
fn demo_writes_a_clip_and_a_still() {
    let folder = tempfile::tempdir().unwrap();
    let small = ["demo", "--strands", "3000", "--guides", "100", "--seconds", "0.25"];
    let stdout = succeed(folder.path(), &[&small[..], &SIZE[..]].concat());
    let out = folder.path().join("out");
    assert_eq!(names(&out), ["hairspring.mp4", "hairspring.png"]);
    assert_eq!(play(&out.join("hairspring.mp4")), (6, (160, 96)));
    assert!(drawn_pixels(&read_png(&out.join("hairspring.png")).unwrap()) > 1000);
    for word in [
        "hairspring.mp4",
        "hairspring.png",
        "hairs",
        "points",
        "guides",
        "substeps",
        "threads",
        "simulate",
        "draw",
    ] {
        assert!(stdout.contains(word), "{word} is missing: {stdout}");
    }
}

#[test]
fn a_real_head_is_rendered_and_baked() {
    let file = "grooms/sintel/SintelHairOriginal-sintel_hair.16points.tfx";
    let (Some(groom), Some(body), Some(collider)) =
        (data(file), data("grooms/sintel/sintel.obj"), data("grooms/sintel/sintel-collider.obj"))
    else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let scene = format!(
        "[body]\nfile = {:?}\nscale = 1.0\n[collision]\nfile = {:?}\nscale = 1.0\n\
         [[groom]]\nfile = {:?}\nscale = 1.0\nmaterial = \"wavy\"\nguides = 300\n",
        text(&body),
        text(&collider),
        text(&groom)
    );
    std::fs::write(folder.path().join("sintel.toml"), scene).unwrap();
    succeed(
        folder.path(),
        &["render", "sintel.toml", "-o", "sintel.png", "--frames", "3", "--size", "320x180"],
    );
    assert!(drawn_pixels(&read_png(&folder.path().join("sintel.png")).unwrap()) > 4000);
    let report = crate::common::json(&succeed(
        folder.path(),
        &["bake", "sintel.toml", "-o", "s.#.tfx", "--frames", "1-3", "--json"],
    ));
    assert_eq!((&report["strands"], &report["reset_strands"]), (&11_400.into(), &0.into()));
    let rest = hairspring_io::read_groom(&folder.path().join("s.1.tfx"), &Default::default()).unwrap().value;
    let authored = hairspring_io::read_groom(&groom, &Default::default()).unwrap().value;
    let error = farthest(&rest.points, &authored.points);
    assert!(error < 1e-5, "frame 1 differs from the file by {error} m");
}
