//! The panel has every parameter of the scene file, shows which values each accepts and which were changed,
//! and writes the intended text.

mod complete;

use super::*;
use crate::document::{Change, Document, Way};
use egui_kittest::{Harness, kittest::Queryable};
use std::{cell::RefCell, path::Path, rc::Rc};

/// A scene with every table that a scene may have once.
const WHOLE: &str = "[body]\nfile = \"b.obj\"\n[clip]\nfile = \"m.bvh\"\njoint = \"Head\"\npivot = [0.0, 0.0, 0.0]\n\
    [camera]\nfov = 20.0\n[[groom]]\nmaterial = \"curly\"\n[groom.grow]\nstrands = 10\n";
const HEAD: &str = "[builtin]\nstyle = \"wavy\"\nstrands = 10\nguides = 5\n";

fn document(text: &str) -> Document {
    Document::new(Path::new("scene.toml"), text.into()).unwrap()
}

fn parameter(name: &str) -> &'static Parameter {
    parameter::ALL.iter().find(|p| p.name == name).unwrap()
}

/// The panel of a scene with a search, and the recorded actions.
struct Panel {
    harness: Harness<'static>,
    session: Rc<RefCell<Session>>,
    filter: Rc<RefCell<String>>,
    width: Rc<RefCell<f32>>,
}

fn panel(text: &str, sought: &str) -> Panel {
    let session = Rc::new(RefCell::new(Session::new(document(text), 1, None, || ()).unwrap()));
    let filter = Rc::new(RefCell::new(sought.to_owned()));
    let width = Rc::new(RefCell::new(0.0));
    let (shown, typed, wide) = (session.clone(), filter.clone(), width.clone());
    let harness = Harness::builder().with_size([800.0, 4000.0]).build_ui(move |ui| {
        let mut actions = Vec::new();
        let panel = egui::Panel::right("parameters").default_size(360.0).show(ui, |ui| {
            show(ui, &shown.borrow(), &mut typed.borrow_mut(), Some(Camera::default()), &mut actions);
        });
        *wide.borrow_mut() = panel.response.rect.width();
        actions.into_iter().for_each(|action| shown.borrow_mut().act(action).unwrap());
    });
    let mut panel = Panel { harness, session, filter, width };
    panel.harness.run_steps(3);
    panel
}

impl Panel {
    fn resets(&self) -> usize {
        self.harness.query_all_by_label("reset").count()
    }

    fn pointer(&mut self, pos: egui::Pos2, pressed: Option<bool>) {
        self.harness.event(egui::Event::PointerMoved(pos));
        if let Some(pressed) = pressed {
            let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
            self.harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
        }
        self.harness.run_steps(2);
    }

    fn text(&self) -> String {
        self.session.borrow().document().text().to_owned()
    }
}

#[test]
fn a_newly_opened_scene_shows_no_reset() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let scenes = std::fs::read_dir(examples).unwrap().map(|entry| entry.unwrap().path());
    let scenes = scenes.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let mut all: Vec<_> = scenes.map(|path| Document::open(&path).unwrap()).collect();
    all.extend(
        (0..crate::panel::presets::PRESETS.len()).map(|k| document(&crate::panel::presets::text(k, 50, 20))),
    );
    assert!(all.len() > 20);
    for document in all {
        for groom in document.grooms() {
            for (group, parameter) in (0..2).flat_map(|g| parameter::ALL.iter().map(move |p| (g, p))) {
                let key = parameter.key(groom, group);
                let [now, opened] =
                    [document.effective(), document.opened().values()].map(|table| key.look_up(table));
                assert_eq!(now, opened, "{}: {key}", document.settings().name);
            }
        }
    }
    assert_eq!(panel(HEAD, ".").resets(), 0);
    assert_eq!(panel(&HEAD.replace("wavy", "curly"), ".").resets(), 0);
}

