//! Promise: an error in a text file names its line, whether lines end in LF, CR LF or CR.

use crate::samples;
use hairspring_io::{Problem, bvh, csv, obj, ply, tfx, tfxmesh};

type Case = (&'static str, String, fn(&[u8]) -> Result<(), Problem>, usize);

#[test]
fn the_line_of_a_wrong_word_is_named() {
    let table = "strand,x,y,z\n0,0,0,0\n\n0,0,1,0\n\n\n1,1,0,0\n1,1,x,0\n";
    let again = "strand,x,y,z\n0,0,0,0\n1,0,1,0\n0,1,0,0\n";
    let lists = samples::PLY_LISTS.replace("2 0 0 0.0001", "2 x 0 0.0001");
    let cases: [Case; 7] = [
        ("csv", table.into(), |data| csv::parse(data).map(drop), 8),
        ("csv", again.into(), |data| csv::parse(data).map(drop), 4),
        ("ply", lists, |data| ply::parse(data).map(drop), 13),
        ("obj", "v 0 0 0\n\nv 1 x 0\n".into(), |data| obj::parse(data).map(drop), 3),
        ("bvh", samples::motion().replace("0 1.1 0", "0 x 0"), |data| bvh::parse(data).map(drop), 20),
        ("tfx", samples::tfx_2().replace("-1 1.1 0", "-1 x 0"), |data| tfx::parse(data).map(drop), 18),
        (
            "tfxmesh",
            samples::skinned_mesh().replace("2 0 0 -1", "2 0 x -1"),
            |data| tfxmesh::parse(data).map(drop),
            9,
        ),
    ];
    for (name, text, read, line) in cases {
        for end in ["\n", "\r\n", "\r"] {
            let error = read(text.replace('\n', end).as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(&format!("line {line}: ")), "{name}, lines end in {end:?}: {error}");
        }
    }
}

#[test]
fn files_of_every_line_end_are_read() {
    for end in ["\n", "\r\n", "\r"] {
        let lists = samples::PLY_LISTS.replace('\n', end);
        assert_eq!(ply::parse(lists.as_bytes()).unwrap().offsets, [0, 2, 5], "{end:?}");
        let table = "strand,x,y,z\n0,0,0,0\n\n0,0,1,0\n".replace('\n', end);
        assert_eq!(csv::parse(table.as_bytes()).unwrap().offsets, [0, 2], "{end:?}");
    }
}
