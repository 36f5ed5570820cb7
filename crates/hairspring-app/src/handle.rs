//! Handles in the picture: the wind arrow, and the listed objects of the scene (colliders, tools, wind
//! sources, charged bodies). They can be moved, rotated and resized with the mouse. A handle has the same
//! effect as a slider: it writes into the scene's text.

use crate::{document::Document, key::Key, orbit::Lens, session::Action, snapshot::StageSnapshot};
use glam::{Vec2, Vec3};
use hairspring::math::RigidTransform;
use toml_edit::Value;

/// Position of the wind arrow's base, from the picture's top left corner, relative to its width and height
/// [1].
const ROSE: Vec2 = Vec2::new(0.8, 0.7);
/// Length of the arrow for a storm, relative to the height of the picture [1].
const LONGEST: f32 = 0.25;
/// Speed of that storm [m/s].
const STORM: f32 = 20.0;
/// An arrow shorter than this means calm, relative to the height of the picture [1]. Otherwise it would be
/// hard to set 0 by hand.
const CALM: f32 = 0.015;
/// Length of the arrow of a source that blows at 1 m/s [m]. The length is proportional to the square root of
/// the speed.
const ARROW: f32 = 0.08;
/// Minimum radius that a handle can set [m].
const NARROWEST: f32 = 1e-3;

/// The value that a handle changes.
#[derive(Clone, Debug)]
enum Pull {
    /// The scene's wind: base of the arrow, and its length for a storm [m].
    Wind(Vec3, f32),
    /// A position.
    Place(Key),
    /// A radius around a center.
    Radius(Key, Vec3),
    /// The direction of an axis from its center and, by the arrow's length, the air speed along it. The speed
    /// keeps its current sign.
    Axis(Key, Option<(Key, f32)>, Vec3),
}

/// A handle.
#[derive(Clone, Debug)]
pub struct Handle {
    /// Position in world space [m].
    pub at: Vec3,
    /// Label.
    pub name: String,
    pull: Pull,
    /// Transform of the object that the handle belongs to, since the rest pose.
    pose: RigidTransform,
}

impl Handle {
    /// The action for dragging the handle to a position in world space.
    pub fn pulled(&self, to: Vec3) -> Action {
        let own = |place: Vec3| list(self.pose.inverse_transform_point(place), 1e4);
        match &self.pull {
            Pull::Wind(from, longest) => {
                let way = to - *from;
                let share = way.length() / longest;
                let calm = share * LONGEST < CALM;
                let speed = if calm { 0.0 } else { STORM * (share * share).min(1.0) };
                Action::Set(
                    Key::top("wind").field("velocity"),
                    Some(list(way.normalize_or_zero() * speed, 1e2)),
                )
            }
            Pull::Place(key) => Action::Set(key.clone(), Some(own(to))),
            Pull::Radius(key, middle) => {
                let radius = to.distance(*middle).max(NARROWEST);
                Action::Set(key.clone(), Some(rounded(radius, 1e4).into()))
            }
            Pull::Axis(key, speed, middle) => {
                let way = to - *middle;
                let axis = self.pose.rotation.inverse() * way.normalize_or(Vec3::Y);
                let mut values = vec![(key.clone(), Some(list(axis, 1e3)))];
                values.extend(speed.as_ref().map(|(key, sign)| {
                    let speed = (way.length() / ARROW).powi(2).clamp(0.01, 100.0);
                    (key.clone(), Some(rounded(speed * sign, 1e2).into()))
                }));
                Action::SetAll(values)
            }
        }
    }

    /// Base of the arrow, if the handle is the tip of one.
    pub fn arrow(&self) -> Option<Vec3> {
        match self.pull {
            Pull::Wind(from, _) | Pull::Axis(.., from) => Some(from),
            _ => None,
        }
    }

    /// Center of the circle, if the handle is on its rim.
    pub fn rim(&self) -> Option<Vec3> {
        match self.pull {
            Pull::Radius(_, middle) => Some(middle),
            _ => None,
        }
    }

    /// Whether this is the wind handle.
    pub fn is_wind(&self) -> bool {
        matches!(self.pull, Pull::Wind(..))
    }
}

