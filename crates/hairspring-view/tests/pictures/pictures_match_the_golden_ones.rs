//! Promise: pictures match the golden ones. The CPU renderer is the reference, so a change of its look must
//! be intended.
//!
//! Small scenes are compared with approved pictures, by structural similarity of their luminance (Wang et
//! al. 2004). Different rounding on another processor passes; a moved highlight or a missing shadow does
//! not. After an intended change, run with `HAIRSPRING_GOLDEN=write`, check the pictures in `tests/golden`,
//! and commit them.

use crate::alike::{ALIKE, similarity};
use hairspring_scene::{HairColor, HairLook};
use hairspring_view::{Frame, Image, Quality, Renderer, read_png, write_png};
use std::path::PathBuf;

fn draw(style: crate::support::Style, color: HairColor) -> Image {
    // Fewer, thicker strands: a full head at a twentieth of the work.
    let groom = crate::support::groom(crate::support::Style { strands: 8000, points: 20, ..style });
    let ball = crate::support::ball();
    let look = HairLook::from(color);
    let mut hair = crate::support::hair(&groom, &look);
    hair.width_scale = 4.0;
    let (hair, bodies) = ([hair], [crate::support::body(&ball)]);
    let quality = Quality { shadow_voxels: 64, ..Quality::default() };
    Renderer::new(200, 150).draw(&Frame { quality, ..crate::support::frame(&hair, &bodies) }).clone()
}

fn check(name: &str, image: Image) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var("HAIRSPRING_GOLDEN").is_ok_and(|v| v == "write") {
        write_png(&path, &image).unwrap();
    }
    let kept = read_png(&path).unwrap();
    let score = similarity(&image, &kept);
    if score < ALIKE {
        let seen = std::env::temp_dir().join(format!("hairspring-{name}"));
        write_png(&seen, &image).unwrap();
        panic!(
            "{name}: the similarity is {score:.4}, but {ALIKE} is needed; the picture is in {}",
            seen.display()
        );
    }
}

#[test]
fn straight_brown() {
    check("straight-brown.png", draw(crate::support::STRAIGHT, HairColor::Brown));
}

#[test]
fn wavy_blonde() {
    check("wavy-blonde.png", draw(crate::support::WAVY, HairColor::Blonde));
}

#[test]
fn similarity_detects_a_change_of_look() {
    let kept = draw(crate::support::STRAIGHT, HairColor::Brown);
    assert!(similarity(&kept, &kept) > 0.9999);
    assert!(similarity(&draw(crate::support::STRAIGHT, HairColor::DarkBrown), &kept) < ALIKE);
    assert!(similarity(&draw(crate::support::WAVY, HairColor::Brown), &kept) < ALIKE);
}

#[test]
fn a_picture_is_read_back_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let image = draw(crate::support::WAVY, HairColor::Gray);
    let path = hairspring_view::sequence_path(&folder.path().join("frame.####.png"), 12).unwrap();
    assert!(path.ends_with("frame.0012.png"));
    write_png(&path, &image).unwrap();
    assert!(read_png(&path).unwrap() == image);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file is left");
    std::fs::write(&path, "no picture").unwrap();
    assert!(read_png(&path).unwrap_err().to_string().contains("frame.0012.png"));
    let missing = folder.path().join("missing/frame.png");
    assert!(write_png(&missing, &image).unwrap_err().to_string().contains("missing"));
}
