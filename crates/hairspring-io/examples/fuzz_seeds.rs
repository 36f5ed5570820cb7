//! Writes a small sound file of every format as a seed for its fuzz target: `fuzz_seeds FOLDER` (usually `fuzz/corpus`).

#[path = "../tests/common/samples.rs"]
mod samples;

use std::{fs, io, path::PathBuf};

fn main() -> io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        return Err(io::Error::other("name the folder: fuzz_seeds fuzz/corpus"));
    };
    let rig = [samples::RIG, samples::WEIGHTS].join(&0);
    let scene = include_str!("../../../docs/scene.md").split("```").nth(1).unwrap_or_default();
    let scene = scene.trim_start_matches("toml\n").as_bytes().to_vec();
    for (name, bytes, _) in samples::all() {
        let (target, bytes) = match name {
            "hair-even" => ("hair", bytes),
            "obj-strands" => ("obj", bytes),
            "glb-strands" | "glb-morph" => ("glb", bytes),
            _ if name.starts_with("ply-") => ("ply", bytes),
            "tfx-3" | "tfx-4" => ("tfx", bytes),
            "rig" | "weights" => ("rig", rig.clone()),
            "toml" => ("scene", scene.clone()),
            _ => (name, bytes),
        };
        let targets = if target == "data" { vec!["data", "sanitize"] } else { vec![target] };
        for target in targets {
            fs::create_dir_all(folder.join(target))?;
            fs::write(folder.join(target).join(format!("seed-{name}")), &bytes)?;
        }
    }
    Ok(())
}
