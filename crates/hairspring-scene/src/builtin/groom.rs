//! Builds the groom: hair paths are gathered into locks, waved, and placed clear of the skin.

use super::{
    field::{CELL, Field},
    grow::{Place, course},
    random::Random,
    roots::roots,
    sdf::smoothstep,
    shape,
    style::Cut,
};
use glam::{IVec3, Vec2, Vec3, Vec3Swizzles, vec2, vec3};
use hairspring::{
    body::Mesh,
    groom::{DEFAULT_RADIUS, Groom},
};
use rayon::prelude::*;
use std::{collections::HashMap, f32::consts::TAU};

/// Average number of hairs in a lock.
const LOCK: usize = 180;
/// Average number of hairs in a wisp, the smaller bundles that make up a lock.
const WISP: usize = 20;
/// Minimum distance of any point except the root from the skin [m].
const CLEARANCE: f32 = 0.0005;
/// Names of the groups, by the position of the root.
const GROUPS: [&str; 3] = ["front", "sides", "back"];

/// Middle of the cranium, from which the texture coordinates of the roots are measured [m].
const CRANIUM: Vec3 = vec3(0.0, 0.03, -0.015);

/// A hair before waves are added: its path, and the parameters that it shares with its lock.
struct Strand {
    place: Place,
    length: f32,
    /// Points a fixed step apart, root first [m].
    course: Vec<Vec3>,
    /// Phase [rad] and wavelength factor of its waves.
    phase: f32,
    pitch: f32,
    /// Amplitude factor of its waves.
    amplitude: f32,
}

/// Creates `count` hairs of `points` points each in the style `cut` on the scalp of `mesh`.
pub fn groom(mesh: &Mesh, cut: &Cut, count: usize, points: usize, seed: u32) -> Groom {
    let field = Field::new();
    let tier = |count: usize, purpose: u32| -> Vec<Strand> {
        let roots = roots(mesh, count, seed ^ purpose.wrapping_mul(0x9E37_79B9));
        roots
            .par_iter()
            .enumerate()
            .map(|(i, (p, n))| grown(&field, cut, Place::new(*p, *n), seed, purpose, i))
            .collect()
    };
    // Locks consist of wisps, and wisps of hairs: each tier gathers around the previous one.
    let locks = tier(count.div_ceil(LOCK), 2);
    let mut wisps = tier(count.div_ceil(WISP), 3);
    // The parting separates locks, except for standing hair.
    let apart = if cut.stand > 0.5 { 0.0 } else { 1.0 };
    gather(&mut wisps, &locks, cut.clump * 0.8, 0.4, apart);
    let mut hairs = tier(count, 4);
    gather(&mut hairs, &wisps, cut.clump, 0.25, apart);

    let mut groom = Groom { offsets: (0..=count).map(|s| (s * points) as u32).collect(), ..Groom::default() };
    groom.points = vec![Vec3::ZERO; count * points];
    groom.points.par_chunks_mut(points.max(1)).zip(&hairs).enumerate().for_each(|(i, (out, hair))| {
        let curve = waved(&field, cut, hair, Random::new(seed, 5, i as u32));
        resample(&curve, hair.length / cut.step(), out);
        settle(&field, out);
    });
    // Human hair is thinner at its tip, where it is oldest.
    let taper =
        |k: usize| DEFAULT_RADIUS * (1.0 - 0.6 * smoothstep(0.6, 1.0, k as f32 / (points - 1).max(1) as f32));
    let radii: Vec<f32> = (0..points).map(taper).collect();
    groom.radii = radii.repeat(count);
    groom.group_names = GROUPS.map(String::from).to_vec();
    groom.groups = hairs.iter().map(|h| group(&h.place)).collect();
    groom.root_uvs = hairs.iter().map(|h| texture_coordinates(h.place.root)).collect();
    groom
}

/// Returns the texture coordinates of a root: the scalp seen from above, with the crown in the middle, the face at the
/// lower edge and her left on the right. The distance from the middle is the angle from the vertical, as in a polar map.
fn texture_coordinates(root: Vec3) -> Vec2 {
    let from_middle = root - CRANIUM;
    let angle = from_middle.angle_between(Vec3::Y);
    let around = from_middle.xz().normalize_or_zero() * vec2(1.0, -1.0);
    Vec2::splat(0.5) + around * (angle / TAU)
}

