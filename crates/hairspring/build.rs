//! Tells the library's files whether they are built without optimization.
//!
//! Functions of the kernels must be inlined to be compiled for the instruction set of the kernel. Without optimization there is
//! one instruction set only, and inlining would copy every function to each place that calls it, which takes the compiler
//! minutes. Functions of more than a dozen lines are thus inlined in optimized builds only. The library's own unit tests
//! (`test`) are compiled the same way, for the same reason.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("OPT_LEVEL").as_deref() == Ok("0") {
        println!("cargo::rustc-cfg=unoptimized");
    }
}
