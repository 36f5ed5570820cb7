//! The geometry of hair, body and motion: everything that `Stage::update_settings` does not change.

use super::{
    Reader, body, builtin,
    file::{BodyFile, ClipFile, PropFile, SceneFile},
    groom_file::GroomGeometry,
    map_file::MapsFile,
    material,
    props::{beside_props, with_props},
    sentence::unknown,
};
use crate::{Character, Problem, Result};
use hairspring::material::Material;
use hairspring_scene::{InitialContact, Scene, SceneSheet, builtin::BuiltinOptions};

/// The geometry that a scene file describes.
#[derive(PartialEq)]
pub(super) struct Asked<'a> {
    /// The built-in scene, whether it uses its own motion, and its maps.
    builtin: Option<(BuiltinOptions, bool, &'a MapsFile)>,
    body: &'a Option<BodyFile>,
    collision: &'a Option<BodyFile>,
    sheets: &'a [BodyFile],
    clip: &'a Option<ClipFile>,
    props: &'a [PropFile],
    collide_body: bool,
    settle: f32,
    /// The colliders that push hair out before the scene begins.
    pushing: Vec<usize>,
    grooms: Vec<GroomGeometry<'a>>,
    /// Radii that the materials of each groom set [m], and their profiles.
    radii: Vec<Vec<Radius>>,
}

/// The radius that a material sets [m], and its profile.
type Radius = (Option<f32>, Vec<f32>);

/// Returns the geometry that `file`, parsed from `text`, describes.
pub(super) fn asked<'a>(text: &str, file: &'a SceneFile) -> std::result::Result<Asked<'a>, Problem> {
    let mut radii = Vec::new();
    let mut made = None;
    if let Some(named) = &file.builtin {
        let settings = builtin::settings(text, file, named)?;
        radii.extend(settings.grooms.iter().map(|groom| radii_of(&groom.materials)));
        made = Some((builtin::options(text, named)?, named.motion != Some(false), &named.maps));
    }
    for groom in &file.groom {
        radii.push(radii_of(&material::of_groom(text, file, groom)?));
    }
    Ok(Asked {
        builtin: made,
        body: &file.body,
        collision: &file.collision,
        sheets: &file.sheet,
        clip: &file.clip,
        props: &file.prop,
        collide_body: file.solver.collide_body,
        settle: file.solver.preroll,
        pushing: (0..file.collider.len())
            .filter(|k| file.collider[*k].initial == InitialContact::Push)
            .collect(),
        grooms: file.groom.iter().map(|groom| groom.geometry()).collect(),
        radii,
    })
}

/// The radii that these materials set. A group past the end uses the last.
fn radii_of(materials: &[Material]) -> Vec<Radius> {
    let mut radii: Vec<_> = materials.iter().map(|m| (m.radius, m.radius_profile.clone())).collect();
    while radii.len() > 1 && radii[radii.len() - 2] == radii[radii.len() - 1] {
        radii.pop();
    }
    if radii == [(None, Material::default().radius_profile)] { Vec::new() } else { radii }
}

impl Reader<'_> {
    /// Adds strands, body, motion and collision meshes to a scene that has its settings.
    pub(super) fn geometry(&mut self, file: &SceneFile, scene: &mut Scene) -> Result<()> {
        let mut made = match &file.builtin {
            Some(named) => self.builtin(named)?,
            None => Scene::default(),
        };
        let character = match (&file.body, made.body.take()) {
            (Some(named), _) => {
                // Its unit may be known already, for hulls.
                self.whole = None;
                Some(self.body(named, "body")?)
            }
            (None, body) => body.map(|body| Character {
                body,
                clips: made.clip.take().into_iter().collect(),
                ..Character::default()
            }),
        };
        let collision = file.collision.as_ref().map(|b| self.body(b, "collision mesh")).transpose()?;
        let grown = made.grooms.len();
        for (groom, made) in scene.grooms.iter_mut().zip(made.grooms) {
            groom.groom = made.groom;
        }
        let props = self.props(&file.prop, character.as_ref().map(|c| &c.body))?;
        // Hair grows on the body's own joints and on props. A rigid motion later replaces the joints by a
        // single one.
        let whole = character.as_ref().map(|c| with_props(c.body.clone(), &props));
        self.note_namesakes(file, scene, whole.as_ref().map_or(&[], |body| &body.joints));
        for (groom, named) in scene.grooms[grown..].iter_mut().zip(&file.groom) {
            groom.groom = self.groom(named, &groom.materials, whole.as_ref())?;
        }
        if let (Some(named), Some(collision)) = (&file.collision, &collision) {
            let body = character.as_ref().map(|character| &character.body.mesh);
            self.note_collision(named, &collision.body.mesh, body, &scene.grooms);
        }
        let (body, clip, cache) = self.motion(file, character)?;
        // The built-in collision mesh has the joints of the built-in body, unless the body is now one piece.
        let one_piece = body.as_ref().is_some_and(|b| b.joints.len() == 1);
        let made = made.collision.map(|c| if one_piece { body::rigid(c) } else { c });
        let collision = collision.map(|c| c.body).or(made);
        scene.collision = match (collision, &body, &file.collision) {
            (Some(collision), Some(body), Some(named)) => Some(self.carried(collision, body, named)?),
            (collision, ..) => collision,
        };
        self.prop_joints(body.as_ref(), &props)?;
        let whole = body.clone().map(|body| with_props(body, &props));
        let clip = match (&body, &whole) {
            (Some(body), Some(whole)) => {
                beside_props(clip, (body, whole), &props, file.solver.teleport_distance)
            }
            _ => clip,
        };
        let body = whole;
        for sheet in &file.sheet {
            let open = self.body(sheet, "sheet")?.body;
            let body = body.as_ref().map_or(Ok(open.clone()), |body| self.carried(open, body, sheet))?;
            let thickness = sheet.thickness.unwrap_or(SceneSheet::THICKNESS);
            let initial = sheet.initial.unwrap_or_default();
            scene.sheets.push(SceneSheet { body, thickness, initial });
        }
        (scene.body, scene.clip, scene.vertex_cache) = (body, clip, cache);
        self.joints(scene)
    }

    /// Checks that the joints which objects follow exist.
    fn joints(&self, scene: &Scene) -> Result<()> {
        let joints = scene.body.as_ref().map_or(&[][..], |b| &b.joints);
        let known = |name: &str| joints.iter().any(|j| j.name.eq_ignore_ascii_case(name));
        let colliders = scene.colliders.iter().map(|c| ("[[collider]]", &c.joint));
        let sources = scene.wind_sources.iter().map(|s| ("[[wind_source]]", &s.joint));
        let charged = scene.charged.iter().map(|c| ("[[charged]]", &c.joint));
        let hands = scene.hands.iter().map(|h| ("[[hand]]", &h.joint));
        for (section, joint) in colliders.chain(sources).chain(charged).chain(hands) {
            let Some(name) = joint.as_ref().filter(|name| !known(name)) else {
                continue;
            };
            let text = format!("the joint {}", unknown(name, joints.iter().map(|j| j.name.as_str())));
            return Err(self.wrong(self.text.find(section).unwrap_or(0), "joint", text));
        }
        Ok(())
    }
}
