//! Which strands of a groom are simulated.

use hairspring::{follow::choose_guides, groom::Groom};

/// Number of guides that are chosen in a groom that marks none.
const DEFAULT: u32 = 2_000;

/// Selects the simulated strands of a groom; the others follow them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guides {
    /// The strands that the groom file marks as guides, or 2,000 chosen ones if it marks none. The default.
    #[default]
    FromGroom,
    /// This many strands, spread over the scalp per group.
    Count(u32),
    /// Every strand.
    All,
}

impl Guides {
    /// Returns the simulated strands of `groom`, in increasing order.
    pub fn simulated(self, groom: &Groom) -> Vec<u32> {
        match self.count(groom) {
            Some(count) => choose_guides(groom, count.max(1) as usize),
            None if self == Self::All => (0..groom.strand_count() as u32).collect(),
            None => marked(groom),
        }
    }

    /// Returns a note if more strands are simulated than asked for, because every group of the groom has at least one
    /// guide. The share of a group is rounded, which alone is not worth a note.
    pub(crate) fn more_than_asked(self, groom: &Groom, simulated: usize) -> Option<String> {
        let count = self.count(groom)? as usize;
        let mut groups = groom.groups.clone();
        groups.sort_unstable();
        groups.dedup();
        (simulated > count + groups.len() / 2).then(|| {
            format!(
                "{simulated} strands are simulated instead of {count}, because each of the {} groups has at least one",
                groups.len()
            )
        })
    }

    /// Returns the number of guides to choose; `None` if they are given.
    fn count(self, groom: &Groom) -> Option<u32> {
        match self {
            Self::All => None,
            Self::FromGroom => groom.guides.is_empty().then_some(DEFAULT),
            Self::Count(count) => Some(count),
        }
    }
}

/// Returns the strands that a groom marks as guides.
fn marked(groom: &Groom) -> Vec<u32> {
    let guides = groom.guides.iter().flat_map(|own| own.guides.into_iter().zip(own.weights));
    let mut marked: Vec<u32> = guides.filter(|(_, weight)| *weight > 0.0).map(|(guide, _)| guide).collect();
    marked.sort_unstable();
    marked.dedup();
    marked
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// One large group, and `small` groups of one strand.
    fn groom(small: u16) -> Groom {
        let large = 1000 - small;
        let strand = |k: u16| [0.0, 0.01, 0.02].map(|y| Vec3::new(0.001 * f32::from(k), y, 0.0));
        let mut groom = Groom::from_strands((0..1000).map(strand), 4e-5);
        groom.groups = (0..1000).map(|k: u16| k.saturating_sub(large - 1)).collect();
        groom
    }

    #[test]
    fn every_group_has_a_guide_and_a_note_says_so() {
        for (small, guides, strands, noted) in [
            (0, Guides::All, 1000, false),
            (0, Guides::Count(20), 20, false),
            (90, Guides::Count(20), 18 + 90, true),
            (90, Guides::Count(5000), 1000, false),
            (90, Guides::FromGroom, 1000, false),
        ] {
            let groom = groom(small);
            let simulated = guides.simulated(&groom).len();
            assert_eq!(simulated, strands, "{small} {guides:?}");
            let note = guides.more_than_asked(&groom, simulated);
            assert_eq!(note.is_some(), noted, "{note:?}");
            assert!(note.is_none_or(|note| note.starts_with("108 strands")
                && note.contains("of 20")
                && note.contains("91 groups")));
        }
    }
}
