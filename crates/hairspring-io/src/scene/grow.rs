//! `grow` of a `[[groom]]`: the skin of the body that hair grows on.

use super::{Reader, groom_file::GrowFile, map_file::MapsFile, sentence::unknown};
use crate::Result;
use glam::Vec3;
use hairspring::{
    body::Body,
    groom::{Groom, grow_along},
};
use toml::Spanned;

impl Reader<'_> {
    /// Grows the hair that `named` describes.
    pub(super) fn grown(
        &mut self,
        named: &Spanned<GrowFile>,
        maps: &MapsFile,
        body: Option<&Body>,
    ) -> Result<Groom> {
        let near = named.span().start;
        let file = named.get_ref();
        let Some(body) = body else {
            return Err(self.wrong(near, "grow", "`grow` needs a [body] that hair grows on".into()));
        };
        let mesh = &body.mesh;
        let mut allowed = vec![file.parts.is_none(); mesh.triangles.len()];
        for name in file.parts.iter().flatten() {
            let mut parts = mesh.parts.iter().filter(|p| p.name == *name).peekable();
            if parts.peek().is_none() {
                let text = format!("the part {}", unknown(name, mesh.parts.iter().map(|p| p.name.as_str())));
                return Err(self.wrong(near, "parts", text));
            }
            parts.for_each(|p| allowed[p.triangles.start as usize..p.triangles.end as usize].fill(true));
        }
        if let Some(name) = &file.joint {
            let joint = body.joint(name).ok_or_else(|| {
                let text =
                    format!("the joint {}", unknown(name, body.joints.iter().map(|j| j.name.as_str())));
                self.wrong(near, "joint", text)
            })?;
            for (t, allowed) in allowed.iter_mut().enumerate() {
                *allowed &= mesh.triangles[t].iter().all(|v| strongest(body, *v as usize) == joint);
            }
        }
        if let Some(shape) = &file.inside {
            let shape = self.shape(shape, near)?.collider_shape();
            let inside = |p: Vec3| shape.as_ref().is_some_and(|s| s.distance(p) < 0.0);
            for (t, allowed) in allowed.iter_mut().enumerate() {
                *allowed &= inside(mesh.corners(t).iter().sum::<Vec3>() / 3.0);
            }
        }
        let growth = file.growth();
        let comb = self.comb_map(maps, growth.strands as usize, mesh)?;
        let direction = |s: usize, t: usize, weights: Vec3, normal: Vec3| {
            comb.as_ref().map_or(normal, |comb| comb.direction(s, (t, weights), normal))
        };
        let groom = grow_along(mesh, &growth, |t| allowed[t], direction);
        if groom.strand_count() == 0 {
            return Err(self.wrong(
                near,
                "grow",
                "`grow` selects no skin of the body; widen its parts, joint or shape".into(),
            ));
        }
        Ok(groom)
    }
}

/// The joint with the largest weight of a vertex; the first for a rigid body.
fn strongest(body: &Body, vertex: usize) -> usize {
    body.skin.as_ref().map_or(0, |skin| {
        let pairs = skin.joints[vertex].into_iter().zip(skin.weights[vertex]);
        pairs.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(j, _)| j as usize)
    })
}