/// All handles of a scene, as seen through `lens`. `distance` is that from the camera to its target [m].
pub fn all(document: &Document, stage: &StageSnapshot, lens: &Lens, distance: f32) -> Vec<Handle> {
    let mut handles = vec![wind(document, lens, distance)];
    let carried = &stage.carried;
    for (name, one, poses) in [
        ("collider", "Collider", &carried.colliders),
        ("hand", "Hand", &carried.hands),
        ("wind_source", "Source", &carried.wind_sources),
        ("charged", "Charged body", &carried.charged),
    ] {
        let entries = document.effective().get(name).and_then(toml::Value::as_array);
        for (k, entry) in entries.into_iter().flatten().enumerate() {
            let (key, table) = shape(Key::top(name).place(k), entry);
            let pose = poses.get(k).copied().unwrap_or_default();
            of_shape(&format!("{one} {}", k + 1), (&key, table), pose, lens, &mut handles);
        }
    }
    handles
}

fn wind(document: &Document, lens: &Lens, distance: f32) -> Handle {
    let (eye, way) = lens.ray(ROSE);
    let from = eye + way * distance;
    // Height of the picture in meters at this depth.
    let longest = LONGEST / lens.scale(distance, 1.0);
    let key = Key::top("wind").field("velocity");
    let velocity = vector(key.look_up(document.effective())).unwrap_or_default();
    let speed = velocity.length();
    let tip = velocity.normalize_or_zero() * longest * (speed / STORM).sqrt().min(1.0);
    let name = if speed > 0.0 { format!("wind {speed:.1} m/s") } else { "calm: pull for wind".into() };
    Handle { at: from + tip, name, pull: Pull::Wind(from, longest), pose: RigidTransform::default() }
}

/// The table that holds an entry's positions: its `shape`, its `tool`, or the entry itself.
fn shape(key: Key, entry: &toml::Value) -> (Key, &toml::Value) {
    for name in ["shape", "tool"] {
        if let Some((kind, inner)) =
            entry.get(name).and_then(toml::Value::as_table).and_then(|t| t.iter().next())
        {
            return (key.field(name).entry(kind), inner);
        }
    }
    (key, entry)
}

/// Handles of a shape: its positions, its radius around its center, and its axis.
fn of_shape(
    name: &str,
    (key, table): (&Key, &toml::Value),
    pose: RigidTransform,
    lens: &Lens,
    handles: &mut Vec<Handle>,
) {
    let number = |name: &str| table.get(name).and_then(toml::Value::as_float).map(|x| x as f32);
    let mut add = |what: &str, at: Vec3, pull: Pull| {
        handles.push(Handle { at, name: format!("{name}: {what}"), pull, pose });
    };
    for (field, what) in [("center", "move"), ("a", "move an end"), ("b", "move an end"), ("point", "move")] {
        if let Some(place) = vector(table.get(field)) {
            add(what, pose.transform_point(place), Pull::Place(key.field(field)));
        }
    }
    let Some(middle) = vector(table.get("center")).map(|center| pose.transform_point(center)) else { return };
    if let Some(radius) = number("radius") {
        add("widen", middle + lens.right() * radius, Pull::Radius(key.field("radius"), middle));
    }
    if let Some(axis) = vector(table.get("axis")).and_then(Vec3::try_normalize) {
        let speed = number("speed");
        let length = ARROW * speed.map_or(1.0, |s| s.abs().max(0.01).sqrt());
        let sign = speed.map(|s| (key.field("speed"), if s < 0.0 { -1.0 } else { 1.0 }));
        let what = if sign.is_some() { "turn, pull for speed" } else { "turn" };
        add(what, middle + pose.rotation * axis * length, Pull::Axis(key.field("axis"), sign, middle));
    }
}

fn vector(value: Option<&toml::Value>) -> Option<Vec3> {
    let number =
        |x: &toml::Value| x.as_float().or_else(|| x.as_integer().map(|i| i as f64)).map(|x| x as f32);
    let list: Vec<f32> = value?.as_array()?.iter().map(number).collect::<Option<_>>()?;
    <[f32; 3]>::try_from(list).ok().map(Vec3::from)
}

fn rounded(x: f32, parts: f64) -> f64 {
    // Rounding may leave a number that is not exact in binary; the shortest representation is written.
    (f64::from(x) * parts).round() / parts
}

