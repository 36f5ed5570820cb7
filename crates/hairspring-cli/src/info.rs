//! `hairspring info`: describes the content of a file.

use crate::{
    console::{Console, say},
    fault::Fault,
    input::{Units, tell},
    totals::grouped,
};
use clap::Parser;
use glam::Vec3;
use hairspring::{
    body::{Body, Clip},
    groom::{Groom, Repairs},
};
use hairspring_io::{Format, ReadOptions, read_body, read_bones, read_groom, read_motion, read_scene};
use hairspring_scene::{Guides, Scene};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Describes the content of a groom, body, motion or scene file, in meters, Y up.
///
/// For a groom, `repaired` counts what was fixed while reading: points that were not finite, segments of zero
/// length, strands of fewer than three points, and radii that were not above 0. `length_m` is the length of
/// the shortest, the median and the longest strand.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring info head.hair
  hairspring info ponytail.tfx --scale 0.0025 --json
  hairspring info robot.glb")]
pub struct Options {
    /// A groom (.hair, .tfx, .data), body (.glb, .gltf, .obj, .tfxmesh), motion (.bvh), bones (.tfxbone) or scene (.toml)
    #[arg(value_name = "FILE")]
    file: PathBuf,

    #[command(flatten)]
    units: Units,

    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let path = &options.file;
    let units = ReadOptions::from(options.units);
    let wrong = |e| Fault::reading(e, path);
    let format = Format::of(path).ok_or_else(|| {
        Fault::Usage(format!(
            "{}: unknown extension; expected .hair, .tfx, .data, .glb, .gltf, .obj, .tfxmesh, .tfxbone, .bvh or .toml",
            path.display()
        ))
    })?;
    let mut found = match format {
        Format::Hair | Format::Tfx | Format::Usc => {
            let loaded = read_groom(path, &units).map_err(wrong)?;
            tell(&loaded.notes, &loaded.repairs, console);
            groom(&loaded.value, &loaded.repairs)
        }
        Format::Gltf | Format::Obj | Format::TfxMesh => {
            let loaded = read_body(path, &units).map_err(wrong)?;
            tell(&loaded.notes, &loaded.repairs, console);
            let mut found = body(&loaded.value.body);
            found["motions"] = loaded.value.clips.iter().map(clip).collect();
            found
        }
        Format::Bvh => {
            let loaded = read_motion(path, None, &units).map_err(wrong)?;
            tell(&loaded.notes, &loaded.repairs, console);
            let names: Vec<&str> = loaded.value.joints.iter().map(|j| j.name.as_str()).collect();
            let mut found = clip(&loaded.value.clip);
            found["joints"] = json!(names);
            found
        }
        Format::TfxBone => {
            let bones = read_bones(path).map_err(wrong)?;
            json!({ "strands": bones.bones.len(), "joints": bones.names })
        }
        Format::Scene => {
            let loaded = read_scene(path).map_err(wrong)?;
            tell(&loaded.notes, &loaded.repairs, console);
            scene(&loaded.value, &loaded.repairs)
        }
    };
    let mut all = json!({ "format": format.name() });
    if let (Value::Object(all), Value::Object(found)) = (&mut all, &mut found) {
        all.append(found);
    }
    match options.json {
        true => say(&all),
        false => lines(path, &all),
    }
    Ok(())
}

fn groom(groom: &Groom, repairs: &Repairs) -> Value {
    let counts = || (0..groom.strand_count()).map(|s| groom.range(s).len());
    let mut lengths: Vec<f32> = (0..groom.strand_count()).map(|s| groom.strand_length(s)).collect();
    lengths.sort_by(f32::total_cmp);
    let at = |i: usize| lengths.get(i).copied().unwrap_or(0.0);
    json!({
        "strands": groom.strand_count(),
        "points": groom.point_count(),
        "points_min": counts().min(),
        "points_max": counts().max(),
        "length_m": [at(0), at(lengths.len() / 2), at(lengths.len().saturating_sub(1))],
        "bounds_m": bounds(groom.bounds()),
        "repaired": repairs.total(),
        "groups": groom.groups.iter().max().map_or(1, |g| u32::from(*g) + 1),
        "guides": guides(groom),
        "colors": !groom.colors.is_empty(),
    })
}

