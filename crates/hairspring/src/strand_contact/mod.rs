//! Hair on hair, strand by strand: segments that touch press each other apart, rub, and may hold together until they are pulled apart.
//!
//! The reference that the volume (`volume/`) is measured against, for guides and for small scenes. Strands meet between substeps, not once a frame: inside
//! a substep each is solved by itself, and what its neighbours do to it is part of the velocities that it begins with.
//!
//! ```text
//! before a substep   v ← v + h M⁻¹ Jᵀ F           F the loads that contacts carry, J from velocities to those of contacts
//! the substep        every strand by itself
//! after it           v ← v + A⁻¹ Jᵀ p             p by projected Gauss–Seidel, so that no segments will be in each other at the end of the next;
//!                                                 A what strands make of it: masses, bending (`response`), and lengths that stay (`along`)
//! carried            F ← what acted in this substep and in the one before it, F + p/h
//! ```
//!
//! Sequential impulses (Moreau 1988, *Unilateral Contact and Dry Friction in Finite Freedom Dynamics*; Catto 2005, *Iterative Dynamics with Temporal
//! Coherence*), with a difference: the load is not where iterations begin but is given to the strands' solve, which is then in balance with it, tension
//! and weight together. What acts in two substeps in turn is a load; what acts in one is a blow, and is not carried.
//!
//! Every impulse acts on both segments, equal and opposite: momentum is kept to rounding. No place is ever moved: lengths and contact with bodies are as
//! the substep left them.
//!
//! Strands that are the same at rest are one here (`hair`), and a segment is shown so many others at most (`grid`): the cost of a crowd grows with its number.
//!
//! A start at rest stays one: a segment is no thicker than half of the way to the nearest other strand at rest, so that nothing touches there.
//!
//! # Cost
//! Strands meet in every substep, in one order on one thread, so that results depend on no number of threads: and cost more the more of them
//! touch: of 500 shaken strands of 32 points at 4 substeps a frame takes 1.1 ms on one core without, 140 ms with a radius of 1 mm and 290 ms with that of their density.
//!
//! # Missing
//! A strand does not meet itself. Followers are moved by their guides alone. Where more
//! strands are pressed together than there is room for, they overlap, and tremble; a narrow tie does not gather them, because they hold each other up.

mod along;
mod closest;
mod contact;
mod grid;
mod hair;
mod response;
mod rest;
#[cfg(test)]
mod tests;

pub(crate) use hair::Hair;

use crate::settings;
use along::Along;
use contact::{Contact, ContactResponse, SolverParams};
use glam::{Mat3, Quat, Vec3};
use grid::Grid;

/// Sweeps over all contacts after a substep. More are for piles: what is left of an approach is carried into the next substep.
const SWEEPS: usize = 8;

/// Most contacts that are kept, over the number of segments: a strand in a bundle, each segment beside three of each of six neighbours, counted once for both.
const MOST_CONTACTS: usize = 16;

/// Strands that meet each other one by one: what is known of their contacts, and memory.
pub(crate) struct Neighbours {
    settings: settings::Neighbours,
    /// The largest radius of a segment [m].
    radius: f32,
    /// See [`NeighboursReport::crowded`].
    crowded: usize,
    pub hair: Hair,
    grid: Grid,
    along: Along,
    /// Sorted by their segments.
    contacts: Vec<Contact>,
    before: Vec<Contact>,
    /// Of each contact, where it was asked for.
    sides: Vec<Option<ContactResponse>>,
}

/// What is known of strands that meet each other one by one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NeighboursReport {
    /// The largest radius of contact [m]: the one that was asked for, or found.
    pub radius: f32,
    /// Pairs of segments that are near each other.
    pub near: usize,
    /// Of those, pairs that press each other.
    pub pressing: usize,
    /// Of those, pairs that hold together.
    pub bonds: usize,
    /// Sum of the forces along the normals of all pairs, pulling ones negative [N].
    pub force: f32,
    /// The deepest that two segments are in each other [m].
    pub depth: f32,
    /// Strands that are the same at rest as others before them, and meet the rest as one with those.
    pub same: usize,
    /// Pairs of segments that were looked at after the last substep.
    pub looked_at: usize,
    /// The most segments that were ever left with some of their neighbours out, because they had more than are looked at.
    pub crowded: usize,
}

