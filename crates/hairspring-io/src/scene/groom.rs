//! The strands of a `[[groom]]`: read or grown, placed, thickened, and bound to the skin.

use super::{
    Reader,
    file::FileName,
    groom_file::{ColorSource, GroomFile, Reverse},
    material,
};
use crate::{
    ReadOptions, Result,
    load::read_groom_on,
    read_bones,
    skin_distance::{SkinDistance, reverse_to_skin, unit_on_skin},
    text,
    tfxbone::RootBones,
    units::{FitUnit, extent},
};
use glam::Affine3A;
use hairspring::{
    body::{Body, NearestTree},
    groom::{Groom, bind_roots_where, thicken},
    material::Material,
};
use hairspring_scene::HairLook;
use std::collections::{BTreeSet, HashSet};

/// The surface of the body that strands are placed on.
struct Skin<'a> {
    tree: NearestTree<'a>,
    /// Longest side of the box around the body [m].
    size: f32,
}

impl Reader<'_> {
    /// Returns the strands of a `[[groom]]`, placed on the `body`.
    pub(super) fn groom(
        &mut self,
        named: &GroomFile,
        materials: &[Material],
        body: Option<&Body>,
    ) -> Result<Groom> {
        let place = named.transform.to_affine();
        if named.reverse == Reverse::Nearest && body.is_none() {
            let text = "`reverse = \"nearest\"` needs a [body], which has the skin".into();
            return Err(self.wrong(named.start(), "reverse", text));
        }
        let skin = body.filter(|_| named.file.is_some()).map(|body| Skin {
            tree: NearestTree::new(&body.mesh),
            size: extent(body.mesh.positions.iter().copied()),
        });
        let mut groom = match (&named.file, &named.grow) {
            (Some(file), _) => self.read_strands(named, file, place, skin.as_ref())?,
            (None, Some(grow)) => self.grown(grow, &named.maps, body)?,
            // The check of the text has rejected this case already.
            (None, None) => Groom::default(),
        };
        if place != Affine3A::IDENTITY {
            groom.points.iter_mut().for_each(|p| *p = place.transform_point3(*p));
        }
        if !groom.roots.is_empty() && place != Affine3A::IDENTITY {
            groom.roots.clear();
        }
        if let (Some(file), Some(skin)) = (&named.file, &skin) {
            let mut notes = Vec::new();
            if named.reverse == Reverse::Nearest {
                let turned = reverse_to_skin(&mut groom, &skin.tree);
                notes.push(format!(
                    "{turned} of {} strands ended nearer to the skin than they began; their points are reversed",
                    groom.strand_count()
                ));
            }
            let turned = named.reverse == Reverse::All;
            notes.extend(SkinDistance::new(&groom, &skin.tree).and_then(|distance| distance.note(turned)));
            self.note(&self.resolve(file), notes);
        }
        self.apply_maps(&named.maps, &mut groom, body.map(|b| &b.mesh))?;
        if named.thicken.copies > 0 {
            groom.roots.clear();
            thicken(&mut groom, &named.thicken, body.map(|b| &b.mesh));
        }
        if let Some(bones) = &named.bones {
            let read = self.named(read_bones(&self.resolve(bones)), bones, "bone file")?;
            let note = bind_by_bones(&mut groom, &read, body, named.thicken.copies)
                .map_err(|text| self.wrong(bones.span().start, "bones", text))?;
            self.note(&self.resolve(bones), note.into_iter().collect());
        }
        let groups = groom.groups.iter().max().map_or(1, |last| *last as usize + 1);
        if let (Some(file), Some(note)) = (&named.file, material::of_groups(materials.len(), groups)) {
            self.note(&self.resolve(file), vec![note]);
        }
        // A material's radius replaces the groom's from here on, so that hair is drawn as thick as it is
        // simulated.
        for s in 0..groom.strand_count() {
            let material = materials.get(groom.group(s) as usize).or(materials.last());
            if let Some(radii) = material.and_then(|m| m.radii(groom.strand(s), groom.scale(s))) {
                let points = groom.range(s);
                groom.radii[points].copy_from_slice(&radii);
            }
        }
        Ok(groom)
    }

    /// Reads the strands of a groom's file.
    fn read_strands(
        &mut self,
        named: &GroomFile,
        file: &FileName,
        place: Affine3A,
        skin: Option<&Skin<'_>>,
    ) -> Result<Groom> {
        let path = self.resolve(file);
        let options = ReadOptions { scale: named.scale, up: named.up };
        let fit = skin.map(|skin| {
            move |ends: &[[glam::Vec3; 2]], units: &[f32]| {
                unit_on_skin(ends, units, place, &skin.tree, skin.size)
            }
        });
        let read = read_groom_on(&path, &options, fit.as_ref().map(|fit| fit as FitUnit<'_>));
        let mut loaded = self.named(read, file, "groom")?;
        if named.reverse == Reverse::All {
            loaded.value.reverse();
        }
        if loaded.value.colors.is_empty() {
            if named.colors == Some(ColorSource::File) {
                loaded.notes.push(
                    "the file has no colors, so `colors = \"file\"` has no effect; the color is that of [groom.look]".into(),
                );
            }
        } else {
            match named.colors.unwrap_or(ColorSource::File) {
                ColorSource::Look => loaded.value.colors.clear(),
                ColorSource::File if sets_color(&named.look) => loaded.notes.push(
                    "the file has a color for each point, which replaces the color of [groom.look]; set `colors = \"look\"` to use that of the look".into(),
                ),
                ColorSource::File => {}
            }
        }
        self.note(&path, loaded.notes);
        let r = loaded.repairs;
        self.repairs.non_finite_points += r.non_finite_points;
        self.repairs.zero_segments += r.zero_segments;
        self.repairs.short_strands += r.short_strands;
        self.repairs.empty_strands += r.empty_strands;
        self.repairs.bad_radii += r.bad_radii;
        self.repairs.folds += r.folds;
        Ok(loaded.value)
    }
}

/// Binds each root to skin that follows one of its bones. Copies of a strand use the bones of that
/// strand.
fn bind_by_bones(
    groom: &mut Groom,
    bones: &RootBones,
    body: Option<&Body>,
    copies: u32,
) -> std::result::Result<Option<String>, String> {
    let Some((body, skin)) = body.and_then(|b| b.skin.as_ref().map(|s| (b, s))) else {
        return Err("`bones` needs a skinned [body]".into());
    };
    let copies = 1 + copies as usize;
    if bones.bones.len() * copies != groom.strand_count() {
        let (n, strands) = (bones.bones.len(), groom.strand_count() / copies);
        return Err(format!("the file holds the bones of {n} roots, but the groom has {strands} strands"));
    }
    let weighted = |(joints, weights): (&[u16; 4], &[f32; 4])| {
        (0..4).filter(|k| weights[*k] > 0.0).map(|k| joints[k]).collect::<Vec<_>>()
    };
    let moving: HashSet<u16> = skin.joints.iter().zip(&skin.weights).flat_map(weighted).collect();
    let joint = |name: &String| body.joint(name).map(|j| j as u16).filter(|j| moving.contains(j));
    let joint: Vec<Option<u16>> = bones.names.iter().map(joint).collect();
    let of_root = |s: usize| {
        let s = s % bones.bones.len();
        weighted((&bones.bones[s], &bones.weights[s])).into_iter().filter_map(|b| joint[b as usize])
    };
    let follows = |t: usize, j: u16| {
        let corners = body.mesh.triangles[t].iter().map(|v| *v as usize);
        corners.flat_map(|v| skin.joints[v].into_iter().zip(skin.weights[v])).any(|(k, w)| k == j && w > 0.0)
    };
    bind_roots_where(groom, &body.mesh, |s, t| of_root(s).any(|j| follows(t, j)));

    let used: BTreeSet<u16> = bones.bones.iter().zip(&bones.weights).flat_map(weighted).collect();
    let without: Vec<u16> = used.into_iter().filter(|b| joint[*b as usize].is_none()).collect();
    let Some(first) = without.first() else { return Ok(None) };
    let lost = (0..bones.bones.len()).filter(|s| of_root(*s).next().is_none()).count();
    Ok(Some(format!(
        "{} bones, such as {:?}, move no skin of the body; {lost} roots that follow only these are bound to the nearest skin",
        without.len(),
        text::name(&bones.names[*first as usize]),
    )))
}

/// Whether a look has other colors than by default.
fn sets_color(look: &HairLook) -> bool {
    let plain = HairLook::default();
    look.root_color != plain.root_color
        || look.tip_color != plain.tip_color
        || look.melanin != plain.melanin
        || look.dye != plain.dye
}
