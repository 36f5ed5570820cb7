//! Real-time simulation of strand hair. Strands are mass-spring chains or elastic rods, integrated implicitly by
//! a direct banded solver whose cost is linear in the number of points of a strand.
//!
//! # Quick start
//!
//! ```
//! use hairspring::prelude::*;
//!
//! // A strand of 16 points, 15 cm long, that hangs from the origin.
//! let strand: Vec<Vec3> = (0..16).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
//! let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
//! let mut points = vec![Vec3::ZERO; simulation.point_count()];
//! for frame in 1..=60 {
//!     // The root moves by 10 cm in a second.
//!     let pose = RigidTransform::from_translation(Vec3::X * (0.1 * frame as f32 / 60.0));
//!     simulation.step(&StepInput::new(1.0 / 60.0, pose, &simulation.rigid_roots(pose)));
//! }
//! simulation.write_points(&mut points);
//! assert!((points[0].x - 0.1).abs() < 1e-6);
//! # Ok::<(), BuildError>(())
//! ```
//!
//! # Tour
//!
//! | step | type |
//! | --- | --- |
//! | strands as authored, read from a file or made by code | [`groom::Groom`] |
//! | the fiber: stiffness, friction, drag | [`material::Material`] |
//! | time steps, integrator, contact | [`settings::Solver`] |
//! | the simulation of some or all strands | [`simulation::Simulation`] |
//! | what moves in a frame: roots, colliders, air | [`simulation::StepInput`] |
//! | shapes that hair collides with, also of your own | [`collide::ColliderShape`], [`collide::Collider`] |
//! | forces of your own | [`forces::ForceField`] |
//! | tools that hold hair: grab, comb, tie | [`forces::Manipulator`] |
//! | hair on hair, as a volume or strand by strand | [`settings::Volume`], [`settings::Neighbours`] |
//! | hairs that are drawn and not simulated | [`follow::Follow`] |
//! | what to draw for debugging | [`simulation::Simulation::debug_lines`] |
//! | contacts one by one, with user data | [`simulation::Simulation::contact_points`] |
//! | a character's mesh, skeleton and motion | [`body::Body`], [`body::Clip`] |
//!
//! The crate `hairspring-scene` plays whole scenes, and `hairspring-io` reads and writes files. The folder
//! `examples` has a program for each use: an engine's loop, a custom force and collider, a distance field from an
//! array, rollback, many characters, follow hairs, debug lines.
//!
//! # Units
//!
//! All quantities are in SI units: meters, kilograms, seconds, newtons, pascals. Coordinates are right-handed,
//! with Y up.
//!
//! # Determinism
//!
//! A step has the same bits for any number of threads. Instruction sets differ by rounding;
//! [`simulation::Simulation::use_instruction_set`] selects one. After a [`simulation::Simulation::restore`] the same
//! inputs give the same bits again.
//!
//! # Threads
//!
//! Steps run on the current [`rayon`](https://docs.rs/rayon) thread pool. To limit the threads, call them inside of
//! `ThreadPool::install`. Without the feature `parallel` they run on the calling thread.
//!
//! # Features
//!
//! | feature | default | |
//! | --- | --- | --- |
//! | `parallel` | yes | Steps run on all threads of a `rayon` pool. Without it, `rayon` is not compiled, and results have the same bits. |
//! | `serde` | no | Settings, materials, manipulators and snapshots implement `Serialize` and `Deserialize`, settings in the form of scene files; so do the vectors of `glam`. |
//!
//! # Errors and panics
//!
//! Building, setting points and restoring a snapshot return errors. [`simulation::Simulation::try_step`] returns an error
//! for input that is not finite or of the wrong length. Strands whose state becomes non-finite are reset and counted in
//! [`simulation::StepReport::reset_strands`]. Functions that take an index or an array of a given shape panic on a wrong
//! one; each says so under *Panics*.
//!
//! # Versions
//!
//! The minimum supported Rust version is 1.95. CI builds with it, and the lint `clippy::incompatible_msrv` refuses newer
//! functions of the standard library. A higher minimum comes with a new minor version, not with a patch.
//!
//! Errors, reports and enums are `#[non_exhaustive]`: a match needs a wildcard arm. The exceptions are
//! [`settings::When`] and [`settings::Range`]: a new kind of condition or range is a breaking change, because a program
//! that shows them must know all of them. Settings are plain structs that may get more fields in a minor version. Write
//! `..Default::default()`, also where all present fields are given.

#![warn(missing_debug_implementations)]

pub mod air;
pub mod body;
pub mod collide;
pub mod follow;
pub mod forces;
pub mod groom;
pub mod material;
pub mod math;
pub(crate) mod parallel;
pub mod prelude;
pub mod settings;
pub(crate) mod simd;
pub mod simulation;
pub(crate) mod strand;
pub(crate) mod strand_contact;
pub(crate) mod volume;

pub use glam;