#[test]
fn reset_restores_the_value_at_the_time_of_opening() {
    let text = format!("{HEAD}[builtin.look]\nroughness = 0.5\n");
    let mut panel = panel(&text, "roughness");
    let act = |panel: &Panel, name: &str, value: Value| {
        panel.session.borrow_mut().act(Action::Parameter(parameter(name), Some(value))).unwrap();
    };
    act(&panel, "look.roughness", 0.7.into());
    act(&panel, "look.cuticle", 5.0.into());
    panel.filter.replace("cuticle".into());
    panel.harness.run_steps(3);
    assert_eq!(panel.resets(), 1);
    panel.harness.get_by_label("reset").click();
    panel.harness.run_steps(3);
    assert!(!panel.text().contains("cuticle"), "not in the text, as before: {}", panel.text());
    panel.filter.replace("roughness".into());
    panel.harness.run_steps(3);
    panel.harness.get_by_label("reset").click();
    panel.harness.run_steps(3);
    assert_eq!(panel.text(), text);
    // A new material is based on the style's, and can be reset to it.
    act(&panel, "preset", "coily".into());
    assert!(panel.text().contains("preset = \"coily\""));
    let back = edit::reset(panel.session.borrow().edited(), parameter("preset"), (0, 0));
    assert_eq!(back.unwrap().as_str(), Some("wavy"));
}

#[test]
fn parameters_that_restart_the_scene_are_known() {
    for parameter in parameter::ALL {
        let mut document = [WHOLE, HEAD]
            .map(document)
            .into_iter()
            .find(|d| {
                let key = parameter.key(0, 0);
                let maybe = matches!(parameter.kind(), Kind::Maybe { .. } | Kind::MaybeColor { .. });
                key.look_up(d.effective()).is_some()
                    || (maybe && key.parent().look_up(d.effective()).is_some())
            })
            .unwrap();
        let now = parameter.key(0, 0).look_up(document.effective()).cloned();
        let value: Value = match parameter.kind() {
            Kind::Number { max, .. } => max.into(),
            Kind::Maybe { from, .. } => from.into(),
            Kind::Count { min, .. } => (min + 1).into(),
            Kind::Guides { .. } => 7.into(),
            Kind::Switch => (!now.unwrap().as_bool().unwrap()).into(),
            Kind::Choice => {
                let now = now.as_ref().unwrap().as_str();
                parameter.words().find(|word| Some(*word) != now).unwrap().into()
            }
            Kind::Bounded => unreachable!("it has become a number with a range"),
            Kind::Color | Kind::MaybeColor { .. } => [0.25, 0.5, 0.75].into_iter().collect(),
            Kind::Vector { .. } => [0.5, 1.5, 2.5].into_iter().collect(),
            Kind::Profile => [1.0, 2.0].into_iter().collect(),
        };
        let edits = edit::of(&mut document, parameter, Some(value), (0, 0)).unwrap();
        let change = document.set_all(edits).unwrap_or_else(|why| panic!("{}: {why}", parameter.name));
        let expected = if parameter.is_geometry() { Change::Geometry } else { Change::Settings };
        assert_eq!(change, expected, "{}", parameter.name);
    }
}

#[test]
fn setting_melanin_replaces_the_colors_in_one_step_and_removing_it_restores_them() {
    let text = "[[groom]]\nfile = \"a.hair\"\n[groom.look]\nroot_color = [0.22, 0.12, 0.055] # chestnut\ntip_color = [0.34, 0.2, 0.1]\n";
    let mut document = document(text);
    let melanin = parameter("look.melanin");
    for value in [0.5, 0.6] {
        let edits = edit::of(&mut document, melanin, Some(value.into()), (0, 0)).unwrap();
        document.set_all(edits).unwrap();
    }
    assert!(document.text().contains("melanin = 0.6") && !document.text().contains("color"));
    let idle = |document: &Document, name: &str| parameter(name).inactive_reason(document, (0, 0)).is_some();
    assert!(idle(&document, "look.root_color") && idle(&document, "look.tip_color"));
    assert!(!idle(&document, "look.melanin_redness"));
    document.step(Way::Back).unwrap();
    assert_eq!(document.text(), text, "one step");
    assert!(!idle(&document, "look.root_color") && idle(&document, "look.melanin_redness"));
    document.step(Way::Forth).unwrap();
    let edits = edit::of(&mut document, melanin, None, (0, 0)).unwrap();
    document.set_all(edits).unwrap();
    assert!(document.text().contains("0.22") && !document.text().contains("melanin"), "{}", document.text());
    assert_eq!(document.effective(), document.opened().values());
}

