//! Reasons why an experiment gives no number.

/// Why there is no measured value or no reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// The strand became non-finite and was reset to its rest shape.
    #[error("the strand turned non-finite")]
    NotFinite,
    /// The strand still moved at the end of the experiment's time.
    #[error("the strand did not come to rest")]
    NotAtRest,
    /// The strand stayed stable up to the largest load.
    #[error("the strand never gave way")]
    NoThreshold,
    /// The swing turned back far too soon.
    #[error("the strand did not swing")]
    NoSwing,
    /// The experiment cannot be set up with so few points.
    #[error("the experiment needs {0} points or more")]
    TooFewPoints(u32),
    /// The motion died out before it could be timed.
    #[error("the motion died out before it could be timed")]
    DiedOut,
}
