//! Materials underfoot: the response of ice, snow, gravel, sand and wood to the feet on them.
//!
//! ```text
//! tile forces (N, 1 kHz) -elastic-> displacement and speed of the sheet under each tile
//!   ice:    kinetic energy -onsets-> crack events -energy-> joules -+-fracture-> crack graph, depth
//!   grains: power          -onsets-> collisions   -energy-> joules -+-relief--> prints
//!   wood:   strain         -slips--> creaks              -> joules -+
//!                                                                   +-resonance-> Cue (one event: touch and sound)
//! ```
//!
//! `Grounds` is all the ground of one page: the engine passes it each frame. Nothing here reads a clock or the
//! system's randomness: times come with the frames, random numbers from the seeds of the layout, so that the same
//! walk gives the same pond, to the bit.

mod bed;
mod crack;
mod elastic;
mod energy;
mod fracture;
mod grains;
mod grounds;
mod ice;
mod onsets;
mod relief;
mod resonance;
mod spec;
mod state;
mod tile;
mod wood;

pub use crack::Crack;
pub use elastic::Body;
pub use energy::EnergyLaw;
pub use fracture::{CrackRules, Seed};
pub use relief::Relief;
pub use resonance::{PlaceModes, Ring};
pub use spec::{Grain, GrainSpec, GroundMaterial, GroundSpec, IceSpec, Sheet, WoodSpec};
pub use state::{GroundCounters, GroundEvent, GroundState};

pub use elastic::{Elastic, Motion};
pub use fracture::{Fracture, Growth};
pub use grounds::Grounds;
pub use onsets::Onsets;
