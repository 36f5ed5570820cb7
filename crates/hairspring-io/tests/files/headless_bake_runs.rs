//! Promise: the example that bakes a scene writes files that can be read.

#[path = "../../examples/headless_bake.rs"]
#[allow(dead_code)] // `main` is for `cargo run --example`.
mod headless_bake;

#[test]
fn it_writes_one_file_for_each_frame() {
    let folder = tempfile::tempdir().unwrap();
    headless_bake::bake(folder.path(), 2).unwrap();
    for frame in 1..=2 {
        let file = folder.path().join(format!("groom0.{frame:04}.hair"));
        let read = hairspring_io::read_groom(&file, &hairspring_io::ReadOptions::default()).unwrap();
        assert!(read.value.strand_count() >= 500, "{} strands", read.value.strand_count());
    }
}
