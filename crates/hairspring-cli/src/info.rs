//! `hairspring info`: describes the content of a file.

use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    input::{Units, print_notes},
    totals::grouped,
};
use clap::Parser;
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Body, Clip, Mesh, Part},
    groom::{Groom, Repairs},
};
use hairspring_io::{
    ErrorKind, Format, Motion, ReadOptions, SkinDistance, bytes_of, pc2, read_body, read_bones, read_groom,
    read_motion, read_scene,
};
use hairspring_scene::{Guides, Scene, VertexCache};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Describes the content of a groom, body, motion or scene file, in meters, Y up.
///
/// For a groom, `repaired` counts what was fixed while reading: points that were not finite, segments of zero
/// length, strands of fewer than three points, and radii that were not above 0. `length_m` is the length of
/// the shortest, the median and the longest strand.
///
/// `joint_positions_m` are the joints of a body at rest, or of a motion in its first frame, and
/// `part_bounds_m` two corners of the box around each part, in the order of `joints` and `parts`. For the
/// grooms of a scene with a body, `root_distance_m` is the median and the largest distance of a root from the
/// skin. `simulated` is the number of strands of a groom that are simulated. A point cache has no unit, so
/// `bounds_file_units` is the box around all its samples as it is.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring info head.hair
  hairspring info ponytail.tfx --scale 0.0025 --json
  hairspring info robot.glb")]
pub struct Options {
    /// A groom (.hair, .tfx, .data, .csv, .ply, or lines in .obj, .glb and .gltf), body (.glb, .gltf, .vrm, .obj, .tfxmesh),
    /// motion (.bvh), point cache (.pc2), bones (.tfxbone) or scene (.toml); .usd and .abc with the Python package
    #[arg(value_name = "FILE")]
    file: PathBuf,

