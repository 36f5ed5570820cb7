//! Promise: a scene file either gives the scene that it describes, or one sentence that says where it is wrong.
//!
//! People write scene files by hand, so the reader's answer to a slip is part of the format: the line, what stands
//! there, what would have been right, and for a misspelt word the word that was meant. The page that documents the fields
//! is read here too, so that it can not fall behind the reader.

mod common;

use common::data;
use glam::Vec3;
use hairspring::{
    body::{Body, Clip},
    groom::Groom,
    scene::{Guides, Neighbours, Scene, Shape, Volume, VolumeMethod},
};
use hairspring_io::{Error, ErrorKind, Loaded, read_scene, scene::check_text, write_groom};
use std::{fs, path::Path};
use tempfile::TempDir;

/// A folder with a groom `hair.data` and a mesh `head.obj`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let strands =
        (0..5).map(|i| (0..4).map(|k| Vec3::new(0.1 * i as f32, 0.1 * k as f32, 0.0)).collect::<Vec<_>>());
    write_groom(&folder.path().join("hair.data"), &Groom::from_strands(strands, 4e-5)).unwrap();
    let mesh = "g scalp\nv 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3\ng neck\nf 1 3 4\n";
    fs::write(folder.path().join("head.obj"), mesh).unwrap();
    let nod = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Yrotation Xrotation\nJOINT Head\n{\nOFFSET 0 0.6 0\n\
               CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 0.2 0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.02\n\
               0 0 0 0 0 0\n0 0 0 0 10 0\n0 0 0 0 20 0\n";
    fs::write(folder.path().join("nod.bvh"), nod).unwrap();
    folder
}

fn read(folder: &Path, text: &str) -> Result<Loaded<Scene>, Error> {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    read_scene(&path)
}