/// Number of strands that the file names as guides.
fn guides(groom: &Groom) -> usize {
    let mut used: Vec<u32> = groom.guides.iter().flat_map(|g| g.guides).collect();
    used.sort_unstable();
    used.dedup();
    used.len()
}

fn body(body: &Body) -> Value {
    let joints: Vec<&str> = body.joints.iter().map(|j| j.name.as_str()).collect();
    let parts: Vec<&str> = body.mesh.parts.iter().map(|p| p.name.as_str()).collect();
    json!({
        "vertices": body.mesh.positions.len(),
        "triangles": body.mesh.triangles.len(),
        "bounds_m": bounds(body.mesh.bounds()),
        "skinned": body.skin.is_some(),
        "parts": parts,
        "joints": joints,
    })
}

fn clip(clip: &Clip) -> Value {
    json!({
        "name": clip.name,
        "frames": clip.frame_count(),
        "rate_hz": clip.rate,
        "seconds": clip.duration(),
    })
}

fn scene(scene: &Scene, repairs: &Repairs) -> Value {
    let grooms: Vec<Value> = scene
        .grooms
        .iter()
        .map(|g| {
            let mut found = groom(&g.groom, &Repairs::default());
            if let Value::Object(found) = &mut found {
                // Repairs are counted for all grooms together.
                found.remove("repaired");
            }
            found["simulated"] = match g.guides {
                Guides::All => json!("all"),
                Guides::FromGroom => json!("file"),
                Guides::Count(n) => json!(n),
            };
            found
        })
        .collect();
    json!({
        "name": scene.name,
        "strands": scene.grooms.iter().map(|g| g.groom.strand_count()).sum::<usize>(),
        "points": scene.grooms.iter().map(|g| g.groom.point_count()).sum::<usize>(),
        "repaired": repairs.total(),
        "grooms": grooms,
        "body": scene.body.as_ref().map(body),
        "motion": scene.clip.as_ref().map(clip),
        "colliders": scene.colliders.len() + scene.sheets.len() + usize::from(scene.collision.is_some()),
        "substeps": scene.solver.substeps,
    })
}

fn bounds(bounds: Option<(Vec3, Vec3)>) -> Value {
    json!(bounds.map(|(low, high)| [low.to_array(), high.to_array()]))
}

/// Prints the figures as lines of `name value`, with groups indented under their name.
fn lines(path: &Path, all: &Value) {
    say(path.display());
    show(all, 1);
}

fn show(value: &Value, depth: usize) {
    let Value::Object(fields) = value else { return };
    for (name, value) in fields {
        let label = format!("{:indent$}{:<12}", "", name.replace('_', " "), indent = 2 * depth);
        match value {
            Value::Object(_) => {
                say(label.trim_end());
                show(value, depth + 1);
            }
            Value::Array(items) if items.iter().any(Value::is_object) => {
                for (i, item) in items.iter().enumerate() {
                    say(format_args!("{:indent$}{name} {}", "", i + 1, indent = 2 * depth));
                    show(item, depth + 1);
                }
            }
            _ => say(format_args!("{label} {}", plain(value))),
        }
    }
}

fn plain(value: &Value) -> String {
    match value {
        Value::Null => "none".into(),
        Value::Bool(yes) => if *yes { "yes" } else { "no" }.into(),
        Value::String(text) => text.clone(),
        Value::Number(n) => match n.as_u64() {
            Some(n) => grouped(n as usize),
            None => format!("{:.4}", n.as_f64().unwrap_or(f64::NAN)),
        },
        Value::Array(items) if items.is_empty() => "none".into(),
        Value::Array(items) => {
            let parts: Vec<String> = items.iter().map(plain).collect();
            let nested = items.iter().any(Value::is_array);
            parts.join(if nested { " to " } else { " " })
        }
        Value::Object(_) => String::new(),
    }
}
