//! Groups of strands: their handles, their strands, and user data.

use super::Simulation;

/// Identifies a group of strands: those with the same index in [`Groom::groups`](crate::groom::Groom::groups), which
/// have the same material.
///
/// ```
/// use hairspring::prelude::*;
///
/// let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
/// let groom = Groom { groups: vec![0, 1, 1], ..Groom::from_strands([&strand, &strand, &strand], 35e-6) };
/// let simulation = Simulation::builder(groom).group_user_data(&[100, 200]).build()?;
/// let ponytail = GroupId::new(1);
/// assert_eq!(simulation.group(2), ponytail);
/// assert_eq!(simulation.group_user_data(ponytail), 200);
/// assert!(simulation.strands_in_group(ponytail).eq([1, 2]));
/// # Ok::<(), hairspring::simulation::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GroupId(u16);

impl GroupId {
    /// Returns the handle of the group with this index in the groom.
    pub const fn new(index: u16) -> Self {
        Self(index)
    }

    /// Returns the index of the group in the groom.
    pub const fn index(self) -> u16 {
        self.0
    }
}

impl Simulation {
    /// Returns the groups that have simulated strands, in ascending order.
    pub fn groups(&self) -> Vec<GroupId> {
        let mut groups: Vec<_> = self.strands().map(|s| self.group_in_groom(s)).collect();
        groups.sort_unstable();
        groups.dedup();
        groups
    }

    /// Returns the group of a strand, an index into those given to [`Simulation::builder`].
    ///
    /// # Panics
    /// If `strand` is not less than [`Simulation::strand_count`].
    pub fn group(&self, strand: usize) -> GroupId {
        self.group_in_groom(self.model.groom_strands[self.model.lane_of_strand[strand] as usize])
    }

    /// Returns the simulated strands of a group in ascending order, as indices into those given to
    /// [`Simulation::builder`].
    pub fn strands_in_group(&self, group: GroupId) -> impl Iterator<Item = usize> + '_ {
        self.strands().enumerate().filter(move |(_, s)| self.group_in_groom(*s) == group).map(|(k, _)| k)
    }

    /// Returns the user data of a group, such as an entity of the engine. The simulation does not read
    /// it, and snapshots do not contain it. 0 if it was never set.
    pub fn group_user_data(&self, group: GroupId) -> u128 {
        self.group_user_data.get(usize::from(group.0)).copied().unwrap_or(0)
    }

    /// Sets the user data of a group.
    pub fn set_group_user_data(&mut self, group: GroupId, user_data: u128) {
        let index = usize::from(group.0);
        if index >= self.group_user_data.len() {
            self.group_user_data.resize(index + 1, 0);
        }
        self.group_user_data[index] = user_data;
    }

    fn group_in_groom(&self, strand: u32) -> GroupId {
        GroupId(self.model.groom.group(strand as usize))
    }
}
