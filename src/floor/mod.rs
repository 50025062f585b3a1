//! The floor: its geometry, and the sensors and actuators under it.
//!
//! Floor space has its origin at the south-west corner of the floor, x east (right), y north (away from the user), in
//! metres. [`Geometry`] gives the places of tiles and sensors; [`Floor`] adds the hardware wired to them.

mod address;
mod area;
mod block;
mod calibration;
mod contact_id;
mod count_range;
mod drive;
mod exp;
mod floor_file;
mod geometry;
mod geometry_build;
mod geometry_error;
mod halo;
mod hardware;
mod laws;
mod network;
mod position_map;
mod record;
mod rect;
mod sensor_choice;
mod sensor_places;
mod serial;
mod significant;
mod tile_id;
mod uneven;

pub use area::{Area, SENSED_BEYOND_M};
pub use block::TileBlock;
pub use calibration::{Calibration, LawKind};
pub use contact_id::ContactId;
pub use count_range::{CountRange, CountSign};
pub use drive::{Drive, Loudspeaker, Response};
pub use floor_file::FloorFile;
pub use geometry::Geometry;
pub use geometry_error::GeometryError;
pub use halo::Forwarding;
pub use hardware::{Actuator, Board, Floor};
pub use laws::{Divider, Exponential, Linear, Power};
pub use network::{Network, NotANetwork};
pub use position_map::PositionMap;
pub use record::{CalibrationRecord, Day, MapRecord, NotADay};
pub use rect::Rect;
pub use sensor_choice::{NoSuchSensor, SensorChoice};
pub use sensor_places::{SensorPlaces, SensorPlacesError};
pub use serial::{NotAPort, PortName, SerialWire, TextLines, TextNumbers};
pub use tile_id::{Corner, SensorId, TileId};
pub use uneven::OwnPlate;
pub(crate) use {
    address::ADDRESS, exp::exp, network::NETWORK, record::DAY, serial::PORT, serial::RequestEnd,
};

pub use address::{NotAnAddress, canonical, read_address};
