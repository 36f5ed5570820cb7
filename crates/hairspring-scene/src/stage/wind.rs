//! The scene's sources of wind, where they are now.

use super::body::StagedBody;
use crate::Scene;
use hairspring::air::Source;

/// Sources of wind in motion.
pub(super) struct StagedWind {
    /// The joint that carries each; `None`: fixed.
    joints: Vec<Option<usize>>,
    sources: Vec<Source>,
}

impl StagedWind {
    /// Each carried by one of `joints`.
    pub(super) fn new(joints: Vec<Option<usize>>) -> Self {
        Self { joints, sources: Vec::new() }
    }

    /// Puts them where the body is, blowing as at `time` [s].
    pub(super) fn advance(&mut self, scene: &Scene, time: f64, body: &StagedBody) {
        self.sources.clear();
        let all = scene.wind_sources.iter().zip(&self.joints).enumerate();
        self.sources.extend(all.map(|(k, (source, joint))| source.at(k, body.carried(*joint), time)));
    }

    /// As they blow in the last frame that was begun.
    pub(super) fn sources(&self) -> &[Source] {
        &self.sources
    }
}
