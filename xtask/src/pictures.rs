//! Draws the pictures of the book with the program, from the table `docs/pictures.toml`: scenes as they are,
//! and each parameter of a scene at a low and at a high value.
//!
//! ```text
//! [[scene]]                             [[parameter]]
//! file = "examples/scenes/fan.toml"    name = "material.bend"           where the change goes, see `set`
//! picture = "gallery/fan"              scene = "rail"                   of docs/parameters/scenes
//! frame = 90                           frame = 30                       at 30 frames per second
//! data = true  (third-party files)
//! card = true  (drawn with --gpu)      low = 0.5                        any value of TOML
//! groom = "groom.toml"  (see           high = 8.0
//! motion = "head.bvh"    `prepared`)   with = { "wind.gust" = 1.0 }     optional changes in both
//! ```

use crate::run;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};
use toml::{Table, Value};

const TABLE: &str = "docs/pictures.toml";

/// Folder for scenes with one change. It is as deep as that of the original scenes, so that relative paths
/// still work.
const CHANGED: &str = "out/pictures/scenes";

/// Draws the pictures whose name contains `part`.
pub fn draw(part: &str) -> Result<(), String> {
    let table = read(Path::new(TABLE))?;
    let program = program()?;
    fs::create_dir_all(CHANGED).map_err(|why| format!("{CHANGED}: {why}"))?;
    for entry in entries(&table, "scene") {
        let (file, picture) = (word(entry, "file")?, word(entry, "picture")?);
        // Scenes of third-party hair may be next to the checkout.
        if entry.get("data").is_some() && !Path::new("../shared/data").exists() {
            println!("{picture}: skipped, the data that {file} names is not here");
        } else if picture.contains(part) {
            let card = entry.get("card").and_then(Value::as_bool).unwrap_or(false);
            let file = prepared(&program, Path::new(file), entry)?;
            render(&program, &file, picture, frame(entry)?, "640x480", card)?;
        }
    }
    for entry in entries(&table, "parameter") {
        let (name, scene) = (word(entry, "name")?, word(entry, "scene")?);
        if !name.contains(part) {
            continue;
        }
        let base = read(Path::new(&format!("docs/parameters/scenes/{scene}.toml")))?;
        for side in ["low", "high"] {
            let value = entry.get(side).ok_or(format!("{TABLE}: {name} has no `{side}`"))?;
            let mut changed = base.clone();
            for (also, value) in entry.get("with").and_then(Value::as_table).into_iter().flatten() {
                set(&mut changed, also, value)?;
            }
            set(&mut changed, name, value)?;
            let from = Path::new(CHANGED).join(format!("{name}-{side}.toml"));
            fs::write(&from, changed.to_string()).map_err(|why| format!("{}: {why}", from.display()))?;
            let picture = format!("parameters/{name}-{side}");
            render(&program, &from, &picture, frame(entry)?, "320x240", false)?;
        }
    }
    Ok(())
}

/// Builds the program, or uses the one that the environment variable names.
fn program() -> Result<PathBuf, String> {
    if let Some(built) = std::env::var_os("HAIRSPRING") {
        return Ok(built.into());
    }
    run::cargo(&["build", "--release"], &[])?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or("target".into(), PathBuf::from);
    Ok(target.join("release").join(format!("hairspring{}", std::env::consts::EXE_SUFFIX)))
}

/// The file of a scene, ready to be drawn. If the entry names a groom scene, the tutorial's first step is done:
/// in a folder as deep as that of the scene, the groom is baked and the motion is copied.
fn prepared(program: &Path, scene: &Path, entry: &Table) -> Result<PathBuf, String> {
    if entry.get("groom").is_none() {
        return Ok(scene.to_owned());
    }
    let folder = Path::new("out/shot");
    fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    let copy = |from: &Path| {
        let to = folder.join(from.file_name().unwrap_or_default());
        fs::copy(from, &to).map_err(|why| format!("{}: {why}", from.display())).map(|_| to)
    };
    copy(Path::new(word(entry, "motion")?))?;
    let groom = copy(Path::new(word(entry, "groom")?))?;
    let status = Command::new(program)
        .args(["--quiet", "bake", "--frames", "1", "-o"])
        .args([&folder.join("groom.####.hair"), &groom])
        .stdout(Stdio::null())
        .status();
    match status {
        Ok(status) if status.success() => copy(scene),
        Ok(status) => Err(format!("{}: the program ended with {status}", groom.display())),
        Err(why) => Err(format!("{}: {why}", program.display())),
    }
}

