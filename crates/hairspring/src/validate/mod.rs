//! The simulation held against closed forms.
pub mod reference;
