//! A simulated floor: plates, sensors and feet that make the packets a real floor would.

mod floor;
mod foot;
mod footprint;
mod loadcell;
mod plate;
mod sensor;

pub use floor::{Sensing, SimConfig, SimFloor};
pub use foot::{Foot, FootDriver, Load};
pub use footprint::{Cell, Print, shoe_size};
pub use loadcell::{CalibrationError, calibrated};
pub use plate::PlateConfig;
pub use sensor::{PartConfig, SensorFault};
