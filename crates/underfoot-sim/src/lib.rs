//! A simulated floor: plates, sensors and feet that produce the packets of a real floor.
//!
//! ```text
//! Scenario -resolve-> Script (or a hand) -> Feet (m, N)
//!   -print-> loads on tiles -plate statics-> support forces
//!   -parts-> volts, noise -converter-> counts -> Readings per board
//! ```
//!
//! Code that receives the packets can't distinguish them from real ones: the floor needs calibration
//! ([`FloorBuild`]) like a real one. The simulation is deterministic: the same seeds and feet give the same packets.
//!
//! ```
//! use std::time::Duration;
//! use underfoot::floor::Floor;
//! use underfoot::glam::Vec2;
//! use underfoot_sim::{FloorBuild, FloorQuality, Pace, Performance, Person, Script, SimulatedSource};
//! use underfoot::source::SensorSource;
//! use underfoot::units::Newtons;
//!
//! let (sim, floor) = FloorBuild::of(FloorQuality::Slight, 1).in_use(&Floor::default())?;
//!
//! let mut person = Performance::new(Person::default(), 1);
//! person.appear(Vec2::new(0.9, 0.6), 0.0)?;
//! person.press(Vec2::new(1.0, 1.1), Newtons(120.0), Duration::from_millis(300))?;
//! let script = Script::new(vec![person], floor.geometry.bounds());
//!
//! let mut source = SimulatedSource::new(sim, Box::new(script), Pace::FreeRunning);
//! let packet = source.next(Duration::ZERO)?;
//! assert!(packet.is_some_and(|packet| packet.board == 0 && packet.readings.len() == 24));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrivals;
mod build;
mod curve;
mod definition;
mod drawn_walk;
mod floor;
mod floor_clock;
mod foot;
mod footprint;
mod footwear;
mod gait;
mod hand;
mod legs;
mod loadcell;
mod looping_script;
mod mapping;
mod performance;
mod person;
mod plate;
mod quality;
mod recorded;
mod reference;
mod rehearsal;
mod rolling;
mod rolling_fit;
mod scenario;
mod scene;
mod script;
mod seam;
mod sensor;
#[cfg(feature = "net")]
mod session;
mod simulated;
mod slide;
mod standing;
mod sway;
mod track;
mod visit;
mod watched;
mod way;

pub use arrivals::{ArrivalError, ArrivalHandle, Arrivals, arrivals};
pub use build::{BuildError, FloorBuild, drift_zeros};
pub use drawn_walk::{DrawnWalk, WalkError};
pub use floor::{SimConfig, SimFloor, SimulatedSensors};
pub use floor_clock::Host;
pub use foot::{Foot, FootDriver, Load};
pub use footprint::{Print, PrintCell, shoe_size};
pub use footwear::Footwear;
pub use gait::{Gait, PREFERRED_M_S};
pub use hand::{FootHandle, HandDriver, feet_by_hand};
pub use loadcell::{CalibrationError, calibrated, load_table};
pub use looping_script::LoopingScript;
pub use mapping::{MappingError, mapped, press_table};
pub use performance::Performance;
pub use person::{MoveError, Person};
pub use plate::PlateConfig;
pub use quality::{FloorQuality, UnknownQuality};
pub use recorded::{BadFeet, FeetRecorder, FeetTape, PlayedFeet, RecordedFeet, TakeOver, go_on_from, taped};
pub use reference::reference;
pub use rehearsal::{FaultSwitch, RehearsalSource};
pub use rolling::{Rolling, RollingHabit};
pub use scenario::Scenario;
pub use scene::{PlayedScene, RandomPerson, SceneKind};
pub use script::Script;
pub use seam::SeamConfig;
pub use sensor::{PartConfig, SensorFault};
#[cfg(feature = "net")]
pub use session::{SimulationError, session, session_from_files, session_with};
pub use simulated::{Pace, SimulatedSource};
pub use slide::Slide;
pub use standing::{StandingHabit, standing_on};
pub use visit::{Visit, visit};
pub use watched::{WatchedFeet, watched};

/// Tests the Rust code in the page of this crate.
#[cfg(all(doctest, feature = "net"))]
#[doc = include_str!("../README.md")]
struct Readme;
