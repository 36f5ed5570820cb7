//! `[clip]`: the motion of the body.

use super::{
    Reader,
    body::rigid,
    file::{ClipFile, KeyFile, SceneFile, TravelName},
    namesakes::namesakes,
    sentence::unknown,
};
use crate::{
    Character, Format, ReadOptions, Result,
    clip_choice::{OF_VERTICES, first_note, pick_clip, unplayed_note},
    load::read_motion_at,
};
use hairspring::body::{
    Body, Clip, HeadMotion, KEYED_RATE, Key, Travel, head_motion, keyframe_clip, retarget,
};
use hairspring_scene::VertexCache;

impl Reader<'_> {
    /// Returns the body as it is simulated, and its motion: that of its joints, or that of its vertices.
    #[allow(clippy::type_complexity)]
    pub(super) fn motion(
        &mut self,
        file: &SceneFile,
        character: Option<Character>,
    ) -> Result<(Option<Body>, Option<Clip>, Option<VertexCache>)> {
        let Some(named) = &file.clip else {
            // A body file's motions are used only if a [clip] selects one. The built-in body uses its own
            // motion.
            return Ok(match character {
                Some(c) if file.builtin.is_some() => (Some(c.body), c.clips.into_iter().next(), None),
                Some(c) => {
                    if let Some(body) = file.body.as_ref().filter(|_| c.vertex_cache.is_none()) {
                        let note = c.unplayed_note("; add [clip] to play one");
                        self.note(&self.resolve(&body.file), note.into_iter().collect());
                    }
                    (Some(c.body), None, c.vertex_cache)
                }
                None => (None, None, None),
            });
        };
        // A motion that the scene names replaces that of the vertices.
        let near =
            named.file.as_ref().map_or_else(|| self.text.find("[clip]").unwrap_or(0), |f| f.span().start);
        let Some(character) = character else {
            return Err(self.wrong(near, "file", "[clip] moves a body, but there is no [body]".into()));
        };
        if let (Some(body), Some(_)) = (&file.body, &character.vertex_cache) {
            let note = unplayed_note(&[OF_VERTICES], "; [clip] replaces it");
            self.note(&self.resolve(&body.file), note.into_iter().collect());
        }
        if !named.keys.is_empty() {
            let pivot = named.pivot.unwrap_or_default();
            let keys: Vec<Key> = named.keys.iter().map(KeyFile::key).collect();
            let clip = keyframe_clip(&keys, pivot, KEYED_RATE, file.solver.teleport_distance);
            return Ok((Some(rigid(character.body)), Some(clip), None));
        }
        let Some(file) = &named.file else {
            if let Some(body) = &file.body {
                let note = first_note(&character.clips, named.name.as_deref());
                self.note(&self.resolve(&body.file), note.into_iter().collect());
            }
            return self.own_motion(character, named, near);
        };
        let path = self.resolve(file);
        let options = ReadOptions { scale: named.scale, up: named.up };
        if named.rate.is_some() && Format::of(&path) != Some(Format::Bvh) {
            let text = "`rate` is only for a .bvh file; other formats give the time of each key";
            return Err(self.wrong(near, "rate", text.into()));
        }
        let read = read_motion_at(&path, named.name.as_deref(), &options, named.rate);
        let loaded = self.named(read, file, "motion")?;
        self.note(&path, loaded.notes);
        let (joints, clip) = (loaded.value.joints, loaded.value.clip);
        let Some(joint) = &named.joint else {
            let carried = retarget(&joints, &clip, &character.body).ok_or_else(|| {
                let text = "no joint of the motion has the name of a joint of the body; set `joint` to drive it as one piece";
                self.wrong(near, "file", text.into())
            })?;
            let (matched, all) = (carried.matched, character.body.joints.len());
            let mut notes = vec![format!("moves {matched} of the body's {all} joints, by their names")];
            if !carried.on_floor {
                notes.push(format!(
                    "motion and body have no joint near the floor in common, so the body starts at its own place and moves {:.2} times as far as the motion; to drive it as one piece, set `joint`",
                    carried.scale
                ));
            }
            if let Some(height) = carried.first_frame_height {
                let side = if height > 0.0 { "higher" } else { "lower" };
                notes.push(format!(
                    "its first frame is {:.2} m {side} than most others, so the body is placed by the height of those; set `start` to leave it out",
                    height.abs()
                ));
            }
            self.note(&path, notes);
            return Ok((Some(character.body), Some(self.cut(carried.clip, named, near)?), None));
        };
        let Some(pivot) = named.pivot else {
            let text = "`joint` needs `pivot`: the point of the body that it turns about [m], such as the top of the neck";
            return Err(self.wrong(near, "joint", text.into()));
        };
        let options = HeadMotion {
            pivot,
            rest_frame: named.rest_frame.unwrap_or(named.start),
            travel: named.travel.map(Into::into).unwrap_or_default(),
            facing: named.facing.unwrap_or(0.0).to_radians(),
            ..HeadMotion::default()
        };
        if options.rest_frame >= clip.frame_count() {
            let text = format!("the motion has {} frames", clip.frame_count());
            return Err(self.wrong(near, "rest_frame", text));
        }
        let driven = head_motion(&joints, &clip, joint, &options).ok_or_else(|| {
            let text = format!("the joint {}", unknown(joint, joints.iter().map(|j| j.name.as_str())));
            self.wrong(near, "joint", text)
        })?;
        self.notes.extend(namesakes(&joints, joint, "motion"));
        Ok((Some(rigid(character.body)), Some(self.cut(driven, named, near)?), None))
    }

    /// Returns a body that a motion of its own file moves. A motion of morph targets becomes one of the vertices, which
    /// takes the place of the joints.
    #[allow(clippy::type_complexity)]
    fn own_motion(
        &mut self,
        mut character: Character,
        named: &ClipFile,
        near: usize,
    ) -> Result<(Option<Body>, Option<Clip>, Option<VertexCache>)> {
        if character.clips.is_empty() {
            let motion =
                named.name.as_ref().map_or(String::new(), |name| format!("the motion {name:?} but "));
            let text = format!(
                "[clip] names {motion}no `file`, and the body's own file holds no motion; name the file of a motion, or \
                 remove [clip]"
            );
            return Err(self.wrong(near, "name", text));
        }
        let wrong = |text: String| self.wrong(near, "name", format!("in the body's file {text}"));
        let clip = pick_clip(&character.clips, named.name.as_deref()).map_err(wrong)?;
        let cache = character.morphed(clip).map_err(wrong)?;
        let clip = self.cut(character.clips.swap_remove(clip), named, near)?;
        let Some(mut cache) = cache else { return Ok((Some(character.body), Some(clip), None)) };
        let unused = cache.frames.len() - clip.frame_count();
        cache.frames.drain(..unused);
        self.notes.push(format!(
            "the motion {:?} moves morph targets, so {} frames at {} Hz move the body's vertices, and the body has no joints",
            clip.name,
            cache.frames.len(),
            cache.rate
        ));
        Ok((Some(rigid(character.body)), None, Some(cache)))
    }

    /// Returns the clip from the first used frame on.
    fn cut(&self, clip: Clip, named: &ClipFile, near: usize) -> Result<Clip> {
        if named.start >= clip.frame_count() {
            let text = format!(
                "the motion has {} frames, so none is left from frame {} on",
                clip.frame_count(),
                named.start
            );
            return Err(self.wrong(near, "start", text));
        }
        Ok(clip.from_frame(named.start))
    }
}

impl From<TravelName> for Travel {
    fn from(name: TravelName) -> Self {
        match name {
            TravelName::Keep => Travel::Keep,
            TravelName::InPlace => Travel::InPlace,
            TravelName::None => Travel::None,
        }
    }
}