/// The message for a scene, without the folder's name.
fn message(text: &str) -> String {
    let folder = folder();
    let error = read(folder.path(), text).expect_err(text);
    error.to_string().replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn a_scene_is_what_its_file_describes() {
    let folder = folder();
    let text = r#"
        gravity = [0, -1.6, 0]
        [body]
        file = "head.obj"
        scale = 1
        parts = ["scalp"]
        color = [0.1, 0.2, 0.3]
        [[groom]]
        file = "hair.data"
        scale = 2
        transform = { position = [0, 0, 1], rotation = [0, 90, 0], scale = [1, 1, -1] }
        material = ["mine", "coily"]
        guides = 3
        [material.mine]
        preset = "curly"
        friction = 0.5
        mass_profile = [1, 1.5, 4]
        [[collider]]
        shape.sphere = { center = [0, 0, 0], radius = 0.5 }
        [[collider]]
        shape.plane = { point = [0, -1, 0], normal = [0, 2, 0] }
        [[collider]]
        shape.box = { center = [0, 1, 0], size = [0.2, 0.4, 0.6], rotation = [0, 90, 0] }
        [wind]
        velocity = [1, 0, 0]
        [volume]
        method = "incompressible"
        cell = 0.02
        [neighbours]
        on = true
        thickness = 0.004
        stiction = 2e-6
    "#;
    let Loaded { value: scene, notes, .. } = read(folder.path(), text).unwrap();
    assert_eq!((scene.name.as_str(), scene.gravity), ("scene", Vec3::new(0.0, -1.6, 0.0)));
    assert!(notes.is_empty(), "{notes:?}");
    let body = scene.body.as_ref().unwrap();
    assert_eq!((body.mesh.triangles.len(), body.mesh.positions.len()), (1, 3));
    assert_eq!(body.mesh.parts[0].color, Vec3::new(0.1, 0.2, 0.3));
    let groom = &scene.grooms[0];
    assert_eq!((groom.guides, groom.groom.strand_count()), (Guides::Count(3), 5));
    // 0.1 → 0.2 m a strand along x, turned by 90° about Y to −z, then moved.
    assert!(
        groom.groom.strand(1)[0].distance(Vec3::new(0.0, 0.0, 0.8)) < 1e-6,
        "{}",
        groom.groom.strand(1)[0]
    );
    let curly = hairspring::material::preset("curly").unwrap();
    assert_eq!((groom.materials[0].bend, groom.materials[0].friction), (curly.bend, 0.5));
    assert_eq!(groom.materials[0].mass_profile, [1.0, 1.5, 4.0]);
    assert_eq!(groom.materials[1], hairspring::material::preset("coily").unwrap());
    assert!(matches!(scene.colliders[0].shape, Shape::Sphere { radius: 0.5, .. }));
    let floor = Shape::Plane { point: Vec3::NEG_Y, normal: Vec3::Y * 2.0 };
    assert_eq!(scene.colliders[1].shape, floor);
    // Turned by 90° about Y, its 0.6 m lie along x.
    let shelf = scene.colliders[2].shape.obstacle();
    for (at, distance) in [(Vec3::new(0.31, 1.0, 0.0), 0.01), (Vec3::new(0.0, 1.0, 0.09), -0.01)] {
        assert!((shelf.distance(at) - distance).abs() < 1e-6, "{} at {at}", shelf.distance(at));
    }
    assert_eq!(scene.solver, Default::default());
    let volume = Volume { method: VolumeMethod::Incompressible, cell: Some(0.02), ..Volume::default() };
    assert_eq!(scene.volume, volume);
    let neighbours = Neighbours { on: true, thickness: Some(0.004), stiction: 2e-6, ..Neighbours::default() };
    assert_eq!(scene.neighbours, neighbours);
}

#[test]
fn a_head_joint_drives_a_bust() {
    let folder = folder();
    let text = "[body]\nfile = \"head.obj\"\n[[groom]]\nfile = \"hair.data\"\n\
                [clip]\nfile = \"nod.bvh\"\njoint = \"head\"\npivot = [0.5, 0, 0]\nstart = 1\n";
    let scene = read(folder.path(), text).unwrap().value;
    let clip: &Clip = scene.clip.as_ref().unwrap();
    assert_eq!((clip.joint_count, clip.frame_count()), (1, 2));
    // Relative to the first used frame; about X, as in the file, whatever the order of channels.
    let want = glam::Quat::from_rotation_x(10f32.to_radians());
    assert!(clip.samples[0].rotation.dot(glam::Quat::IDENTITY).abs() > 0.999999);
    assert!(clip.samples[1].rotation.dot(want).abs() > 0.999999, "{}", clip.samples[1].rotation);
    let body: &Body = scene.body.as_ref().unwrap();
    assert_eq!(body.joints.len(), 1);
}

#[test]
fn slips_are_named_with_their_line_and_the_word_that_was_meant() {
    const GROOM: &str = "[[groom]]\nfile = \"hair.data\"\n";
    for (text, parts) in [
        (format!("{GROOM}giudes = 3\n"), &["scene.toml, line 3", "`giudes`", "did you mean `guides`?"][..]),
        (format!("[solver]\nsubstep = 3\n{GROOM}"), &["line 2", "did you mean `substeps`?"]),
        (format!("[slover]\n{GROOM}"), &["line 1", "did you mean `solver`?"]),
        (format!("{GROOM}[volume]\nmethod = \"densty\"\n"), &["line 4", "did you mean `density`?"]),
        (format!("{GROOM}[volume]\ncell = 0\n"), &["line 4", "`cell` must be above 0 [m]"]),
        (format!("{GROOM}[volume]\nfriction = -1\n"), &["line 4", "`friction` must be 0 or more [1/s]"]),
        (format!("{GROOM}[neighbours]\nthickness = 0\n"), &["line 4", "`thickness` must be above 0 [m]"]),
        (format!("{GROOM}[neighbours]\nregain = -1\n"), &["line 4", "`regain` must be 0 or more [1/s]"]),
        (format!("{GROOM}[neighbours]\nfriction = 2\n"), &["line 4", "`friction` must be 0 to 1"]),
        (format!("{GROOM}[neighbours]\nstiction = -1\n"), &["line 4", "`stiction` must be 0 or more [N]"]),
        (
            format!("{GROOM}[material.a]\npreset = \"wavvy\"\n")
                .replace("data\"\n", "data\"\nmaterial = \"a\"\n"),
            &["line 5", "did you mean `wavy`?"],
        ),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\n\nfrictoin = 1\n"),
            &["line 6", "did you mean `friction`?"],
        ),
        (format!("{GROOM}material = \"coly\"\n"), &["line 3", "did you mean `coily`?"]),
        (
            format!("{GROOM}guides = \"many\"\n"),
            &["line 3", "a number of guides above 0, \"all\" or \"file\""],
        ),
        (format!("{GROOM}look = {{ root_colour = [0, 0, 0] }}\n"), &["line 3", "did you mean `root_color`?"]),
        (format!("{GROOM}[solver]\nsubsteps = 0\n"), &["line 4", "1 to 64"]),
        (format!("{GROOM}[camera]\nfov = 200\n"), &["line 4", "1 to 170"]),
        (format!("{GROOM}material = \"a\"\n[material.a]\nfriction = 7\n"), &["line 5", "0 to 1"]),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nbend = 2\nmass_profile = [1, 0, 2]\n"),
            &["line 6", "`mass_profile` must be 1 to 64 numbers above 0"],
        ),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = [1, 101]\n"),
            &["line 5", "at most 100 times the smallest"],
        ),
        (format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = []\n"), &["line 5", "1 to 64"]),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = [{}]\n", ["1"; 65].join(", ")),
            &["line 5", "1 to 64"],
        ),
        (format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = [1, nan]\n"), &["line 5", "above 0"]),
        (format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = 3\n"), &["line 4", "sequence"]),
        (
            "[[groom]]\nfile = \"hiar.data\"\n".into(),
            &["hiar.data was not found", "the groom that", "line 2"],
        ),
        (
            format!("[body]\nfile = \"haed.obj\"\n{GROOM}"),
            &["haed.obj was not found", "the body that", "line 2"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\nparts = [\"sclap\"]\n{GROOM}"),
            &["line 3", "did you mean `scalp`?"],
        ),
        (format!("[body]\nfile = \"head.obj\"\nrig = \"x.json\"\n{GROOM}"), &["line 3", "`weights`"]),
        (format!("{GROOM}[clip]\nfile = \"nod.bvh\"\n"), &["line 4", "no [body]"]),
        (
            format!(
                "[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nfile = \"nod.bvh\"\njoint = \"Haed\"\npivot = [0, 0, 0]\n"
            ),
            &["line 7", "did you mean `Head`?"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nfile = \"nod.bvh\"\njoint = \"Head\"\n"),
            &["line 7", "`pivot`"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nfile = \"nod.bvh\"\n"),
            &["line 6", "no joint of the motion"],
        ),
        (format!("[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nname = \"dance\"\n"), &["line 6", "\"dance\""]),
        (
            format!("{GROOM}[[collider]]\nshape.box = {{ center = [0, 0, 0], size = [1, 0, 1] }}\n"),
            &["line 4", "edges above 0"],
        ),
        (
            format!(
                "{GROOM}[[collider]]\njoint = \"x\"\nshape.sphere = {{ center = [0, 0, 0], radius = 1 }}\n"
            ),
            &["line 4", "`x`"],
        ),
        (
            format!("{GROOM}[[collider]]\nshape.plane = {{ point = [0, 0, 0], normal = [0, 0, 0] }}\n"),
            &["line 4", "normal"],
        ),
        (format!("{GROOM}bones = \"x.tfxbone\"\n"), &["x.tfxbone was not found"]),
        ("name = \"empty\"\n".into(), &["scene.toml", "[[groom]]"]),
        ("gravity = [0, 1\n".into(), &["line 1"]),
    ] {
        let message = message(&text);
        println!("{message}");
        for part in parts {
            assert!(message.contains(part), "{text}\n gives\n{message}\nwithout {part:?}");
        }
        assert!(!message.contains('\n'), "one sentence: {message}");
    }
}

#[test]
fn missing_and_broken_files_differ_in_kind() {
    let folder = folder();
    fs::write(folder.path().join("broken.data"), b"\x05\0\0\0").unwrap();
    let kind = |file: &str| read(folder.path(), &format!("[[groom]]\nfile = {file:?}\n")).unwrap_err().kind();
    assert_eq!(kind("none.data"), ErrorKind::NotFound);
    assert_eq!(kind("broken.data"), ErrorKind::Malformed);
    assert_eq!(kind("head.obj"), ErrorKind::Unsupported);
    assert_eq!(read_scene(&folder.path().join("no.toml")).unwrap_err().kind(), ErrorKind::NotFound);
}

#[test]
fn the_page_that_documents_scenes_is_right() {
    let page = include_str!("../../../docs/scene.md");
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    check_text(example).unwrap();
    // The fields that stand in comments there, since they exclude others.
    check_text(
        &example
            .replace("# rig =", "rig =")
            .replace("# weights =", "weights =")
            .replace("# bones =", "bones ="),
    )
    .unwrap();
}

#[test]
fn bodies_of_several_files_and_hair_grown_on_them() {
    let folder = folder();
    let text = "[body]\nfile = \"head.obj\"\nscale = 1\nparts = [\"scalp\"]\n[[body.more]]\nfile = \"head.obj\"\nscale = 2\n\
                color = [0.1, 0.2, 0.3]\n[[groom]]\ngrow = { parts = [\"scalp\"], strands = 40, length = 0.2 }\n\
                thicken = { copies = 2, radius = 0.01 }\nmaterial = \"short-fur\"\n";
    let scene = read(folder.path(), text).unwrap().value;
    let mesh = &scene.body.as_ref().unwrap().mesh;
    assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.parts.len()), (3 + 4, 1 + 2, 1 + 2));
    assert_eq!(mesh.parts[2].triangles, 2..3);
    assert!(mesh.parts[0].color != mesh.parts[1].color);
    let groom = &scene.grooms[0].groom;
    assert_eq!((groom.strand_count(), groom.point_count()), (120, 120 * 16));
    assert_eq!(groom.guides[85].guides[0], 5);
    assert!(groom.radii.iter().all(|r| *r == 25e-6), "hair is drawn as thick as its material says");

    let wrong = |grow: &str| message(&format!("[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\n{grow}\n"));
    assert!(
        wrong("grow = { parts = [\"sclap\"] }")
            .contains("line 5: the part `sclap` is not known here; did you mean `scalp`?")
    );
    assert!(wrong("grow = { points = 2 }").contains("line 5: `points` must be 3 to 256"));
    assert!(
        wrong("grow = { inside.sphere = { center = [9, 9, 9], radius = 0.1 } }")
            .contains("no skin of the body")
    );
    assert!(wrong("file = \"hair.data\"\ngrow = {}").contains("needs `file` or `grow`, and not both"));
    assert!(wrong("guides = 3").contains("needs `file` or `grow`"));
    assert!(message("[[groom]]\ngrow = {}\n").contains("`grow` needs a [body]"));
}

