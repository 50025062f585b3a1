//! A simulated floor: plates, sensors and feet that make the packets a real floor would.

mod curve;
mod floor;
mod foot;
mod footprint;
mod gait;
mod hand;
mod loadcell;
mod person;
mod plate;
mod scenario;
mod script;
mod sensor;
mod sway;
mod track;
mod written;

pub use floor::{Sensing, SimConfig, SimFloor};
pub use foot::{Foot, FootDriver, Load};
pub use footprint::{Cell, Print, shoe_size};
pub use gait::{Gait, PREFERRED_M_S};
pub use hand::{FootHandle, HandDriver, feet_by_hand};
pub use loadcell::{CalibrationError, calibrated};
pub use person::{MoveError, Performance, Person};
pub use plate::PlateConfig;
pub use scenario::{Problem, Scenario, ScenarioError};
pub use script::Script;
pub use sensor::{PartConfig, SensorFault};
