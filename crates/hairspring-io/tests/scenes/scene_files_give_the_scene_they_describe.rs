//! Promise: a scene file gives the scene that it describes.
//!
//! This includes the files that it refers to, some of them real data. Invalid combinations are refused with
//! a one-sentence error.

use crate::scenes::{folder, message, read};
use glam::Vec3;
use hairspring::{
    air::{Flow, Turbulence, WindOcclusion, WindSource},
    body::{Body, Clip},
    forces::{Manipulator, comb::Comb, tie::Tie},
    math::angle_between,
    settings::{Neighbours, Volume, VolumeMethod},
};
use hairspring_io::Loaded;
use hairspring_scene::{
    Guides, Hand, Shape,
    stage::{FrameRate, Stage},
};
use hairspring_test::data;
use std::fs;

#[test]
fn scene_files_give_the_scene_they_describe() {
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
        [[wind_source]]
        gust = 0.5
        shape.fan = { center = [0, 0, 1], axis = [0, 0, -1], radius = 0.1, speed = 3 }
        [turbulence]
        strength = 0.4
        [wind_occlusion]
        hair = 50
        [[charged]]
        center = [0, 1, 0]
        radius = 0.1
        charge = -1e-7
        path = [{ time = 2, center = [1, 1, 0] }]
        [volume]
        method = "incompressible"
        cell = 0.02
        [neighbours]
        on = true
        radius = 0.002
        [[hand]]
        tool.tie = { center = [0, 1, 0], axis = [0, -1, 0], radius = 0.01, reach = 0.1 }
        [[hand]]
        tool.comb = { a = [0, 0, 0], b = [0.1, 0, 0], radius = 0.02, grip = 400 }
        joint = "root"
        path = [[0, 0, 0, 0], [2, 0, -0.4, 0]]
        until = 2
    "#;
    let Loaded { value: scene, notes, .. } = read(folder.path(), text).unwrap();
    assert_eq!((scene.name.as_str(), scene.gravity), ("scene", Vec3::new(0.0, -1.6, 0.0)));
    // The transform of the groom moves the roots away from the skin. The file has one group. Strand contact and a tie are both on.
    assert!(notes.len() == 3 && notes[0].contains("from the skin"), "{notes:?}");
    assert!(notes[1].contains("1 group and `material` names 2 materials"), "{notes:?}");
    assert!(notes[2].contains("out of the ring of a tie"), "{notes:?}");
    let body = scene.body.as_ref().unwrap();
    assert_eq!((body.mesh.triangles.len(), body.mesh.positions.len()), (1, 3));
    assert_eq!(body.mesh.parts[0].color, Vec3::new(0.1, 0.2, 0.3));
    let groom = &scene.grooms[0];
    assert_eq!((groom.guides, groom.groom.strand_count()), (Guides::Count(3), 5));
    // A strand at x = 0.1 m is scaled to 0.2 m, rotated by 90° about Y to −z, then translated.
    assert!(
        groom.groom.strand(1)[0].distance(Vec3::new(0.0, 0.0, 0.8)) < 1e-6,
        "{}",
        groom.groom.strand(1)[0]
    );
    let curly = hairspring::material::preset("curly").unwrap();
    assert_eq!((groom.materials[0].bend, groom.materials[0].friction), (curly.bend, 0.5));
    assert_eq!(groom.materials[0].mass_profile, [1.0, 1.5, 4.0]);
    assert_eq!(groom.materials[1], hairspring::material::preset("coily").unwrap());
    assert_eq!(scene.colliders[0].shape, Shape::Sphere { center: Vec3::ZERO, radius: 0.5 });
    let floor = Shape::Plane { point: Vec3::NEG_Y, normal: Vec3::Y * 2.0 };
    assert_eq!(scene.colliders[1].shape, floor);
    // The box is rotated by 90° about Y, so its edge of 0.6 m lies along x.
    let shelf = scene.colliders[2].shape.collider_shape().unwrap();
    for (at, distance) in [(Vec3::new(0.31, 1.0, 0.0), 0.01), (Vec3::new(0.0, 1.0, 0.09), -0.01)] {
        assert!((shelf.distance(at) - distance).abs() < 1e-6, "{} at {at}", shelf.distance(at));
    }
    assert_eq!(scene.solver, Default::default());
    let volume = Volume { method: VolumeMethod::Incompressible, cell: Some(0.02), ..Volume::default() };
    assert_eq!(scene.volume, volume);
    assert_eq!(scene.neighbours, Neighbours { on: true, radius: Some(0.002), ..Neighbours::default() });
    let (center, axis) = (Vec3::Y, Vec3::NEG_Y);
    let tie = Tie { center, axis, radius: 0.01, reach: 0.1, gather: 0.5, pull: 60.0, damping: 1.0 };
    assert_eq!(scene.hands[0], Hand::new(Manipulator::Tie(tie)));
    let comb = Comb { a: Vec3::ZERO, b: Vec3::X * 0.1, radius: 0.02, grip: 400.0, friction: 3.0 };
    assert_eq!(scene.hands[1].tool, Manipulator::Comb(comb));
    assert_eq!(scene.hands[1].moved(1.0), Vec3::NEG_Y * 0.2);
    let fan = Flow::Fan { center: Vec3::Z, axis: Vec3::NEG_Z, radius: 0.1, speed: 3.0, spread: 11.8 };
    let source = WindSource { joint: None, shape: fan, gust: 0.5, gust_rate: 0.0 };
    assert_eq!(scene.wind_sources, [source]);
    assert_eq!(scene.turbulence, Turbulence { strength: 0.4, ..Turbulence::default() });
    assert_eq!(scene.wind_occlusion, WindOcclusion { hair: 50.0, ..WindOcclusion::default() });
    let balloon = &scene.charged[0];
    assert_eq!((balloon.charge, balloon.solid), (-1e-7, true));
    assert_eq!(balloon.center(1.0), Vec3::new(0.5, 1.0, 0.0));
}

