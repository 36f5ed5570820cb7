//! The path of a single hair: it leaves the skin, is combed away from the parting over the layers below it,
//! and falls.

use super::{field::Field, sdf::smoothstep, style::Cut};
use glam::{Vec2, Vec3, Vec3Swizzles, vec2, vec3};

/// The parting seen from above (x, z) [m]: from the hairline to the crown.
const PARTING: [Vec2; 2] = [vec2(0.026, 0.085), vec2(0.008, -0.050)];
/// Height of the parting [m].
const PARTING_HEIGHT: f32 = 0.110;

/// Position of a root within the style.
#[derive(Clone, Copy)]
pub struct Place {
    /// The root on the skin [m].
    pub root: Vec3,
    /// Outward normal of the skin there.
    pub normal: Vec3,
    /// Direction in which the hair is combed: 1 to the left (+X), −1 to the right.
    pub side: f32,
    /// Distance from the parting along the skull [m].
    pub from_parting: f32,
}

impl Place {
    /// Computes the place of a root.
    pub fn new(root: Vec3, normal: Vec3) -> Self {
        let nearest = on_parting(root.xz());
        let away = root.xz() - nearest;
        let line = PARTING[0] - PARTING[1];
        let side = if away.perp_dot(line) > 0.0 { 1.0 } else { -1.0 };
        let chord = root.distance(vec3(nearest.x, PARTING_HEIGHT, nearest.y));
        // The arc over the skull is longer than the chord through it (radius about 9 cm).
        let from_parting = 0.18 * (chord / 0.18).min(0.98).asin();
        Self { root, normal, side, from_parting }
    }
}

/// Returns the point of the parting nearest to `p`, both (x, z) [m].
fn on_parting(p: Vec2) -> Vec2 {
    let line = PARTING[1] - PARTING[0];
    PARTING[0] + line * ((p - PARTING[0]).dot(line) / line.length_squared()).clamp(0.0, 1.0)
}

/// Returns the path of the hair at `place`, of at least `length` [m]: points [`Cut::step`] apart, root first.
///
/// `layer`, 0 to 1, is the position among the layers from inside to outside; `sway` changes the direction of
/// fall [unit vectors per meter].
pub fn course(field: &Field, cut: &Cut, place: &Place, length: f32, layer: f32, sway: Vec3) -> Vec<Vec3> {
    let step = cut.step();
    let steps = (length / step).ceil() as usize + 2;
    let mut points = Vec::with_capacity(steps);
    points.push(place.root);
    let mut p = place.root;
    let mut heading = combed(field, cut, place, p, 0.0, sway);
    heading = (heading * (1.0 - cut.lift) + place.normal * cut.lift).normalize_or(place.normal);
    for i in 1..steps {
        let s = i as f32 * step;
        // The hair rests on the layers below: its height grows over the first centimeters.
        let floor = 0.0006 + cut.volume * layer * smoothstep(0.0, cut.rise, s);
        let wish = combed(field, cut, place, p, floor, sway);
        // The hair turns gradually: over about 1 cm near the skin, 3 cm where it falls.
        let turn = 1.0 - (-step / if s < 0.16 { 0.0125 } else { 0.027 }).exp();
        heading = (heading + (wish - heading) * turn).normalize_or(heading);
        let mut next = p + heading * step;
        for _ in 0..2 {
            let (d, n) = field.at(next);
            if d < floor {
                // At most a third of a step at once, so that the path stays smooth.
                next += n * (floor - d).min(step * 0.35);
            }
        }
        heading = (next - p).normalize_or(heading);
        p += heading * step;
        points.push(p);
    }
    points
}

/// Returns the preferred direction of hair at `p`, a unit vector; its layer is `floor` above the skin [m].
fn combed(field: &Field, cut: &Cut, place: &Place, p: Vec3, floor: f32, sway: Vec3) -> Vec3 {
    let (d, n) = field.at(p);
    // Away from the parting: sideways in front of the crown, in all directions behind it, and never into the
    // face.
    let mut away = (p.xz() - on_parting(p.xz())).normalize_or(vec2(place.side, 0.0));
    if away.x * place.side < 0.35 && p.z > PARTING[1].y {
        away.x = place.side * 0.35;
    }
    away.y = away.y.min(0.0) - 0.20 * smoothstep(-0.02, 0.06, p.z);
    // On top of the head the comb dominates, below the temples gravity.
    let comb = smoothstep(-0.02, 0.09, p.y);
    let mut wish = vec3(away.x, 0.0, away.y) * (0.12 + 0.9 * comb) - Vec3::Y * (1.15 - 0.75 * comb);
    // At the shoulder: to the front or to the back, depending on the root, and not off its side.
    let shoulder = smoothstep(-0.05, -0.10, p.y) * smoothstep(0.15, 0.55, n.y) * smoothstep(0.06, 0.02, d);
    let ahead = if place.root.z > 0.012 { 0.45 } else { -0.45 };
    wish = wish.lerp(vec3(-0.5 * p.x.signum(), -0.8, ahead), shoulder);
    wish += sway;
    // Along the surface while touching it. On the head, hair that stands off is also pulled back to its
    // layer.
    let on = smoothstep(floor + 0.012, floor + 0.003, d);
    let head = smoothstep(-0.03, 0.03, p.y);
    let outward = wish.dot(n);
    wish -= n * (outward.min(0.0) * on + outward.max(0.0) * head);
    wish -= n * (head * ((d - floor) / 0.006).clamp(0.0, 1.5));
    let wish = wish.normalize_or(-Vec3::Y);
    // Standing hair: outward, with a small influence of the comb.
    (wish + (n - wish) * cut.stand).normalize_or(wish)
}
