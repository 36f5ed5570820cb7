//! Promise: the wind arrow and the objects of a scene have handles in the picture. A dragged handle follows
//! the pointer, and the drag changes the scene's text as a slider would. One undo step reverts the whole
//! drag. The camera does not move during the drag, whichever tool is active.
//!
//! Positions in the picture are known in closed form: at the target's depth d, a picture with the field of
//! view v is 2 d tan(v / 2) high.

mod support;

use support::{until, window};

/// A ball at the middle of the picture, 2 m from the camera.
const SCENE: &str = "[builtin]\nstrands = 100\nguides = 20\nmotion = false\n\n\
    [[collider]]\nshape.sphere = { center = [0.0, 1.5, 0.0], radius = 0.05 } # mine\n\n\
    [camera]\nposition = [0.0, 1.5, 2.0]\ntarget = [0.0, 1.5, 0.0]\nfov = 30.0\n";

/// Height of the picture at the ball [m].
fn height() -> f64 {
    4.0 * 15f64.to_radians().tan()
}

/// Returns the scene's text after this script.
fn text_after(script: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(folder.path(), SCENE, script);
    assert!(until(&mut window, |app| app.is_idle()));
    let wrong = window.state().message().filter(|(_, wrong)| *wrong);
    assert_eq!(wrong, None);
    window.state().session().document().text().to_owned()
}

/// The three numbers at `key`.
fn vector(text: &str, key: &[&str]) -> [f64; 3] {
    let table: toml_edit::DocumentMut = text.parse().unwrap();
    let mut item = table.as_item();
    for name in key {
        item = item
            .get(name)
            .unwrap_or_else(|| item.get(0).and_then(|i| i.get(name)).expect("the key is missing"));
    }
    let list = item.as_array().unwrap();
    std::array::from_fn(|k| list.get(k).unwrap().as_float().unwrap())
}

fn is_near(a: [f64; 3], b: [f64; 3], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance)
}

#[test]
fn dragged_ball_follows_the_pointer() {
    let center = &["collider", "shape", "sphere", "center"];
    for hand in ["look", "grab", "head"] {
        let text = text_after(&format!("pause\nhand {hand}\nwait 1\ndrag 0.5 0.5 0.5 0.4 10"));
        let height_of_ball = 1.5 + 0.1 * height();
        assert!(is_near(vector(&text, center), [0.0, height_of_ball, 0.0], 3e-4), "{hand}: {text}");
        assert!(text.contains("radius = 0.05 } # mine"), "the rest of the text changed: {text}");
    }
    let back = text_after("pause\nwait 1\ndrag 0.5 0.5 0.5 0.4 10\ndrag 0.5 0.4 0.5 0.5 10");
    assert!(is_near(vector(&back, center), [0.0, 1.5, 0.0], 5e-4), "the camera turned: {back}");
}

#[test]
fn dragging_the_wind_arrow_sets_the_velocity() {
    let text = text_after("pause\nwait 1\ndrag 0.8 0.7 0.8 0.6 10");
    // The arrow has two fifths of its maximum length, and the speed is quadratic in the length.
    assert!(is_near(vector(&text, &["wind", "velocity"]), [0.0, 20.0 * 0.16, 0.0], 0.02), "{text}");
}

#[test]
fn a_drag_is_one_undo_step() {
    assert_eq!(text_after("pause\nwait 1\ndrag 0.5 0.5 0.6 0.4 10\nundo"), SCENE);
    assert_eq!(text_after("pause\nwait 1\ndrag 0.8 0.7 0.7 0.6 10\nundo"), SCENE);
}

#[test]
fn without_handles_the_same_drag_turns_the_view() {
    assert_eq!(text_after("pause\noverlay handles off\nwait 1\ndrag 0.5 0.5 0.6 0.4 10"), SCENE);
}
