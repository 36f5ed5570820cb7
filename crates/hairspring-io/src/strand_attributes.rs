//! Attributes of whole strands in a table: group, guide flag, texture coordinates of the root, density mask, and
//! factors of the material.

use crate::strands::Read;
use glam::Vec2;
use hairspring::{
    follow::assign_guides,
    groom::{GuideWeights, StrandScale, thin},
};

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
    /// Group of each strand; shape `[strands]`, or empty.
    pub groups: Vec<String>,
}

impl StrandAttributes {
    /// Puts the attributes into a groom. Notes say what could not be used.
    pub fn apply(self, read: &mut Read) {
        let groom = &mut read.groom;
        let strands = groom.strand_count();
        let [stiffness, damping, drag, friction, charge, flatness, tether, density, guide, u, v] =
            self.numbers;
        if !self.groups.is_empty() {
            let mut names: Vec<String> = Vec::new();
            let index = |name: &String, names: &mut Vec<String>| match names.iter().position(|n| n == name) {
                Some(k) => k,
                None => {
                    names.push(name.clone());
                    names.len() - 1
                }
            };
            let groups: Vec<usize> = self.groups.iter().map(|name| index(name, &mut names)).collect();
            if names.len() > MOST_GROUPS {
                read.notes.push(format!("more than {MOST_GROUPS} groups; all strands are in one"));
            } else {
                groom.groups = groups.into_iter().map(|g| g as u16).collect();
                groom.group_names = names;
            }
        }
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
        }
    }
}
