//! Hair on hair, strand by strand: segments that come nearer than they are thick press, rub and hold together, until they are pulled apart. For guides
//! and small scenes, and what the hair volume is measured against.
//!
//! ```text
//! start ──► free run ──► near pairs ──► what they ask of each other ──► start again, with brakes ──► forces found
//!             │ nothing touches                                                 ▲
//!             └─────────────────────────► done                                  └ carried forces act in both runs
//! ```
//!
//! A frame is first run as if strands met nothing new. That says where each would go, with all that acts on it: so a pair is braked only against
//! what it does to each other, and what both do alike is left alone. (A brake to where the other was a frame ago would hold back what falls
//! together, by as much as it stops what falls apart.) Where two would come too near, the frame is run again from its start with brakes on the
//! diagonal of each strand's system, as stiff as is needed: strands stay independent, and it is implicit, hence stable. McAdams 2009 and Bridson et al.
//! 2002, *Robust Treatment of Collisions*, step freely first and then correct, too.
//!
//! The force between two segments is state, and acts on both sides alike. What a brake adds in the frame it strikes is alike on both as far as the
//! masses that move are known: [`NeighboursReport::unbalanced`] says how far it is not. Each side's brake is worth at most nine times what the other
//! gave, and what is carried on is the lesser; at rest there is no brake, and no error.
//!
//! # Thickness
//! A segment is as thick as the authored groom lets it be: half way to the next strand, and no more than the setting. So a groom that
//! keeps still touches nothing.
//!
//! # Cost
//! Nothing but the search where nothing touches; else a second run of the simulations that are touched. The search is on all threads, the contacts
//! are gone through on one.
//!
//! # Missing
//! The built-in head's first frame is not the file to the bit.
//! A strand does not meet itself. Contact that slides on to the next segment begins there with no force. Strands faster than the longest segment and
//! four thicknesses a frame, relative to the mean, may pass each other; so may those that a force of fifteen times their weight draws together.
//! A segment is held to its sixteen nearest at most. What is pressed from many sides is held the less firmly the more there are.
//! Tips that are drawn together by half of their strands' weight or more pass each other. Cost grows with the square of the segments in a cell, and cells grow with
//! the thickness and with speed. Followers are moved by their guides alone.

mod closest;
mod contact;
mod hair;
mod near;
mod pairs;

use crate::{
    scene,
    simulation::{Drive, Met, Simulation, StepReport},
};
use contact::{Contact, Sum};
use glam::Vec3;
use hair::{Free, Hair};
use near::Near;
use pairs::Pairs;

/// Most contacts, over segments: memory for them is taken once.
const CONTACTS: usize = 4;

/// One simulation in a step that several take together.
pub struct Member<'a> {
    /// The strands.
    pub simulation: &'a mut Simulation,
    /// Their frame; all members' are equally long.
    pub drive: Drive<'a>,
    /// What the step did.
    pub report: StepReport,
}

/// What is known of strands that meet each other, after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NeighboursReport {
    /// Largest distance at which strands touch, axis to axis [m].
    pub thickness: f32,
    /// Pairs of segments that were near enough to meet.
    pub near: usize,
    /// Pairs that touched.
    pub contacts: usize,
    /// Pairs that hold together.
    pub bonds: usize,
    /// Bonds that broke in the step.
    pub broken: usize,
    /// Simulations that were run a second time.
    pub again: usize,
    /// Momentum that one side of the contacts was given and the other was not [N s].
    pub unbalanced: f32,
    /// Momentum that went between the sides, the sum of amounts [N s].
    pub exchanged: f32,
}

/// Strands of one or more simulations that meet each other one by one.
pub struct Neighbours {
    settings: scene::Neighbours,
    hair: Hair,
    near: Near,
    pairs: Pairs,
    contacts: Vec<Contact>,
    /// The last frame's, and memory.
    before: Vec<Contact>,
    report: NeighboursReport,
}

impl Neighbours {
    /// Lets the strands of `simulations` meet each other; as they are now counts as their rest. `None` where that is off.
    pub fn new(settings: &scene::Neighbours, simulations: &[&Simulation]) -> Option<Self> {
        if !settings.on {
            return None;
        }
        let hair = Hair::new(simulations, settings.thickness);
        let points = hair.len();
        let mut near = Near::default();
        near.reserve(points);
        let thickness = 2.0 * hair.radius.iter().copied().fold(0.0, f32::max);
        Some(Self {
            settings: *settings,
            pairs: Pairs::new(points),
            before: Vec::with_capacity(CONTACTS * points),
            contacts: Vec::with_capacity(CONTACTS * points),
            hair,
            near,
            report: NeighboursReport { thickness, ..NeighboursReport::default() },
        })
    }

