//! Promise: lengths, radii and other values that no hair has, because they are in another unit, are reported.

use crate::scenes::{folder, read};

/// The notes of a scene that grows hair of this length and radius [m].
fn notes(length: &str, radius: &str) -> Vec<String> {
    let text = format!(
        "[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\ngrow = {{ strands = 3, length = {length} }}\nmaterial = \"a\"\n\
         [material.a]\nradius = {radius}\n"
    );
    read(folder().path(), &text).unwrap().notes
}

#[test]
fn hair_of_meters_and_as_thick_as_a_rope_is_noted() {
    let found = notes("25", "0.07");
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("`grow` has hair of 25 m; lengths are in meters"), "{found:?}");
    assert!(found[1].starts_with("[material.a] has hair that is 0.140 m thick; lengths are"), "{found:?}");
    for (length, radius) in [("0.002", "2e-6"), ("2.5", "1e-3"), ("1", "35e-6")] {
        assert_eq!(notes(length, radius), Vec::<String>::new());
    }
}

#[test]
fn values_in_another_unit_are_noted() {
    let noted = |above: &str, below: &str| {
        let text = format!(
            "{above}\n[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\ngrow = {{ strands = 3, length = 0.1 }}\nmaterial = \"a\"\n\
             [material.a]\n{below}\n"
        );
        read(folder().path(), &text).unwrap().notes
    };
    let sheet =
        |thickness: &str| format!("[[sheet]]\nfile = \"head.obj\"\nscale = 1\nthickness = {thickness}");
    for (above, below, start) in [
        ("gravity = [0, -981, 0]", "", "gravity is 981 m/s²; it is in m/s²"),
        ("", "density = 1.3", "[material.a] has a density of 1.3 kg/m³; it is in kg/m³ (hair has 1300)"),
        ("", "young = 4", "[material.a] has a Young's modulus of 4 Pa; it is in Pa"),
        ("", &sheet("2"), "a [[sheet]] is 2 m thick; lengths are in meters"),
    ] {
        let found = noted(above, below);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with(start), "{found:?}");
    }
    let usual = format!("density = 1100\nyoung = 1e8\n{}", sheet("0.01"));
    assert_eq!(noted("gravity = [0, -24.8, 0]", &usual), Vec::<String>::new());
}
