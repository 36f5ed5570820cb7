//! Publishes snapshots for the window, and reuses their memory.

use super::{CachedFrames, lock, work::Work};
use crate::{
    drag_limiter::Pushing,
    snapshot::{Snapshot, StageSnapshot, Still},
};
use hairspring_scene::stage::Stage;
use std::{
    sync::{Arc, atomic::Ordering::Relaxed},
    time::{Duration, Instant},
};

/// Steps between measurements of all strands while playing. Figures that change faster cannot be read.
const MEASURED: u64 = 15;

impl Work {
    /// Updates the follow hairs of all stages.
    pub(super) fn show(&mut self) {
        if std::mem::take(&mut self.unshown) {
            for ((stage, _), report) in self.stages.iter_mut().zip(&mut self.reports) {
                report.follow = stage.update_render_points();
            }
        }
    }

    /// Publishes the current state of the stages.
    pub(super) fn publish(&mut self) {
        if self.stages.is_empty() {
            return;
        }
        self.show();
        let measured = self.measured.0 == self.scene && self.measures.len() == self.stages.len();
        if !(self.playing && measured && self.step < self.measured.1 + MEASURED) {
            self.measured = (self.scene, self.step);
            self.measures.clear();
            self.measures.extend(self.stages.iter().map(|(stage, _)| (stage.measure(), stage.energy())));
        }
        let mut next = self.spare();
        // `spare` returned a snapshot without other owners.
        let (Some(snapshot), Some((first, _))) = (Arc::get_mut(&mut next), self.stages.first()) else {
            return;
        };
        let fresh = |(_, still): &(Stage, Arc<Still>)| StageSnapshot::new(still.clone());
        if snapshot.scene != self.scene || snapshot.stages.len() != self.stages.len() {
            snapshot.stages = self.stages.iter().map(fresh).collect();
        }
        let figures = self.measures.iter().zip(&self.reports);
        for ((stage_snapshot, (stage, still)), (measure, report)) in
            snapshot.stages.iter_mut().zip(&self.stages).zip(figures)
        {
            stage_snapshot.fill(stage, still, self.show);
            (stage_snapshot.measure, stage_snapshot.energy) = *measure;
            stage_snapshot.report = *report;
            stage_snapshot.pushed = self.pushing.as_ref().map(Pushing::shown);
        }
        let picked = self.picked;
        snapshot.picked = picked.map(|p| (p, first.strand_figures(p.groom, p.strand)));
        (snapshot.step, snapshot.scene, snapshot.time) = (self.step, self.scene, first.time());
        snapshot.frame = self.frame();
        self.frames.list(&mut snapshot.cached);
        self.published += 1;
        snapshot.number = self.published;
        (snapshot.took, snapshot.reset_strands) = (self.took, self.reset_strands);
        self.shown = Instant::now();
        self.shared.seen.store(false, Relaxed);
        if let Some(old) = lock(&self.shared.latest).replace(next) {
            self.pool.push(old);
        }
        (self.wake)();
    }

    /// Returns a snapshot that nobody else uses.
    fn spare(&mut self) -> Arc<Snapshot> {
        // The window holds one or two snapshots. The limit prevents a leak.
        self.pool.truncate(8);
        let free = self.pool.iter_mut().position(|s| Arc::get_mut(s).is_some());
        free.map(|k| self.pool.swap_remove(k)).unwrap_or_else(|| {
            Arc::new(Snapshot {
                number: 0,
                step: 0,
                scene: 0,
                time: 0.0,
                frame: 0,
                cached: CachedFrames::default(),
                stages: Vec::new(),
                took: Duration::ZERO,
                reset_strands: 0,
                picked: None,
            })
        })
    }
}