#[test]
fn a_camera_is_written_as_a_whole() {
    let mut document = document(HEAD);
    let before = document.settings().camera.unwrap();
    let edits = edit::of(&mut document, parameter("camera.fov"), Some(40.0.into()), (0, 0)).unwrap();
    document.set_all(edits).unwrap();
    let after = document.settings().camera.unwrap();
    assert_eq!((after.position, after.target, after.fov), (before.position, before.target, 40.0));
}

#[test]
fn a_slider_from_0_is_linear() {
    let mut panel = panel(&format!("{HEAD}look = {{ melanin = 0.9 }}\n"), "look.melanin");
    let rect = panel.harness.query_all_by_role(egui::accesskit::Role::Slider).next().unwrap().rect();
    let key = Key::top("groom").place(0).field("look.melanin");
    let values = [12.0, 22.0, 32.0].map(|x| {
        let at = egui::pos2(rect.left() + x, rect.center().y);
        panel.pointer(at, Some(true));
        panel.pointer(at, Some(false));
        let session = panel.session.borrow();
        key.look_up(session.document().effective()).and_then(toml::Value::as_float).unwrap()
    });
    let [first, second] = [values[1] - values[0], values[2] - values[1]];
    // A slider rounds to the resolution of a pixel.
    assert!(first > 0.05 && (first - second).abs() < 0.06, "{values:?}");
}

#[test]
fn a_new_number_of_hairs_applies_when_the_slider_is_released() {
    let mut panel = panel(HEAD, "on the scalp");
    let rect = panel.harness.query_all_by_role(egui::accesskit::Role::Slider).next().unwrap().rect();
    let begun = panel.session.borrow().begun();
    let at = |share: f32| egui::pos2(rect.left() + share * rect.width(), rect.center().y);
    panel.pointer(at(0.02), Some(true));
    for k in 0..5 {
        panel.pointer(at(0.02 + 0.02 * k as f32), None);
        assert_eq!(panel.text(), HEAD, "while it is dragged");
    }
    panel.pointer(at(0.1), Some(false));
    assert_ne!(panel.text(), HEAD);
    assert_eq!(panel.session.borrow().begun(), begun + 1, "once");
    assert!(panel.session.borrow().is_reading(), "by another thread than the window's");
    let key = Key::top("groom").place(0).field("strands");
    let session = &panel.session;
    let hairs = key.look_up(session.borrow().document().effective()).and_then(toml::Value::as_integer);
    let shown = || {
        assert!(session.borrow_mut().error().is_none());
        let session = session.borrow();
        let snapshot = session.latest().filter(|s| s.scene == session.begun())?;
        Some(snapshot.stages[0].still.grooms[0].strand_count() as i64)
    };
    let waited = (0..12_000).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(5));
        shown()
    });
    assert_eq!(waited, hairs);
    panel.session.borrow_mut().act(Action::Undo).unwrap();
    assert_eq!(panel.text(), HEAD, "one step");
}

#[test]
fn a_tooltip_names_range_unit_and_default() {
    let of = |name: &str| {
        let (parameter, head) = (parameter(name), document(HEAD));
        let reason = parameter.inactive_reason(&head, (0, 0));
        tip(parameter, reason.as_deref(), parameter.key(0, 0).look_up(head.defaults()))
    };
    for (name, line) in [
        ("damping", "0 to 10000 [s]; default 0.015\n"),
        ("effects.clump", "0 to 1; default 0\n"),
        ("wind.velocity", "three numbers from -1000 to 1000 [m/s]; default 0, 0, 0\n"),
        ("solver.segment_contacts", "on or off; default on\n"),
        ("style", "straight, wavy, curly, coily, short-fur; default wavy\n"),
        ("look.melanin", "0 to 1; default none\n"),
        ("strands", "0 to 10000000; default 100000\n"),
    ] {
        assert!(of(name).contains(line), "{}", of(name));
    }
    assert!(of("look.melanin_redness").starts_with("No effect unless \"Melanin\" is set."));
}