/// Draws one frame of a scene as a picture of the book, on the CPU or on the GPU.
fn render(
    program: &Path,
    scene: &Path,
    picture: &str,
    frame: i64,
    size: &str,
    card: bool,
) -> Result<(), String> {
    let to = PathBuf::from(format!("docs/pictures/{picture}.jpg"));
    let folder = to.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    let status = Command::new(program)
        .args(["--quiet", "render", "--size", size, "--frames", &frame.to_string(), "-o"])
        .arg(&to)
        .arg(scene)
        .args(card.then_some("--gpu"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status();
    match status {
        Ok(status) if status.success() => {
            let bytes = fs::metadata(&to).map_err(|why| format!("{}: {why}", to.display()))?.len();
            println!("{}: {:.1} kB", to.display(), bytes as f64 / 1e3);
            Ok(())
        }
        Ok(status) => Err(format!("{}: the program ended with {status}", scene.display())),
        Err(why) => Err(format!("{}: {why}", program.display())),
    }
}

/// Sets a parameter by its name in the book: keys separated by dots. Missing tables are created. In an array
/// of tables the parameter is set in each of them. In the same way it is set in every material, whatever its
/// name is.
fn set(scene: &mut Table, name: &str, value: &Value) -> Result<(), String> {
    if let Some(field) = name.strip_prefix("material.") {
        let materials = scene.get_mut("material").and_then(Value::as_table_mut);
        let materials = materials.ok_or(format!("{name}: the scene has no material"))?;
        return materials.iter_mut().try_for_each(|(_, material)| set_in(material, field, value));
    }
    let (first, rest) = name.split_once('.').unwrap_or((name, ""));
    match rest {
        "" => {
            scene.insert(name.into(), value.clone());
            Ok(())
        }
        _ => set_in(scene.entry(first).or_insert(Value::Table(Table::new())), rest, value),
    }
}

/// Like [`set`], below a value of the scene.
fn set_in(place: &mut Value, name: &str, value: &Value) -> Result<(), String> {
    match place {
        Value::Table(table) => set(table, name, value),
        Value::Array(tables) => tables.iter_mut().try_for_each(|table| set_in(table, name, value)),
        _ => Err(format!("{name}: there is a value where a table should be")),
    }
}

fn read(file: &Path) -> Result<Table, String> {
    let text = fs::read_to_string(file).map_err(|why| format!("{}: {why}", file.display()))?;
    text.parse().map_err(|why| format!("{}: {why}", file.display()))
}

fn entries<'a>(table: &'a Table, kind: &str) -> impl Iterator<Item = &'a Table> {
    table.get(kind).and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table)
}

fn word<'a>(entry: &'a Table, key: &str) -> Result<&'a str, String> {
    entry.get(key).and_then(Value::as_str).ok_or(format!("{TABLE}: an entry has no `{key}`"))
}

fn frame(entry: &Table) -> Result<i64, String> {
    entry.get("frame").and_then(Value::as_integer).ok_or(format!("{TABLE}: an entry has no `frame`"))
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_change_is_written_to_every_table_of_its_name() {
        let mut scene =
            "[[groom]]\nguides = 1\n[[groom]]\n[material.a]\npreset = \"wavy\"\n".parse().unwrap();
        for (name, value) in [("groom.look.shadow", 2.0), ("material.bend", 3.0), ("wind.gust", 0.5)] {
            super::set(&mut scene, name, &value.into()).unwrap();
        }
        let looks = scene["groom"].as_array().unwrap();
        assert!(looks.iter().all(|groom| groom["look"]["shadow"].as_float() == Some(2.0)));
        assert_eq!(scene["material"]["a"]["bend"].as_float(), Some(3.0));
        assert_eq!(scene["wind"]["gust"].as_float(), Some(0.5));
        assert!(super::set(&mut scene, "wind.gust.rate", &1.0.into()).is_err());
    }
}