#[test]
fn the_page_leaves_no_setting_out() {
    let page = include_str!("../../../docs/scene.md");
    let material = hairspring::material::Material { radius: Some(1.0), ..Default::default() };
    let volume = hairspring::scene::Volume { cell: Some(1.0), ..Default::default() };
    let neighbours = hairspring::scene::Neighbours { thickness: Some(1.0), ..Default::default() };
    for (name, fields) in [
        ("look", toml::Table::try_from(hairspring::scene::HairLook::default())),
        ("effects", toml::Table::try_from(hairspring::scene::Effects::default())),
        ("wind", toml::Table::try_from(hairspring::scene::Wind::default())),
        ("solver", toml::Table::try_from(hairspring::scene::Solver::default())),
        ("volume", toml::Table::try_from(volume)),
        ("neighbours", toml::Table::try_from(neighbours)),
        ("camera", toml::Table::try_from(hairspring::scene::Camera::default())),
        ("material", toml::Table::try_from(material)),
    ] {
        for key in fields.unwrap().keys() {
            assert!(page.contains(&format!("\n{key} = ")), "docs/scene.md does not show `{key}` of {name}");
        }
    }
}

#[test]
fn the_mohawk_binds_to_skin_that_follows_its_bones() {
    let Some(groom) = data("grooms/tressfx_mohawk/Ratboy_mohawk.tfx") else { return };
    let folder = folder();
    let text = format!(
        "[body]\nfile = {body:?}\n[[groom]]\nfile = {groom:?}\nbones = {bones:?}\n",
        body = groom.with_file_name("Ratboy_body.tfxmesh"),
        bones = groom.with_file_name("Ratboy_mohawk.tfxbone"),
    );
    let Loaded { value: scene, repairs, .. } = read(folder.path(), &text).unwrap();
    assert!(repairs.zero_segments > 0, "{repairs:?}");
    let (groom, body) = (&scene.grooms[0].groom, scene.body.as_ref().unwrap());
    assert_eq!(groom.roots.len(), 2_228);
    let mut off: Vec<f32> = groom.roots.iter().map(|r| r.offset.length()).collect();
    off.sort_by(f32::total_cmp);
    println!("roots off the skin: median {} m, worst {} m", off[1_114], off[2_227]);
    assert!(off[1_114] < 1e-3 && off[2_227] < 5e-3, "median {} m, worst {} m", off[1_114], off[2_227]);
    for (s, root) in groom.roots.iter().enumerate() {
        let back = root.position(body.mesh.corners(root.triangle as usize));
        assert!(back.distance(groom.strand(s)[0]) < 1e-6);
    }
}

