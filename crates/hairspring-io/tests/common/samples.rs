//! Small generated files of every format, and the readers for them.

use glam::{Vec2, Vec3};
use hairspring::groom::Groom;
use hairspring_io::{
    Problem, bvh, csv, gltf, hair, makehuman, obj, pc2, ply, scene, tfx, tfxbone, tfxmesh, usc, write_groom,
};

/// A format's name, a small file in it, and its reader.
pub type Sample = (&'static str, Vec<u8>, fn(&[u8]) -> Result<(), Problem>);

/// Three strands of `points` points, with colors and texture coordinates.
pub fn groom(points: usize) -> Groom {
    let strands =
        (0..3).map(|s| (0..points).map(|i| Vec3::new(s as f32, 0.1 * i as f32, 0.5)).collect::<Vec<_>>());
    let mut groom = Groom::from_strands(strands, 4e-5);
    groom.radii.iter_mut().enumerate().for_each(|(i, r)| *r += 1e-6 * (i / points) as f32);
    groom.colors = groom.points.iter().map(|p| p.fract()).collect();
    groom.root_uvs = vec![Vec2::new(0.25, 0.5); 3];
    groom
}

/// The bytes of `groom` as written in the format of `extension`.
pub fn written(groom: &Groom, extension: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("groom").with_extension(extension);
    write_groom(&path, groom).unwrap();
    std::fs::read(path).unwrap()
}

/// A table of two strands with every attribute.
const TABLE: &str = "strand,x,y,z,radius,r,g,b,group,guide,u,v,stiffness,damping,drag,friction,charge,density\n\
    a,0,0,0,4e-5,1,0.5,0,top,1,0.1,0.9,2,1,1,0.5,1,1\na,0,0.1,0,3e-5,1,0.5,0,top,1,0.1,0.9,2,1,1,0.5,1,1\n\
    b,1,0,0,4e-5,0,0.5,1,side,0,0.2,0.8,1,1,3,1,1,1\nb,1,0.1,0,3e-5,0,0.5,1,side,0,0.2,0.8,1,1,3,1,1,1\n";

/// Two samples of three points.
fn point_cache() -> Vec<u8> {
    let mut bytes = b"POINTCACHE2\0".to_vec();
    bytes.extend(1i32.to_le_bytes());
    bytes.extend(3i32.to_le_bytes());
    [0f32, 1.0].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes.extend(2i32.to_le_bytes());
    (0..18).for_each(|k| bytes.extend((0.1 * k as f32).to_le_bytes()));
    bytes
}

/// One sample of each format.
pub fn all() -> Vec<Sample> {
    let mut uneven = groom(4);
    uneven.offsets = vec![0, 3, 8, 12];
    vec![
        ("hair", written(&uneven, "hair"), |b| hair::parse(b).map(drop)),
        ("hair-even", written(&groom(4), "hair"), |b| hair::parse(b).map(drop)),
        ("tfx-4", written(&groom(4), "tfx"), |b| tfx::parse(b).map(drop)),
        ("tfx-3", tfx_3(), |b| tfx::parse(b).map(drop)),
        ("tfx-2", tfx_2().into_bytes(), |b| tfx::parse(b).map(drop)),
        ("data", written(&uneven, "data"), |b| usc::parse(b).map(drop)),
        ("tfxbone", bones(), |b| tfxbone::parse(b).map(drop)),
        ("tfxmesh", skinned_mesh().into_bytes(), |b| tfxmesh::parse(b).map(drop)),
        ("obj", mesh().into_bytes(), |b| obj::parse(b).map(drop)),
        ("obj-strands", strands().into_bytes(), |b| obj::parse_groom(b).map(drop)),
        ("ply-ascii", ply_edges("ascii"), |b| ply::parse(b).map(drop)),
        ("ply-little", ply_edges("binary_little_endian"), |b| ply::parse(b).map(drop)),
        ("ply-big", ply_edges("binary_big_endian"), |b| ply::parse(b).map(drop)),
        ("ply-lists", PLY_LISTS.into(), |b| ply::parse(b).map(drop)),
        ("ply-ids", PLY_IDS.into(), |b| ply::parse(b).map(drop)),
        ("csv", TABLE.into(), |b| csv::parse(b).map(drop)),
        ("pc2", point_cache(), |b| pc2::parse(b).map(drop)),
        ("bvh", motion().into_bytes(), |b| bvh::parse(b).map(drop)),
        ("glb", glb(), |b| gltf::parse(b, &|_| None).map(drop)),
        ("glb-morph", glb_morph(), morphed),
        ("glb-strands", glb_strands(), |b| gltf::parse_groom(b, &|_| None).map(drop)),
        ("rig", RIG.into(), |b| makehuman::parse(obj::parse(mesh().as_bytes())?, b, WEIGHTS).map(drop)),
        ("weights", WEIGHTS.into(), |b| makehuman::parse(obj::parse(mesh().as_bytes())?, RIG, b).map(drop)),
        ("toml", scene_text().into_bytes(), |b| scene::check_text(&String::from_utf8_lossy(b))),
    ]
}

/// The scene that the book shows, with one of its comments. Changes in comments seldom matter, and the page has mostly those.
fn scene_text() -> String {
    let page = include_str!("../../../../docs/scene.md");
    let (_, text) = page.split_once("```toml\n").unwrap();
    let fields = text.trim_end().trim_end_matches("```").lines().filter(|line| !line.starts_with('#'));
    let fields = fields.map(|line| line.split_once(" # ").map_or(line, |(field, _)| field.trim_end()));
    ["# A scene"].into_iter().chain(fields).map(|line| format!("{line}\n")).collect()
}

/// A `.tfx` of version 3 with two strands.
pub fn tfx_3() -> Vec<u8> {
    let mut words = vec![0u32; 74];
    words[..4].copy_from_slice(&[3f32.to_bits(), 2, 3, 4]);
    words[36] = 296;
    words.extend((0..18).map(|i| (i as f32).to_bits()));
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

/// The text of a `.tfx` of version 2 with two strands of different lengths.
pub fn tfx_2() -> String {
    "version 2.0\nscale 1.0\nrotation 0 0 0\ntranslation 0 0 0\nbothEndsImmovable 0\nmaxNumVerticesInStrand 4\n\
     numFollowHairsPerGuideHair 4\nmaxRadiusAroundGuideHair 1.5\nnumStrands 2\nis sorted 1\n\
     strand 0 numVerts 4 texcoord 0.250000 000000\n0.0, 1.0, 0.5\n0.1, 1.1, 0.5\n0.2, 1.2, 0.5\n0.3, 1.3, 0.5\n\
     strand 1 numVerts 3 texcoord 0.5 1\n-1 1 0\n-1 1.1 0\n-1 1.2 0\n"
        .into()
}

fn bones() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut word = |w: u32, name: &[u8]| {
        bytes.extend(w.to_le_bytes());
        bytes.extend(name);
    };
    word(2, b"");
    for (i, name) in [b"hip\0", b"arm\0"].iter().enumerate() {
        word(i as u32, b"");
        word(4, *name);
    }
    word(3, b"");
    for s in 0..3 {
        word(s, b"");
        for (bone, weight) in [(1, 0.75f32), (0, 0.25), (0, 0.0), (0, 0.0)] {
            word(bone, &weight.to_le_bytes());
        }
    }
    bytes
}

/// The text of a `.tfxmesh` with one triangle.
pub fn skinned_mesh() -> String {
    "# a triangle\nnumOfBones 2\n0 hip\n1 arm\nnumOfVertices 3\n# index, position, normal, joints, weights\n\
     0 0 0 0 0 1 0 0 1 0 0 1 0 0 0\n1 1 0 0 0 1 0 1 0 0 0 0.5 0.5 0 0\n2 0 0 -1 0 1 0 1 0 0 0 1 0 0 0\n\
     numOfTriangles 1\n0 0 1 2\n"
        .into()
}

/// The text of an `.obj` with two groups.
pub fn mesh() -> String {
    "o thing\nv 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nv 0 1 0\nvt 0 0\nvt 1 1\ng floor\nf 1/1 2/2 3/1 4\n\
     g joint-a\nf -1//1 1 2\n"
        .into()
}

/// The text of an `.obj` with two polylines.
fn strands() -> String {
    "v 0 0 0\nv 0 1 0\nv 0 2 0.5\nvt 0.5\ng hair\nl 1/1 2 \\\n 3\nl -3 -1\n".into()
}

/// A PLY file of one face and two strands by edges: vertices 0, 2, 1 and 3, 4. Each property has another type.
pub fn ply_edges(encoding: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {encoding} 1.0\ncomment two strands\nelement vertex 5\nproperty double x\nproperty float y\n\
         property short z\nproperty float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
         element face 1\nproperty list uchar int vertex_indices\n\
         element edge 3\nproperty int vertex1\nproperty uint vertex2\nend_header\n"
    );
    let mut file = header.into_bytes();
    let (text, big) = (encoding == "ascii", encoding == "binary_big_endian");
    let mut add = |number: &str, mut bytes: Vec<u8>, last: bool| match text {
        true => file.extend(format!("{number}{}", if last { "\n" } else { " " }).bytes()),
        false => {
            if big {
                bytes.reverse();
            }
            file.extend(bytes);
        }
    };
    for (i, (x, y)) in
        [(0.25, 0.0), (0.5, 0.2), (0.25, 0.1), (-1.0, 0.0), (-1.0, 0.5)].into_iter().enumerate()
    {
        add(&x.to_string(), f64::to_le_bytes(x).into(), false);
        add(&y.to_string(), f32::to_le_bytes(y).into(), false);
        add("-3", i16::to_le_bytes(-3).into(), false);
        add("0.00004", f32::to_le_bytes(0.00004).into(), false);
        for (k, channel) in [0u8, 51 * i as u8, 255].into_iter().enumerate() {
            add(&channel.to_string(), vec![channel], k == 2);
        }
    }
    add("3", vec![3], false);
    for i in 0..3i32 {
        add(&i.to_string(), i.to_le_bytes().into(), i == 2);
    }
    for [a, b] in [[4i32, 3], [0, 2], [1, 2]] {
        add(&a.to_string(), a.to_le_bytes().into(), false);
        add(&b.to_string(), b.to_le_bytes().into(), true);
    }
    file
}

