//! The strands of a stage that are written: all, or those that are simulated.

use hairspring::{groom::Groom, material::Material};
use hairspring_io::CacheDescription;
use hairspring_scene::stage::Stage;
use std::borrow::Cow;

/// Strands of each groom.
pub struct Selection {
    /// Whether each strand is simulated; shape `[grooms][strands]`.
    simulated: Vec<Vec<bool>>,
    only_simulated: bool,
}

impl Selection {
    /// Selects all strands, or only the simulated ones.
    pub fn new(stage: &Stage, only_simulated: bool) -> Self {
        let simulated = stage.strands().enumerate().map(|(g, strands)| {
            (0..strands.groom.strand_count()).map(|s| stage.guide_of(g, s) as usize == s).collect()
        });
        Self { simulated: simulated.collect(), only_simulated }
    }

    /// Strands of groom `g` that are selected.
    fn strands(&self, g: usize) -> impl Iterator<Item = usize> + '_ {
        let all = self.simulated[g].iter().enumerate();
        all.filter(|(_, simulated)| !self.only_simulated || **simulated).map(|(s, _)| s)
    }

    /// The grooms at rest, with the selected strands only.
    pub fn grooms(&self, stage: &Stage) -> Vec<Groom> {
        stage.strands().enumerate().map(|(g, all)| self.groom(g, all.groom)).collect()
    }

    fn groom(&self, g: usize, all: &Groom) -> Groom {
        if !self.only_simulated {
            return all.clone();
        }
        let mut groom = Groom { offsets: vec![0], group_names: all.group_names.clone(), ..Groom::default() };
        for s in self.strands(g) {
            let range = all.range(s);
            groom.points.extend_from_slice(&all.points[range.clone()]);
            groom.radii.extend_from_slice(&all.radii[range.clone()]);
            groom.colors.extend_from_slice(all.colors.get(range).unwrap_or_default());
            groom.offsets.push(groom.points.len() as u32);
            groom.groups.extend(all.groups.get(s));
            groom.root_uvs.extend(all.root_uvs.get(s));
        }
        groom
    }

    /// The current points of each groom.
    pub fn points<'a>(&self, stage: &'a Stage) -> Vec<Cow<'a, [glam::Vec3]>> {
        let points = |(g, all): (usize, hairspring_scene::stage::Strands<'a>)| {
            if !self.only_simulated {
                return Cow::Borrowed(all.points);
            }
            Cow::Owned(self.strands(g).flat_map(|s| all.points[all.groom.range(s)].iter().copied()).collect())
        };
        stage.strands().enumerate().map(points).collect()
    }

    /// Describes the grooms, which have these names or none, for a file of moving strands.
    pub fn describe(
        &self,
        names: &[String],
        grooms: Vec<Groom>,
        materials: Vec<Vec<Material>>,
        source: String,
    ) -> CacheDescription {
        let guides =
            (0..grooms.len()).map(|g| self.strands(g).map(|s| self.simulated[g][s]).collect()).collect();
        let name = |k: usize| match names.get(k).filter(|name| !name.is_empty()) {
            Some(name) => name.clone(),
            None if grooms.len() == 1 => "groom".into(),
            None => format!("groom_{}", k + 1),
        };
        let names: Vec<String> = (0..grooms.len()).map(name).collect();
        let grooms = names.into_iter().zip(grooms).collect();
        CacheDescription { grooms, guides, materials, source, ..CacheDescription::default() }
    }
}
