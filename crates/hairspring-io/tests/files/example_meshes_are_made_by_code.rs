//! Promise: every mesh of the example scenes is generated here, from a few solids and from the library's
//! own head and hand. The files equal the generated meshes byte for byte. `HAIRSPRING_MESHES=write` writes
//! the files again (`cargo xtask meshes`); afterwards, render the scenes that show them and check the
//! pictures.

use glam::{Quat, Vec3, vec3};
use hairspring::body::Mesh;
use hairspring_scene::builtin::{hand, head};
use std::{collections::HashMap, f32::consts::TAU, fmt::Write, fs, path::Path};

/// A mesh as written to its file: the vertex lines, then the group and face lines.
#[derive(Default)]
struct Obj {
    vertices: Vec<String>,
    faces: Vec<String>,
}

impl Obj {
    /// Adds a vertex and returns its number, from 1.
    fn vertex(&mut self, p: Vec3) -> usize {
        // Coordinates are rounded to 0.1 mm; adding 0 turns -0 into 0.
        let [x, y, z] = p.to_array().map(|c| (f64::from(c) * 1e4).round() / 1e4 + 0.0);
        self.vertices.push(format!("v {x:.4} {y:.4} {z:.4}"));
        self.vertices.len()
    }

    /// Starts a part; the faces that follow belong to it.
    fn part(&mut self, name: &str) {
        self.faces.push(format!("g {name}"));
    }

    /// Adds a face, counterclockwise seen from outside.
    fn face(&mut self, corners: &[usize]) {
        let mut line = String::from("f");
        corners.iter().for_each(|corner| write!(line, " {corner}").unwrap());
        self.faces.push(line);
    }

    /// Adds rows of vertices with quads between them. A `closed` grid also joins the last row and column to
    /// the first. Returns the number of the first vertex.
    fn grid(
        &mut self,
        rows: usize,
        columns: usize,
        closed: bool,
        at: impl Fn(usize, usize) -> Vec3,
    ) -> usize {
        let first = self.vertices.len() + 1;
        (0..rows * columns).for_each(|i| _ = self.vertex(at(i / columns, i % columns)));
        let vertex = |row: usize, column: usize| first + row % rows * columns + column % columns;
        let open = usize::from(!closed);
        for row in 0..rows - open {
            for column in 0..columns - open {
                let [a, b] = [row, row + 1].map(|row| [column, column + 1].map(|c| vertex(row, c)));
                self.face(&[a[0], a[1], b[1], b[0]]);
            }
        }
        first
    }

    /// Adds an ellipsoid of `rows` rows from pole to pole, with `round` vertices in each. Where it is
    /// `staggered`, each row is turned by half a vertex relative to the previous one.
    fn ellipsoid(&mut self, rows: usize, round: usize, staggered: bool, at: impl Fn(Vec3) -> Vec3) {
        let top = self.vertex(at(Vec3::Y));
        for row in 1..rows {
            let (s, c) = (0.5 * TAU * row as f32 / rows as f32).sin_cos();
            for k in 0..round {
                let turn = k as f32 - if staggered { 0.5 * row as f32 } else { 0.0 };
                let (sin, cos) = (TAU * turn / round as f32).sin_cos();
                self.vertex(at(vec3(s * cos, c, -s * sin)));
            }
        }
        let bottom = self.vertex(at(Vec3::NEG_Y));
        let vertex = |row: usize, k: usize| top + 1 + (row - 1) * round + k % round;
        (0..round).for_each(|k| self.face(&[top, vertex(1, k), vertex(1, k + 1)]));
        for row in 1..rows - 1 {
            for k in 0..round {
                let [a, b] = [row, row + 1].map(|row| [k, k + 1].map(|k| vertex(row, k)));
                self.face(&[a[0], b[0], b[1], a[1]]);
            }
        }
        (0..round).for_each(|k| self.face(&[vertex(rows - 1, k + 1), vertex(rows - 1, k), bottom]));
    }

