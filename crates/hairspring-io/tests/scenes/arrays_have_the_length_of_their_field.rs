//! Promise: a list of numbers has as many as its field needs, wherever it is. A decimal comma makes four numbers of three,
//! which would be another gravity or another place.

use crate::scenes::{folder, message, read};

const GROOM: &str = "[[groom]]\nfile = \"hair.data\"\nscale = 1.0\n";
const BODY: &str = "[body]\nfile = \"head.obj\"\nscale = 1.0\n";

#[test]
fn a_number_too_many_is_refused() {
    let collider = |shape: &str| format!("{GROOM}[[collider]]\nshape = {{ {shape} }}\n");
    for (text, line, field) in [
        (format!("gravity = [0.0, -9,81, 0.0]\n{GROOM}"), 1, "gravity"),
        (format!("{GROOM}[wind]\nvelocity = [1, 2, 3, 4]\n"), 5, "velocity"),
        (format!("{GROOM}[camera]\nposition = [0.35, 1, 6, 1.1]\n"), 5, "position"),
        (format!("{GROOM}transform = {{ position = [0, 1,5, 0] }}\n"), 4, "position"),
        (format!("{GROOM}[groom.transform]\nrotation = [0, 45, 0, 1]\n"), 5, "rotation"),
        (
            format!(
                "{GROOM}{BODY}[clip]\nkeys = [{{ time = 0 }}, {{ time = 1, position = [0, 0, 1, 5] }}]\n"
            ),
            8,
            "position",
        ),
        (
            format!("{GROOM}{BODY}[clip]\nfile = \"nod.bvh\"\njoint = \"Head\"\npivot = [0, 1,55, 0]\n"),
            10,
            "pivot",
        ),
        (collider("sphere = { center = [0, 1, 0, 9], radius = 0.1 }"), 5, "center"),
        (collider("box = { center = [0, 1, 0], size = [1, 1, 1, 1] }"), 5, "size"),
        (collider("plane = { point = [0, 0, 0], normal = [0, 1, 0, 0] }"), 5, "normal"),
        (collider("hull = { points = [[0, 0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }"), 5, "points"),
        (
            format!(
                "{GROOM}[[wind_source]]\nshape.point = {{ center = [0, 0, 0, 1], radius = 1, speed = 1 }}\n"
            ),
            5,
            "center",
        ),
        (format!("{GROOM}[[hand]]\ntool.grab = {{ center = [0, 0, 0, 0], radius = 1 }}\n"), 5, "center"),
        (format!("{GROOM}look = {{ root_color = [1, 0, 0, 1] }}\n"), 4, "root_color"),
    ] {
        let message = message(&text);
        assert!(
            message.starts_with(&format!("scene.toml, line {line}: `{field}` needs three numbers")),
            "{message}"
        );
        assert!(message.contains("such as [") && message.ends_with(", not 4 values"), "{message}");
    }
    let hand =
        "[[hand]]\ntool.grab = { center = [0, 0, 0], radius = 1 }\npath = [[0, 0, 0, 0], [1, 0, 1,5, 0]]\n";
    let message = message(&format!("{GROOM}{hand}"));
    assert!(message.contains("line 6: `path` needs a list of 4 values, not 5 values"), "{message}");
}

#[test]
fn lists_of_any_length_are_read() {
    let folder = folder();
    let text = format!(
        "{GROOM}material = \"a\"\n[material.a]\nradius_profile = [1, 0.9, 0.8, 0.7, 0.6]\n[[hand]]\ntool.grab = {{ center = [0, 0, 0], radius = 1 }}\npath = [[0, 0, 0, 0], [1, 0, 1, 0], [2, 0, 0, 0]]\n"
    );
    let scene = read(folder.path(), &text).unwrap().value;
    assert_eq!(scene.hands[0].path.len(), 3);
    assert_eq!(scene.grooms[0].materials[0].radius_profile.len(), 5);
}
