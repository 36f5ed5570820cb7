//! Promise: groups of strands have handles and user data, which the simulation keeps.

use crate::support::groom;
use hairspring::{
    groom::Groom,
    simulation::{GroupId, Simulation},
};

#[test]
fn groups_are_those_of_the_groom() {
    let groom = Groom { groups: vec![2, 0, 2, 5], ..groom(4) };
    // The order of the caller's strands is kept, and group 5 is not simulated.
    let mut simulation =
        Simulation::builder(groom).strands(&[2, 1, 0]).group_user_data(&[10, 11, 1 << 100]).build().unwrap();
    let [fringe, tail, absent] = [0, 2, 5].map(GroupId::new);
    assert_eq!(simulation.groups(), [fringe, tail]);
    assert_eq!([0, 1, 2].map(|s| simulation.group(s)), [tail, fringe, tail]);
    assert!(simulation.strands_in_group(tail).eq([0, 2]));
    assert_eq!(simulation.strands_in_group(absent).count(), 0);
    assert_eq!([fringe, tail, absent].map(|g| simulation.group_user_data(g)), [10, 1 << 100, 0]);
    simulation.set_group_user_data(absent, 3);
    let instance = simulation.instance();
    assert_eq!([fringe, tail, absent].map(|g| instance.group_user_data(g)), [10, 1 << 100, 3]);
}
