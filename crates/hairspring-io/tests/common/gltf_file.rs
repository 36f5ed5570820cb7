//! Builds small glTF files in code.

use serde_json::{Value, json};

/// A glTF file under construction. Its JSON may be changed freely.
pub struct GltfFile {
    pub json: Value,
    pub bin: Vec<u8>,
}

impl Default for GltfFile {
    fn default() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
            "accessors": [], "bufferViews": []
        });
        Self { json, bin: Vec::new() }
    }
}

impl GltfFile {
    /// A mesh of one node: a tetrahedron of 10 cm with corners in the axes.
    pub fn tetrahedron() -> Self {
        let mut file = Self::default();
        let positions = file.floats("VEC3", &TETRAHEDRON.concat());
        let indices = file.bytes(5121, "SCALAR", 12, &[0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
        file.push("meshes", json!({"name": "tetra", "primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}));
        file.json["nodes"] = json!([{"name": "Head", "mesh": 0}]);
        file.json["scenes"][0]["nodes"] = json!([0]);
        file
    }

    /// Appends `value` to the list `list`, and returns its index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = &mut self.json[list];
        if list.is_null() {
            *list = json!([]);
        }
        let list = list.as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// Appends a view of `bytes`, and returns its index.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.push("bufferViews", view)
    }

    /// Appends an accessor of `count` elements, and returns its index.
    pub fn bytes(&mut self, kind: u32, shape: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": kind, "count": count, "type": shape}),
        )
    }

    /// Appends an accessor of floats, and returns its index.
    pub fn floats(&mut self, shape: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        self.bytes(5126, shape, values.len() / width, &bytes)
    }

    /// The only primitive of the first mesh.
    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// The file as `.glb`.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"].is_null() {
            json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut file = b"glTF".to_vec();
        for word in [2, (28 + json.len() + self.bin.len()) as u32, json.len() as u32] {
            file.extend(word.to_le_bytes());
        }
        file.extend(b"JSON");
        file.extend(json);
        file.extend((self.bin.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(&self.bin);
        file
    }
}

/// Corners of [`GltfFile::tetrahedron`] [m].
pub const TETRAHEDRON: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
