//! Promise: a prop moves by its own keys, independent of the motion of the body. Its mesh, hair that grows
//! on it, and colliders and hands attached to it move with it. Its keys have the same format as those of
//! `[clip]`, and invalid props are refused with a one-sentence error.

use crate::scenes::{folder, message, read};
use glam::Vec3;
use hairspring::math::angle_between;
use hairspring_scene::stage::Stage;

/// A head with hair, and above it a lid with hair of its own and an attached ball. The lid is lifted by 2 m
/// in a second.
const LID: &str = "[body]\nfile = \"head.obj\"\nscale = 1\nparts = [\"scalp\"]\n\
    [[prop]]\nname = \"lid\"\nmesh = { file = \"head.obj\", parts = [\"neck\"], scale = 1 }\n\
    keys = [{ time = 0 }, { time = 1, position = [0, 2, 0] }]\n\
    [[collider]]\njoint = \"LID\"\nshape.sphere = { center = [0, 5, 0], radius = 0.5 }\n\
    [[groom]]\ngrow = { parts = [\"scalp\"], strands = 20 }\n[[groom]]\ngrow = { parts = [\"neck\"], strands = 10 }\n";

/// Motions of the body that move only its own joint: none, keys, and a nod of the head.
const MOTIONS: [&str; 3] = [
    "",
    "[clip]\nkeys = [{ time = 0 }, { time = 0.5, position = [1, 0, 0] }]\n",
    "[clip]\nfile = \"nod.bvh\"\njoint = \"Head\"\npivot = [0, 0, 0]\n",
];

#[test]
fn a_prop_and_everything_attached_move_by_its_keys() {
    let folder = folder();
    for motion in MOTIONS {
        let scene = read(folder.path(), &format!("{LID}{motion}")).unwrap().value;
        let mut stage = Stage::new(scene).unwrap();
        let rest = stage.body().unwrap().mesh.positions.clone();
        let roots = |stage: &Stage, groom: usize| -> Vec<Vec3> {
            let strands = stage.strands().nth(groom).unwrap();
            strands.groom.offsets.windows(2).map(|w| strands.points[w[0] as usize]).collect()
        };
        let before = [0, 1].map(|groom| roots(&stage, groom));
        for _ in 0..60 {
            stage.step(hairspring_test::FRAME);
        }
        let up = Vec3::Y * 2.0;
        let now = stage.body().unwrap().positions;
        // The head has three vertices; the vertices of the lid follow.
        for (now, rest) in now[3..].iter().zip(&rest[3..]) {
            assert!(now.distance(*rest + up) < 1e-5, "{motion}: {now} of {rest}");
        }
        assert!(
            now[..3].iter().zip(&rest).all(|(now, rest)| (now.y - rest.y).abs() < 0.5),
            "{motion}: the body moves with the prop"
        );
        for (now, before) in roots(&stage, 1).iter().zip(&before[1]) {
            assert!(now.distance(*before + up) < 1e-4, "{motion}: hair of the lid, {now} of {before}");
        }
        for (now, before) in roots(&stage, 0).iter().zip(&before[0]) {
            assert!((now.y - before.y).abs() < 0.5, "{motion}: hair of the head, {now} of {before}");
        }
        let ball = stage.colliders().last().unwrap();
        assert!(
            ball.end.translation.distance(up) < 1e-5,
            "{motion}: the ball is at {}",
            ball.end.translation
        );
    }
}

#[test]
fn a_prop_can_be_added_to_the_built_in_scene() {
    let folder = folder();
    let text = "[builtin]\nstrands = 50\n[[prop]]\nname = \"hand\"\nmesh = { file = \"head.obj\", scale = 1 }\n\
                keys = [{ time = 8, rotation = [0, 90, 0] }]\n[[hand]]\njoint = \"hand\"\n\
                tool.grab = { center = [0, 0, 0], radius = 0.1 }\n";
    let scene = read(folder.path(), text).unwrap().value;
    let (clip, body) = (scene.clip.as_ref().unwrap(), scene.body.as_ref().unwrap());
    // The built-in clip lasts 5 s; afterwards the head rests until the prop's last key.
    assert_eq!((clip.joint_count, body.joints.len()), (4, 4));
    assert!((clip.duration() - 8.0).abs() < 0.02, "the clip lasts {} s", clip.duration());
    assert_eq!(clip.sample(6.0)[..3], clip.sample(7.0)[..3]);
    assert_eq!(body.skin.as_ref().unwrap().inverse_bind.len(), 4);
    Stage::new(scene).unwrap();
}

