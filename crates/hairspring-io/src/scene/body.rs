//! `[body]` and `[collision]`: the meshes, and the joints that move them.

use super::{
    Reader,
    file::{BodyFile, FileName},
    groom_file::Placement,
    sentence::unknown,
};
use crate::{
    Character, ReadOptions, Result, load,
    load::read_mesh,
    makehuman, obj,
    units::{self, UnitHint, WholeBody},
};
use glam::{Affine3A, Mat3A, Vec3};
use hairspring::body::{Body, Joint, Mesh, Part, Skin};

impl Reader<'_> {
    /// Reads a `[body]` or `[collision]` with its additional files. `what` names it in error messages.
    pub(super) fn body(&mut self, named: &BodyFile, what: &str) -> Result<Character> {
        let mut character = self.piece(named, what)?;
        if what != "body" {
            self.note_unplayed(&named.file, &character, what);
        }
        if let Some(cache) = &named.vertex_cache {
            if what != "body" {
                let text = "`vertex_cache` is for [body] only; other meshes move with its joints".into();
                return Err(self.wrong(named.file.span().start, "vertex_cache", text));
            }
            if !named.more.is_empty() {
                let text = "`vertex_cache` moves the vertices of a body of one file; join the files of [[body.more]] to it in the program that made them";
                return Err(self.wrong(named.file.span().start, "vertex_cache", text.into()));
            }
            character.vertex_cache = Some(self.vertex_cache(named, cache, &character.body)?);
        }
        for file in &named.more {
            let piece = self.body(file, what)?;
            if (0..piece.clips.len()).any(|clip| piece.morphs.moves(clip)) {
                let note = "its animated morph targets are left out; name the file as that of [body] itself";
                self.note(&self.resolve(&file.file), vec![note.into()]);
            }
            self.note_unplayed(&file.file, &piece, what);
            let carrier =
                file.joint.as_deref().map(|name| self.joint(&character.body, name, file)).transpose()?;
            join(&mut character.body, piece.body, carrier);
        }
        Ok(character)
    }

    /// Adds a note if a file has motions, of which only those of the body's own file and of [clip] are played.
    pub(super) fn note_unplayed(&mut self, file: &FileName, character: &Character, what: &str) {
        let path = self.resolve(file);
        if self.played.contains(&path) {
            return;
        }
        let end = match what {
            "prop" => "; the [[prop]] moves by its `keys`",
            "hull" => "; the hull moves with the `joint` of its [[collider]]",
            _ => "; the mesh moves with the joints of the [body]",
        };
        self.note(&path, character.unplayed_note(end).into_iter().collect());
    }

    /// Reads one file of a body.
    pub(super) fn piece(&mut self, named: &BodyFile, what: &str) -> Result<Character> {
        let path = self.resolve(&named.file);
        let options = ReadOptions { scale: named.scale, up: named.up };
        let transform = named.transform.map_or(Affine3A::IDENTITY, Placement::to_affine);
        let mut scale = named.scale.unwrap_or(makehuman::SCALE);
        let mut character = match (&named.rig, &named.weights) {
            (Some(rig), Some(weights)) => self.rigged(named, rig, weights, &options)?,
            (None, None) => {
                let grown = |units: &[f32], mesh: &dyn Fn(f32) -> Mesh| {
                    self.body_unit(units, &|unit| {
                        let mut body = Body::rigid(mesh(unit));
                        place(&mut body, transform);
                        body.mesh
                    })
                };
                let hint = match self.whole {
                    Some(whole) => UnitHint::PartOf(whole, transform),
                    None if what == "body" => UnitHint::Grown(&grown),
                    None => UnitHint::None,
                };
                let loaded = self.named(read_mesh(&path, &options, hint), &named.file, what)?;
                self.note(&path, loaded.notes);
                scale = loaded.scale;
                loaded.value
            }
            _ => {
                let text = "`rig` and `weights` belong together: name both, or neither".into();
                return Err(self.wrong(named.file.span().start, "rig", text));
            }
        };
        let body = &mut character.body;
        if named.transform.is_some() {
            if body.skin.is_some() || body.joints.len() > 1 {
                let text = "`transform` is for a mesh without joints, and this file has joints; move it in the program that made it";
                return Err(self.wrong(named.file.span().start, "transform", text.into()));
            }
            place(body, transform);
        }
        if what == "body" && self.whole.is_none() {
            self.whole = units::bounds_of(&body.mesh.positions).map(|bounds| WholeBody { scale, bounds });
        }
        if let Some(parts) = &named.parts {
            if parts.is_empty() {
                let text = "`parts` must name at least one part of the file; omit it to keep all";
                return Err(self.wrong(named.file.span().start, "parts", text.into()));
            }
            let known: Vec<String> = body.mesh.parts.iter().map(|p| p.name.clone()).collect();
            if let Some(wrong) = parts.iter().find(|p| !known.contains(p)) {
                let text = format!("the part {}", unknown(wrong, known.iter().map(String::as_str)));
                return Err(self.wrong(named.file.span().start, "parts", text));
            }
            let is_kept = |name: &str| parts.iter().any(|p| p == name);
            let mut used = vec![false; body.mesh.positions.len()];
            for part in body.mesh.parts.iter().filter(|part| is_kept(&part.name)) {
                let triangles =
                    &body.mesh.triangles[part.triangles.start as usize..part.triangles.end as usize];
                triangles.iter().flatten().for_each(|v| used[*v as usize] = true);
            }
            body.keep_parts(is_kept);
            character.morphs.keep(&used);
        }
        // Hair collides with both sides of a sheet.
        if what != "sheet" && turn_outward(&mut body.mesh) {
            let note = "its triangles face inward; they are turned round, so that hair stays outside";
            self.note(&path, vec![note.into()]);
        }
        // Every file of a body gets at least one part, so that each keeps its own color.
        if body.mesh.parts.is_empty() {
            body.mesh.parts.push(Part {
                name: what.into(),
                triangles: 0..body.mesh.triangles.len() as u32,
                color: obj::DEFAULT_COLOR,
                roughness: obj::DEFAULT_ROUGHNESS,
            });
        }
        for part in &mut body.mesh.parts {
            part.color = named.color.unwrap_or(part.color);
            part.roughness = named.roughness.unwrap_or(part.roughness);
        }
        Ok(character)
    }

    /// Reads a MakeHuman mesh with its rig.
    fn rigged(
        &self,
        named: &BodyFile,
        rig: &FileName,
        weights: &FileName,
        options: &ReadOptions,
    ) -> Result<Character> {
        let bytes = |name: &FileName, what: &str| self.named(load::bytes_of(&self.resolve(name)), name, what);
        let mesh = bytes(&named.file, "body")?;
        let (rig_data, weight_data) = (bytes(rig, "rig")?, bytes(weights, "weight file")?);
        let mesh = obj::parse(&mesh).map_err(|p| p.in_file(&self.resolve(&named.file)))?;
        let mut character =
            makehuman::parse(mesh, &rig_data, &weight_data).map_err(|p| p.in_file(&self.resolve(rig)))?;
        let parts = character.body.mesh.parts.iter_mut().map(|part| &mut part.name);
        load::make_printable(parts.chain(character.body.joints.iter_mut().map(|joint| &mut joint.name)));
        let turn = units::turn_of(options.up.unwrap_or(crate::Axis::Y));
        units::apply_to_body(&mut character.body, &mut [], options.scale.unwrap_or(makehuman::SCALE), turn);
        Ok(character)
    }

    /// Finds the joint `name` of `body`, which the table `named` refers to.
    fn joint(&self, body: &Body, name: &str, named: &BodyFile) -> Result<u16> {
        body.joint(name).map(|j| j as u16).ok_or_else(|| {
            let text = format!("the joint {}", unknown(name, body.joints.iter().map(|j| j.name.as_str())));
            self.wrong(named.file.span().start, "joint", text)
        })
    }

    /// Binds the collision mesh to the body's joints, so that one pose moves both.
    pub(super) fn carried(&self, mut collision: Body, body: &Body, named: &BodyFile) -> Result<Body> {
        let rest: Vec<Affine3A> = body.world(&body.rest_pose());
        let inverse_bind: Vec<Affine3A> = rest.iter().map(|w| w.inverse()).collect();
        let of = |name: &str| self.joint(body, name, named);
        // A glTF file without a skin has joints: its objects. The body rarely knows them.
        let one_joint = |skin: &Skin| skin.weights.iter().all(|w| w[0] == 1.0);
        let strange = collision.joints.iter().all(|joint| body.joint(&joint.name).is_none());
        if strange && collision.skin.as_ref().is_some_and(one_joint) {
            collision.skin = None;
        }
        collision.skin = match (&collision.skin, &named.joint) {
            // A mesh that is skinned to its own joints uses the body's joints of the same names.
            (Some(skin), None) => {
                let map: Vec<u16> = collision.joints.iter().map(|j| of(&j.name)).collect::<Result<_>>()?;
                let joints = skin.joints.iter().map(|four| four.map(|j| map[j as usize])).collect();
                let inverse_bind = body.skin.as_ref().map_or(inverse_bind, |s| s.inverse_bind.clone());
                Some(Skin { joints, weights: skin.weights.clone(), inverse_bind })
            }
            (None, None) if body.joints.len() == 1 => None,
            (_, name) => {
                let joint = name.as_deref().map_or(Ok(0), of)?;
                let count = collision.mesh.positions.len();
                Some(Skin {
                    joints: vec![[joint, 0, 0, 0]; count],
                    weights: vec![[1.0, 0.0, 0.0, 0.0]; count],
                    inverse_bind,
                })
            }
        };
        collision.joints = body.joints.clone();
        Ok(collision)
    }
}