#[test]
fn a_head_joint_drives_a_bust() {
    let folder = folder();
    let text = "[body]\nfile = \"head.obj\"\n[[groom]]\nfile = \"hair.data\"\n\
                [clip]\nfile = \"nod.bvh\"\njoint = \"head\"\npivot = [0.5, 0, 0]\nstart = 1\n";
    let scene = read(folder.path(), text).unwrap().value;
    let clip: &Clip = scene.clip.as_ref().unwrap();
    assert_eq!((clip.joint_count, clip.frame_count()), (1, 2));
    // Rotations are relative to the first used frame. The nod is about X as in the file, whatever the order
    // of channels.
    let want = glam::Quat::from_rotation_x(10f32.to_radians());
    assert!(clip.samples[0].rotation.dot(glam::Quat::IDENTITY).abs() > 0.999999);
    assert!(
        clip.samples[1].rotation.dot(want).abs() > 0.999999,
        "the head turns by {}",
        clip.samples[1].rotation
    );
    let body: &Body = scene.body.as_ref().unwrap();
    assert_eq!(body.joints.len(), 1);
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
    assert!(groom.radii.iter().all(|r| *r == 25e-6), "the radius of grown hair differs from the material's");

    let wrong = |grow: &str| message(&format!("[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\n{grow}\n"));
    assert!(
        wrong("grow = { parts = [\"sclap\"] }")
            .contains("line 5: the part `sclap` is unknown; did you mean `scalp`?")
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
fn a_scene_can_extend_the_built_in_one() {
    let folder = folder();
    let text = "[builtin]\nstyle = \"short-fur\"\nstrands = 50\nguides = \"all\"\nmaterial = \"mine\"\n\
                [material.mine]\nfriction = 0.5\n[[groom]]\nfile = \"hair.data\"\n";
    let scene = read(folder.path(), text).unwrap().value;
    let hair = &scene.grooms[0];
    assert_eq!((hair.groom.strand_count(), hair.guides, hair.materials[0].friction), (50, Guides::All, 0.5));
    assert_eq!(scene.grooms.len(), 3, "expected the hair, the brows and the groom of the file");
    assert!(scene.clip.is_some() && scene.collision.is_some());
    // With keys, the body moves as one rigid piece, together with its collision mesh.
    let keyed = "[builtin]\nstrands = 50\n[clip]\npivot = [0, -0.1, 0]\n\
                 keys = [{ time = 0.5 }, { time = 1, position = [0, 0.2, 0], rotation = [0, 90, 0] }]\n";
    let scene = read(folder.path(), keyed).unwrap().value;
    let (clip, body) = (scene.clip.unwrap(), scene.body.unwrap());
    assert_eq!((clip.joint_count, body.joints.len(), clip.frame_count()), (1, 1, 61));
    assert_eq!(scene.collision.unwrap().joints.len(), 1);
    let still = read(folder.path(), "[builtin]\nstrands = 50\nmotion = false\n").unwrap().value;
    assert!(still.clip.is_none() && still.camera.is_some());
    // The camera of the portrait would cut off hair that is blown, thrown or added.
    let grown = "[[groom]]\ngrow = { strands = 10 }\n";
    for more in [grown, "[wind]\nvelocity = [1, 0, 0]\n", "[clip]\nkeys = [{ time = 1 }, { time = 2 }]\n"] {
        let scene = read(folder.path(), &format!("[builtin]\nstrands = 50\n{more}")).unwrap().value;
        assert!(scene.camera.is_none(), "{more}");
    }
    let wrong = |text: &str| message(&format!("[builtin]\n{text}\n"));
    assert!(
        wrong("style = \"wavvy\"").contains("line 2: the style `wavvy` is unknown; did you mean `wavy`?")
    );
    assert!(wrong("strands = 10000001").contains("line 2: `strands` must be 0 to 10000000"));
    assert!(wrong("guides = \"file\"").contains("line 2: `guides` must be a number above 0 or \"all\""));
    assert!(wrong("material = \"wavvy\"").contains("line 2: the material `wavvy`"));
    assert!(wrong("[body]\nfile = \"head.obj\"").contains("has its own body"));
    let keys = |keys: &str| wrong(&format!("strands = 50\n[clip]\nkeys = {keys}"));
    assert!(keys("[{ time = 1 }, { time = 0.5 }]").contains("line 4: `keys` must be in order of `time`"));
    assert!(
        keys("[{ time = -1 }]").contains("line 4: `keys` must be in order of `time`, from 0 to 3600 [s]")
    );
    assert!(
        keys("[{ time = 1 }]\nfile = \"nod.bvh\"").contains("`keys` must be omitted if there is a `file`")
    );
    assert!(
        keys("[{ time = 1, rotation = [inf, 0, 0] }]").contains("line 4: `keys` must be of finite numbers")
    );
}

#[test]
fn mohawk_roots_bind_to_the_skin() {
    let Some(groom) = data("grooms/tressfx_mohawk/Ratboy_mohawk.tfx") else { return };
    let folder = folder();
    let text = format!(
        "[body]\nfile = {body:?}\n[[groom]]\nfile = {groom:?}\nbones = {bones:?}\n",
        body = groom.with_file_name("Ratboy_body.tfxmesh"),
        bones = groom.with_file_name("Ratboy_mohawk.tfxbone"),
    );
    let Loaded { value: scene, repairs, .. } = read(folder.path(), &text).unwrap();
    assert!(repairs.zero_segments > 0, "no segment of zero length was repaired: {repairs:?}");
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
            tilt = tilt.max(angle_between(sample.rotation, glam::Quat::IDENTITY).to_degrees());
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
    assert!((1.5..1.9).contains(&(hi.y - lo.y)), "the body extends from {lo} to {hi}");
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    let head = body.joint("Head").unwrap();
    let mut last = None;
    for f in (0..clip.frame_count()).step_by(20) {
        let world = body.world(&clip.sample(f as f64 / clip.rate));
        body.skinned(&world, &mut positions, &mut normals);
        let (lo, hi) =
            positions.iter().fold((positions[0], positions[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        // The body is upright, on the floor of the rest pose, with its arms down, and one stride long.
        let floor = body.mesh.bounds().unwrap().0.y;
        println!("frame {f}: {lo} {hi} head {}", world[head].translation);
        assert!((lo.y - floor).abs() < 0.12, "frame {f}: lowest {} over a floor at {floor}", lo.y);
        assert!((1.45..1.85).contains(&(hi.y - lo.y)), "frame {f}: {lo} {hi}");
        assert!(hi.x - lo.x < 1.2 && hi.z - lo.z < 1.3, "frame {f}: {lo} {hi}");
        last = Some(world[head].translation);
    }
    // The body walks along +Z, as in the capture.
    assert!(last.unwrap().z > 1.0, "the head ends at {}", last.unwrap());
}

#[test]
fn hulls_and_sheets_are_read_from_meshes_or_refused() {
    let folder = folder();
    let stone = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.1 0.1 0.1\nf 1 2 3\nf 1 3 4\n";
    fs::write(folder.path().join("stone.obj"), stone).unwrap();
    let text = "[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\nfile = \"hair.data\"\n\
                [[collider]]\nshape.hull = { file = \"stone.obj\", scale = 0.5 }\n\
                [[collider]]\nshape.hull = { points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }\n\
                [[sheet]]\nfile = \"head.obj\"\nscale = 2\nparts = [\"neck\"]\nthickness = 0.01\n\
                [[sheet]]\nfile = \"head.obj\"\nscale = 1\n";
    let scene = read(folder.path(), text).unwrap().value;
    assert_eq!(scene.colliders.len(), 2);
    for (collider, size) in scene.colliders.iter().zip([0.5, 1.0]) {
        let hull = collider.shape.collider_shape().unwrap();
        let (slope, corner) = (hull.distance(Vec3::splat(size)), hull.distance(Vec3::Y * (2.0 * size)));
        assert!((slope - 2.0 * size / 3f32.sqrt()).abs() < 1e-5 && (corner - size).abs() < 1e-5);
    }
    assert_eq!(scene.sheets.len(), 2);
    assert_eq!((scene.sheets[0].thickness, scene.sheets[0].body.mesh.triangles.len()), (0.01, 1));
    assert_eq!((scene.sheets[1].thickness, scene.sheets[1].body.mesh.triangles.len()), (0.002, 2));

    let wrong = |more: &str| {
        message(&format!("[body]\nfile = \"head.obj\"\nscale = 1\n[[groom]]\nfile = \"hair.data\"\n{more}\n"))
    };
    for (more, part) in [
        (
            "[[collider]]\nshape.hull = { points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] }",
            "line 7: `shape.hull` must be given at most 2048 `points` that span a volume",
        ),
        ("[[collider]]\nshape.hull = {}", "line 7: `shape.hull` must be"),
        ("[[collider]]\nshape.hull = { file = \"head.obj\", scale = 1 }", "head.obj span no volume"),
        (
            "[[collider]]\nshape.hull = { file = \"head.obj\", scale = 0 }",
            "line 7: `shape.hull.scale` must be above 0 [m]",
        ),
        ("[[collider]]\nshape.hull = { file = \"none.obj\" }", "scene.toml, line 6, names it as the hull"),
        ("[[collider]]\nshape.hull = { point = [[0, 0, 0]] }", "available keys: points, file, scale"),
        ("[[sheet]]\nfile = \"head.obj\"\nthickness = 0", "line 8: `thickness` must be above 0 [m]"),
        (
            "[collision]\nfile = \"head.obj\"\nthickness = 0.1",
            "line 8: `thickness` must be omitted except in [[sheet]]",
        ),
        ("[[sheet]]\nfile = \"none.obj\"", "scene.toml, line 7, names it as the sheet"),
    ] {
        let message = wrong(more);
        assert!(message.contains(part), "{more}: {message}");
    }
}

#[test]
fn a_built_in_head_without_strands_is_bald() {
    let folder = folder();
    let scene = |text: &str| read(folder.path(), text).unwrap().value;
    let bald = scene("[builtin]\nstrands = 0\nmotion = false\n[solver]\ncollide_body = false\n");
    assert_eq!(bald.grooms[0].groom.strand_count(), 0);
    assert!(bald.grooms[1].groom.strand_count() > 0, "the brows are missing");
    let mut stage = Stage::new(bald).unwrap();
    stage.step_frame(FrameRate::new(60, 1).unwrap());
    assert!(
        message("[builtin]\nstrands = -1\n")
            .contains("`strands` needs a whole number, 0 to 10000000, not -1")
    );
}

#[test]
fn colors_are_linear_numbers_or_srgb_in_hexadecimal() {
    let folder = folder();
    let sienna = Vec3::new(0.3515, 0.0844, 0.0262);
    let text = r##"
        [body]
        file = "head.obj"
        color = "#a0522d"
        [[groom]]
        file = "hair.data"
        look = { root_color = "#A0522D", tip_color = [0.1, 0.2, 0.3], dye = "#fff" }
        [ground]
        color = "#a0522d"
    "##;
    let scene = read(folder.path(), text).unwrap().value;
    let look = &scene.grooms[0].look;
    for color in [look.root_color, scene.ground.color.unwrap(), scene.body.unwrap().mesh.parts[0].color] {
        assert!(color.distance(sienna) < 1e-3, "{color}");
    }
    assert_eq!((look.tip_color, look.dye), (Vec3::new(0.1, 0.2, 0.3), Vec3::ONE));
    let scene = read(folder.path(), "[builtin]\nstrands = 10\nlook = { tip_color = \"#a0522d\" }\n").unwrap();
    assert!(scene.value.grooms[0].look.tip_color.distance(sienna) < 1e-3);
}
