//! Promise: a tie in a scene with strand contact is reported, because strands that support each other do not fit into a
//! narrow ring.

use crate::scenes::{folder, read};

/// The notes of a scene with a tie and these further lines.
fn notes(lines: &str) -> Vec<String> {
    let text = format!(
        "[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\ngrow = {{ strands = 3 }}\n[[hand]]\ntool.tie = {{ center = [0, 1, 0], \
         axis = [0, 0, 1], radius = 0.01, reach = 0.1 }}\n{lines}"
    );
    read(folder().path(), &text).unwrap().notes
}

#[test]
fn a_tie_is_reported_only_where_strands_touch() {
    let found = notes("[neighbours]\non = true\n");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].starts_with("strands with [neighbours] keep each other out of the ring of a tie"),
        "{found:?}"
    );
    for lines in ["", "[neighbours]\non = false\n", "[volume]\nmethod = \"density\"\n"] {
        assert_eq!(notes(lines), Vec::<String>::new(), "{lines}");
    }
}
