//! Promise: hair of one groom interacts with that of another as within one groom.
//!
//! A scene may have separate grooms for the fringe and the length, or two heads with one groom each. How an
//! artist divides strands into grooms depends on files and materials, not on physics. So hair that is
//! divided into grooms moves exactly, bit for bit, as in one groom. This holds for every interaction: the
//! volume by either method, strand contact, and charge. A guide has the weight of the hairs of its own
//! groom that follow it.
//!
//! A second head, which moves independently, may have any position in its file, for example inside the
//! first head. Its hair is initialized where the head is when the scene begins, as if its mesh had been
//! authored there.

use crate::support::{play, points};
use glam::Vec3;
use hairspring::{
    body::{Body, Clip, Joint, Mesh, Skin, Trs},
    groom::{Groom, bind_roots_where},
    material::Material,
    settings::{Solver, Volume, VolumeMethod},
};
use hairspring_scene::{Collider, Guides, InitialContact, Scene, SceneGroom, Shape, stage::Stage};
use hairspring_test::{FRAME, farthest, line};

const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);
const POINTS: usize = 12;

/// A strand of 12 cm from `root` along `direction`.
fn strand(root: Vec3, direction: Vec3) -> Vec<Vec3> {
    line(root, root + direction * 0.12, POINTS)
}

/// Two patches of hair, 4 cm apart, that fall toward each other.
fn patches() -> Vec<Vec<Vec3>> {
    let patch = |side: f32| {
        (0..64).map(move |k| {
            let root = Vec3::new(side * (0.02 + 0.002 * (k % 8) as f32), 0.0, 0.002 * (k / 8) as f32);
            strand(root, Vec3::new(-side, 0.3, 0.0).normalize())
        })
    };
    patch(-1.0).chain(patch(1.0)).collect()
}

fn groom(strands: &[Vec<Vec3>]) -> SceneGroom {
    SceneGroom {
        groom: Groom::from_strands(strands, 35e-6),
        materials: vec![Material { drag: 0.1, ..Material::default() }],
        guides: Guides::All,
        ..SceneGroom::default()
    }
}

fn scene(grooms: Vec<SceneGroom>) -> Scene {
    let solver = Solver { sag_free: false, ..Solver::default() };
    Scene { grooms, gravity: GRAVITY, solver, ..Scene::default() }
}

/// All points of a scene after `frames` frames.
fn played(scene: &Scene, frames: usize) -> Vec<Vec3> {
    let mut stage = Stage::new(scene.clone()).unwrap();
    play(&mut stage, frames);
    points(&stage)
}

#[test]
fn hair_divided_into_grooms_moves_as_in_one() {
    let strands = patches();
    let (left, right) = strands.split_at(64);
    /// Enables one kind of interaction between two grooms.
    type Meet = fn(&mut Scene);
    let meetings: [(&str, Meet); 4] = [
        ("density", |s| s.volume.method = VolumeMethod::Density),
        ("incompressible", |s| s.volume.method = VolumeMethod::Incompressible),
        ("neighbours", |s| s.neighbours.on = true),
        ("charge", |s| s.grooms.iter_mut().for_each(|g| g.materials[0].charge = 3e-9)),
    ];
    for (name, meet) in meetings {
        let (mut one, mut two) = (scene(vec![groom(&strands)]), scene(vec![groom(left), groom(right)]));
        [&mut one, &mut two].into_iter().for_each(meet);
        let (one, two) = (played(&one, 20), played(&two, 20));
        assert!(one == two, "{name}: {} m apart", farthest(&one, &two));
        // The interaction has an effect: the left groom alone moves differently.
        let mut alone = scene(vec![groom(left)]);
        meet(&mut alone);
        let difference = farthest(&played(&alone, 20), &one[..64 * POINTS]);
        assert!(difference > 1e-4, "{name}: the other patch moves it by {difference} m");
    }
}