    /// Adds a solid between two rectangles that face along z, each given by its center and half of its
    /// width and height.
    fn frustum(&mut self, front: (Vec3, [f32; 2]), back: (Vec3, [f32; 2])) {
        let first = self.vertices.len();
        for (middle, [x, y]) in [front, back] {
            for (x, y) in [(-x, -y), (x, -y), (x, y), (-x, y)] {
                self.vertex(middle + vec3(x, y, 0.0));
            }
        }
        for corners in [[1, 2, 3, 4], [5, 8, 7, 6], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 8, 4], [4, 8, 5, 1]] {
            self.face(&corners.map(|corner| first + corner));
        }
    }

    /// Adds a mesh of the library with its parts. It must be closed, as a collider must be: each edge
    /// occurs equally often in both directions.
    fn mesh(&mut self, mesh: &Mesh, place: impl Fn(Vec3) -> Vec3) {
        let mut edges = HashMap::new();
        for (a, b) in mesh.triangles.iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]) {
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
        assert!(edges.values().all(|n| *n == 0), "the mesh is not closed");
        let first = self.vertices.len() + 1;
        mesh.positions.iter().for_each(|p| _ = self.vertex(place(*p)));
        for part in &mesh.parts {
            self.part(&part.name);
            for t in part.triangles.clone() {
                self.face(&mesh.triangles[t as usize].map(|i| first + i as usize));
            }
        }
    }

    /// Checks that the file equals this mesh, or writes it.
    fn assert_equals_file(self, file: &str, what: &str) {
        let lines = [format!("# {what}; in meters. Made by `cargo xtask meshes`.")];
        let text = [&lines[..], &self.vertices, &self.faces].concat().join("\n") + "\n";
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes").join(file);
        if std::env::var("HAIRSPRING_MESHES").is_ok_and(|v| v == "write") {
            hairspring_io::atomically(&path, |out| std::io::Write::write_all(out, text.as_bytes())).unwrap();
        }
        let kept = fs::read_to_string(&path).unwrap();
        let other = kept.lines().zip(text.lines()).position(|(kept, made)| kept != made);
        assert!(kept == text, "{file} differs from the generated mesh, first in line {other:?} from 0");
    }
}

#[test]
fn the_head() {
    let mut obj = Obj::default();
    obj.mesh(&head(), |p| p);
    obj.assert_equals_file("meshes/head.obj", "A head asleep on its neck");
}

#[test]
fn the_hand() {
    let mut obj = Obj::default();
    // The palm faces the head, and the fingers point forward.
    obj.mesh(&hand(0.005).mesh, |p| vec3(-0.26 - p.z, 0.06 - p.x, -0.09 + p.y));
    obj.assert_equals_file("meshes/hand.obj", "An open right hand beside a head");
}

#[test]
fn the_comb() {
    let mut obj = Obj::default();
    obj.part("comb");
    obj.frustum((vec3(0.0, 0.07, -0.242), [0.066, 0.0035]), (vec3(0.0, 0.07, -0.256), [0.066, 0.0035]));
    for tine in 0..23 {
        let at = |z: f32| vec3(0.063 * (tine as f32 / 11.0 - 1.0), 0.07, z);
        // The outermost tines are the thickest.
        let half = if tine % 22 == 0 { 0.0011 } else { 0.0006 };
        obj.frustum((at(-0.2), [half, 0.0008]), (at(-0.242), [2.0 * half, 0.0016]));
    }
    obj.assert_equals_file(
        "meshes/comb.obj",
        "A comb behind a head: its spine of 13 cm along x, and 23 tines that point forward",
    );
}

#[test]
fn the_rail() {
    let mut obj = Obj::default();
    const COLUMNS: usize = 41;
    obj.part("front");
    let at =
        |row: usize, column: usize| vec3(0.0065 * (column as f32 - 20.0), 0.008 * (row as f32 - 1.0), 0.008);
    let first = obj.grid(3, COLUMNS, false, at);
    let [a, b, c, d] = [0, COLUMNS - 1, 3 * COLUMNS - 1, 2 * COLUMNS].map(|i| first + i);
    let [e, f, g, h] = [(-0.13, -0.008), (0.13, -0.008), (0.13, 0.008), (-0.13, 0.008)]
        .map(|(x, y)| obj.vertex(vec3(x, y, -0.008)));
    obj.part("rail");
    for corners in [[f, e, h, g], [e, a, d, h], [b, f, g, c], [d, c, g, h], [e, f, b, a]] {
        obj.face(&corners);
    }
    obj.assert_equals_file("meshes/rail.obj", "A rail of 26 cm with a front that hair grows on");
}

#[test]
fn the_stone() {
    let mut obj = Obj::default();
    obj.part("stone");
    let (middle, turn) = (vec3(0.0, -0.13, 0.07), Quat::from_rotation_z(0.35));
    obj.ellipsoid(5, 9, true, |n| middle + turn * (n * vec3(0.11, 0.065, 0.075)));
    obj.assert_equals_file("meshes/stone.obj", "A convex stone");
}