/// A PLY file whose strands are lists: vertices 2, 0 and 1, 2, 3.
pub const PLY_LISTS: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
    property float z\nproperty float width\nelement strand 3\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 0.0001\n1 0 0 0.0002\n2 0 0 0.0001\n3 0 0 0.0001\n2 2 0\n0\n3 1 2 3\n";

/// A PLY file whose points have the number of their strand: 0 and 1, 2 and 3, 4.
pub const PLY_IDS: &str = "ply\r\nformat ascii 1.0\r\nelement vertex 5\r\nproperty float x\r\nproperty float y\r\n\
    property float z\r\nproperty int strand_id\r\nproperty float curl\r\nend_header\r\n\
    0 0 0 7 0\r\n1 0 0 7 0\r\n2 0 0 -1 0\r\n3 0 0 -1 0\r\n4 0 0 7 0\r\n";

/// The text of a `.bvh` of two joints and two frames.
/// The text of a `.bvh` of two joints and two frames.
pub fn motion() -> String {
    "HIERARCHY\nROOT Hips\n{\n OFFSET 0 1 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n\
     JOINT Head\n {\n OFFSET 0 0.5 0\n CHANNELS 3 Yrotation Xrotation Zrotation\n End Site\n {\n OFFSET 0 0.2 0\n }\n }\n}\n\
     MOTION\nFrames: 2\nFrame Time: 0.0333\n0 1 0 10 20 30 1 2 3\n0 1.1 0 10 20 30 1 2 4\n"
        .into()
}

