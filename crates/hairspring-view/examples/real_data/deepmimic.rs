//! DeepMimic's clips (Peng et al. 2018): JSON with `Frames`, lists of a length of time, the root's place and a turn for each joint. Read here and not by
//! the library: a table asks for two of them.

use glam::{Quat, Vec3, vec3};
use hairspring::body::{Clip, Joint, Trs, retarget};
use hairspring_io::read_scene;
use hairspring_scene::{Ground, Scene};
use std::{error::Error, f32::consts::FRAC_PI_2, fs, path::Path};

/// A scene of the same body and hair, which walks.
const WALKS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes/straight-walk.toml");

/// Numbers of a frame.
const WIDTH: usize = 44;

/// Joints in the order of a frame: name on a rig of CMU's names, parent, place in the parent's space [m] (DeepMimic's `humanoid3d.txt`), whether it is
/// a hinge, with one angle in place of four numbers.
const JOINTS: [(&str, Option<u32>, Vec3, bool); 13] = [
    ("Hips", None, Vec3::ZERO, false),
    ("LowerBack", Some(0), vec3(0.0, 0.236, 0.0), false),
    ("Neck", Some(1), vec3(0.0, 0.224, 0.0), false),
    ("RightUpLeg", Some(0), vec3(0.0, 0.0, 0.085), false),
    ("RightLeg", Some(3), vec3(0.0, -0.422, 0.0), true),
    ("RightFoot", Some(4), vec3(0.0, -0.410, 0.0), false),
    ("RightArm", Some(1), vec3(-0.024, 0.244, 0.183), false),
    ("RightForeArm", Some(6), vec3(0.0, -0.275, 0.0), true),
    ("LeftUpLeg", Some(0), vec3(0.0, 0.0, -0.085), false),
    ("LeftLeg", Some(8), vec3(0.0, -0.422, 0.0), true),
    ("LeftFoot", Some(9), vec3(0.0, -0.410, 0.0), false),
    ("LeftArm", Some(1), vec3(-0.024, 0.244, -0.183), false),
    ("LeftForeArm", Some(11), vec3(0.0, -0.275, 0.0), true),
];

/// The walking scene with this motion, named by the file.
pub fn scene(path: &Path) -> Result<Scene, Box<dyn Error>> {
    let mut scene = read_scene(Path::new(WALKS))?.value;
    let (joints, clip) = motion(&fs::read_to_string(path)?)?;
    let body = scene.body.as_ref().ok_or("the walking scene has no body")?;
    scene.clip = Some(retarget(&joints, &clip, body).ok_or("the body has none of the joints")?.clip);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    scene.name = format!("Straight hair, {}", stem.trim_start_matches("humanoid3d_"));
    (scene.ground, scene.camera) = (Ground::default(), None);
    Ok(scene)
}

/// The skeleton and its motion: they face +X, and are turned to face +Z.
fn motion(text: &str) -> Result<(Vec<Joint>, Clip), Box<dyn Error>> {
    let frames = text.split_once("\"Frames\"").ok_or("there are no `Frames`")?.1;
    let turn = Quat::from_rotation_y(-FRAC_PI_2);
    let joint = |(name, parent, place, _): (&str, _, Vec3, _)| Joint {
        name: name.into(),
        parent,
        rest: Trs { translation: turn * place, ..Trs::default() },
    };
    let joints: Vec<Joint> = JOINTS.map(joint).into();
    let (mut samples, mut rate) = (Vec::new(), 0.0);
    for list in frames.split('[').filter_map(|rest| rest.split_once(']')).map(|(list, _)| list) {
        let numbers = list.split(',').map(|x| x.trim().parse()).collect::<Result<Vec<f32>, _>>()?;
        if numbers.len() != WIDTH {
            return Err(format!("a frame has {} numbers, not {WIDTH}", numbers.len()).into());
        }
        // The last frame has a length of 0.
        rate = if samples.is_empty() { 1.0 / f64::from(numbers[0]) } else { rate };
        let mut rest = &numbers[4..];
        for ((_, _, _, hinge), joint) in JOINTS.iter().zip(&joints) {
            let (own, after) = rest.split_at(if *hinge { 1 } else { 4 });
            rest = after;
            let rotation = match *own {
                [w, x, y, z] => Quat::from_xyzw(x, y, z, w).normalize(),
                _ => Quat::from_rotation_z(own[0]),
            };
            let root = joint.parent.is_none().then(|| turn * Vec3::from_slice(&numbers[1..4]));
            let translation = root.unwrap_or(joint.rest.translation);
            samples.push(Trs { translation, rotation: turn * rotation * turn.inverse(), scale: Vec3::ONE });
        }
    }
    Ok((joints, Clip { name: "Frames".into(), rate, joint_count: JOINTS.len(), samples }))
}
