//! Promise: a path with backslashes, as Windows writes it, is reported with how to write it.

use crate::scenes::message;

#[test]
fn an_escape_sequence_that_is_no_such_is_explained() {
    for path in ["C:\\Users\\me\\fan.data", "C:\\new\\head.data", "C:\\x\\y.data", "..\\"] {
        let error = message(&format!("[[groom]]\nfile = \"{path}\"\n"));
        assert!(error.starts_with("scene.toml, line 2: "), "{error}");
        assert!(error.ends_with("write paths with / or in single quotes"), "{error}");
    }
}

#[test]
fn an_escape_sequence_that_is_one_by_chance_is_explained() {
    let error = message("[[groom]]\nfile = \"..\\files\\new.data\"\n");
    assert!(error.contains("was not found; scene.toml, line 2, names it as the groom"), "{error}");
    assert!(error.ends_with("write paths with / or in single quotes"), "{error}");
    let error = message("[[groom]]\nfile = '..\\files\\new.data'\n");
    assert_eq!(error.ends_with("; write paths with /"), !cfg!(windows), "{error}");
    let error = message("[[groom]]\nfile = \"new.data\"\n");
    assert!(error.ends_with("names it as the groom"), "{error}");
}
