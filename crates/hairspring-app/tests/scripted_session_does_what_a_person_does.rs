//! Promise: a script can do what a user does: open the window, play, change parameters, throw the ball,
//! grab a lock, record, save and open again. The saved file contains the changes and nothing else, the
//! recordings play, undo works, and no line is refused. An undo or redo step that fails stays available
//! until it succeeds.

mod support;

use egui::{Event, Event::PointerMoved, Modifiers, PointerButton::Primary};
use egui_kittest::kittest::Queryable;
use hairspring_app::{Action, Document, Session};
use support::{SMALL, sound, until, window};

#[test]
fn a_session_opens_plays_changes_records_saves_and_opens_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let script = format!(
        "wait 5\npause\n\
         set wind.velocity [2.0, 0.0, -1.0]\nset wind.gust 0.5\nset wind.gust_rate 0.7\nset turbulence.strength 0.4\n\
         set solver.substeps 3\nset solver.projection_iterations 2\nset volume.method \"density\"\nset volume.friction 5.0\n\
         set builtin.look.roughness 0.5\nset gravity [0.0, -5.0, 0.0]\nwait 10\n\
         set solver.inertia 0.5\nundo\nredo\nundo\n\
         hand ball\ndrag 0.2 0.5 0.7 0.5 12\nhand grab\ndrag 0.5 0.5 0.7 0.7 12\nhand head\ndrag 0.5 0.4 0.6 0.4 8\nhand comb\ndrag 0.5 0.5 0.6 0.7 12\nhand hand\ndrag 0.3 0.3 0.4 0.7 12\nhand look\ndrag 0.5 0.5 0.6 0.5 4\n\
         show tension\noverlay slice on\noverlay volume on\noverlay colliders on\noverlay roots on\noverlay frames on\nwait 3\nshow natural\n\
         still {still}\nclip {clip} 0.5\nturntable {turn} 0.3\npictures {pictures} 0.1\n\
         save {saved}\nnew curly\nwait 2\nopen {saved}\nwait 3\n",
        still = file("still.png").display(),
        clip = file("clip.mp4").display(),
        turn = file("turn.mp4").display(),
        pictures = file("p.##.png").display(),
        saved = file("saved.toml").display(),
    );
    let mut window = window(folder.path(), SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()), "the script did not finish");
    let app = window.state();
    let wrong = app.message().filter(|(_, wrong)| *wrong);
    assert_eq!(wrong, None, "a line was refused");
    assert!(sound(app));
    let text = std::fs::read_to_string(file("saved.toml")).unwrap();
    assert_eq!(app.session().document().text(), text, "the open scene differs from the saved file");
    for line in ["gust = 0.5", "substeps = 3", "method = \"density\"", "roughness = 0.5", "strands = 400"] {
        assert!(text.contains(line), "{line} is missing in the file:\n{text}");
    }
    assert!(!text.contains("inertia"), "an undone change is in the file:\n{text}");
    assert_eq!(Document::open(&file("saved.toml")).unwrap().text(), text);
    let still = hairspring_view::read_png(&file("still.png")).unwrap();
    assert_eq!((still.width, still.height), (1280, 720));
    let dark = still.rgb.iter().filter(|b| **b < 8).count();
    assert!(dark < still.rgb.len() / 2, "the picture is mostly black");
    for clip in ["clip.mp4", "turn.mp4"] {
        assert!(std::fs::metadata(file(clip)).unwrap().len() > 2000, "{clip} is nearly empty");
    }
    for k in 1..=3 {
        assert!(file(&format!("p.{k:02}.png")).exists());
    }
}