/// A rig of two bones for [`mesh`].
pub const RIG: &[u8] = br#"{"hip": {"head": {"strategy": "CUBE", "cube_name": "joint-a"}, "parent": ""},
  "arm": {"head": {"strategy": "MEAN", "vertex_indices": [0, 1]}, "parent": "hip"}}"#;

/// Weights for [`RIG`].
pub const WEIGHTS: &[u8] = br#"{"weights": {"hip": [[0, 1.0], [1, 0.5]], "arm": [[1, 0.5], [2, 1.0]]}}"#;

/// A GLB of one skinned triangle and one that is attached to a node, with an animation of every
/// interpolation mode.
pub fn glb() -> Vec<u8> {
    let mut bin: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    let mut add = |bytes: Vec<u8>| {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bin.len(), bytes.len()));
        bin.extend(bytes);
        bin.resize(bin.len().next_multiple_of(4), 0);
    };
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    add(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0])); // 0: positions
    add(vec![0, 0, 1, 0, 2, 0]); // 1: indices, u16
    add(vec![0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]); // 2: joints, u8
    add(vec![255, 0, 0, 0, 128, 127, 0, 0, 255, 0, 0, 0]); // 3: weights, normalized u8
    let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let mut down = identity;
    down[13] = -1.0;
    add(floats(&[identity, down].concat())); // 4: inverse bind matrices
    add(floats(&[0.0, 0.5])); // 5: times
    add(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0])); // 6: rotations
    add(floats(&[0.0; 18])); // 7: cubic translations
    add(floats(&[1.0; 6])); // 8: scales
    let accessor = |view: usize, kind: u32, count: usize, shape: &str, more: &str| {
        format!(r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"{shape}"{more}}}"#)
    };
    let accessors = [
        accessor(0, 5126, 3, "VEC3", r#","min":[0,0,-1],"max":[1,0,0]"#),
        accessor(1, 5123, 3, "SCALAR", ""),
        accessor(2, 5121, 3, "VEC4", ""),
        accessor(3, 5121, 3, "VEC4", r#","normalized":true"#),
        accessor(4, 5126, 2, "MAT4", ""),
        accessor(5, 5126, 2, "SCALAR", r#","min":[0],"max":[0.5]"#),
        accessor(6, 5126, 2, "VEC4", ""),
        accessor(7, 5126, 6, "VEC3", ""),
        accessor(8, 5126, 2, "VEC3", ""),
    ];
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,2]}}],
"nodes":[{{"name":"hip","children":[1,3]}},{{"name":"arm","translation":[0,1,0]}},{{"mesh":0,"skin":0}},{{"name":"hat","mesh":1,"translation":[0,2,0]}}],
"skins":[{{"joints":[0,1],"inverseBindMatrices":4}}],
"materials":[{{"name":"red","pbrMetallicRoughness":{{"baseColorFactor":[1,0,0,1],"roughnessFactor":0.25}}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3}},"indices":1,"material":0}}]}},{{"name":"cap","primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"animations":[{{"name":"wave","samplers":[{{"input":5,"output":6}},{{"input":5,"output":7,"interpolation":"CUBICSPLINE"}},{{"input":5,"output":8,"interpolation":"STEP"}}],
"channels":[{{"sampler":0,"target":{{"node":1,"path":"rotation"}}}},{{"sampler":1,"target":{{"node":0,"path":"translation"}}}},{{"sampler":2,"target":{{"node":3,"path":"scale"}}}}]}}],
"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#,
        accessors.join(","),
        views.join(","),
        bin.len()
    );
    glb_of(json, &bin)
}

