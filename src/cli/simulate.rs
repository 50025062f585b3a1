use std::net::{SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use underfoot::sim::{self, Scenario, Script, SimConfig, SimFloor};
use underfoot::source::{Pace, SensorSource, SimulatedSource, SourceError};
use underfoot::wire::{SensorEncoder, SensorFormat};
use underfoot::floor::{Floor, Geometry};
use underfoot::layout::Layout;
use underfoot::schema;

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::layout_args::LayoutArgs;
use super::stop::stop_flag;

/// What `underfoot simulate` is asked to do.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Scenario file; without it, the built-in session on the built-in map layout.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// The layout whose controls the scenario names (a file or a built-in name).
    #[arg(long, value_name = "LAYOUT")]
    layout: Option<PathBuf>,
    #[command(flatten)]
    floor: FloorArgs,
    /// Where the boards send their packets.
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1:9000")]
    send: SocketAddr,
    /// What the boards send.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Which floor of its kind: sensors and noise follow from this number.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Perfect sensors: alike, exact, without noise.
    #[arg(long)]
    ideal: bool,
    /// Calibrate the simulated floor as a lab would, write its floor file, and go on.
    #[arg(long, value_name = "FILE")]
    write_floor: Option<PathBuf>,
    /// Play the scenario again and again.
    #[arg(long = "loop")]
    again: bool,
}

#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum Format {
    /// Raw 16-bit counts, one OSC integer per channel.
    #[default]
    Counts,
    /// Newtons, one OSC float per channel.
    Newtons,
    /// Raw counts in one OSC blob, big-endian.
    Blob,
}