#[test]
fn still_of_a_comparison_shows_both_scenes_and_captions() {
    let folder = tempfile::tempdir().unwrap();
    let still = folder.path().join("pair.png");
    let script = format!(
        "pause\nwait 1\ncompare on\nsecond on\n\
         set builtin.look.root_color [0.9, 0.0, 0.0]\nset builtin.look.tip_color [0.9, 0.0, 0.0]\nwait 1\nstill {}\n",
        still.display()
    );
    let mut window = window(folder.path(), SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    let image = hairspring_view::read_png(&still).unwrap();
    let (left, gap, right) = (0..638, 638..642, 642..1280);
    assert!(
        gap.clone().all(|x| (0..692).all(|y| image.pixel(x, y) == [24; 3])),
        "the gap between the two pictures is missing"
    );
    let red = |columns: std::ops::Range<u32>| -> u64 {
        let column = |x: u32| {
            (0..692).map(|y| image.pixel(x, y)).map(|[r, g, _]| u64::from(r.saturating_sub(g))).sum::<u64>()
        };
        columns.map(column).sum()
    };
    let (brown, dyed) = (red(left.clone()), red(right.clone()));
    assert!(dyed > 2 * brown && brown > 0, "the sides do not show their own scenes: {brown}, {dyed}");
    for side in [left, right] {
        let words = side.map(|x| (692..720).filter(|y| image.pixel(x, *y)[0] > 150).count()).sum::<usize>();
        assert!(words > 100, "a caption is missing: {words} light pixels");
    }
    let [first, second] = window.state().session().captions();
    assert!(
        first.starts_with("Root color: [") && second.contains("Tip color: [0.9, 0, 0]"),
        "{first}; {second}"
    );
}

fn press(pos: egui::Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: Primary, pressed, modifiers: Modifiers::NONE }
}

#[test]
fn refused_commands_report_an_error_and_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(folder.path(), SMALL, "pause\nset solver.substeps 0\nwait 1");
    assert!(until(&mut window, |app| app.is_idle()));
    let (message, wrong) = window.state().message().expect("there is no message");
    assert!(wrong && message.contains("substeps"), "{message}");
    assert_eq!(window.state().session().document().text(), SMALL);
    // A click on the message dismisses it.
    let message = message.to_owned();
    let center = window.get_by_label(&message).rect().center();
    for event in [PointerMoved(center), press(center, true), press(center, false)] {
        window.event(event);
        window.step();
    }
    window.step();
    assert_eq!(window.state().message(), None);
    for (line, word) in [
        ("open nowhere.toml", "nowhere.toml"),
        ("open picture.gif", "picture.gif"),
        ("set no.such 1", "no"),
        ("still hair.txt", "png"),
        ("clip hair.png 1", "mp4"),
        ("clip hair.mp4 0.001", "1 to 100000 frames"),
        ("turntable hair.mp4 4000", "1 to 100000 frames"),
        ("unset wind.gust", "nothing to remove"),
        ("unset wnd.gust", "nothing to remove"),
        ("range 500000 600000", "from frame 500000 to 600000"),
        ("save few.hair", "few.hair: a scene is written as .toml"),
    ] {
        let mut window = self::window(folder.path(), SMALL, &format!("pause\n{line}"));
        assert!(until(&mut window, |app| app.is_idle()));
        let (message, wrong) = window.state().message().expect("there is no message");
        assert!(wrong && message.contains(word), "{line}: {message:?}");
        assert_eq!(window.state().session().document().text(), SMALL, "'{line}' changed the scene");
    }
}

#[test]
fn a_paused_wait_takes_exactly_its_steps() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(folder.path(), SMALL, "pause\nreset\nwait 130");
    assert!(until(&mut window, |app| app.is_idle()));
    let time = window.state().session().latest().unwrap().time;
    assert!((time - 130.0 / 60.0).abs() < 1e-6, "{time}");
}

#[test]
fn an_opened_motion_reports_what_it_removed() {
    let folder = tempfile::tempdir().unwrap();
    let motion = folder.path().join("nod.bvh");
    std::fs::write(
        &motion,
        "HIERARCHY\nROOT head\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n\
         MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n0 9 0\n",
    )
    .unwrap();
    let scene = format!(
        "{SMALL}# her nod\n[clip]\nkeys = [{{ time = 0.0 }}, {{ time = 1.0, rotation = [0.0, 5.0, 0.0] }}]\n"
    );
    let script = format!("pause\nopen {}\nwait 1", motion.display());
    let mut window = window(folder.path(), &scene, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    let (message, wrong) = window.state().message().expect("there is no message");
    assert!(!wrong && message.ends_with("removed from the scene: clip.keys"), "{message}");
    assert!(window.state().session().document().text().contains("# her nod\n[clip]\nfile = "));
}

#[test]
fn recording_continues_past_the_end_of_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    // The motion has three steps and repeats several times within a clip of twelve.
    let scene =
        format!("{SMALL}[clip]\nkeys = [{{ time = 0.0 }}, {{ time = 0.05, rotation = [0.0, 5.0, 0.0] }}]\n");
    let clip = folder.path().join("p.##.png");
    let script = format!("pause\nwait 9\npictures {} 0.2\n", clip.display());
    let mut window = window(folder.path(), &scene, &script);
    assert!(until(&mut window, |app| app.is_idle()), "the recording did not finish");
    assert!(folder.path().join("p.06.png").exists());
}

