//! Promise: lengths and radii that no hair has, because they are not in meters, are reported.

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
