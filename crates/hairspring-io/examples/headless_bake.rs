//! A bake without a window: a scene is played, and each frame's hair is written to a file.

use hairspring::groom::Groom;
use hairspring_io::write_groom;
use hairspring_scene::{
    builtin::{BuiltinOptions, scene},
    stage::Stage,
};
use std::{error::Error, path::Path};

/// Runs the example.
pub fn main() -> Result<(), Box<dyn Error>> {
    bake(Path::new("target/bake"), 5)
}

/// Writes `frames` frames of the built-in head to `folder`.
pub fn bake(folder: &Path, frames: u32) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    // `hairspring_io::read_scene` reads a scene file instead.
    let mut stage = Stage::new(scene(&BuiltinOptions { strands: 500, ..Default::default() }))?;
    for frame in 1..=frames {
        if frame > 1 {
            stage.step(1.0 / 24.0);
        }
        for (k, hair) in stage.strands().enumerate() {
            let now = Groom { points: hair.points.to_vec(), ..hair.groom.clone() };
            for lost in write_groom(&folder.join(format!("groom{k}.{frame:04}.hair")), &now)? {
                println!("{lost}");
            }
        }
    }
    println!("{frames} frames in {}", folder.display());
    Ok(())
}
