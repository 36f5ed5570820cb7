//! Promise: an error in a scene file is reported in one sentence.
//!
//! People write scene files by hand, so error messages are part of the format. A message names the line,
//! what was found there and what is valid. For a misspelled word it suggests the intended one.

use crate::scenes::{folder, message, read};
use hairspring_io::{ErrorKind, read_scene};
use std::fs;

#[test]
fn errors_name_the_line_and_suggest_the_intended_word() {
    const GROOM: &str = "[[groom]]\nfile = \"hair.data\"\n";
    const GRAB: &str = "[[hand]]\ntool.grab = { center = [0, 0, 0], radius = 1 }\n";
    for (text, parts) in [
        (format!("{GROOM}giudes = 3\n"), &["scene.toml, line 3", "`giudes`", "did you mean `guides`?"][..]),
        (format!("[solver]\nsubstep = 3\n{GROOM}"), &["line 2", "did you mean `substeps`?"]),
        (format!("[slover]\n{GROOM}"), &["line 1", "did you mean `solver`?"]),
        (format!("{GROOM}[volume]\nmethod = \"densty\"\n"), &["line 4", "did you mean `density`?"]),
        (
            format!("{GROOM}[solver]\nsubsteps = 2\nsag_free = true\nsubsteps = 3\n"),
            &["scene.toml, line 6", "`substeps` is given twice in the same table; remove one of the two"],
        ),
        (
            format!("{GROOM}look = {{ melanin = 0.5, melanin = 0.6 }}\n"),
            &["line 3", "`melanin` is given twice in the same table"],
        ),
        (
            format!("[solver]\n{GROOM}[solver]\nsubsteps = 3\n"),
            &["line 4", "[solver] is given twice; move its keys below the first header"],
        ),
        (
            format!("[groom]\nfile = \"hair.data\"\n{GROOM}"),
            &["line 3", "`groom` was one table before; write [[groom]], with two brackets, for each"],
        ),
        (format!("{GROOM}[volume]\ncell = 0\n"), &["line 4", "`cell` must be above 0, at most 1 [m]"]),
        (format!("{GROOM}[neighbours]\nradius = 0\n"), &["line 4", "`radius` must be above 0 [m]"]),
        (format!("{GROOM}[neighbours]\nstiction = -1\n"), &["line 4", "`stiction` must be 0 or more [N]"]),
        (format!("{GROOM}[volume]\nfriction = -1\n"), &["line 4", "`friction` must be 0 or more [1/s]"]),
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
        (
            format!("{GROOM}look = {{ melanin = 0.5, tip_color = [0, 0, 0] }}\n"),
            &["line 3", "`melanin` or colors", "not both"],
        ),
        (
            format!("{GROOM}[groom.look]\nroot_color = [0, 0, 0]\nmelanin = 0.5\n"),
            &["line 5", "`melanin` or colors", "not both"],
        ),
        (format!("{GROOM}[groom.look]\nmelanin = 1.5\n"), &["line 4", "`melanin` must be 0 to 1"]),
        (format!("{GROOM}[groom.look]\ndye = [0, 0, 2]\n"), &["line 4", "`dye` must be three numbers"]),
        (format!("{GROOM}[solver]\nsubsteps = 0\n"), &["line 4", "1 to 1024"]),
        (format!("{GROOM}[camera]\nfov = 200\n"), &["line 4", "1 to 170"]),
        (format!("{GROOM}[ground]\nheight = nan\n"), &["line 4", "`height` must be a finite number"]),
        (format!("{GROOM}[ground]\ncolor = [0, 2, 0]\n"), &["line 4", "`color` must be three numbers"]),
        (format!("{GROOM}[ground]\ncolour = [0, 1, 0]\n"), &["line 4", "did you mean `color`?"]),
        (format!("{GROOM}material = \"a\"\n[material.a]\nfriction = 7\n"), &["line 5", "0 to 1"]),
        // A material that no groom uses.
        (format!("{GROOM}[material.m]\npreset = \"weavy\"\n"), &["line 4", "did you mean `wavy`?"]),
        (format!("{GROOM}[material.m]\npreset = \"wavy\"\nbend = -3\n"), &["line 5", "`bend` must be"]),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nbend = 2\nmass_profile = [1, 0, 2]\n"),
            &["line 6", "`mass_profile` must be 1 to 64 numbers, 0.0001 to 10000"],
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
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = [1, nan]\n"),
            &["line 5", "0.0001 to 10000"],
        ),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nmass_profile = 3\n"),
            &["line 5", "`mass_profile` needs a list"],
        ),
        ("[groom]\nfile = \"hair.data\"\n".into(), &["line 1", "write [[groom]], with two brackets"]),
        (
            format!("{GROOM}[collider]\nshape.sphere = {{ center = [0, 0, 0], radius = 1 }}\n"),
            &["line 3", "write [[collider]], with two brackets"],
        ),
        (format!("{GROOM}[[wind]]\nvelocity = [1, 0, 0]\n"), &["line 3", "write [wind], with one bracket"]),
        (format!("[[body]]\nfile = \"head.obj\"\n{GROOM}"), &["line 1", "write [body], with one bracket"]),
        (
            "[[groom]]\nfile = \"hiar.data\"\n".into(),
            &["hiar.data was not found", "names it as the groom", "line 2"],
        ),
        (
            format!("[body]\nfile = \"haed.obj\"\n{GROOM}"),
            &["haed.obj was not found", "names it as the body", "line 2"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\nparts = [\"sclap\"]\n{GROOM}"),
            &["line 3", "did you mean `scalp`?"],
        ),
        (format!("[body]\nfile = \"head.obj\"\nrig = \"x.json\"\n{GROOM}"), &["line 3", "`weights`"]),
        (format!("{GROOM}[clip]\nfile = \"nod.bvh\"\n"), &["line 4", "no [body]"]),
        (format!("{GROOM}material = []\n"), &["line 3", "`material` must name at least one"]),
        (
            format!("[body]\nfile = \"head.obj\"\nparts = []\n{GROOM}"),
            &["line 3", "`parts` must name at least one"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nkeys = [{{ time = 1 }}]\nname = \"nod\"\n"),
            &["line 7", "`name` must be omitted if there are `keys`"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nkeys = [{{ time = 1 }}]\nstart = 2\n"),
            &["line 7", "`start` must be omitted"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\n{GROOM}[clip]\nkeys = [{{ time = 1 }}]\nup = \"z\"\n"),
            &["line 7", "`up` must be given with a `file`"],
        ),
        (
            format!(
                "[body]\nfile = \"head.obj\"\nvertex_cache = \"a.pc2\"\n{GROOM}[clip]\nkeys = [{{ time = 1 }}]\n"
            ),
            &["line 3", "`vertex_cache` must be omitted if there is a [clip]"],
        ),
        (
            format!(
                "[body]\nfile = \"head.obj\"\nvertex_cache = \"head.#.obj\"\n[[body.more]]\nfile = \"head.obj\"\n{GROOM}"
            ),
            &["line 3", "body of one file"],
        ),
        (
            format!("[body]\nfile = \"head.obj\"\nvertex_rate = 30\n{GROOM}"),
            &["line 3", "`vertex_rate` must be given with a `vertex_cache`"],
        ),
        (
            "[body]\nfile = \"head.obj\"\n[[groom]]\ngrow = { strands = 5 }\nreverse = true\n".into(),
            &["line 5", "`reverse` must be omitted if hair is grown"],
        ),
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
            &["line 4", "`shape.box.size` must be three numbers above 0 [m]"],
        ),
        (
            format!(
                "{GROOM}[[collider]]\njoint = \"x\"\nshape.sphere = {{ center = [0, 0, 0], radius = 1 }}\n"
            ),
            &["line 4", "`x`"],
        ),
        (
            format!("{GROOM}[[collider]]\nshape.plane = {{ point = [0, 0, 0], normal = [0, 0, 0] }}\n"),
            &["line 4", "`shape.plane.normal` must be a vector with a length above 0"],
        ),
        (
            format!("{GROOM}[[hand]]\ntool.grap = {{ center = [0, 0, 0], radius = 1 }}\n"),
            &["line 4", "did you mean `grab`?"],
        ),
        (
            format!("{GROOM}[[hand]]\ntool.grab = {{ center = [0, 0, 0], radius = 0 }}\n"),
            &["line 4", "`tool.grab.radius` must be above 0 [m]"],
        ),
        (format!("{GROOM}{GRAB}{GRAB}joint = \"x\"\n"), &["line 7", "`x` is unknown"]),
        (
            format!("{GROOM}{GRAB}{GRAB}path = [[1, 0, 0, 0], [1, 0, 0, 1]]\n"),
            &["line 7", "`path` must be finite, with increasing times [s]"],
        ),
        (format!("{GROOM}{GRAB}from = 2\nuntil = 1\n"), &["line 6", "`until` must be after `from` [s]"]),
        (
            format!(
                "{GROOM}[[hand]]\ntool.tie = {{ center = [0, 0, 0], axis = [0, 0, 0], radius = 1, reach = 1 }}\n"
            ),
            &["line 4", "`tool.tie.axis` must be a vector with a length above 0"],
        ),
        (
            format!(
                "{GROOM}[[hand]]\ntool.comb = {{ a = [0, 0, 0], b = [1, 0, 0], radius = 1, grip = 2, friction = 3 }}\n"
            ),
            &["line 4", "`tool.comb.friction` must be 0 to `grip` [1/s]"],
        ),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nglobal_shape = {{ pull = 61 }}\n"),
            &["line 5", "`global_shape.pull` must be 0 to 60 [Hz]"],
        ),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\nglobal_shape = {{ pul = 6 }}\n"),
            &["did you mean `pull`?"],
        ),
        (format!("{GROOM}bones = \"x.tfxbone\"\n"), &["x.tfxbone was not found"]),
        (format!("{GROOM}[turbulence]\nsize = 0\n"), &["line 4", "`size` must be 1e-6 to 1000000 [m]"]),
        (format!("{GROOM}[wind_occlusion]\nhair = -1\n"), &["line 4", "`hair` must be 0 or more [1/m]"]),
        (
            format!("{GROOM}[[wind_source]]\nshape.fna = {{ center = [0, 0, 0] }}\n"),
            &["line 4", "did you mean `fan`?"],
        ),
        (
            format!(
                "{GROOM}[[wind_source]]\nshape.point = {{ center = [0, 0, 0], radius = 1, speed = 1 }}\n[[wind_source]]\n\
                 shape.vortex = {{ center = [0, 0, 0], axis = [0, 0, 0], radius = 1, speed = 1 }}\n"
            ),
            &["line 6", "`shape.vortex.axis` must be a vector with a length above 0"],
        ),
        (
            format!(
                "{GROOM}[[wind_source]]\njoint = \"x\"\nshape.point = {{ center = [0, 0, 0], radius = 1, speed = 1 }}\n"
            ),
            &["line 4", "`x`"],
        ),
        (
            format!("{GROOM}[[charged]]\ncenter = [0, 0, 0]\nradius = 1\ncharge = 1\n"),
            &["line 6", "`charge` must be -1e-3 to 1e-3 [C]"],
        ),
        (
            format!(
                "{GROOM}[[charged]]\ncenter = [0, 0, 0]\nradius = 1\ncharge = 0\npath = [{{ time = 0, center = [0, 0, 0] }}]\n"
            ),
            &["line 7", "each later than the one before"],
        ),
        (
            format!("{GROOM}material = \"a\"\n[material.a]\ncharge = 1\n"),
            &["line 5", "`charge` must be -1e-6 to 1e-6 [C/m]"],
        ),
        // A key of a nested table, in each of the ways to write it.
        (
            format!("{GROOM}[[collider]]\n[collider.shape.sphere]\ncenter = [0, 0, 0]\nradius = 0\n"),
            &["line 6", "`shape.sphere.radius` must be above 0 [m]"],
        ),
        (
            format!("{GROOM}{GRAB}{GRAB}tool.grab.pull = -1\n").replace(
                &format!("{GRAB}tool"),
                "[[hand]]\ntool.grab.center = [0, 0, 0]\ntool.grab.radius = 1\ntool",
            ),
            &["line 8", "`tool.grab.pull` must be 0 to 1000 [Hz]"],
        ),
        (
            format!(
                "{GROOM}material = \"a\"\n[material.a]\ndamping = 1\n[material.a.global_shape]\ndamping = 11\n"
            ),
            &["line 7", "`global_shape.damping` must be 0 to 10"],
        ),
        // A key with the same name as one of the table around its own.
        (
            format!(
                "{GROOM}scale = 1.0\nup = \"y\"\n\n[groom.transform]\nposition = [0, 0, 0]\nscale = [1, 0, 1]\n"
            ),
            &["line 8", "`transform.scale` must be finite and not 0"],
        ),
        (
            "[[groom]]\ntransform.scale = 0\nfile = \"hair.data\"\nscale = 1\n".into(),
            &["line 2", "`transform.scale` must be finite and not 0"],
        ),
        (
            format!("{GROOM}scale = 1.0\ntransform = {{ rotation = [nan, 0, 0] }}\n"),
            &["line 4", "`transform.rotation` must be"],
        ),
        ("[[groom]]\nscale = -1\nfile = \"hair.data\"\n".into(), &["line 2", "`scale` must be above 0"]),
        // A file of an unknown kind.
        (
            "[[groom]]\nfile = \"x.xyz\"\n".into(),
            &[
                "scene.toml, line 2",
                "the groom \"x.xyz\": unknown extension",
                ".gltf, .glb, .vrm",
                ".usdz, .abc",
            ],
        ),
        ("[[groom]]\nfile = \"\"\n".into(), &["scene.toml, line 2", "the groom \"\": unknown extension"]),
        ("[[groom]]\nfile = \"scene.toml\"\n".into(), &["scene.toml, line 2", "the groom \"scene.toml\""]),
        (
            format!("[body]\nfile = \"hair.data\"\n{GROOM}"),
            &["scene.toml, line 2", "the body \"hair.data\"", ".gltf, .glb, .vrm, .obj"],
        ),
        ("name = \"empty\"\n".into(), &["scene.toml", "[[groom]]"]),
        ("gravity = [0, 1\n".into(), &["line 1"]),
    ] {
        let message = message(&text);
        println!("{message}");
        for part in parts {
            assert!(message.contains(part), "{text}\n gives\n{message}\nwhich does not contain {part:?}");
        }
        assert!(!message.contains('\n'), "more than one line: {message}");
    }
}

