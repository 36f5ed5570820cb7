//! Tells the library's files that they are built without SIMD.

fn main() {
    println!("cargo::rustc-cfg=one_lane");
    println!("cargo::rerun-if-changed=build.rs");
}
