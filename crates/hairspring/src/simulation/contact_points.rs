//! The contacts of a step, one by one: their place, force, normal and collider.

use super::Simulation;
use crate::collide::MovingCollider;
use glam::Vec3;

/// A contact of a strand with a collider at the end of a step; see [`Simulation::contact_points`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactPoint {
    /// The strand, as an index into those given to [`Simulation::builder`].
    pub strand: usize,
    /// The point of the strand, or the second point of the segment.
    pub point: usize,
    /// Place on the segment that ends at `point` [1]: 1 for a contact of the point itself, and less for a
    /// contact of the segment between its points.
    pub fraction: f32,
    /// World position [m].
    pub position: Vec3,
    /// Magnitude of the normal force on the strand in the last substep, above 0 [N]. The force is along the outward
    /// normal of the collider. Friction is not included.
    pub force: f32,
    /// Index in `colliders` of the collider that is nearest to `position`. The solver stores the force of a
    /// contact, but not its collider. Where two colliders overlap, the force may be from the other one.
    pub collider: usize,
    /// [`MovingCollider::user_data`] of that collider.
    pub user_data: u128,
    /// Outward unit normal of that collider in world space.
    pub normal: Vec3,
    /// Distance from that collider's surface, negative inside [m].
    pub distance: f32,
}

impl Simulation {
    /// Returns the contacts of all strands with `colliders`, the colliders of the last step at the end of the
    /// frame: strand by strand, from the root. Without colliders there are none.
    ///
    /// ```
    /// use hairspring::prelude::*;
    ///
    /// // A strand that falls on a floor 5 cm below it.
    /// let strand: Vec<Vec3> = (0..16).map(|i| Vec3::X * (0.01 * i as f32)).collect();
    /// let solver = Solver { sag_free: false, ..Solver::default() };
    /// let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).solver(solver).build()?;
    /// let floor = ColliderShape::Plane { point: Vec3::NEG_Y * 0.05, normal: Vec3::Y };
    /// let anchor = RigidTransform::IDENTITY;
    /// let colliders = [MovingCollider::at_rest(floor, anchor).with_user_data(7)];
    /// let roots = simulation.rigid_roots(anchor);
    /// let input = StepInput::new(1.0 / 60.0, anchor, &roots).with_colliders(&colliders);
    /// (0..60).for_each(|_| _ = simulation.step(&input));
    /// let contacts = simulation.contact_points(&colliders);
    /// assert!(contacts.iter().all(|contact| contact.user_data == 7 && contact.normal == Vec3::Y));
    /// assert!(!contacts.is_empty());
    /// # Ok::<(), hairspring::simulation::BuildError>(())
    /// ```
    pub fn contact_points(&self, colliders: &[MovingCollider]) -> Vec<ContactPoint> {
        let mut contacts = Vec::new();
        for (strand, view) in self.each_strand().enumerate() {
            let mut before = view.root();
            // The first two points are driven by the root.
            for (point, x) in view.points().enumerate() {
                let i = point * view.stride();
                for (fraction, force) in [view.segment_contact(i), (1.0, view.normal_force(i))] {
                    let position = before.lerp(x, fraction);
                    let touches = point >= 2 && force > 0.0;
                    let near = touches.then(|| nearest(colliders, position)).flatten();
                    let Some((collider, distance, normal)) = near else { continue };
                    let user_data = colliders[collider].user_data;
                    contacts.push(ContactPoint {
                        strand,
                        point,
                        fraction,
                        position,
                        force,
                        collider,
                        user_data,
                        normal,
                        distance,
                    });
                }
                before = x;
            }
        }
        contacts
    }
}

/// Returns the collider nearest to `position` at the end of the frame, the distance [m] and the normal in
/// world space.
fn nearest(colliders: &[MovingCollider], position: Vec3) -> Option<(usize, f32, Vec3)> {
    let seen = colliders.iter().enumerate().map(|(k, o)| {
        let (distance, normal) = o.shape.distance_and_normal(o.end.inverse_transform_point(position));
        (k, distance, o.end.rotation * normal)
    });
    seen.min_by(|a, b| a.1.total_cmp(&b.1))
}