#[test]
fn the_leaf() {
    let mut obj = Obj::default();
    obj.part("leaf");
    let at = |row: usize, column: usize| {
        let (u, v) = (row as f32 / 8.0 - 1.0, 1.0 - column as f32 / 4.0);
        // The leaf is narrow at both ends, which hang down. It is folded along its middle, and its rim is
        // wavy.
        let (half, wave) = (0.085 * (1.4 * u).cos(), (5.0 * u + 1.2 * v).sin());
        let height = -0.122 - 0.038 * u * u + 0.018 * v.abs() - 0.008 * v + 0.010 * v.abs() * wave;
        vec3(0.15 * u, height, 0.075 + half * v)
    };
    obj.grid(17, 9, false, at);
    obj.assert_equals_file("meshes/leaf.obj", "A leaf: one open surface");
}

#[test]
fn the_hat() {
    let mut obj = Obj::default();
    obj.part("hat");
    const ROUND: usize = 48;
    // The crown: radius and height of each ring. Its sides are steep, and its top is flat.
    let crown = (1..=14).map(|row| {
        let (sin, cos) = (0.25 * TAU * row as f32 / 14.0).sin_cos();
        (sin.powf(0.8), 0.105 * cos.max(0.0).powf(0.8))
    });
    // The brim rises toward its rim.
    let brim = (1..=6).map(|row| (1.0 + 0.09 * row as f32, 0.0008 * (row * row) as f32));
    let top = obj.vertex(vec3(0.0, 0.105, 0.0));
    for (radius, height) in crown.chain(brim) {
        for k in 0..ROUND {
            let (sin, cos) = (TAU * k as f32 / ROUND as f32).sin_cos();
            // The front and the back of the brim are lower than its sides.
            let bent = if radius > 1.0 { 0.06 * (radius - 1.0) * cos * cos } else { 0.0 };
            obj.vertex(vec3(0.102 * radius * cos, height + bent, -0.122 * radius * sin));
        }
    }
    let vertex = |ring: usize, k: usize| top + 1 + ring * ROUND + k % ROUND;
    for k in 0..ROUND {
        obj.face(&[top, vertex(0, k), vertex(0, k + 1)]);
        for ring in 0..19 {
            obj.face(&[vertex(ring, k), vertex(ring + 1, k), vertex(ring + 1, k + 1), vertex(ring, k + 1)]);
        }
    }
    obj.assert_equals_file(
        "meshes/hat.obj",
        "A hat: one open surface, with its opening at the origin and its front toward +z",
    );
}

#[test]
fn the_balloon() {
    let mut obj = Obj::default();
    for (name, middle, radius) in
        [("head", vec3(0.0, 1.5, 0.0), 0.1), ("balloon", vec3(0.12, 1.83, 0.0), 0.12)]
    {
        obj.part(name);
        obj.ellipsoid(16, 24, false, |n| middle + radius * n);
    }
    obj.assert_equals_file("balloon.obj", "A ball for a head and a balloon over it");
}

#[test]
fn the_curtain() {
    let mut obj = Obj::default();
    let slab =
        |y: f32| [(-0.18, -0.008), (-0.18, 0.008), (0.18, 0.008), (0.18, -0.008)].map(|(x, z)| vec3(x, y, z));
    let [a, b, c, d] = slab(1.02).map(|p| obj.vertex(p));
    let [e, f, g, h] = slab(1.0).map(|p| obj.vertex(p));
    obj.part("rail");
    for corners in [[a, b, c, d], [a, e, f, b], [b, f, g, c], [c, g, h, d], [d, h, e, a]] {
        obj.face(&corners);
    }
    obj.part("underside");
    let mut under = slab(1.0).map(|p| obj.vertex(p));
    under.reverse();
    obj.face(&under);
    obj.part("fan");
    let ring = |row: usize, column: usize| {
        let (sin, cos) = (TAU * row as f32 / 24.0).sin_cos();
        let (along, out) = (-TAU * column as f32 / 8.0).sin_cos();
        let radius = 0.12 + 0.012 * out;
        vec3(radius * cos, 0.85 + radius * sin, -0.35 + 0.024 * along)
    };
    obj.grid(24, 8, true, ring);
    obj.assert_equals_file(
        "curtain.obj",
        "A rail 36 cm long, hair grows on its underside; and the ring of a fan, 12 cm in radius, which faces +z",
    );
}
