//! The angle between two rotations.

use glam::Quat;

/// Returns the angle of the rotation that leads from `a` to `b`, both of unit length, by the shorter way [rad]: 0 to π.
///
/// It is found with an arctangent. [`Quat::angle_between`] uses the arccosine, which turns rounding errors into angles
/// of 10⁻³ between rotations that are equal.
///
/// ```
/// use glam::Quat;
/// use hairspring::math::angle_between;
///
/// let [a, b] = [1.0, 1.001].map(Quat::from_rotation_x);
/// assert!((angle_between(a, b) - 0.001).abs() < 1e-6);
/// assert!(angle_between(a, -a) < 1e-6);
/// ```
pub fn angle_between(a: Quat, b: Quat) -> f32 {
    let turn = b * a.inverse();
    2.0 * turn.xyz().length().atan2(turn.w.abs())
}
