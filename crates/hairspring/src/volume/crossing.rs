//! Drag between hairs that cross: strands that move across each other stop each other.
//!
//! ```text
//! 1/λ = n D                    encounters per meter:  n  length of strands per volume [1/m²],  D  spacing of strands at rest [m]
//! du/dt = −|u| u/λ             →   u(dt) = u / (1 + |u| dt/λ)                       u  velocity relative to the surrounding hair
//! node    R = U/λ / (1 + dt U/λ) (1 − t tᵀ),   U² = Σ w m |v|² / M − |V|²,   t = Σ w m τ / M
//! point   a = Σ w R (V − v)
//! ```
//!
//! Two locks that cross in one cell do not change its mean velocity, and a pressure acts on both alike.
//! Neither stops them. The variance of the velocities in the cell shows that they cross.
//!
//! A strand that moves sideways through hair meets n D other strands per meter, like a molecule in a gas
//! (mean free path λ, Maxwell 1860). Each strand is as thick as the hair that it represents. An encounter is
//! inelastic: it removes the relative velocity. A strand therefore stops within a few spacings at any speed,
//! and slow relative motion is hardly damped. The integral of n along a path does not depend on the cell
//! size, and u(dt) is exact for intervals of any length.
//!
//! Strands slide freely along each other, to the extent that the strands of a node have a common direction:
//! |t| is 1 if they are parallel, and 0 if they have no common direction. R is symmetric, is the same for all
//! points of a node, and acts on the difference from the node's mean. It therefore conserves momentum and
//! does not damp common motion.

/// Drag of crossing hair on the points of a node.
#[derive(Clone, Copy)]
pub struct Crossing {
    /// 1/λ for a mass of 1 [1/m].
    per_mass: f32,
    /// Duration of an interval [s].
    dt: f32,
}

impl Crossing {
    /// Creates the drag for strands `spacing` apart at rest [m], with `length` of strand per unit of mass
    /// [m], in cells of `cell` [m] and intervals of `dt` [s].
    pub fn new(spacing: f32, length: f32, cell: f32, dt: f32) -> Self {
        Self { per_mass: spacing * length / cell.powi(3), dt }
    }

    /// Returns the drag rate of a node with this mass, if the velocities of its points have the standard
    /// deviation `spread` [1/s].
    pub fn rate(&self, mass: f32, spread: f32) -> f32 {
        let free = self.per_mass * mass * spread;
        free / (1.0 + free * self.dt)
    }
}
