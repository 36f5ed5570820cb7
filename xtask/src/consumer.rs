//! A program outside of the workspace that links the library by path, built without optimization: as a user's first
//! build is.

use crate::run;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// Files of the program: its manifest names no crate but the library, whose `glam` it uses.
const MANIFEST: &str = "\
[package]
name = \"consumer\"
version = \"0.0.0\"
edition = \"2024\"

[dependencies]
hairspring = { path = \"LIBRARY\" }

[workspace]
";

const PROGRAM: &str = "\
use hairspring::prelude::*;

fn main() {
    let strand = |s: usize| {
        let root = Vec3::X * (0.004 * s as f32);
        (0..16).map(move |i| root + Vec3::Y * (0.01 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..100).map(strand), 40e-6);
    for model in Model::ALL {
        let material = Material { model, ..Material::default() };
        let mut simulation = Simulation::builder(groom.clone()).materials(&[material]).build().unwrap();
        simulation.set_volume(&Volume { method: VolumeMethod::Incompressible, ..Volume::default() }).unwrap();
        let ball = ColliderShape::Sphere { center: Vec3::new(0.2, 0.05, 0.02), radius: 0.03 };
        let anchor = RigidTransform::IDENTITY;
        let colliders = [MovingCollider::at_rest(ball, anchor)];
        let roots = simulation.rigid_roots(anchor);
        for _ in 0..3 {
            simulation.step(&StepInput::new(1.0 / 60.0, anchor, &roots).with_colliders(&colliders));
        }
        let measure = simulation.measure(&colliders);
        assert_eq!((measure.non_finite, simulation.strand_count()), (0, 100));
        println!(\"{model:?}: {} points, stretch {:.4} %\", simulation.point_count(), 100.0 * measure.stretch_max);
    }
}
";

/// Builds and runs the program in a folder of its own, where no setting of this repository reaches it.
pub fn run() -> Result<(), String> {
    let folder = std::env::temp_dir().join(format!("hairspring-consumer-{}", std::process::id()));
    let done = build_and_run(&folder);
    _ = fs::remove_dir_all(&folder);
    done
}

fn build_and_run(folder: &Path) -> Result<(), String> {
    let text = |e: std::io::Error| e.to_string();
    let root = std::env::current_dir().map_err(text)?;
    let library = root.join("crates/hairspring");
    fs::create_dir_all(folder.join("src")).map_err(text)?;
    // A path in TOML: backslashes would be escapes.
    let library = library.display().to_string().replace('\\', "/");
    fs::write(folder.join("Cargo.toml"), MANIFEST.replace("LIBRARY", &library)).map_err(text)?;
    fs::write(folder.join("src/main.rs"), PROGRAM).map_err(text)?;
    // The versions that the workspace is tested with.
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).map_err(text)?;
    println!("$ cargo run in a crate outside of the workspace, without optimization");
    let mut command: Command = run::command(&["run", "--quiet"], &[]);
    for name in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "RUST_MIN_STACK", "CARGO_BUILD_RUSTFLAGS"] {
        command.env_remove(name);
    }
    let target: PathBuf = folder.join("target");
    let status = command
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target)
        .stdin(Stdio::null())
        .status()
        .map_err(text)?;
    if status.success() { Ok(()) } else { Err(format!("the consumer crate ended with {status}")) }
}