    #[command(flatten)]
    units: Units,

    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// The curves and the meshes of a USD or Alembic file.
fn external(path: &Path, units: &ReadOptions, console: Console) -> Result<Value, Fault> {
    let mut found = json!({});
    let hair = read_groom(path, units).map(|loaded| {
        print_notes(&loaded.notes, console);
        found["groom"] = groom(&loaded.value, &loaded.repairs);
    });
    let mesh = read_body(path, units).map(|loaded| {
        print_notes(&loaded.notes, console);
        found["body"] = body(&loaded.value.body);
    });
    match (hair, mesh) {
        (Err(why), Err(_)) => return Err(Fault::reading(why, path)),
        (Err(why), _) | (_, Err(why)) if why.kind() == ErrorKind::Unsupported => console.note(why),
        (Err(why), _) | (_, Err(why)) => return Err(Fault::reading(why, path)),
        _ => {}
    }
    Ok(found)
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let path = &options.file;
    let units = ReadOptions::from(options.units);
    let wrong = |e| Fault::reading(e, path);
    let format = Format::of(path).ok_or_else(|| {
        Fault::Usage(format!(
            "{}: unknown extension; expected .hair, .tfx, .data, .glb, .gltf, .vrm, .obj, .tfxmesh, .tfxbone, .bvh, .csv, .ply, .pc2, .usd, .abc or .toml",
            path.display()
        ))
    })?;
    if options.units.reverse && !Format::GROOMS.contains(&format) {
        return Err(Fault::Usage("--reverse applies to a groom file (.hair, .tfx, .data)".into()));
    }
    let has_unit = options.units.scale.is_some() || options.units.up.is_some();
    if has_unit && matches!(format, Format::Pc2 | Format::TfxBone) {
        let text = format!(
            "--scale and --up do not apply to a .{} file, which is described in its own unit",
            format.name()
        );
        return Err(Fault::Usage(text));
    }
    let mut found = match format {
        Format::Hair | Format::Tfx | Format::Usc | Format::Csv | Format::Ply => {
            let mut loaded = read_groom(path, &units).map_err(wrong)?;
            print_notes(&loaded.notes, console);
            if options.units.reverse {
                loaded.value.reverse();
            }
            groom(&loaded.value, &loaded.repairs)
        }
        Format::Usd | Format::Alembic => external(path, &units, console)?,
        Format::Pc2 => {
            let data = bytes_of(path).map_err(wrong)?;
            let cache = pc2::parse(&data).map_err(|p| wrong(p.in_file(path)))?;
            let mut positions = cache.samples.iter().flatten();
            let first = positions.next().map(|first| (*first, *first));
            let box_of_all =
                first.map(|first| positions.fold(first, |(low, high), p| (low.min(*p), high.max(*p))));
            json!({
                "samples": cache.samples.len(),
                "points": cache.samples.first().map_or(0, Vec::len),
                "first_frame": cache.first_frame,
                "frames_per_sample": cache.frames_per_sample,
                "bounds_file_units": bounds(box_of_all),
            })
        }
        Format::Gltf | Format::Obj | Format::TfxMesh => match read_body(path, &units) {
            Ok(loaded) => {
                print_notes(&loaded.notes, console);
                let mut found = body(&loaded.value.body);
                found["motions"] = loaded.value.clips.iter().map(clip).collect();
                found
            }
            // A file of lines is a groom.
            Err(why) => {
                let loaded = read_groom(path, &units).map_err(|_| wrong(why))?;
                print_notes(&loaded.notes, console);
                groom(&loaded.value, &loaded.repairs)
            }
        },
        Format::Bvh => {
            let loaded = read_motion(path, None, &units).map_err(wrong)?;
            print_notes(&loaded.notes, console);
            let Motion { joints, clip: motion } = loaded.value;
            let mut found = clip(&motion);
            let skeleton = Body { joints, ..Body::default() };
            let first = motion.samples.get(..motion.joint_count).unwrap_or_default();
            found["joints"] = names(&skeleton);
            found["joint_positions_m"] = positions(&skeleton.world(first));
            found
        }
        Format::TfxBone => {
            let bones = read_bones(path).map_err(wrong)?;
            json!({ "strands": bones.bones.len(), "joints": bones.names })
        }
        Format::Scene => {
            options.units.refuse_for_scene()?;
            let loaded = read_scene(path).map_err(wrong)?;
            print_notes(&loaded.notes, console);
            scene(&loaded.value, &loaded.repairs)
        }
    };
    let mut all = json!({ "format": format.name() });
    if let (Value::Object(all), Value::Object(found)) = (&mut all, &mut found) {
        all.append(found);
    }
    match options.json {
        true => print_json(&all),
        false => lines(path, &all),
    }
    Ok(())
}

fn groom(groom: &Groom, repairs: &Repairs) -> Value {
    let counts = || (0..groom.strand_count()).map(|s| groom.range(s).len());
    let mut lengths: Vec<f32> = (0..groom.strand_count()).map(|s| groom.strand_length(s)).collect();
    lengths.sort_by(f32::total_cmp);
    let middle = lengths.get(lengths.len() / 2);
    let length = middle.map(|middle| [lengths[0], *middle, lengths[lengths.len() - 1]]);
    json!({
        "strands": groom.strand_count(),
        "points": groom.point_count(),
        "points_min": counts().min(),
        "points_max": counts().max(),
        "length_m": length,
        "bounds_m": bounds(groom.bounds()),
        "repaired": repairs.total(),
        "groups": groom.groups.iter().max().map_or(1, |g| u32::from(*g) + 1),
        "guides": if groom.guides.is_empty() { 0 } else { Guides::FromGroom.simulated(groom).len() },
        "colors": !groom.colors.is_empty(),
    })
}

fn names(body: &Body) -> Value {
    body.joints.iter().map(|j| j.name.as_str()).collect()
}

/// Positions of joints with these transforms [m].
fn positions(world: &[Affine3A]) -> Value {
    world.iter().map(|w| json!(w.translation.to_array())).collect()
}

/// Boxes around the parts of a mesh [m].
fn part_bounds(mesh: &Mesh) -> Value {
    let of_part = |part: &Part| {
        let triangles = &mesh.triangles[part.triangles.start as usize..part.triangles.end as usize];
        let mut corners = triangles.iter().flatten().map(|v| mesh.positions[*v as usize]);
        let first = corners.next()?;
        Some(corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
    };
    mesh.parts.iter().map(|part| bounds(of_part(part))).collect()
}

fn body(body: &Body) -> Value {
    let parts: Vec<&str> = body.mesh.parts.iter().map(|p| p.name.as_str()).collect();
    json!({
        "vertices": body.mesh.positions.len(),
        "triangles": body.mesh.triangles.len(),
        "bounds_m": bounds(body.mesh.bounds()),
        "skinned": body.skin.is_some(),
        "parts": parts,
        "part_bounds_m": part_bounds(&body.mesh),
        "joints": names(body),
        "joint_positions_m": positions(&body.world(&body.rest_pose())),
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

fn vertex_motion(cache: &VertexCache) -> Value {
    json!({ "frames": cache.frames.len(), "rate_hz": cache.rate, "seconds": cache.duration() })
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
            if let Some(body) = &scene.body {
                let distance = SkinDistance::of(&g.groom, &body.mesh);
                found["root_distance_m"] = json!(distance.map(|d| [d.median, d.max]));
            }
            found["simulated"] = json!(g.guides.simulated(&g.groom).len());
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
        "motion": scene.clip.as_ref().map(clip).or_else(|| scene.vertex_cache.as_ref().map(vertex_motion)),
        "colliders": scene.colliders.len() + scene.sheets.len() + usize::from(scene.collision.is_some()),
        "substeps": scene.solver.substeps,
    })
}

fn bounds(bounds: Option<(Vec3, Vec3)>) -> Value {
    json!(bounds.map(|(low, high)| [low.to_array(), high.to_array()]))
}

/// Prints the figures as lines of `name value`, with groups indented under their name.
fn lines(path: &Path, all: &Value) {
    print_line(path.display());
    show(all, 1);
}

fn show(value: &Value, depth: usize) {
    let Value::Object(fields) = value else { return };
    for (name, value) in fields {
        // Lists with one entry for each joint or part are printed with the names, one a line.
        let named = match name.as_str() {
            "joint_positions_m" => fields.get("joints"),
            "part_bounds_m" => fields.get("parts"),
            _ => None,
        };
        if let (Some(Value::Array(names)), Value::Array(items)) = (named, value) {
            if !names.is_empty() {
                print_line(format_args!("{:indent$}{}", "", name.replace('_', " "), indent = 2 * depth));
            }
            for (name, item) in names.iter().zip(items) {
                print_line(format_args!(
                    "{:indent$}{:<24} {}",
                    "",
                    plain(name),
                    plain(item),
                    indent = 2 * depth + 2
                ));
            }
            continue;
        }
        let label = format!("{:indent$}{:<12}", "", name.replace('_', " "), indent = 2 * depth);
        match value {
            Value::Object(_) => {
                print_line(label.trim_end());
                show(value, depth + 1);
            }
            Value::Array(items) if items.iter().any(Value::is_object) => {
                for (i, item) in items.iter().enumerate() {
                    print_line(format_args!("{:indent$}{name} {}", "", i + 1, indent = 2 * depth));
                    show(item, depth + 1);
                }
            }
            _ => print_line(format_args!("{label} {}", plain(value))),
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
