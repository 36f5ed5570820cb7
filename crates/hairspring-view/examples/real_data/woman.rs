//! `face.bin` of JoltPhysics (Rouwe 2025, `Assets/face.bin`): a woman's head and shoulders, and a hand that strokes her hair. Read here and
//! not by the library: there is one such file. Its convex hulls, one a bone, are passed over: they overlap, and where a point is in two of them the nearest way out
//! of one leads into the other.

use glam::{Affine3A, Mat4, Quat, Vec3};
use hairspring::body::{Body, Clip, Joint, Mesh, Part, Skin, Trs};
use hairspring_io::read_scene_text;
use hairspring_scene::Scene;
use std::{error::Error, fs, path::Path};

/// Frames a second [Hz]. The file names none; the hand then goes along the head in 2 s.
const RATE: f32 = 30.0;

/// Linear RGB.
const SKIN: Vec3 = Vec3::new(0.50, 0.30, 0.23);

/// Hair and settings: long straight hair, which was made for another head. This likeness puts its roots on her skin.
const SCENE: &str = r#"
name = "A hand strokes her hair"

[[groom]]
file = "../../grooms/straight/straight.hair"
scale = 1.0
material = "straight"
guides = 3000

[groom.transform]
scale = [-0.003778, 0.003778, 0.003778]
rotation = [0.0, 180.0, 0.0]
position = [0.0, -0.0639, -0.0269]

[camera]
position = [-0.75, 0.15, 0.75]
target = [-0.03, -0.03, 0.0]
fov = 34.0
"#;

/// The head with its hair, and the hand.
pub fn scene(path: &Path) -> Result<Scene, Box<dyn Error>> {
    let mut scene = read_scene_text(&path.with_file_name("woman.toml"), SCENE)?.value;
    let data = fs::read(path)?;
    let mut file = Words(&data);
    file.number()?;
    let positions = file.list(Words::vector)?;
    let triangles = file.list(|file| Ok([file.number()?, file.number()?, file.number()?]))?;
    let binds = file.list(Words::matrix)?;
    let weights = file.number()?;
    let mut skin = Skin { joints: Vec::new(), weights: Vec::new(), inverse_bind: binds.clone() };
    for _ in &positions {
        let (mut joints, mut shares) = ([0; 4], [0.0; 4]);
        for k in 0..weights as usize {
            (joints[k], shares[k]) = (file.number()? as u16, file.real()?);
        }
        skin.joints.push(joints);
        skin.weights.push(shares);
    }
    let frames = file.number()? as usize;
    let mut samples = Vec::with_capacity(frames * binds.len());
    for _ in 0..frames * binds.len() {
        let (translation, turn) = (file.vector()?, file.vector()?);
        let w = (1.0 - turn.length_squared()).max(0.0).sqrt();
        let rotation = Quat::from_xyzw(turn.x, turn.y, turn.z, w).normalize();
        samples.push(Trs { translation, rotation, scale: Vec3::ONE });
    }
    let joint = |(k, bind): (usize, &Affine3A)| {
        let (scale, rotation, translation) = bind.inverse().to_scale_rotation_translation();
        Joint { name: k.to_string(), parent: None, rest: Trs { translation, rotation, scale } }
    };
    let joints: Vec<Joint> = binds.iter().enumerate().map(joint).collect();
    let all = 0..triangles.len() as u32;
    let parts = vec![Part { name: "woman".into(), triangles: all, color: SKIN, roughness: 0.6 }];
    let mut mesh = Mesh { positions, triangles, parts, ..Mesh::default() };
    mesh.compute_normals();
    scene.clip =
        Some(Clip { name: "face".into(), rate: f64::from(RATE), joint_count: joints.len(), samples });
    scene.body = Some(Body { mesh, joints, skin: Some(skin) });
    Ok(scene)
}

/// What is left of the file: little-endian words.
struct Words<'a>(&'a [u8]);

impl Words<'_> {
    fn number(&mut self) -> Result<u32, Box<dyn Error>> {
        let (word, rest) = self.0.split_first_chunk().ok_or("the file ends too early")?;
        self.0 = rest;
        Ok(u32::from_le_bytes(*word))
    }

    fn real(&mut self) -> Result<f32, Box<dyn Error>> {
        Ok(f32::from_bits(self.number()?))
    }

    fn vector(&mut self) -> Result<Vec3, Box<dyn Error>> {
        Ok(Vec3::new(self.real()?, self.real()?, self.real()?))
    }

    fn matrix(&mut self) -> Result<Affine3A, Box<dyn Error>> {
        let mut columns = [0.0; 16];
        for x in &mut columns {
            *x = self.real()?;
        }
        Ok(Affine3A::from_mat4(Mat4::from_cols_array(&columns)))
    }

    /// So many of `one` as the next word says.
    fn list<T>(
        &mut self,
        mut one: impl FnMut(&mut Self) -> Result<T, Box<dyn Error>>,
    ) -> Result<Vec<T>, Box<dyn Error>> {
        let count = self.number()?;
        (0..count).map(|_| one(self)).collect()
    }
}