#[test]
fn sintels_head_follows_a_walk_and_a_dab() {
    let Some(groom) = data("grooms/sintel/SintelHairOriginal-sintel_hair.16points.tfx") else { return };
    for motion in ["motion/cmu/02_01.bvh", "motion/animated_drawings/dab.bvh"] {
        let folder = folder();
        let text = format!(
            "[body]\nfile = {body:?}\n[collision]\nfile = {collision:?}\n[[groom]]\nfile = {groom:?}\n\
             [clip]\nfile = {motion:?}\njoint = \"Head\"\npivot = [0, 1.45, 0]\nstart = 1\n",
            body = groom.with_file_name("sintel.obj"),
            collision = groom.with_file_name("sintel-collider.obj"),
            motion = data(motion).unwrap(),
        );
        let Loaded { value: scene, notes, .. } = read(folder.path(), &text).unwrap();
        println!("{notes:?}");
        let (body, clip) = (scene.body.unwrap(), scene.clip.unwrap());
        assert_eq!((body.joints.len(), clip.joint_count), (1, 1));
        assert_eq!(scene.collision.unwrap().joints, body.joints);
        let (mut tilt, mut away) = (0.0f32, 0.0f32);
        for sample in &clip.samples {
            tilt = tilt.max(sample.rotation.angle_between(glam::Quat::IDENTITY).to_degrees());
            away = away.max(sample.to_affine().transform_point3(Vec3::Y * 1.45).distance(Vec3::Y * 1.45));
        }
        println!("{motion}: turns up to {tilt:.0} degrees, moves up to {away:.2} m");
        assert!((5.0..175.0).contains(&tilt) && (0.005..0.6).contains(&away), "{tilt} degrees, {away} m");
    }
}