#[test]
fn a_prop_rides_on_the_joint_that_it_names() {
    let folder = folder();
    let riding = |joint: &str| LID.replace("name = \"lid\"", &format!("name = \"lid\"\njoint = \"{joint}\""));
    for motion in MOTIONS {
        let scene = read(folder.path(), &format!("{}{motion}", riding("Root"))).unwrap().value;
        let mut stage = Stage::new(scene).unwrap();
        let rest = stage.body().unwrap().mesh.positions.clone();
        let mut turned = 0.0f32;
        for frame in 0..=60 {
            if frame > 0 {
                stage.step(hairspring_test::FRAME);
            }
            let root = stage.carried(Some("root"));
            turned =
                turned.max(angle_between(root.rotation, glam::Quat::IDENTITY) + root.translation.length());
            let lifted =
                stage.carried(Some("lid")).transform_point(Vec3::ZERO) - root.transform_point(Vec3::ZERO);
            // Its keys move it in the space of the joint.
            let own = root.rotation.inverse() * lifted;
            assert!(own.x.abs() + own.z.abs() < 1e-4, "{motion}: the lid moves by {own}");
            for (now, rest) in stage.body().unwrap().positions[3..].iter().zip(&rest[3..]) {
                assert!(
                    now.distance(root.transform_point(*rest + own)) < 1e-4,
                    "{motion}: {now} of {rest}, frame {frame}"
                );
            }
            let ball = stage.colliders().last().unwrap().end;
            assert!(
                ball.translation.distance(root.transform_point(own)) < 1e-4,
                "{motion}: the ball is at {ball:?}"
            );
        }
        assert_eq!(turned > 0.1, !motion.is_empty(), "{motion}: the body moves by {turned}");
        let own = (stage.carried(Some("root")).inverse() * stage.carried(Some("lid"))).translation;
        assert!(own.distance(Vec3::Y * 2.0) < 1e-4, "{motion}: the keys end at {own}");
    }
    // A second prop rides on the first, and an unknown joint is refused.
    let second = "[[prop]]\nname = \"knob\"\njoint = \"lid\"\n";
    let mut stage = Stage::new(read(folder.path(), &format!("{LID}{second}")).unwrap().value).unwrap();
    (0..60).for_each(|_| _ = stage.step(hairspring_test::FRAME));
    assert!(stage.carried(Some("knob")).translation.distance(Vec3::Y * 2.0) < 1e-4);
    let lost = message(&riding("neck"));
    assert!(lost.contains("the joint `neck` is unknown"), "{lost}");
    let later = message(&format!("{}{second}", riding("knob")));
    assert!(later.contains("the joint `knob` is unknown"), "a prop rides on a prop below it: {later}");
}

#[test]
fn a_prop_rides_on_the_head_of_the_built_in_scene() {
    let folder = folder();
    let text = "[builtin]\nstrands = 50\n[[prop]]\nname = \"hat\"\njoint = \"head\"\n\
                mesh = { file = \"head.obj\", scale = 1 }\n";
    let mut stage = Stage::new(read(folder.path(), text).unwrap().value).unwrap();
    let mut turned = 0.0f32;
    for _ in 0..60 {
        stage.step(hairspring_test::FRAME);
        let [head, hat] = ["head", "hat"].map(|name| stage.carried(Some(name)));
        turned = turned.max(angle_between(head.rotation, glam::Quat::IDENTITY));
        let off = hat.translation.distance(head.translation) + angle_between(hat.rotation, head.rotation);
        assert!(off < 1e-3, "the hat leaves the head by {off}");
    }
    assert!(turned > 0.05, "the head turns by {turned}");
}

