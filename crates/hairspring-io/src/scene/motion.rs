//! `[clip]`: the motion of the body.

use super::{
    Reader,
    body::rigid,
    file::{ClipFile, KeyFile, TravelName},
    sentence::unknown,
};
use crate::{
    Character, Format, ReadOptions, Result,
    load::{pick_clip, read_motion_at},
};
use hairspring::body::{Body, Clip, HeadMotion, Key, Travel, head_motion, keyframe_clip, retarget};

impl Reader<'_> {
    /// Returns the body as it is simulated, and its motion.
    pub(super) fn motion(
        &mut self,
        named: Option<&ClipFile>,
        character: Option<Character>,
        builtin: bool,
    ) -> Result<(Option<Body>, Option<Clip>)> {
        let Some(named) = named else {
            // A body file's motions are used only if a [clip] selects one. The built-in body uses its own
            // motion.
            return Ok(match character {
                Some(c) if builtin => (Some(c.body), c.clips.into_iter().next()),
                other => (other.map(|c| c.body), None),
            });
        };
        let near =
            named.file.as_ref().map_or_else(|| self.text.find("[clip]").unwrap_or(0), |f| f.span().start);
        let Some(character) = character else {
            return Err(self.wrong(near, "file", "[clip] moves a body, but there is no [body]".into()));
        };
        if !named.keys.is_empty() {
            let pivot = named.pivot.unwrap_or_default();
            let keys: Vec<Key> = named.keys.iter().map(KeyFile::key).collect();
            return Ok((Some(rigid(character.body)), Some(keyframe_clip(&keys, pivot))));
        }
        let Some(file) = &named.file else {
            let clip = pick_clip(&character.clips, named.name.as_deref());
            let clip =
                clip.map_err(|text| self.wrong(near, "name", format!("in the body's file {text}")))?.clone();
            return Ok((Some(character.body), Some(self.cut(clip, named, near)?)));
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
            self.note(&path, notes);
            return Ok((Some(character.body), Some(self.cut(carried.clip, named, near)?)));
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
        Ok((Some(rigid(character.body)), Some(self.cut(driven, named, near)?)))
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