impl Neighbours {
    /// Strands as they are at rest in `hair`; `None` where they are not to meet, or there are not two.
    pub fn new(settings: &settings::Neighbours, mut hair: Hair) -> Option<Self> {
        if !settings.on || hair.shown_count() < 2 {
            return None;
        }
        let mut grid = Grid::new(hair.segments().count());
        let radius = rest::find_radii(settings.radius, &mut hair, &mut grid);
        let most = MOST_CONTACTS * hair.segments().count();
        Some(Self {
            settings: *settings,
            radius,
            crowded: 0,
            along: Along::new(&hair),
            hair,
            grid,
            contacts: Vec::with_capacity(most),
            before: Vec::with_capacity(most),
            sides: Vec::with_capacity(most),
        })
    }

    /// See [`NeighboursReport`].
    pub fn report(&self) -> NeighboursReport {
        let mut report = NeighboursReport {
            radius: self.radius,
            near: self.contacts.len(),
            same: self.hair.shown_count() - self.hair.strand_count(),
            looked_at: self.grid.looked_at,
            crowded: self.crowded,
            ..Default::default()
        };
        for contact in &self.contacts {
            report.pressing += usize::from(contact.presses());
            report.bonds += usize::from(contact.holds());
            report.force += contact.force();
            report.depth = report.depth.max(contact.depth());
        }
        report
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.hair.bytes()
            + self.grid.bytes()
            + MOST_CONTACTS
                * self.hair.segments().count()
                * (2 * size_of::<Contact>() + size_of::<Option<ContactResponse>>())
    }

    /// Nothing touches any more: strands were put elsewhere.
    pub fn forget(&mut self) {
        self.contacts.clear();
    }

    /// Hair was turned as a whole.
    pub fn turn(&mut self, by: Quat) {
        let turn = Mat3::from_quat(by);
        self.contacts.iter_mut().for_each(|contact| contact.turn(&turn));
    }

    /// Goes on with what `old` knew of the same strands.
    pub fn take_over(&mut self, old: &Neighbours) {
        self.contacts.extend_from_slice(&old.contacts[..old.contacts.len().min(self.contacts.capacity())]);
    }

    /// Whether any strand touches another.
    pub fn touch(&self) -> bool {
        self.contacts.iter().any(|contact| contact.presses() || contact.holds())
    }

    /// Leaves as the velocities of `hair` what they change by by what contacts carry, in a substep of `h` [s].
    pub fn apply_warm_start(&mut self, h: f32) {
        self.hair.v.fill(Vec3::ZERO);
        for contact in &self.contacts {
            contact.apply_warm_start(h, &mut self.hair);
        }
    }

    /// What the velocity of point `i` was changed by by the last [`Neighbours::meet`] [m/s].
    pub fn change(&self, i: usize) -> Vec3 {
        self.along.change(i, &self.hair)
    }

    /// Finds who touches whom in `hair`, after a substep of `h` [s], and changes velocities so that none will be in the other after the next.
    pub fn solve_contacts(&mut self, h: f32) {
        let Self { hair, grid, along, contacts, before, sides, .. } = self;
        std::mem::swap(contacts, before);
        contacts.clear();
        grid.sort(hair, h);
        let (mut known, most) = (before.iter().peekable(), contacts.capacity());
        grid.pairs(hair, |pair| {
            while known.next_if(|contact| contact.pair < pair).is_some() {}
            let old = known.next_if(|contact| contact.pair == pair);
            if let Some(contact) = Contact::find(pair, old, hair, h)
                && contacts.len() < most
            {
                contacts.push(contact);
            }
        });
        self.crowded = self.crowded.max(grid.crowded);
        let rules = SolverParams { h, friction: self.settings.friction, stiction: self.settings.stiction };
        sides.clear();
        sides.resize_with(contacts.len(), || None);
        along.begin(hair);
        for _ in 0..SWEEPS {
            contacts
                .iter_mut()
                .zip(&mut *sides)
                .for_each(|(contact, sides)| contact.solve(sides, &rules, hair));
            along.keep_lengths(hair);
        }
        contacts.iter_mut().for_each(|contact| contact.carry(&rules));
    }
}
