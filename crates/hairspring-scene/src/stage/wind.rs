//! The scene's wind sources at their current poses.

use super::body::StagedBody;
use crate::Scene;
use hairspring::air::Source;

/// Wind sources in motion.
pub(super) struct StagedWind {
    /// The joint that carries each; `None`: fixed.
    joints: Vec<Option<usize>>,
    sources: Vec<Source>,
}

impl StagedWind {
    /// Creates the sources, each carried by one of `joints`.
    pub(super) fn new(joints: Vec<Option<usize>>) -> Self {
        Self { joints, sources: Vec::new() }
    }

    /// Updates the sources for the current body pose, with gusts at `time` [s].
    pub(super) fn advance(&mut self, scene: &Scene, time: f64, body: &StagedBody) {
        self.sources.clear();
        let all = scene.wind_sources.iter().zip(&self.joints).enumerate();
        self.sources
            .extend(all.map(|(k, (source, joint))| source.at_time(k, body.pose().carried(*joint), time)));
    }

    /// Returns the sources in the last frame that was begun.
    pub(super) fn sources(&self) -> &[Source] {
        &self.sources
    }
}
