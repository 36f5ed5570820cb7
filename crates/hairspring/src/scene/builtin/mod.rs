//! The built-in scene: a bust with a full head of hair that turns, nods and shakes, all made by code.

mod borders;
mod bust;
mod field;
mod grow;
mod groom;
mod nets;
mod random;
mod roots;
mod sdf;
mod shape;
mod style;

pub use style::Style;

/// bust
pub fn bust() -> (crate::body::Body, crate::body::Body) {
    (bust::drawn(), bust::collision())
}
/// hair
pub fn hair(mesh: &crate::body::Mesh, style: Style, n: usize) -> (crate::groom::Groom, crate::scene::HairLook) {
    (groom::groom(mesh, &style.cut(), n, style.points() as usize, 1), style.look())
}