#[test]
fn a_change_does_not_widen_the_panel() {
    let text = format!(
        "{HEAD}[[collider]]\nshape.sphere = {{ center = [-0.000237, 0.23, 0.024747], radius = 0.066 }}\n"
    );
    let mut panel = panel(&text, ".");
    let before = *panel.width.borrow();
    let values: [(&str, Value); 5] = [
        ("damping", 0.12345.into()),
        ("young", 4.56e9.into()),
        ("guides", 7.into()),
        ("density", 4321.5.into()),
        ("mass_profile", [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0].into_iter().collect()),
    ];
    for (name, value) in values {
        panel.session.borrow_mut().act(Action::Parameter(parameter(name), Some(value))).unwrap();
        panel.harness.run_steps(3);
        assert_eq!(*panel.width.borrow(), before, "{name}");
    }
    assert_eq!(panel.resets(), 5);
    assert_eq!(before, 360.0);
}

#[test]
fn a_search_leaves_the_groups_as_they_were() {
    let mut panel = panel(HEAD, "");
    let open = |panel: &Panel| panel.harness.query_all_by_label("Specular").count();
    assert_eq!(open(&panel), 0);
    panel.filter.replace("specular".into());
    panel.harness.run_steps(3);
    assert!(open(&panel) > 0);
    panel.filter.replace(String::new());
    panel.harness.run_steps(30);
    assert_eq!(open(&panel), 0, "closed as before");
}

#[test]
fn the_color_picker_opens_and_the_font_has_its_characters() {
    let mut panel = panel(HEAD, "root");
    let button = panel.harness.query_all_by_role(egui::accesskit::Role::ColorWell).next().unwrap();
    button.click();
    // A glyph that no font has fails the test.
    panel.harness.run_steps(3);
    assert!(panel.harness.query_by_label("📋").is_some());
}

#[test]
fn no_label_is_truncated() {
    let panel = panel(HEAD, "nothing is called so");
    let font = egui::TextStyle::Body.resolve(&panel.harness.ctx.global_style());
    let width = |text: &str| {
        let text = text.to_owned();
        panel
            .harness
            .ctx
            .fonts_mut(|f| f.layout_no_wrap(text, font.clone(), egui::Color32::WHITE))
            .rect
            .width()
    };
    let cut: Vec<_> = parameter::ALL.iter().map(|p| p.label).filter(|label| width(label) > LABEL).collect();
    assert!(cut.is_empty(), "wider than {LABEL} points: {cut:?}");
}

#[test]
fn a_group_is_found_by_its_name() {
    let mut panel = panel(HEAD, "collision");
    let named = |panel: &Panel, name: &str| panel.harness.query_all_by_label(name).next().is_some();
    assert!(named(&panel, "Colliders") && named(&panel, "Friction"));
    panel.filter.replace("camera".into());
    panel.harness.run_steps(3);
    assert!(named(&panel, "Camera position"));
}

#[test]
fn the_current_view_is_written_as_the_scene_camera_in_one_undo_step() {
    let mut panel = panel(HEAD, "camera");
    panel.harness.get_by_label(TAKE_VIEW).click();
    panel.harness.run_steps(3);
    let camera = panel.session.borrow().document().settings().camera.unwrap();
    assert!(
        camera.position.distance(Camera::default().position) < 1e-3
            && camera.target == Camera::default().target
    );
    panel.session.borrow_mut().act(Action::Undo).unwrap();
    assert_eq!(panel.text(), HEAD);
}

#[test]
fn many_long_groom_names_leave_room_for_the_parameters() {
    let long = "A name that an exporter made from the whole path of the groom in its own scene, number";
    let groom = |k: usize| format!("[[groom]]\nname = \"{long} {k}\"\n[groom.grow]\nstrands = 5\n");
    let text: String = (0..20).map(groom).collect();
    let panel = panel(&format!("{HEAD}{text}"), "");
    let search = panel.harness.query_all_by_role(egui::accesskit::Role::TextInput).next().unwrap().rect();
    assert!(search.top() < 150.0, "the list of grooms fills the panel: {search:?}");
    assert!(*panel.width.borrow() < 400.0);
}
