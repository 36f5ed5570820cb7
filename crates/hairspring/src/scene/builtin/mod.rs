//! The built-in scene.

mod borders;
mod bust;
mod nets;
mod random;
mod sdf;
mod shape;

/// bust
pub fn bust() -> (crate::body::Body, crate::body::Body) {
    (bust::drawn(), bust::collision())
}
