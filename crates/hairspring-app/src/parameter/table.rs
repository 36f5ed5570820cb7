//! The parameters of the panel: group, object, name, label and control.

use super::{Group, Kind, Of, Parameter};

const fn number(min: f64, max: f64) -> Kind {
    Kind::Number { min, max, log: false }
}

const fn scale(min: f64, max: f64) -> Kind {
    Kind::Number { min, max, log: true }
}

macro_rules! parameters {
    ($($group:ident { $($of:ident $name:literal, $label:literal, $kind:expr;)* })*) => {
        &[$($(Parameter { group: Group::$group, of: Of::$of, name: $name, label: $label, kind: $kind },)*)*]
    };
}

/// All parameters.
pub const ALL: &[Parameter] = parameters! {
    Style {
        Groom "style", "Hairstyle", Kind::Choice;
        Groom "strands", "Hair count", Kind::Count { min: 100, max: 200_000 };
        Groom "guides", "Guides", Kind::Guides { max: 20_000 };
        Groom "grow.strands", "Hair count", Kind::Count { min: 10, max: 200_000 };
        Groom "grow.length", "Length", scale(0.002, 1.0);
        Groom "grow.spread", "Length variation", Kind::Bounded;
        Groom "grow.fall", "Droop", Kind::Bounded;
        Groom "grow.points", "Points per hair", Kind::Count { min: 3, max: 64 };
        Groom "thicken.copies", "Copies per strand", Kind::Count { min: 0, max: 20 };
        Groom "thicken.radius", "… radius", number(0.0, 0.01);
        Groom "thicken.tip", "… tip spread", number(0.0, 10.0);
        Material "preset", "Material", Kind::Choice;
        Material "tether", "Tether", number(0.0, 3.0);
        Material "tether_profile", "… profile", Kind::Profile;
        Material "global_shape.pull", "Global shape", number(0.0, 20.0);
        Material "global_shape.profile", "… profile", Kind::Profile;
        Material "global_shape.damping", "… damping", number(0.0, 4.0);
        Groom "effects.clump", "Clump", Kind::Bounded;
        Groom "effects.curl_radius", "Curl radius", number(0.0, 0.02);
        Groom "effects.curl_length", "Curl length", scale(0.002, 0.2);
        Groom "effects.noise", "Flyaway", number(0.0, 0.02);
        Groom "transform.position", "Position", Kind::Vector { reach: 5.0 };
        Groom "transform.rotation", "Rotation", Kind::Vector { reach: 180.0 };
        Groom "transform.scale", "Scale", Kind::Vector { reach: 10.0 };
    }
    Stiffness {
        Material "model", "Model", Kind::Choice;
        Material "bend", "Bending", scale(0.01, 1000.0);
        Material "bend_profile", "… profile", Kind::Profile;
        Material "damping", "Damping", number(0.0, 0.2);
        Material "damping_profile", "… profile", Kind::Profile;
        Material "flatness", "Flatness", Kind::Bounded;
        Material "flatness_profile", "… profile", Kind::Profile;
        Material "young", "Young's modulus", scale(1e8, 1e11);
        Material "shear", "Shear modulus", scale(1e7, 1e11);
    }
    Weight {
        Scene "gravity", "Gravity", Kind::Vector { reach: 30.0 };
        Material "density", "Density", number(100.0, 5000.0);
        Material "mass_profile", "Mass profile", Kind::Profile;
        Material "radius", "Fiber radius", Kind::Maybe { min: 1e-5, max: 2e-4, from: 3.5e-5, without: "from the groom" };
        Material "radius_profile", "… profile", Kind::Profile;
    }
    Motion {
        Groom "motion", "Built-in motion", Kind::Switch;
        Scene "clip.start", "First frame", Kind::Count { min: 0, max: 500 };
        Scene "clip.rest_frame", "Rest frame", Kind::Count { min: 0, max: 500 };
        Scene "clip.travel", "Travel", Kind::Choice;
        Scene "clip.facing", "Facing", number(-180.0, 180.0);
        Scene "solver.inertia", "Head inertia", Kind::Bounded;
    }
    Air {
        Scene "wind.velocity", "Wind", Kind::Vector { reach: 20.0 };
        Scene "wind.gust", "Gust amount", Kind::Bounded;
        Scene "wind.gust_rate", "Gust rate", number(0.0, 5.0);
        Scene "turbulence.strength", "Turbulence", number(0.0, 5.0);
        Scene "turbulence.size", "Eddy size", scale(0.01, 2.0);
        Scene "turbulence.octaves", "Octaves", Kind::Count { min: 1, max: 6 };
        Scene "wind_occlusion.body", "Body occlusion", number(0.0, 300.0);
        Scene "wind_occlusion.hair", "Hair occlusion", number(0.0, 300.0);
        Scene "wind_occlusion.reach", "Wake length", number(0.05, 3.0);
        Material "drag", "Drag", number(0.0, 5.0);
        Material "drag_profile", "… profile", Kind::Profile;
        Material "charge", "Static charge", number(-1e-8, 1e-8);
        Material "charge_profile", "… profile", Kind::Profile;
    }
    Collision {
        Scene "solver.collide_body", "Body collision", Kind::Switch;
        Scene "solver.contact", "Contact method", Kind::Choice;
        Scene "solver.segment_contacts", "Segment contacts", Kind::Switch;
        Material "friction", "Friction", Kind::Bounded;
        Material "friction_profile", "… profile", Kind::Profile;
        Material "friction_kinetic", "… kinetic", Kind::Bounded;
        Scene "solver.teleport_distance", "Teleport distance", scale(0.05, 10.0);
    }
    Volume {
        Scene "volume.method", "Volume method", Kind::Choice;
        Scene "volume.friction", "Volume friction", number(0.0, 30.0);
        Scene "volume.pressure", "Pressure", number(0.0, 3.0);
        Scene "volume.recovery_rate", "Volume recovery", number(0.0, 100.0);
        Scene "volume.cell", "Cell size", Kind::Maybe { min: 0.002, max: 0.1, from: 0.015, without: "automatic" };
        Scene "neighbours.on", "Strand contacts", Kind::Switch;
        Scene "neighbours.radius", "Strand radius", Kind::Maybe { min: 0.0002, max: 0.02, from: 0.002, without: "automatic" };
        Scene "neighbours.friction", "Strand friction", number(0.0, 1.0);
        Scene "neighbours.stiction", "Stiction", number(0.0, 1e-4);
    }
    Look {
        Groom "look.root_color", "Root color", Kind::Color;
        Groom "look.tip_color", "Tip color", Kind::Color;
        Groom "look.melanin", "Melanin", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "the two colors" };
        Groom "look.melanin_redness", "Redness", Kind::Bounded;
        Groom "look.dye", "Dye", Kind::Color;
        Groom "look.variation", "Variation", Kind::Bounded;
        Groom "look.roughness", "Roughness", Kind::Bounded;
        Groom "look.cuticle", "Cuticle", Kind::Bounded;
        Groom "look.specular", "Specular", Kind::Bounded;
        Groom "look.backlight", "Backlight", Kind::Bounded;
        Groom "look.scatter", "Scatter", Kind::Bounded;
        Groom "look.shadow", "Shadow", Kind::Bounded;
        Scene "body.color", "Skin color", Kind::MaybeColor { from: [0.5, 0.3, 0.23], without: "from the file" };
        Scene "body.roughness", "Skin roughness", Kind::Maybe { min: 0.0, max: 1.0, from: 0.5, without: "from the file" };
        Scene "ground.on", "Ground", Kind::Switch;
        Scene "ground.height", "… height", Kind::Maybe { min: -2.0, max: 2.0, from: 0.0, without: "under the body" };
        Scene "ground.color", "… color", Kind::MaybeColor { from: [0.4, 0.37, 0.33], without: "shadow alone" };
    }
    Camera {
        Scene "camera.position", "Camera position", Kind::Vector { reach: 10.0 };
        Scene "camera.target", "Camera target", Kind::Vector { reach: 10.0 };
        Scene "camera.fov", "Field of view", number(5.0, 90.0);
        Scene "camera.follow", "Follow hair", Kind::Switch;
        Scene "picture.light_angle", "Light angle", number(-180.0, 180.0);
        Scene "picture.background", "Background", Kind::Choice;
        Scene "picture.backdrop_center", "Backdrop center", Kind::Color;
        Scene "picture.backdrop_edge", "Backdrop edge", Kind::Color;
        Scene "picture.shutter", "Shutter", number(0.0, 360.0);
        Scene "picture.shutter_samples", "… samples", Kind::Count { min: 2, max: 64 };
    }
    Solver {
        Scene "solver.integrator", "Integrator", Kind::Choice;
        Scene "solver.substeps", "Substeps", Kind::Count { min: 1, max: 64 };
        Scene "solver.projection_iterations", "Iterations", Kind::Count { min: 0, max: 20 };
        Scene "solver.quality", "Quality", Kind::Choice;
        Scene "solver.sag_free", "Sag-free start", Kind::Switch;
        Scene "solver.preroll", "Pre-roll", number(0.0, 10.0);
        Scene "solver.global_shape", "Use global shape", Kind::Switch;
    }
};
