//! Promise: a number sign inside of a word is no comment, so that no number is cut short.
//!
//! Programs that were built with old C libraries write numbers that are not finite as `-1.#IND` and `1.#QNAN0`. A reader
//! that takes the rest for a comment reads -1 and 1.

use crate::samples;
use hairspring_io::{bvh, csv, obj, ply, tfx, tfxmesh};

const WORDS: [&str; 4] = ["-1.#IND", "1.#QNAN0", "1.#INF", "-1.#IND00"];

#[test]
fn numbers_that_are_not_finite_are_errors_with_line_and_word() {
    let mesh = |word: &str| format!("v 0 0 0\nv 0 1 {word}\nv 1 0 0\nf 1 2 3\n");
    let colored = |word: &str| format!("v 0 0 0\nv 0 1 0 1 {word} 1\nv 1 0 0\nf 1 2 3\n");
    let strand = |word: &str| format!("v 0 0 0\nv 0 1 {word}\nl 1 2\n");
    let table = |word: &str| format!("strand,x,y,z\n0,0,0,{word}\n");
    type Case = (fn(&[u8]) -> Result<(), hairspring_io::Problem>, fn(&str) -> String, usize);
    let cases: [Case; 7] = [
        (|data| obj::parse(data).map(drop), mesh, 2),
        (|data| obj::parse(data).map(drop), colored, 2),
        (|data| obj::parse_groom(data).map(drop), strand, 2),
        (|data| csv::parse(data).map(drop), table, 2),
        (|data| tfx::parse(data).map(drop), |word| samples::tfx_2().replace("1.1, 0.5", word), 13),
        (|data| tfxmesh::parse(data).map(drop), |word| samples::skinned_mesh().replace("0.5 0.5", word), 8),
        (
            |data| bvh::parse(data).map(drop),
            |word| samples::motion().replace("0 0.5 0", &format!("0 0 {word}")),
            8,
        ),
    ];
    for word in WORDS {
        for (read, text, line) in cases {
            let text = text(word);
            let error = read(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(&format!("line {line}: ")) && error.contains(word), "{text}{error}");
            assert!(error.contains("which is not finite; correct it"), "{error}");
        }
        let text = samples::PLY_IDS.replace("3 0 0 -1 0", &format!("3 0 {word} -1 0"));
        let error = ply::parse(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("line 13: "), "{error}");
    }
}

#[test]
fn comments_after_a_space_are_left_out() {
    let text = "#a\n  # b\nv 0 0 0 # c\nv 0 1 0\t#d\nv 1 0 0 #\nf 1 2 3 # e\\\n";
    assert_eq!(obj::parse(text.as_bytes()).unwrap().triangles, [[0, 1, 2]]);
    let error = obj::parse(b"v 0 0 0#c\n").unwrap_err().to_string();
    assert!(error.contains("found `0#c`; put a space before a comment"), "{error}");
    let error = obj::parse(b"v 0 0\n").unwrap_err().to_string();
    assert_eq!(error, "line 1: expected a vertex of 3 numbers, but the line ends");
}