#[test]
fn settings_change_during_playback() {
    let document = Document::new("scene.toml".as_ref(), SMALL.into()).unwrap();
    let mut session = Session::new(document, 2, None, || ()).unwrap();
    let wait = |session: &Session, step: u64| {
        for _ in 0..6000 {
            if let Some(snapshot) = session.latest().filter(|s| s.scene == session.begun() && s.step >= step)
            {
                return snapshot;
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        panic!("step {step} was not reached");
    };
    let before = wait(&session, 5);
    let key = "wind.velocity".parse().unwrap();
    session.act(Action::Set(key, Some(toml_edit::Value::from_iter([5.0, 0.0, 0.0])))).unwrap();
    let after = wait(&session, before.step + 30);
    assert_eq!(after.scene, before.scene, "a setting restarted the scene");
    assert!(after.time > before.time);
    // While paused, a changed look is a new snapshot although time does not advance. The change is applied
    // after the pause.
    session.act(Action::Play(false)).unwrap();
    let mut seen = |roughness: f64| {
        let key = "builtin.look.roughness".parse().unwrap();
        session.act(Action::Set(key, Some(roughness.into()))).unwrap();
        for _ in 0..6000 {
            let shown = session.latest().filter(|s| s.stages[0].looks[0].roughness == roughness as f32);
            if let Some(snapshot) = shown {
                return (snapshot.number, snapshot.step);
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        panic!("a roughness of {roughness} was not shown");
    };
    let (first, second) = (seen(0.875), seen(0.75));
    assert!(
        second.0 > first.0 && second.1 == first.1,
        "expected a newer snapshot at the same time: {first:?}, then {second:?}"
    );
}

#[test]
fn a_failed_undo_step_stays_available() {
    let folder = tempfile::tempdir().unwrap();
    let stone = folder.path().join("stone.obj");
    let away = folder.path().join("away.obj");
    std::fs::write(&stone, "v 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n")
        .unwrap();
    let text = format!("{SMALL}[[collider]]\nshape.hull = {{ file = \"stone.obj\", scale = 1.0 }}\n");
    let document = Document::new(&folder.path().join("scene.toml"), text.clone()).unwrap();
    let mut session = Session::new(document, 1, None, || ()).unwrap();
    let now = |session: &Session| session.document().text().to_owned();
    let set = |speed: f64| {
        let key = "wind.velocity".parse().unwrap();
        Action::Set(key, Some(toml_edit::Value::from_iter([speed, 0.0, 0.0])))
    };
    for action in [set(1.0), Action::Rest, set(2.0), Action::New(SMALL.into())] {
        session.act(action).unwrap();
    }
    // Undo into the previous scene, undo twice within it, and redo all three steps.
    let steps = [Action::Undo, Action::Undo, Action::Undo, Action::Redo, Action::Redo, Action::Redo];
    let mut seen = vec![now(&session)];
    for (k, step) in steps.into_iter().enumerate() {
        let (left, more) = (now(&session), session.steps());
        // The last step leads to a scene that names no file.
        if k < 5 {
            std::fs::rename(&stone, &away).unwrap();
            for _ in 0..2 {
                let why = session.act(step.clone()).unwrap_err().to_string();
                assert!(why.contains("stone.obj"), "step {k}: {why}");
                assert_eq!((now(&session), session.steps()), (left.clone(), more), "step {k}");
            }
            std::fs::rename(&away, &stone).unwrap();
        }
        session.act(step).unwrap();
        seen.push(now(&session));
    }
    assert_eq!((&*seen[0], &*seen[3]), (SMALL, &*text), "undo does not return to the other scene: {seen:?}");
    assert!(
        seen[1].contains("2.0") && seen[2].contains("1.0"),
        "undo does not return to the earlier wind: {seen:?}"
    );
    assert!(seen.iter().eq(seen.iter().rev()), "redo does not mirror undo: {seen:?}");
}
