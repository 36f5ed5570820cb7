//! The panel has every field of the scene file, or a reason why not, and each has a value and a default.

use super::*;
use crate::field;

#[test]
fn every_parameter_has_a_value_and_a_default() {
    let (whole, head) = (document(WHOLE), document(HEAD));
    for parameter in parameter::ALL {
        let key = parameter.key(0, 0);
        let maybe = matches!(parameter.kind(), Kind::Maybe { .. } | Kind::MaybeColor { .. });
        let here = |table: &toml::Table| key.look_up(table).is_some();
        assert!(
            maybe || here(whole.effective()) || here(head.effective()),
            "{} is in no scene",
            parameter.name
        );
        for document in [&whole, &head] {
            let camera = parameter.name.starts_with("camera.");
            assert!(here(document.effective()) == here(document.defaults()) || camera, "{}", parameter.name);
        }
    }
}

/// Fields of the scene file that are not in the panel, and why.
const ELSEWHERE: &[(&str, &str)] = &[
    ("name", "what the scene is called, and nothing that is seen"),
    ("builtin.material", "a name of a table: the panel chooses its preset, and has all its fields"),
    ("groom.material", "as `builtin.material`"),
    ("body.file", "a file is opened by File or dropped on the window"),
    ("body.scale", "how a file is read, which belongs to the file"),
    ("body.up", "as `body.scale`"),
    ("body.transform", "where a file's mesh is, which belongs to the file"),
    ("body.parts", "names of what is in a file"),
    ("body.rig", "a file"),
    ("body.weights", "a file"),
    ("body.more", "further files"),
    ("body.vertex_cache", "a file"),
    ("body.vertex_rate", "how that file is read"),
    ("collision", "a file"),
    ("collision.joint", "belongs to that file"),
    ("sheet", "a file"),
    ("collider.shape.hull.file", "a file"),
    ("collider.shape.hull.scale", "how that file is read"),
    ("clip.file", "a file is opened by File or dropped on the window"),
    ("clip.name", "names what is in a file"),
    ("clip.scale", "how a file is read"),
    ("clip.up", "how a file is read"),
    ("clip.rate", "how a file is read"),
    ("clip.joint", "names a joint of the motion's file, which no window opens"),
    ("prop.name", "names what is carried; it stands beside its file"),
    ("prop.mesh", "a file"),
    ("prop.joint", "names what carries a file's mesh, which is written beside it"),
    ("prop.pivot", "belongs to its keys"),
    ("prop.keys", "the way of a file's mesh, which is written beside it"),
    ("groom.name", "what the groom is called, and nothing that is seen"),
    ("groom.file", "a file is opened by File or dropped on the window"),
    ("groom.scale", "how a file is read"),
    ("groom.up", "how a file is read"),
    ("groom.reverse", "how a file is read"),
    ("groom.colors", "how a file is read"),
    ("groom.bones", "a file"),
    ("groom.maps", "maps are files; the panel has no file dialog for them"),
    ("builtin.maps", "as `groom.maps`"),
    ("groom.grow.parts", "names of parts of the body's file"),
    ("groom.grow.joint", "where hair grows is set with its parts"),
    ("groom.grow.inside", "where hair grows is set with its parts"),
];

/// `book_is_complete` checks that the book has a page for every field of the scene file.
#[test]
fn every_field_of_the_scene_file_is_in_the_panel_or_has_a_documented_reason() {
    let known: Vec<String> = parameter::ALL
        .iter()
        .flat_map(|p| match p.of {
            parameter::Of::Scene => vec![p.name.to_owned()],
            parameter::Of::Groom => vec![format!("groom.{}", p.name), format!("builtin.{}", p.name)],
            parameter::Of::Material => vec![format!("material.{}", p.name)],
        })
        .collect();
    let lists = ["collider", "sheet", "hand", "wind_source", "charged"];
    let shown = |field: &str| {
        let (list, name) = (field.split('.').next().unwrap(), field.rsplit('.').next().unwrap());
        known.iter().any(|k| k == field || k.strip_prefix(field).is_some_and(|rest| rest.starts_with('.')))
            || field == "clip.pivot"
            || field.starts_with("clip.keys")
            || (lists.contains(&list) && field != list && field::of(list, name).is_some())
    };
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/parameters");
    let mut fields = Vec::new();
    let inside = |folder: &Path| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    for page in inside(&book).filter(|path| path.is_dir()).flat_map(|group| inside(&group)) {
        let name = page.file_name().unwrap().to_str().unwrap();
        fields.extend(name.strip_suffix(".md").map(str::to_owned));
    }
    assert!(fields.len() > 150, "{} fields", fields.len());
    let missing: Vec<_> =
        fields.iter().filter(|f| !shown(f) && ELSEWHERE.iter().all(|(name, _)| name != f)).collect();
    assert!(missing.is_empty(), "neither in the panel nor listed with a reason: {missing:?}");
    for (name, why) in ELSEWHERE {
        assert!(fields.iter().any(|f| f == name) && !shown(name) && !why.is_empty(), "{name}");
    }
    for known in known.iter().filter(|k| !k.starts_with("builtin.") && !k.starts_with("groom.")) {
        assert!(fields.contains(known), "{known} is no field of the scene file");
    }
}
