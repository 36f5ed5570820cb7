//! Multipliers that vary along the strands: the profiles of drag, damping, friction and flatness at each particle.

use super::strand_model::StrandModel;
use crate::{
    material::{Material, profile_at, varies},
    simd::lanes::{LANES, Row},
    strand::{
        section::Section,
        tile::{MultiplierRows, multipliers},
    },
};
use glam::Vec3;

/// Smallest length of a strand that is divided by [m].
pub(super) const MIN_LENGTH: f64 = 1e-9;

/// Returns the constants at every particle, see `tile::multipliers`; empty if no material has such a profile.
pub(super) fn constants(model: &StrandModel) -> Vec<MultiplierRows> {
    let is_varied = |m: &Material| {
        [&m.drag_profile, &m.damping_profile, &m.friction_profile, &m.flatness_profile]
            .iter()
            .any(|profile| varies(profile))
    };
    if !model.materials.iter().any(is_varied) {
        return Vec::new();
    }
    let mut rows = vec![[Row([1.0; LANES]); multipliers::ROWS]; model.rest.len()];
    for (place, s) in model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
        let (s, tile) = (*s as usize, model.tiles[place / LANES]);
        let (material, scale) = (model.material(s), model.groom.scale(s));
        // Friction is at most 1 anywhere.
        let most = 1.0 / (material.friction * scale.friction).clamp(f32::MIN_POSITIVE, 1.0);
        let stride = tile.model.stride();
        let ends: Vec<f64> = arc_lengths(model.groom.strand(s));
        let whole = ends[ends.len() - 1].max(MIN_LENGTH);
        for particle in 0..=(ends.len() - 1) * stride {
            // Extra particles are between two points.
            let (point, part) = (particle / stride, (particle % stride) as f64 / stride as f64);
            let next = ends[(point + 1).min(ends.len() - 1)];
            let at = (ends[point] + (next - ends[point]) * part) / whole;
            let rows = &mut rows[tile.first as usize + particle];
            let value = |profile: &[f32]| profile_at(profile, at) as f32;
            rows[multipliers::DRAG].0[place % LANES] = value(&material.drag_profile);
            rows[multipliers::DAMPING].0[place % LANES] = value(&material.damping_profile);
            rows[multipliers::FRICTION].0[place % LANES] = value(&material.friction_profile).min(most);
            let section = Section::new(material, scale, at);
            rows[multipliers::TWIST_RATIO].0[place % LANES] = section.twist_ratio;
            rows[multipliers::FLAT].0[place % LANES] = section.flat;
        }
    }
    rows
}

/// Returns the length of hair from the root to each point [m].
pub(super) fn arc_lengths(points: &[Vec3]) -> Vec<f64> {
    let segments = points.windows(2).map(|w| f64::from(w[0].distance(w[1])));
    std::iter::once(0.0)
        .chain(segments.scan(0.0, |sum, length| {
            *sum += length;
            Some(*sum)
        }))
        .collect()
}
