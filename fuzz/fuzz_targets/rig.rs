#![no_main]
//! `hairspring_io::makehuman::parse` on a small mesh and any rig and weights, separated by a zero byte.
const MESH: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\ng joint-a\nf 1 2 3\n";

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let (rig, weights) = data.split_at(data.iter().position(|b| *b == 0).unwrap_or(data.len()));
    if let Ok(mesh) = hairspring_io::obj::parse(MESH) {
        let _ = hairspring_io::makehuman::parse(mesh, rig, weights.get(1..).unwrap_or_default());
    }
});