/// Adds a piece to a body. Its joints are matched with the body's joints by name; joints without a match are
/// added. A piece without a skin, or with a given `carrier`, follows that joint rigidly.
pub(super) fn join(body: &mut Body, piece: Body, carrier: Option<u16>) {
    let vertices = piece.mesh.positions.len();
    let follow = |joint: u16, vertices: usize| {
        (vec![[joint, 0, 0, 0]; vertices], vec![[1.0, 0.0, 0.0, 0.0]; vertices])
    };
    let skinned = piece.skin.filter(|_| carrier.is_none());
    if body.skin.is_none() && (skinned.is_some() || body.joints.len() > 1) {
        let (joints, weights) = follow(0, body.mesh.positions.len());
        let inverse_bind = body.world(&body.rest_pose()).iter().map(|w| w.inverse()).collect();
        body.skin = Some(Skin { joints, weights, inverse_bind });
    }
    if let Some(skin) = &mut body.skin {
        let (joints, weights) = match skinned {
            None => follow(carrier.unwrap_or(0), vertices),
            Some(more) => {
                let mut map: Vec<u16> = Vec::with_capacity(piece.joints.len());
                for (joint, bind) in piece.joints.iter().zip(&more.inverse_bind) {
                    let known = body.joints.iter().position(|j| j.name.eq_ignore_ascii_case(&joint.name));
                    map.push(known.unwrap_or(body.joints.len()) as u16);
                    if known.is_none() {
                        let parent = joint.parent.map(|p| map[p as usize] as u32);
                        body.joints.push(Joint { parent, ..joint.clone() });
                        skin.inverse_bind.push(*bind);
                    }
                }
                (more.joints.iter().map(|four| four.map(|j| map[j as usize])).collect(), more.weights)
            }
        };
        skin.joints.extend::<Vec<_>>(joints);
        skin.weights.extend(weights);
    }
    body.mesh.append(piece.mesh);
}

