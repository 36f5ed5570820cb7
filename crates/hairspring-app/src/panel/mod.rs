//! The panels around the picture: each shows the session as it is and says what a person asks for as actions.

pub mod files;
pub mod help;
pub mod inspect;
pub mod list;
pub mod parameters;
pub mod presets;
pub mod transport;
pub mod wind;