#[test]
fn the_cmu_rig_walks() {
    let Some(base) = data("characters/makehuman/base.obj") else {
        return;
    };
    let walk = data("motion/cmu/02_01.bvh").unwrap();
    let folder = folder();
    let text = format!(
        "[body]\nfile = {base:?}\nrig = {rig:?}\nweights = {weights:?}\nparts = [\"body\"]\n\
         [clip]\nfile = {walk:?}\nstart = 1\n[[groom]]\nfile = \"hair.data\"\n",
        rig = base.with_file_name("rig.cmu_mb.json"),
        weights = base.with_file_name("weights.cmu_mb.json"),
    );
    let Loaded { value: scene, notes, .. } = read(folder.path(), &text).unwrap();
    println!("{notes:?}");
    let (body, clip) = (scene.body.unwrap(), scene.clip.unwrap());
    assert_eq!((body.mesh.positions.len(), body.joints.len()), (13_380, 31));
    let (lo, hi) = body.mesh.bounds().unwrap();
    assert!((1.5..1.9).contains(&(hi.y - lo.y)), "{lo} {hi}");
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    let head = body.joint("Head").unwrap();
    let mut last = None;
    for f in (0..clip.frame_count()).step_by(20) {
        let world = body.world(&clip.sample(f as f32 / clip.rate));
        body.skinned(&world, &mut positions, &mut normals);
        let (lo, hi) =
            positions.iter().fold((positions[0], positions[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        // Upright, on the floor where the rest pose stands, arms down, one stride long.
        let floor = body.mesh.bounds().unwrap().0.y;
        println!("frame {f}: {lo} {hi} head {}", world[head].translation);
        assert!((lo.y - floor).abs() < 0.12, "frame {f}: lowest {} over a floor at {floor}", lo.y);
        assert!((1.45..1.85).contains(&(hi.y - lo.y)), "frame {f}: {lo} {hi}");
        assert!(hi.x - lo.x < 1.2 && hi.z - lo.z < 1.3, "frame {f}: {lo} {hi}");
        last = Some(world[head].translation);
    }
    // It walks along +Z, as the capture does.
    assert!(last.unwrap().z > 1.0, "{}", last.unwrap());
}