/// Moves a mesh.
fn place(body: &mut Body, by: Affine3A) {
    let mesh = &mut body.mesh;
    mesh.positions.iter_mut().for_each(|p| *p = by.transform_point3(*p));
    let of_normals: Mat3A = by.matrix3.inverse().transpose();
    mesh.normals.iter_mut().for_each(|n| *n = (of_normals * *n).normalize_or_zero());
    if by.matrix3.determinant() < 0.0 {
        // A mirror image has its triangles the other way round.
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}

/// Volume below which a mesh counts as flat, over that of a ball with its area [1].
const FLAT: f64 = 0.05;

/// Area of the openings from which on a mesh counts as open, over its own area [1]: a cap has 0.5, a bust 0.05.
const OPEN: f32 = 0.2;

/// Turns all triangles of a closed mesh round if they face inward. Returns whether it did.
fn turn_outward(mesh: &mut Mesh) -> bool {
    let center = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len().max(1) as f32;
    // The areas of a closed mesh, as vectors, add up to 0.
    let (mut volume, mut area, mut openings) = (0.0f64, 0.0f64, Vec3::ZERO);
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize] - center)) {
        volume += f64::from(a.dot(b.cross(c))) / 6.0;
        let across = (b - a).cross(c - a) / 2.0;
        openings += across;
        area += f64::from(across.length());
    }
    // A ball of the area A has the volume A^(3/2) / (6 √π).
    let ball = area.powf(1.5) / (6.0 * std::f64::consts::PI.sqrt());
    if volume >= -FLAT * ball || openings.length() > OPEN * area as f32 {
        return false;
    }
    let inward = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        let normals: Vec3 = t.iter().filter_map(|v| mesh.normals.get(*v as usize)).sum();
        (b - a).cross(c - a).dot(normals) > 0.0
    };
    // The normals are those of the triangles, or were right already.
    if mesh.triangles.iter().filter(|t| inward(t)).count() > mesh.triangles.len() / 2 {
        mesh.normals.iter_mut().for_each(|n| *n = -*n);
    }
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    true
}

/// Turns a body into one rigid piece that a clip of one joint moves.
pub(super) fn rigid(body: Body) -> Body {
    if body.skin.is_none() && body.joints.len() == 1 { body } else { Body::rigid(body.mesh) }
}