fn list(v: Vec3, parts: f64) -> Value {
    v.to_array().into_iter().map(|x| rounded(x, parts)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{document::Way, snapshot::Still};
    use hairspring_scene::Camera;
    use std::sync::Arc;

    const SCENE: &str = "[builtin]\nstrands = 10\nguides = 5\n\
        [wind]\nvelocity = [0.0, 0.0, 5.0]\n\
        [[collider]]\nshape.sphere = { center = [0.0, 1.3, 0.25], radius = 0.08 }\n\
        [[wind_source]]\nshape.fan = { center = [0.0, 1.55, 0.8], axis = [0.0, 0.0, -1.0], radius = 0.15, speed = 4.0 }\n\
        [[hand]]\ntool.comb = { a = [-0.1, 1.6, 0.15], b = [0.1, 1.6, 0.15], radius = 0.02 }\n\
        [[charged]]\ncenter = [0.3, 1.8, 0.0]\nradius = 0.13\ncharge = -2e-7\n";

    fn scene() -> (Document, StageSnapshot, Lens) {
        let document = Document::new("scene.toml".as_ref(), SCENE.into()).unwrap();
        let still = Still {
            grooms: Vec::new(),
            body: None,
            counts: [0; 4],
            instruction_set: String::new(),
            subject: None,
        };
        let camera = Camera {
            position: Vec3::new(0.0, 1.5, 2.0),
            target: Vec3::new(0.0, 1.5, 0.0),
            fov: 30.0,
            ..Camera::default()
        };
        (document, StageSnapshot::new(Arc::new(still)), Lens::new(&camera, 1.5))
    }

    #[test]
    fn a_handle_that_is_not_moved_changes_nothing() {
        let (mut document, stage, lens) = scene();
        let handles = all(&document, &stage, &lens, 2.0);
        // The wind; a sphere's center and rim; a comb's ends; a fan's center, rim and tip; a charged sphere's
        // center and rim.
        assert_eq!(handles.len(), 1 + 2 + 2 + 3 + 2);
        let before = document.effective().clone();
        for handle in handles {
            let values = match handle.pulled(handle.at) {
                Action::Set(key, value) => vec![(key, value)],
                Action::SetAll(values) => values,
                other => panic!("{other:?}"),
            };
            document.set_all(values).unwrap();
            let now = document.effective();
            assert!(
                alike(&before.clone().into(), &now.clone().into()),
                "{}: {}",
                handle.name,
                document.text()
            );
        }
    }

    /// Whether two values are equal up to a tenth of a millimeter, the precision to which a handle writes.
    fn alike(a: &toml::Value, b: &toml::Value) -> bool {
        use toml::Value::{Array, Float, Table};
        match (a, b) {
            (Float(a), Float(b)) => (a - b).abs() < 2e-4 * (1.0 + a.abs()),
            (Array(a), Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b)),
            (Table(a), Table(b)) => {
                a.len() == b.len() && a.iter().all(|(k, a)| b.get(k).is_some_and(|b| alike(a, b)))
            }
            _ => a == b,
        }
    }

    #[test]
    fn a_handle_moves_a_shape_on_a_joint_in_the_space_of_the_joint() {
        let (mut document, mut stage, lens) = scene();
        let turn = glam::Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
        stage.carried.colliders =
            vec![RigidTransform { rotation: turn, translation: Vec3::new(0.0, 0.5, 0.0) }];
        let handles = all(&document, &stage, &lens, 2.0);
        let ball = &handles[1];
        assert!(ball.at.distance(Vec3::new(0.25, 1.8, 0.0)) < 1e-6, "{}", ball.at);
        // 5 cm along the world's x are 5 cm along its own z.
        let Action::Set(key, value) = ball.pulled(ball.at + Vec3::X * 0.05) else { panic!() };
        document.set(&key, value).unwrap();
        assert!(document.text().contains("center = [0.0, 1.3, 0.3]"), "{}", document.text());
    }

    #[test]
    fn an_arrow_sets_axis_and_speed_in_one_undo_step() {
        let (mut document, stage, lens) = scene();
        let handles = all(&document, &stage, &lens, 2.0);
        let tip = handles.iter().find(|h| h.name.contains("turn")).unwrap();
        let middle = tip.arrow().unwrap();
        let Action::SetAll(values) = tip.pulled(middle + Vec3::X * ARROW * 3.0) else { panic!() };
        document.set_all(values).unwrap();
        assert!(
            document.text().contains("axis = [1.0, 0.0, 0.0]") && document.text().contains("speed = 9.0")
        );
        document.step(Way::Back).unwrap();
        assert_eq!(document.text(), SCENE);
        let wind = &handles[0];
        let Action::Set(key, value) = wind.pulled(wind.arrow().unwrap()) else { panic!() };
        document.set(&key, value).unwrap();
        assert!(document.text().contains("velocity = [0.0, 0.0, 0.0]"));
    }
}