#[test]
fn a_guide_has_the_weight_of_its_follow_hairs() {
    // The effect of the right patch on the left one, with all strands of the right patch simulated, and
    // with one eighth of them as guides for all.
    let strands = patches();
    let (left, right) = strands.split_at(64);
    let left_after = |guides: Guides, volume: VolumeMethod| {
        let mut two = scene(vec![groom(left), SceneGroom { guides, ..groom(right) }]);
        two.volume = Volume { method: volume, cell: Some(0.01), friction: 60.0, ..Volume::default() };
        played(&two, 12)[..64 * POINTS].to_vec()
    };
    let free = left_after(Guides::All, VolumeMethod::Off);
    let all = left_after(Guides::All, VolumeMethod::Density);
    let few = left_after(Guides::Count(8), VolumeMethod::Density);
    let (braked, differs) = (farthest(&free, &all), farthest(&all, &few));
    println!(
        "the right patch moves the left one by {braked:.4} m; with guides only, the result differs by {differs:.4} m"
    );
    assert!(braked > 5e-3, "the right patch moves the left one by only {braked} m");
    assert!(differs < 0.5 * braked, "with guides only, the result differs by {differs} m of {braked} m");
}

/// Adds a plate of 4 cm at `middle`, of two triangles.
fn plate(mesh: &mut Mesh, middle: Vec3) {
    let first = mesh.positions.len() as u32;
    let corner = |x: f32, z: f32| middle + Vec3::new(0.02 * x, 0.0, 0.02 * z);
    mesh.positions.extend([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]);
    mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| first + k)));
}

/// Two plates with hair. The second has a joint of its own and rests at `away` from the first. The clip
/// moves it from there to 6 cm from the first.
fn plates(away: Vec3) -> Scene {
    let mut mesh = Mesh::default();
    plate(&mut mesh, Vec3::ZERO);
    plate(&mut mesh, away);
    let joint = |name: &str| Joint { name: name.into(), parent: None, rest: Trs::default() };
    let weights = vec![[1.0, 0.0, 0.0, 0.0]; 8];
    let joints = (0..8).map(|v| [v / 4, 0, 0, 0]).collect();
    let skin = Skin { joints, weights, inverse_bind: vec![Default::default(); 2] };
    let mut body = Body { mesh, joints: vec![joint("body"), joint("other")], skin: Some(skin) };
    body.mesh.normals = vec![Vec3::Y; 8];
    let there = Trs { translation: Vec3::new(0.06, 0.0, 0.0) - away, ..Trs::default() };
    let clip =
        Clip { name: "still".into(), rate: 60.0, joint_count: 2, samples: vec![Trs::default(), there] };
    let hair = |middle: Vec3, side: f32| {
        let root = |k: usize| {
            middle + Vec3::new(0.003 * (k % 6) as f32 - 0.009, 0.0, 0.003 * (k / 6) as f32 - 0.009)
        };
        groom(&(0..36).map(|k| strand(root(k), Vec3::new(side, 1.0, 0.0).normalize())).collect::<Vec<_>>())
    };
    let mut grooms = [hair(Vec3::ZERO, 0.5), hair(away, -0.5)];
    for (k, groom) in grooms.iter_mut().enumerate() {
        bind_roots_where(&mut groom.groom, &body.mesh, |_, triangle| triangle / 2 == k);
    }
    let mut scene = scene(grooms.into());
    scene.volume = Volume { method: VolumeMethod::Density, ..Volume::default() };
    scene.solver.collide_body = false;
    let ball = Shape::Sphere { center: Vec3::new(0.03, 0.05, 0.0), radius: 0.02 };
    scene.colliders =
        vec![Collider { shape: ball, initial: InitialContact::Keep, joint: Some("body".into()) }];
    Scene { body: Some(body), clip: Some(clip), ..scene }
}

#[test]
fn hair_on_a_second_body_is_initialized_at_its_start_pose() {
    // The second plate rests inside the first, or already at its start position.
    let [moved, made] = [Vec3::ZERO, Vec3::new(0.06, 0.0, 0.0)].map(plates);
    for frames in [0, 15] {
        let difference = farthest(&played(&moved, frames), &played(&made, frames));
        println!("{frames} frames: {difference:.1e} m apart");
        assert!(
            difference < if frames == 0 { 1e-7 } else { 1e-4 },
            "points differ by {difference} m after {frames} frames"
        );
    }
    let mut stage = Stage::new(moved).unwrap();
    stage.step(FRAME);
    let share = stage.volume().unwrap().volume_ratio;
    assert!((share - 1.0).abs() < 0.05, "hair does not start at rest density: {share}");
}
