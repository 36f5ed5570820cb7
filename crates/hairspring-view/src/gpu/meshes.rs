//! The frame's bodies on the GPU.

use super::{
    Gpu,
    memory::{Generation, Store},
    strands::Print,
};
use crate::{body::skin, frame::MeshDraw};
use wgpu::BufferUsages;

/// Bit in a triangle's last index that marks a body with smooth normals.
const SMOOTH: u32 = 1 << 31;

/// The bodies of a frame.
pub(super) struct Meshes {
    pub positions: Store,
    pub normals: Store,
    pub triangles: Store,
    /// Linear RGB and roughness of each part; the first entry is skin.
    pub cloths: Store,
    /// Number of triangles.
    pub count: u32,
    /// What was sent last, per body: triangles, number of vertices, whether normals are smooth, and parts.
    sent: Vec<(Print, usize, bool, Vec<[u32; 2]>)>,
}

impl Meshes {
    pub fn new(gpu: &Gpu) -> Self {
        let store = |label| Store::new(gpu, label, BufferUsages::STORAGE);
        Self {
            positions: store("positions"),
            normals: store("normals"),
            triangles: store("triangles"),
            cloths: store("cloths"),
            count: 0,
            sent: Vec::new(),
        }
    }

    /// Marks everything as not sent, so that it is sent again.
    pub fn forget(&mut self) {
        self.sent.clear();
    }

    /// Sends a frame's bodies.
    pub fn send(&mut self, gpu: &Gpu, bodies: &[MeshDraw], generation: &mut Generation) {
        let print = |b: &MeshDraw| {
            let parts = b.parts.iter().map(|p| [p.triangles.start, p.triangles.end]).collect();
            (Print::of(b.triangles), b.positions.len(), b.smooth(), parts)
        };
        let now: Vec<_> = bodies.iter().map(print).collect();
        if now != self.sent {
            self.send_triangles(gpu, bodies, generation);
            self.sent = now;
        }
        let (color, roughness) = skin::SKIN;
        let mut cloths = vec![color.extend(roughness)];
        let parts = bodies.iter().flat_map(|b| b.parts);
        cloths.extend(parts.map(|p| p.color.extend(p.roughness.clamp(0.15, 1.0))));
        self.cloths.fill(gpu, &cloths, generation);
        let vertices: usize = bodies.iter().map(|b| b.positions.len()).sum();
        self.positions.fit(gpu, 12 * vertices, generation);
        self.normals.fit(gpu, 12 * vertices, generation);
        let mut first = 0;
        for body in bodies {
            self.positions.write(gpu, 12 * first, body.positions);
            if body.smooth() {
                self.normals.write(gpu, 12 * first, body.normals);
            }
            first += body.positions.len();
        }
    }

    fn send_triangles(&mut self, gpu: &Gpu, bodies: &[MeshDraw], generation: &mut Generation) {
        let mut triangles = Vec::new();
        let (mut vertex, mut cloth) = (0, 1);
        for body in bodies {
            let smooth = if body.smooth() { SMOOTH } else { 0 };
            for (t, corners) in body.triangles.iter().enumerate() {
                if corners.iter().any(|i| *i as usize >= body.positions.len()) {
                    continue;
                }
                let part = skin::part(body, t).map_or(0, |part| cloth + part as u32);
                let [a, b, c] = corners.map(|i| vertex + i);
                triangles.push([a, b, c, part | smooth]);
            }
            vertex += body.positions.len() as u32;
            cloth += body.parts.len() as u32;
        }
        self.count = triangles.len() as u32;
        self.triangles.fill(gpu, &triangles, generation);
    }
}
