//! Promise: the last frame of a glTF motion is its last key, whatever its duration, and a joint that is scaled to 0 keeps
//! the scale before it.

use crate::gltf_file::GltfFile;
use hairspring_io::gltf;
use serde_json::json;

/// A tetrahedron with an animation of its node `Head`: two linear keys, the second after `duration` [s].
fn moving(path: &str, duration: f32, values: [[f32; 3]; 2]) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let input = file.floats("SCALAR", &[0.0, duration]);
    let output = file.floats("VEC3", &values.concat());
    let animation = json!({
        "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
        "samplers": [{"input": input, "output": output}],
    });
    file.push("animations", animation);
    file
}

#[test]
fn the_last_frame_of_a_motion_is_its_last_key() {
    for frames in [1, 13, 14, 24, 119] {
        let duration = frames as f32 / 24.0;
        let file = moving("translation", duration, [[0.0; 3], [1.0, 0.0, 0.0]]);
        let (character, _) = gltf::parse(&file.glb(), &|_| None).unwrap();
        let clip = &character.clips[0];
        let last = clip.samples.last().unwrap().translation.x;
        assert!((last - 1.0).abs() < 1e-5, "{frames} frames end at {last}");
        assert!(
            (clip.duration() - f64::from(duration)).abs() < 1e-5,
            "{} s for {duration} s",
            clip.duration()
        );
        assert!(clip.rate >= 60.0, "{} Hz", clip.rate);
    }
}

#[test]
fn a_joint_that_is_scaled_to_nothing_keeps_its_scale() {
    let file = moving("scale", 1.0, [[1.0; 3], [-1.0; 3]]);
    let (character, notes) = gltf::parse(&file.glb(), &|_| None).unwrap();
    let smallest = character.clips[0].samples.iter().map(|s| s.scale.abs().min_element()).fold(1.0, f32::min);
    assert!(smallest > 1e-3, "{smallest}");
    let notes = notes.join("\n");
    assert!(notes.contains("scales the joint \"Head\" to 0 at 0.50 s"), "{notes}");
}
