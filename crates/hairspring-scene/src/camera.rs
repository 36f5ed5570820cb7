//! The camera of a scene.

use glam::Vec3;
use hairspring::settings::define_settings;

define_settings! {
    /// A perspective camera.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Camera {
        /// Position of the scene's camera, used when the scene is opened and rendered.
        position: Vec3 = Vec3::new(0.35, 0.1, 1.1), ["m"], {vector}, default "framed automatically";
        /// Point that the camera looks at.
        target: Vec3 = Vec3::ZERO, ["m"], {
            check |camera| camera.target.is_finite() && camera.target != camera.position
                => "finite, and different from the camera's position"
        }, default "framed automatically";
        /// Vertical field of view: small for a distant portrait, large for a whole room. The default is that of a
        /// portrait lens.
        fov: f32 = 30.0, ["degrees"], {1 to 170};
        /// Moves position and target along with the hair, so that hair that travels stays in the picture at the same size. They
        /// are where the camera is at the start. Steps and nods are averaged over about a second.
        follow: bool = false, "none", {switch};
    }
}
