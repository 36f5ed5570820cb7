//! The cache of frames: states of the stages that the timeline can return to, in bounded memory.

use hairspring::{math::RigidTransform, simulation::ManipulatorId};
use hairspring_scene::stage::{Stage, StageState};
use std::collections::BTreeMap;

/// Largest size of all kept states [bytes].
const LIMIT: usize = 512 << 20;

/// The stages at one frame.
pub(super) struct KeptFrame {
    pub(super) stages: Vec<StageState>,
    /// The tool that the pointer held in each stage. It is no longer held when the frame is returned to.
    pub(super) tool: Option<Vec<ManipulatorId>>,
    /// Displacement of the body by the pointer.
    pub(super) body: RigidTransform,
}

/// Kept frames by their numbers, from 0 at time 0.
pub(super) struct Frames {
    kept: BTreeMap<u64, KeptFrame>,
    bytes: usize,
    /// Only multiples of this number are kept. It doubles when memory is full.
    stride: u64,
    limit: usize,
}

impl Default for Frames {
    fn default() -> Self {
        Self { kept: BTreeMap::new(), bytes: 0, stride: 1, limit: LIMIT }
    }
}

/// What the cache holds, for the timeline.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CachedFrames {
    /// Numbers of the frames, ascending, from 0 at time 0.
    pub frames: Vec<u64>,
    /// Size of the cache, and its limit [bytes].
    pub bytes: [usize; 2],
}

impl Frames {
    /// Keeps a frame, unless it is kept already or left out to save memory.
    pub(super) fn keep<'a>(
        &mut self,
        frame: u64,
        stages: impl Iterator<Item = &'a Stage>,
        (tool, body): (Option<&[ManipulatorId]>, RigidTransform),
    ) {
        if !frame.is_multiple_of(self.stride) || self.kept.contains_key(&frame) {
            return;
        }
        let stages = stages.map(Stage::state).collect();
        let kept = KeptFrame { stages, tool: tool.map(<[_]>::to_vec), body };
        self.bytes += bytes(&kept);
        self.kept.insert(frame, kept);
        while self.bytes > self.limit && self.kept.len() > 1 {
            self.stride *= 2;
            let stride = self.stride;
            self.retain(|frame| frame.is_multiple_of(stride));
        }
    }

    fn retain(&mut self, wanted: impl Fn(u64) -> bool) {
        let size = &mut self.bytes;
        self.kept.retain(|frame, kept| {
            let stays = wanted(*frame);
            *size -= if stays { 0 } else { bytes(kept) };
            stays
        });
    }

    /// The kept frame that is nearest to this number.
    pub(super) fn nearest(&self, frame: u64) -> Option<u64> {
        let before = self.kept.range(..=frame).next_back();
        let after = self.kept.range(frame..).next();
        before.into_iter().chain(after).map(|(kept, _)| *kept).min_by_key(|kept| kept.abs_diff(frame))
    }

    /// A kept frame.
    pub(super) fn get(&self, frame: u64) -> Option<&KeptFrame> {
        self.kept.get(&frame)
    }

    /// Forgets the frames after this one.
    pub(super) fn forget_after(&mut self, frame: u64) {
        if self.kept.last_key_value().is_some_and(|(last, _)| *last > frame) {
            self.retain(|kept| kept <= frame);
        }
    }

    /// Forgets all frames.
    pub(super) fn clear(&mut self) {
        *self = Self { limit: self.limit, ..Self::default() };
    }

    /// Writes what the cache holds, reusing the memory.
    pub(super) fn list(&self, list: &mut CachedFrames) {
        list.frames.clear();
        list.frames.extend(self.kept.keys());
        list.bytes = [self.bytes, self.limit];
    }
}

fn bytes(kept: &KeptFrame) -> usize {
    kept.stages.iter().map(StageState::bytes).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring_scene::builtin::{BuiltinOptions, scene};

    #[test]
    fn memory_is_bounded_by_keeping_every_second_frame_then_every_fourth() {
        let options = BuiltinOptions { strands: 20, ..BuiltinOptions::default() };
        let stage = Stage::new(scene(&options)).unwrap();
        let one = stage.state().bytes();
        let mut frames = Frames { limit: 10 * one, ..Frames::default() };
        let mut list = CachedFrames::default();
        for frame in 0..60 {
            frames.keep(frame, std::iter::once(&stage), (None, RigidTransform::default()));
            frames.list(&mut list);
            assert!(list.bytes[0] <= list.bytes[1] && list.bytes[0] == one * list.frames.len());
        }
        assert_eq!(list.frames, [0, 8, 16, 24, 32, 40, 48, 56]);
        assert_eq!(
            (frames.nearest(11), frames.nearest(13), frames.nearest(900)),
            (Some(8), Some(16), Some(56))
        );
        frames.forget_after(16);
        frames.list(&mut list);
        assert_eq!((&list.frames[..], list.bytes[0]), (&[0, 8, 16][..], 3 * one));
        frames.clear();
        assert_eq!(frames.nearest(0), None);
    }
}
