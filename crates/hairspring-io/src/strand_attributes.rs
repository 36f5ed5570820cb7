//! Attributes of whole strands in a table: group, guide flag, texture coordinates of the root, density mask, and
//! factors of the material.

use crate::{Problem, strands::Read};
use glam::Vec2;
use hairspring::{
    follow::assign_guides,
    groom::{Groom, GuideWeights, StrandScale, thin},
};
use std::collections::HashMap;

/// Names of the attributes that are numbers, in the order of [`StrandAttributes::numbers`].
pub(crate) const NUMBERS: [&str; 11] = [
    "stiffness",
    "damping",
    "drag",
    "friction",
    "charge",
    "flatness",
    "tether",
    "density",
    "guide",
    "u",
    "v",
];

/// Name of the attribute that is a word.
pub(crate) const GROUP: &str = "group";

/// Largest number of groups.
const MOST_GROUPS: usize = 1 << 16;

/// The attributes of all strands so far.
#[derive(Default)]
pub(crate) struct StrandAttributes {
    /// Values of each of [`NUMBERS`]; shape `[strands]`, or empty if the file has none.
    pub numbers: [Vec<f32>; NUMBERS.len()],
    /// Group of each strand.
    pub groups: StrandGroups,
}

/// Groups of strands by their names, in the order in which they appear.
#[derive(Default)]
pub(crate) struct StrandGroups {
    indices: HashMap<String, usize>,
    names: Vec<String>,
    /// Index of the group of each strand; shape `[strands]`, or empty.
    pub of_strands: Vec<usize>,
}

impl StrandGroups {
    /// Returns the index of the group called `name`, which is added if it is new.
    pub fn index(&mut self, name: &str) -> usize {
        if let Some(index) = self.indices.get(name) {
            return *index;
        }
        self.indices.insert(name.to_owned(), self.names.len());
        self.names.push(name.to_owned());
        self.names.len() - 1
    }

    /// Number of groups.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Puts the groups into a groom, unless there is only one without a name. Returns a note if there are too many.
    pub fn apply(self, groom: &mut Groom) -> Option<String> {
        if self.names == [""] {
            return None;
        }
        if self.names.len() > MOST_GROUPS {
            let count = self.names.len();
            return Some(format!(
                "{count} groups are more than the limit of {MOST_GROUPS}, so all strands are in one"
            ));
        }
        groom.groups = self.of_strands.into_iter().map(|group| group as u16).collect();
        groom.group_names = self.names;
        None
    }
}

impl StrandAttributes {
    /// Puts the attributes into a groom. Notes say what could not be used, and what was removed.
    ///
    /// # Errors
    /// Returns an error if the density keeps no strand.
    pub fn apply(self, read: &mut Read) -> Result<(), Problem> {
        let groom = &mut read.groom;
        let strands = groom.strand_count();
        let [stiffness, damping, drag, friction, charge, flatness, tether, density, guide, u, v] =
            self.numbers;
        read.notes.extend(self.groups.apply(groom));
        if u.len() == strands && v.len() == strands {
            groom.root_uvs = u.iter().zip(&v).map(|(u, v)| Vec2::new(*u, *v)).collect();
        }
        for (values, put) in [
            (stiffness, (|s, x| s.bend = x) as fn(&mut StrandScale, f32)),
            (damping, |s, x| s.damping = x),
            (drag, |s, x| s.drag = x),
            (friction, |s, x| s.friction = x),
            (charge, |s, x| s.charge = x),
            (flatness, |s, x| s.flatness = x),
            (tether, |s, x| s.tether = x),
        ] {
            if !values.is_empty() {
                groom.scales.resize(strands, StrandScale::default());
                groom.scales.iter_mut().zip(values).for_each(|(scale, x)| put(scale, x));
            }
        }
        if guide.iter().any(|flag| *flag != 0.0 && *flag != 1.0) {
            read.notes.push(
                "guide flags other than 0 and 1 count as 1 if they are above 0, and as 0 otherwise".into(),
            );
        }
        let guides: Vec<u32> =
            (0..strands as u32).filter(|s| guide.get(*s as usize).is_some_and(|flag| *flag > 0.0)).collect();
        if !guides.is_empty() && guides.len() < strands {
            groom.guides = assign_guides(groom, &guides);
            // A strand whose points are not finite or too far apart, which are repaired later, follows any guide.
            for own in groom.guides.iter_mut().filter(|own| !own.weights.iter().all(|w| w.is_finite())) {
                *own = GuideWeights { guides: [guides[0]; 3], weights: [1.0, 0.0, 0.0] };
            }
        }
        if !density.is_empty() {
            // The radii are not in the groom yet.
            groom.radii = read.radii.take().unwrap_or_default();
            thin(groom, &density);
            let radii = std::mem::take(&mut groom.radii);
            read.radii = (!radii.is_empty()).then_some(radii);
            read.notes.extend(kept_by_density(groom.strand_count(), strands)?);
        }
        Ok(())
    }
}

/// Returns a note about the strands that the density removed.
///
/// # Errors
/// Returns an error if it removed all of them.
fn kept_by_density(kept: usize, strands: usize) -> Result<Option<String>, Problem> {
    if kept == 0 && strands > 0 {
        let text = format!("density keeps none of the {strands} strands; raise it above 0");
        return Err(Problem::whole(text));
    }
    Ok((kept < strands).then(|| format!("density keeps {kept} of {strands} strands")))
}