#[test]
fn values_of_the_wrong_type_are_described_in_toml() {
    const GROOM: &str = "[[groom]]\nfile = \"hair.data\"\n";
    const MATERIAL: &str = "material = \"a\"\n[material.a]\n";
    let three = "three numbers, such as [1.5, 0.0, 0.0]";
    for (text, parts) in [
        ("[wind]\nvelocity = 1.5\n".into(), &["line 4", "`velocity` needs", three, "not 1.5"][..]),
        (
            "[wind]\nvelocity = \"fast\"\n".into(),
            &["line 4", "`velocity` needs", three, "not the text \"fast\""],
        ),
        ("[wind]\nvelocity = [1, 0]\n".into(), &["line 4", "`velocity` needs", three]),
        ("[wind]\nvelocity = [1, 0, \"x\"]\n".into(), &["line 4", "`velocity` needs a number"]),
        ("[wind]\ngust = true\n".into(), &["line 4", "`gust` needs a number, such as 0.5, not true"]),
        (
            "[solver]\nsubsteps = 4.5\n".into(),
            &["line 4", "`substeps` needs a whole number, 1 to 1024, not 4.5"],
        ),
        (
            "[solver]\nsubsteps = -4\n".into(),
            &["line 4", "`substeps` needs a whole number, 1 to 1024, not -4"],
        ),
        ("[solver]\nsubsteps = \"4\"\n".into(), &["line 4", "`substeps` needs a whole number"]),
        (
            "[solver]\nsubsteps = 99999999999999999999\n".into(),
            &["line 4", "`substeps` needs a whole number, 1 to 1024, not 99999999999999999999"],
        ),
        ("[solver]\nsubsteps = 5000000000\n".into(), &["line 4", "1 to 1024, not 5000000000"]),
        (
            "[clip]\nstart = 99999999999999999999\n".into(),
            &["line 4", "a whole number of at most 9223372036854775807, not 99999999999999999999"],
        ),
        ("[solver]\nsag_free = 1\n".into(), &["line 4", "`sag_free` needs true or false, not 1"]),
        ("[volume]\nmethod = 3\n".into(), &["line 4", "`method` needs a name in quotes"]),
        ("thicken = 3\n".into(), &["line 3", "`thicken` needs a table"]),
        // A table that is not one, and a list in its place.
        (
            "[[collider]]\nshape = \"capsule\"\n".into(),
            &[
                "line 4",
                "`shape` needs a table, such as { capsule = { a = [1.5, 0.0, 0.0], b =",
                "not the text",
            ],
        ),
        (
            "[[collider]]\nshape = 3\n".into(),
            &[
                "line 4",
                "`shape` needs a table, such as { sphere = { center = [1.5, 0.0, 0.0], radius = 1.5 } }, not 3",
            ],
        ),
        (
            "[clip]\nkeys = [[0, 1]]\n".into(),
            &["line 4", "`keys` needs a list of tables, such as [{ time = 1.5 }]"],
        ),
        (
            "[[prop]]\nkeys = 3\n".into(),
            &["line 4", "`keys` needs a list of tables, such as [{ time = 1.5 }], not 3"],
        ),
        (
            "[[hand]]\ntool.grab = [1, 2]\n".into(),
            &[
                "line 4",
                "`grab` needs a table, such as { center = [1.5, 0.0, 0.0], radius = 1.5 }, not a list",
            ],
        ),
        (
            "[solver]\nsubsteps = true\n".into(),
            &["line 4", "`substeps` needs a whole number, 1 to 1024, not true"],
        ),
        ("[solver]\ncontact = 3\n".into(), &["line 4", "`contact` needs a name in quotes, one of: \""]),
        ("look = 3\n".into(), &["line 3", "`look` needs a table, such as { root_color = [", "not 3"]),
        (
            format!("{MATERIAL}global_shape = 3\n"),
            &["line 5", "`global_shape` needs a table, such as { pull = "],
        ),
        (
            "[body]\nfile = \"head.obj\"\nparts = \"scalp\"\n".into(),
            &["line 5", "a list, such as [\"name\"]"],
        ),
        ("thicken = { copies = \"x\" }\n".into(), &["line 3", "`copies` needs a whole number"]),
        (
            "look.root_color = 3\n".into(),
            &["line 3", "`root_color` needs three numbers from 0 to 1", "\"#a0522d\""],
        ),
        ("look.root_color = \"red\"\n".into(), &["line 3", "`root_color` needs", "not the text \"red\""]),
        ("look.root_color = [1, 0]\n".into(), &["line 3", "`root_color` needs", "not 2 values"]),
        ("look.dye = \"#12345\"\n".into(), &["line 3", "`dye` needs"]),
        ("[ground]\ncolor = \"#a0522g\"\n".into(), &["line 4", "`color` needs"]),
        (format!("{MATERIAL}friction = \"low\"\n"), &["line 5", "`friction` needs a number"]),
        (
            format!("{MATERIAL}bend = 1\nfriction = [1]\n"),
            &["line 6", "`friction` needs a number, such as 0.5, not a list"],
        ),
        (format!("{MATERIAL}global_shape = {{ pull = \"x\" }}\n"), &["`pull` needs a number"]),
        ("transform.position = 3\n".into(), &["line 3", "`position` needs", three]),
        ("[[collider]]\nshape.sphere = { radius = 1 }\n".into(), &["line 4", "`center` is missing"]),
        ("guides = 2.5\n".into(), &["line 3", "`guides` needs a number of guides above 0"]),
        (
            "[groom.material]\nbend = 2.0\n".into(),
            &["line 3", "`material` needs a material's name", "such as [material.soft]"],
        ),
        (
            "guides = 3\n[groom.transform]\nscale = 2.0\nrotation = 3.0\n".into(),
            &["line 6", "`rotation` needs"],
        ),
        ("colors = \"lok\"\n".into(), &["line 3", "did you mean `look`?"]),
        ("reverse = \"yes\"\n".into(), &["line 3", "true, false or \"nearest\""]),
        ("reverse = 3\n".into(), &["line 3", "true, false or \"nearest\""]),
        ("reverse = \"nearest\"\n".into(), &["line 3", "needs a [body]"]),
    ] {
        let message = message(&format!("{GROOM}{text}"));
        println!("{message}");
        for part in parts {
            assert!(message.contains(part), "{text}\n gives\n{message}\nwhich does not contain {part:?}");
        }
        for word in [
            "f32",
            "u32",
            "i64",
            "i128",
            "struct",
            "sequence",
            "integer",
            "floating point",
            "enum ",
            "variant",
            "map",
        ] {
            assert!(!message.contains(word), "{message}\nspeaks of {word}");
        }
        assert!(!message.contains('\n'), "more than one line: {message}");
    }
}

#[test]
fn missing_and_broken_files_differ_in_kind() {
    let folder = folder();
    fs::write(folder.path().join("broken.data"), b"\x05\0\0\0").unwrap();
    let kind = |file: &str| read(folder.path(), &format!("[[groom]]\nfile = {file:?}\n")).unwrap_err().kind();
    assert_eq!(kind("none.data"), ErrorKind::NotFound);
    assert_eq!(kind("broken.data"), ErrorKind::Malformed);
    // An OBJ may hold strands, but this one has only faces.
    assert_eq!(kind("head.obj"), ErrorKind::Malformed);
    // Of another kind, so that the scene is wrong, even if it names itself.
    for file in ["nod.bvh", "scene.toml", "x.xyz", ""] {
        assert_eq!(kind(file), ErrorKind::Malformed, "{file:?}");
    }
    assert_eq!(read_scene(&folder.path().join("no.toml")).unwrap_err().kind(), ErrorKind::NotFound);
}