    /// Lets go of all that touches and holds.
    pub fn reset(&mut self) {
        self.contacts.clear();
    }

    /// What is known after the last step.
    pub fn report(&self) -> NeighboursReport {
        self.report
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.hair.bytes()
            + self.pairs.bytes()
            + (self.contacts.capacity() + self.before.capacity()) * size_of::<Contact>()
    }

    /// Steps all members by their frame, as [`Simulation::step`] does one that meets no other.
    ///
    /// # Panics
    /// If the members are not the simulations that it was made for, in their order, or as [`Simulation::step`].
    pub fn step(&mut self, members: &mut [Member]) {
        assert_eq!(members.len(), self.hair.members.len(), "the simulations that neighbours were made for");
        let Some(dt) = members.first().map(|m| m.drive.dt) else { return };
        let origin = members[0].simulation.anchor().translation;
        self.hair.begin(members.iter().map(|m| &*m.simulation));
        self.hair.met.fill(Met::default());
        self.contacts.iter().for_each(|contact| contact.carry(&mut self.hair));
        for (k, member) in members.iter_mut().enumerate() {
            member.simulation.begin(&member.drive, true);
            if !self.contacts.is_empty() {
                self.meet(k, member);
            }
            member.simulation.remember();
            self.hair.members[k].broken = member.simulation.run();
        }
        self.see(members, origin, true);
        self.report.near = self.pairs.find(&self.hair, &mut self.near, self.settings.stiction > 0.0);
        self.touch(dt);
        self.report.again = 0;
        for (k, member) in members.iter_mut().enumerate() {
            let points = &self.hair.members[k];
            let met = &self.hair.met[points.first..points.first + points.points];
            if met.iter().any(|met| met.damp.iter().any(|rate| *rate != 0.0)) {
                member.simulation.rewind();
                self.meet(k, member);
                self.hair.members[k].broken = member.simulation.run();
                self.report.again += 1;
            }
        }
        self.see(members, origin, false);
        let mut sum = Sum::default();
        for contact in &mut self.contacts {
            contact.find(&self.hair, &self.settings, dt, &mut sum);
        }
        self.report.contacts = self.contacts.len();
        (self.report.bonds, self.report.broken) = (sum.bonds, sum.broken);
        (self.report.unbalanced, self.report.exchanged) = (sum.unbalanced.length() * dt, sum.forces * dt);
        for (k, member) in members.iter_mut().enumerate() {
            member.report = member.simulation.finish(&member.drive, self.hair.members[k].broken);
        }
    }

    /// What acts on the points of member `k`, put into its simulation.
    fn meet(&self, k: usize, member: &mut Member) {
        let points = &self.hair.members[k];
        let met = &self.hair.met[points.first..points.first + points.points];
        member.simulation.meet((member.drive.anchor, member.drive.dt), &points.firsts, met);
    }

    /// Takes in how points have moved in the frame, `free` of each other or not.
    fn see(&mut self, members: &[Member], origin: Vec3, free: bool) {
        let Hair { members: known, start, free: first, way, .. } = &mut self.hair;
        for (member, points) in members.iter().zip(known) {
            let mut i = points.first;
            member.simulation.see_points(&member.drive.anchor, origin, |x, velocity| {
                way[i] = x - start[i];
                if free {
                    first[i] = Free { velocity, way: way[i] };
                }
                i += 1;
            });
        }
    }

    /// Goes through the near pairs, and what touched in the frame before: what they ask of each other.
    fn touch(&mut self, dt: f32) {
        self.hair.met.fill(Met::default());
        std::mem::swap(&mut self.contacts, &mut self.before);
        self.contacts.clear();
        let mut before = self.before.iter().peekable();
        for pair in self.pairs.iter() {
            // Both are sorted.
            while before.next_if(|known| known.pair < pair).is_some() {}
            let known = before.next_if(|known| known.pair == pair);
            let mut contact = known.copied().unwrap_or(Contact::new(pair));
            if contact.plan(&self.hair, &self.settings, dt)
                && self.contacts.len() < CONTACTS * self.hair.len()
            {
                contact.brake(&mut self.hair);
                self.contacts.push(contact);
            }
        }
        self.hair.contacts.fill(0);
        for segment in self.contacts.iter().flat_map(|contact| contact.pair) {
            self.hair.contacts[segment as usize] += 1;
        }
    }
}
