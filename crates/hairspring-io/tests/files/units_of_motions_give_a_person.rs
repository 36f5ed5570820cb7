//! Promise: the unit of a `.bvh` file is guessed so that a person has a usual height, from a small child to a tall adult.

use hairspring_io::{ReadOptions, read_motion};

/// Reads a person of this height [file units], of five joints or of more. Returns the unit [m] and the notes.
fn unit(height: f32, joints: usize) -> (f32, String) {
    let part = |of: f32| of * height;
    let spine: String =
        (0..joints).map(|k| format!("JOINT Spine{k}\n{{\nOFFSET 0 0 0\nCHANNELS 0\n")).collect();
    let text = format!(
        "HIERARCHY\nROOT Hips\n{{\nOFFSET 0 {} 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n{spine}\
         JOINT Head\n{{\nOFFSET 0 {} 0\nCHANNELS 0\nEnd Site\n{{\nOFFSET 0 {} 0\n}}\n}}\n{}\
         JOINT LeftLeg\n{{\nOFFSET 0 0 0\nCHANNELS 0\nEnd Site\n{{\nOFFSET 0 {} 0\n}}\n}}\n}}\n\
         MOTION\nFrames: 1\nFrame Time: 0.02\n0 0 0\n",
        part(0.5),
        part(0.4),
        part(0.1),
        "}\n".repeat(joints),
        part(-0.5),
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bvh");
    std::fs::write(&path, text).unwrap();
    let loaded = read_motion(&path, None, &ReadOptions::default()).unwrap();
    (loaded.scale, loaded.notes.join("; "))
}

#[test]
fn persons_of_any_height_have_the_unit_of_their_file() {
    for joints in [0, 8] {
        let check = |scale: f32, low: usize, high: usize| {
            for centimeters in (low..=high).step_by(5) {
                let height = centimeters as f32 * 0.01;
                let (unit, notes) = unit(height / scale, joints);
                assert_eq!(unit, scale, "{height} m, {joints}: {notes}");
                assert!(notes.contains(&format!("person is then {height:.2} m tall")), "{notes}");
            }
        };
        check(1.0, 80, 230);
        check(0.001, 80, 230);
        // A smaller child in centimeters may be an adult in inches. Other units are those of adults.
        check(0.01, 105, 230);
        check(0.0254, 135, 195);
        check(0.0254 / 0.45, 135, 195);
    }
}

#[test]
fn a_height_that_no_unit_makes_usual_is_scaled_to_a_person() {
    let (unit, notes) = unit(5.68, 8);
    assert!((5.68 * unit - 1.6).abs() < 1e-3 && notes.contains("set `scale`"), "{notes}");
}