/// A GLB of lines of every mode, with a color, a radius and a node's transform.
pub fn glb_strands() -> Vec<u8> {
    let positions = [[0.0f32, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.2, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0]];
    let mut bin: Vec<u8> = positions.concat().iter().flat_map(|v| v.to_le_bytes()).collect();
    bin.extend([1u8, 0, 2, 1, 3, 4, 0, 0]); // Byte 60: indices of segments.
    bin.extend([255u8, 0, 0, 255].repeat(5)); // Byte 68: colors.
    bin.extend([0.00004f32; 5].iter().flat_map(|v| v.to_le_bytes())); // Byte 88: radii.
    let attributes = r#""attributes":{"POSITION":0,"COLOR_0":2,"_RADIUS":3}"#;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"name":"fringe","mesh":0,"scale":[2,2,2],"children":[1]}},{{"mesh":1,"translation":[0,1,0]}}],
"meshes":[{{"primitives":[{{"mode":1,{attributes},"indices":1}}]}},{{"name":"braid","primitives":[{{"mode":3,{attributes}}},{{"mode":2,{attributes}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"}},{{"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"}},
{{"bufferView":2,"componentType":5121,"normalized":true,"count":5,"type":"VEC4"}},{{"bufferView":3,"componentType":5126,"count":5,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteLength":60}},{{"buffer":0,"byteOffset":60,"byteLength":6}},{{"buffer":0,"byteOffset":68,"byteLength":20}},{{"buffer":0,"byteOffset":88,"byteLength":20}}],
"buffers":[{{"byteLength":108}}]}}"#
    );
    glb_of(json, &bin)
}

/// A GLB of a triangle with a default weight of two targets, which an animation moves.
pub fn glb_morph() -> Vec<u8> {
    let positions = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let first_target = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.25];
    // The last two vertices of the second target, two times, and two weights at each.
    let rest = [0.0, 0.5, 0.0, 0.0, 0.5, 0.1, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5];
    let floats = [&positions[..], &first_target, &rest];
    let mut bin: Vec<u8> = floats.concat().iter().flat_map(|v| v.to_le_bytes()).collect();
    bin.extend([1u8, 2, 0, 0]);
    let json = r#"{"asset":{"version":"2.0"},"nodes":[{"name":"face","mesh":0}],
"meshes":[{"weights":[0.5,0],"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},{"POSITION":2}]}]}],
"animations":[{"name":"smile","samplers":[{"input":3,"output":4}],"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},
{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":3,"componentType":5121},"values":{"bufferView":2}}},
{"bufferView":2,"byteOffset":24,"componentType":5126,"count":2,"type":"SCALAR"},{"bufferView":2,"byteOffset":32,"componentType":5126,"count":4,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},{"buffer":0,"byteOffset":72,"byteLength":48},{"buffer":0,"byteOffset":120,"byteLength":2}],
"buffers":[{"byteLength":124}]}"#;
    glb_of(json.into(), &bin)
}

/// Reads a glTF file and the vertices of its shorter motions.
fn morphed(data: &[u8]) -> Result<(), Problem> {
    let (character, _) = gltf::parse(data, &|_| None)?;
    let short = (0..character.clips.len()).filter(|clip| character.clips[*clip].frame_count() < 1000);
    short.for_each(|clip| drop(character.morphed(clip)));
    Ok(())
}

/// A GLB of a document and its buffer.
fn glb_of(json: String, bin: &[u8]) -> Vec<u8> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut file = b"glTF".to_vec();
    for word in [2, (28 + json.len() + bin.len()) as u32, json.len() as u32] {
        file.extend(word.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(json);
    file.extend((bin.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(bin);
    file
}