/// Returns the index of a root's group in [`GROUPS`].
fn group(place: &Place) -> u16 {
    let angle = place.root.x.abs().atan2(place.root.z + 0.015);
    if angle < 0.75 {
        0
    } else if angle < 1.9 {
        1
    } else {
        2
    }
}

/// Grows the path with number `index` of a tier.
fn grown(field: &Field, cut: &Cut, place: Place, seed: u32, purpose: u32, index: usize) -> Strand {
    let mut random = Random::new(seed, purpose, index as u32);
    let layer = (1.0 - place.from_parting / 0.22).clamp(0.05, 1.0) * random.within(0.75, 1.1);
    let length = (cut.length - cut.level * place.from_parting).max(cut.shortest)
        * (1.0 + 0.07 * random.normal()).max(0.6);
    let sway = random.normal3() * 0.10;
    let course = course(field, cut, &place, length, layer, sway);
    let (phase, pitch, amplitude) =
        (random.within(0.0, TAU), random.within(0.85, 1.2), random.within(0.7, 1.3));
    Strand { place, length, course, phase, pitch, amplitude }
}

/// Pulls every strand toward the nearest of `centers`, preferring its own side of the parting, with
/// `strength` at the tip.
///
/// The waves are those of the center, except for a fraction `jitter` of the strand's own. `apart` is added to
/// the distance of a center on the other side of the parting [m].
fn gather(strands: &mut [Strand], centers: &[Strand], strength: f32, jitter: f32, apart: f32) {
    let index = Nearest::new(centers);
    strands.par_iter_mut().for_each(|strand| {
        let center = &centers[index.find(centers, &strand.place, apart)];
        let offset = strand.place.root - center.place.root;
        let last = center.course.len() - 1;
        let steps = strand.course.len() as f32;
        for (k, p) in strand.course.iter_mut().enumerate() {
            let t = k as f32 / steps;
            // Beyond the center's tip, continue straight along its last segment.
            let at = if k <= last {
                center.course[k]
            } else {
                center.course[last] + (center.course[last] - center.course[last - 1]) * (k - last) as f32
            };
            // Locks taper: the offset of a hair from the center decreases toward the tip.
            let target = at + offset * (1.0 - 0.85 * smoothstep(0.1, 1.0, t));
            *p = p.lerp(target, strength * smoothstep(0.02, 0.55, t));
        }
        strand.phase = center.phase + (strand.phase / TAU - 0.5) * TAU * jitter * 0.5;
        strand.pitch = center.pitch + (strand.pitch - center.pitch) * jitter * 0.2;
        strand.amplitude = center.amplitude + (strand.amplitude - center.amplitude) * jitter;
    });
}

/// Finds the strand with the nearest root.
struct Nearest {
    cell: f32,
    cells: HashMap<IVec3, Vec<u32>>,
}

impl Nearest {
    fn new(centers: &[Strand]) -> Self {
        // Aims at one root per cell on a scalp of about 0.07 m².
        let cell = (0.07 / centers.len().max(1) as f32).sqrt().max(1e-4);
        let mut cells: HashMap<IVec3, Vec<u32>> = HashMap::new();
        for (i, c) in centers.iter().enumerate() {
            cells.entry(key(&c.place, cell)).or_default().push(i as u32);
        }
        Self { cell, cells }
    }

    fn find(&self, centers: &[Strand], place: &Place, apart: f32) -> usize {
        let home = key(place, self.cell);
        let mut best = (f32::INFINITY, 0);
        for reach in 1..12 {
            for z in -reach..=reach {
                for y in -reach..=reach {
                    for x in -reach..=reach {
                        for i in self.cells.get(&(home + IVec3::new(x, y, z))).into_iter().flatten() {
                            let c = &centers[*i as usize].place;
                            let apart = if c.side == place.side { 0.0 } else { apart };
                            let distance = c.root.distance(place.root) + apart;
                            if distance < best.0 {
                                best = (distance, *i as usize);
                            }
                        }
                    }
                }
            }
            // All cells beyond `reach` are farther than this.
            if best.0 <= reach as f32 * self.cell {
                break;
            }
        }
        best.1
    }
}

fn key(place: &Place, cell: f32) -> IVec3 {
    (place.root / cell).floor().as_ivec3()
}

