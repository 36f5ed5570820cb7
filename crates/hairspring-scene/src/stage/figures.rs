//! Numbers about a running scene: its size, and measurements of its hair.

use super::Stage;
use hairspring::simulation::{Contacts, Energy, Measure, NeighboursReport, Start, VolumeReport};

impl Stage {
    /// Returns the number of simulated strands and the total number.
    pub fn simulated_strands(&self) -> (usize, usize) {
        let all = self.hair.iter().map(|h| h.groom().strand_count()).sum();
        (self.simulation.strand_count(), all)
    }

    /// Returns the number of simulated points and the total number.
    pub fn simulated_points(&self) -> (usize, usize) {
        let all = self.hair.iter().map(|h| h.groom().point_count()).sum();
        (self.simulation.point_count(), all)
    }

    /// Returns the number of joints that the sag-free start made stiffer than the fiber, and of those that
    /// are softer than needed.
    pub fn start(&self) -> Start {
        self.simulation.start()
    }

    /// Returns a report of the hair's volume; `None` if strands pass through each other.
    pub fn volume(&self) -> Option<VolumeReport> {
        self.simulation.volume()
    }

    /// Returns a report of the contacts between strands; `None` if they are off.
    pub fn neighbours(&self) -> Option<NeighboursReport> {
        self.simulation.neighbours()
    }

    /// Returns the name of the instruction set used by the simulation.
    pub fn instruction_set(&self) -> String {
        self.simulation.instruction_set()
    }

    /// Returns the energy of all simulated strands at the end of the last step.
    pub fn energy(&self) -> Energy {
        self.simulation.energy()
    }

    /// Returns the current contacts with colliders, and the number of points for which one was evaluated.
    pub fn contacts(&self) -> Contacts {
        self.simulation.contacts(self.body.colliders())
    }

    /// Returns measurements over all simulated strands at the end of the last step.
    pub fn measure(&self) -> Measure {
        self.simulation.measure(self.body.colliders())
    }
}
