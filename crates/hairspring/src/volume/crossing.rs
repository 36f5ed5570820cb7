//! Drag of hair on hair that moves across it: strands that cross each other stop each other.
//!
//! ```text
//! 1/λ = n D                    encounters per meter:  n  length of strands per volume [1/m²],  D  spacing of strands at rest [m]
//! du/dt = −|u| u/λ             →   u(dt) = u / (1 + |u| dt/λ)                       u  velocity relative to the hair around
//! node    R = U/λ / (1 + dt U/λ) (1 − t tᵀ),   U² = Σ w m |v|² / M − |V|²,   t = Σ w m τ / M
//! point   a = Σ w R (V − v)
//! ```
//!
//! Two tresses that cross in one cell do not change its mean velocity, and a pressure acts on both alike. Neither stops them. The variance of the velocities in the
//! cell shows that they cross.
//!
//! A strand that moves sideways through hair meets n D other strands per meter, as a molecule meets others in a gas (mean free path λ, Maxwell 1860). Each strand is as
//! thick as the hair that it stands for. An encounter is inelastic: it takes the relative velocity. So a strand stops within a few spacings at any speed, and slow relative
//! motion is hardly braked. The integral of n along a path is the same for cells of any size, and u(dt) is exact for intervals of any length.
//!
//! Strands slide along each other freely as far as the strands of a node have one direction: |t| is 1 where they do, and 0 where they have none.
//! R is the same for all points of a node, symmetric, and acts on the difference from the node's mean: it keeps momentum and does not brake common motion.

/// What crossing hair takes from the motion of a node's points.
#[derive(Clone, Copy)]
pub struct Crossing {
    /// 1/λ for a mass of 1 [1/m].
    per_mass: f32,
    /// Length of an interval [s].
    dt: f32,
}

impl Crossing {
    /// For strands `spacing` apart at rest with `length` for each mass of 1 [m], in cells of `cell` [m] and intervals of `dt` [s].
    pub fn new(spacing: f32, length: f32, cell: f32, dt: f32) -> Self {
        Self { per_mass: spacing * length / cell.powi(3), dt }
    }

    /// The rate of a node of some mass, of whose points velocities differ by `spread` from their mean [1/s].
    pub fn rate(&self, mass: f32, spread: f32) -> f32 {
        let free = self.per_mass * mass * spread;
        free / (1.0 + free * self.dt)
    }
}