/// Returns the path with its waves.
fn waved(field: &Field, cut: &Cut, hair: &Strand, mut random: Random) -> Vec<Vec3> {
    // One hair in sixty strays from its lock.
    let stray = if random.unit() < 1.0 / 60.0 { 4.0 } else { 1.0 };
    let drift = random.normal3() * cut.frizz * stray;
    let course = &hair.course;
    let step = course[0].distance(course[1]);
    (0..course.len())
        .map(|k| {
            let s = k as f32 * step;
            let tangent = course[(k + 1).min(course.len() - 1)] - course[k.saturating_sub(1)];
            let tangent = tangent.normalize_or(Vec3::NEG_Y);
            let (_, out) = field.at(course[k]);
            let across = tangent.cross(out).normalize_or(Vec3::X);
            let deep = across.cross(tangent);
            let grown = smoothstep(0.0, cut.length * 0.35, s);
            let turn = TAU * s / (cut.wave_length * hair.pitch) + hair.phase;
            let size = cut.wave * hair.amplitude * grown;
            let wave = across * turn.cos() + deep * (turn.sin() * cut.roundness);
            clear(field, course[k] + wave * size + drift * smoothstep(0.0, cut.length, s), grown)
        })
        .collect()
}

/// Moves `p` out of the bust's combing field, if gathering or a wave has moved it too far in. `share` is the
/// fraction of the correction that is applied.
fn clear(field: &Field, p: Vec3, share: f32) -> Vec3 {
    let mut out = p;
    for _ in 0..6 {
        let (d, n) = field.at(out);
        if d >= 2.0 * CLEARANCE {
            break;
        }
        out += n * (2.0 * CLEARANCE - d);
    }
    p.lerp(out, share)
}

/// Writes evenly spaced points along the first `steps` segments of `curve`.
fn resample(curve: &[Vec3], steps: f32, out: &mut [Vec3]) {
    let whole: f32 = curve.windows(2).map(|w| w[0].distance(w[1])).sum();
    let share = steps / (curve.len() - 1) as f32;
    let step = whole * share.min(1.0) / (out.len() - 1).max(1) as f32;
    let (mut segment, mut covered) = (0, 0.0);
    for (k, point) in out.iter_mut().enumerate() {
        let wanted = k as f32 * step;
        loop {
            let l = curve[segment].distance(curve[segment + 1]);
            if covered + l >= wanted || segment + 2 >= curve.len() {
                *point = curve[segment].lerp(curve[segment + 1], ((wanted - covered) / l.max(1e-9)).min(1.0));
                break;
            }
            covered += l;
            segment += 1;
        }
    }
}

/// Cosine of the largest allowed turn between adjacent segments: 75°.
const SHARPEST: f32 = 0.26;

/// Moves every point except the root to at least [`CLEARANCE`] from the skin, with even segments and without
/// folds.
fn settle(field: &Field, points: &mut [Vec3]) {
    let step = points[0].distance(points[1]);
    for k in 1..points.len() {
        // Each point is placed one segment length from the previous one. Both conditions are enforced in
        // turn.
        let before = points[k - 1];
        let along = if k > 1 { (before - points[k - 2]).normalize_or_zero() } else { Vec3::ZERO };
        let mut p = outside(field, points[k]);
        for _ in 0..8 {
            let way = unfolded(along, (p - before).normalize_or(Vec3::NEG_Y));
            let reached = before + way * step;
            p = outside(field, reached);
            if p == reached {
                break;
            }
        }
        points[k] = p;
    }
}

/// Returns the direction nearest to `way` that turns from `along` by no more than [`SHARPEST`] allows. Both
/// are unit vectors, or `along` is zero.
fn unfolded(along: Vec3, way: Vec3) -> Vec3 {
    if along == Vec3::ZERO || along.dot(way) >= SHARPEST {
        return way;
    }
    let aside = way.reject_from_normalized(along).normalize_or(along.any_orthonormal_vector());
    along * SHARPEST + aside * (1.0 - SHARPEST * SHARPEST).sqrt()
}

/// Returns approximately the nearest point to `p` that is [`CLEARANCE`] from the skin.
fn outside(field: &Field, mut p: Vec3) -> Vec3 {
    // The grid is too coarse for the final placement, but it rules out points that are far: its error is
    // below one cell.
    if field.at(p).0 > CELL {
        return p;
    }
    for _ in 0..12 {
        let d = shape::distance(p);
        if d >= CLEARANCE {
            break;
        }
        p += shape::normal(p) * (CLEARANCE * 1.05 - d);
    }
    p
}