#[test]
fn a_mesh_without_joints_is_placed_by_its_transform() {
    let folder = folder();
    let mesh = |transform: &str| {
        format!(
            "[[prop]]\nname = \"lid\"\nmesh = {{ file = \"head.obj\", parts = [\"neck\"], scale = 1{transform} }}\n\
                 [[sheet]]\nfile = \"head.obj\"\nparts = [\"neck\"]\nscale = 1\njoint = \"lid\"{}\n",
            transform.replace(", transform", "\ntransform")
        )
    };
    let body = "[body]\nfile = \"head.obj\"\nscale = 1\nparts = [\"scalp\"]\n";
    let groom = "[[groom]]\nfile = \"hair.data\"\n";
    let scene =
        |transform: &str| read(folder.path(), &format!("{body}{}{groom}", mesh(transform))).unwrap().value;
    let positions = |scene: &hairspring_scene::Scene| {
        let body = scene.body.as_ref().unwrap();
        (body.mesh.positions[3..].to_vec(), scene.sheets[0].body.mesh.positions.clone())
    };
    let (before, sheet) = positions(&scene(""));
    assert_eq!(before, sheet);
    let moved = scene(
        ", transform.position = [0, 1, 0], transform.rotation = [0, 0, 90], transform.scale = [2, 1, -1]",
    );
    let (after, sheet) = positions(&moved);
    assert_eq!(after, sheet);
    for (before, after) in before.iter().zip(&after) {
        let right = Vec3::new(-before.y, 2.0 * before.x + 1.0, -before.z);
        assert!(after.distance(right) < 1e-5, "{before} is placed at {after}, not {right}");
    }
    // A mirrored mesh keeps its outside.
    let mesh = &moved.body.as_ref().unwrap().mesh;
    let [a, b, c] = mesh.corners(mesh.triangles.len() - 1);
    let normal = mesh.normals[mesh.triangles[mesh.triangles.len() - 1][0] as usize];
    assert!((b - a).cross(c - a).dot(normal) > 0.0, "the triangles of a mirrored mesh face inward");
    let wrong = message(&format!("{body}transform.scale = 0\n{groom}"));
    assert!(wrong.contains("line 5: `transform.scale` must be finite and not 0"), "{wrong}");
}

#[test]
fn invalid_props_are_refused() {
    let groom = "[[groom]]\nfile = \"hair.data\"\n";
    let body = "[body]\nfile = \"head.obj\"\nscale = 1\n";
    let wrong = |prop: &str| message(&format!("{body}[[prop]]\n{prop}\n{groom}"));
    for (prop, part) in [
        ("name = \"\"", "line 5: `name` must be non-empty"),
        ("name = \"root\"", "line 5: the body has a joint \"root\" already"),
        ("name = \"a\"\n[[prop]]\nname = \"A\"", "line 7: `name` must be non-empty and unique"),
        ("name = \"a\"\nkeys = [{ time = 1 }, { time = 1 }]", "line 6: `keys` must be in order of `time`"),
        ("name = \"a\"\npivot = [nan, 0, 0]", "line 6: `pivot` must be three finite numbers"),
        ("name = \"a\"\nmesh = { file = \"head.obj\", joint = \"b\" }", "`joint` must be omitted"),
        ("name = \"a\"\nmesh = { file = \"hed.obj\" }", "names it as the prop"),
        ("nmae = \"a\"", "did you mean `name`?"),
    ] {
        assert!(wrong(prop).contains(part), "{prop}: {}", wrong(prop));
    }
    assert!(message(&format!("[[prop]]\nname = \"a\"\n{groom}")).contains("but there is no [body]"));
    let lost = format!(
        "{body}{groom}[[collider]]\njoint = \"b\"\nshape.sphere = {{ center = [0, 0, 0], radius = 1 }}\n"
    );
    assert!(message(&lost).contains("the joint `b` is unknown"), "{}", message(&lost));
}
