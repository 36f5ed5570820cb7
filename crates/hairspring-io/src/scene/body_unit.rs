//! The unit of a body, by the grooms of its scene.

use super::{Reader, groom_file::GroomFile};
use crate::{ReadOptions, load::read_groom_on, skin_distance::unit_on_skin, units::extent};
use glam::Vec3;
use hairspring::{
    body::{Mesh, NearestTree},
    groom::Groom,
};
use std::cell::RefCell;

/// Strands that are compared with the skin at most.
const SAMPLES: usize = 500;

impl Reader<'_> {
    /// Returns the first of `units` [m] in which the strands of a groom stand on the skin. The groom has the unit that the
    /// scene or its file gives, or that its size suggests. `body` returns the mesh in a unit, as it is placed in the scene.
    /// `None` if no groom has a file, or if no unit fits.
    pub(super) fn body_unit(&self, units: &[f32], body: &dyn Fn(f32) -> Mesh) -> Option<f32> {
        self.grooms.iter().find_map(|groom| {
            let (ends, unit) = self.ends(groom)?;
            units.iter().copied().find(|scale| {
                let mesh = body(*scale);
                let size = extent(mesh.positions.iter().copied());
                let place = groom.transform.to_affine();
                unit_on_skin(&ends, &[unit], place, &NearestTree::new(&mesh), size).is_some()
            })
        })
    }

    /// The two ends of some strands of a groom's file, and their unit [m]. An error of the file is reported when its groom
    /// is read.
    fn ends(&self, groom: &GroomFile) -> Option<(Vec<[Vec3; 2]>, f32)> {
        let path = self.resolve(groom.file.as_ref()?);
        let options = ReadOptions { scale: groom.scale, up: groom.up };
        let guessed = RefCell::new(None);
        let fit = |ends: &[[Vec3; 2]], units: &[f32]| {
            *guessed.borrow_mut() = units.first().map(|unit| (ends.to_vec(), *unit));
            None
        };
        let read = read_groom_on(&path, &options, Some(&fit)).ok()?;
        Some(guessed.take().unwrap_or_else(|| (ends(&read.value), 1.0)))
    }
}

/// The two ends of some strands.
fn ends(groom: &Groom) -> Vec<[Vec3; 2]> {
    let step = groom.strand_count().div_ceil(SAMPLES).max(1);
    let of_strand = |s: usize| {
        let strand = groom.strand(s);
        Some([*strand.first()?, *strand.last()?])
    };
    (0..groom.strand_count()).step_by(step).filter_map(of_strand).collect()
}
