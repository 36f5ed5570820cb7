//! Why an experiment gives no number.

/// Why there is no measured value or no reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// The strand turned non-finite and was put back to its rest shape.
    #[error("the strand turned non-finite")]
    NotFinite,
    /// The strand still moved after the time that an experiment is given.
    #[error("the strand did not come to rest")]
    NotAtRest,
    /// No load up to the greatest that is tried makes the strand give way.
    #[error("the strand never gave way")]
    NoThreshold,
    /// A swing that turned back far too soon.
    #[error("the strand did not swing")]
    NoSwing,
    /// The motion died out before enough of it could be timed.
    #[error("the motion died out before it could be timed")]
    DiedOut,
}
