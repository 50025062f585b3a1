//! Outputs for samples and events: sound cards, files, other programs.

#[cfg(feature = "net")]
mod backlog;
mod channel_map;
mod crack_rate;
#[cfg(feature = "audio")]
mod device;
#[cfg(any(feature = "wav", feature = "record"))]
mod disk;
mod fanout;
#[cfg(feature = "net")]
mod json;
mod latency;
mod lockstep;
mod manual;
#[cfg(feature = "wav")]
mod mono;
#[cfg(feature = "net")]
mod osc;
#[cfg(feature = "net")]
mod periodic;
#[cfg(feature = "net")]
mod priority;
#[cfg(feature = "net")]
mod realtime;
mod report;
mod silent;
mod since;
mod stereo;
#[cfg(feature = "net")]
mod tuio;
#[cfg(feature = "net")]
mod udp;
mod wait_free;
#[cfg(all(unix, feature = "net"))]
mod watchdog;
#[cfg(feature = "wav")]
mod wav;
mod within;
#[cfg(feature = "net")]
mod worker;

use thiserror::Error;

use crate::feel::DeviceStatus;
use crate::units::Instant;

pub use crate::outgoing::{AreaNews, AreaState, HeldReport, TuioProfiles};
pub use channel_map::ChannelMap;
#[cfg(feature = "audio")]
pub use device::{DeviceEntry, DeviceOptions, DeviceSink, Mix, OutputDevice, output_devices};
#[cfg(any(feature = "wav", feature = "record"))]
pub(crate) use disk::Disk;
pub use fanout::Fanout;
#[cfg(feature = "net")]
pub use json::JsonSink;
pub use manual::ManualSink;
#[cfg(feature = "wav")]
pub use mono::write_mono;
#[cfg(feature = "net")]
pub use osc::OscSink;
pub use report::Report;
pub use silent::SilentSink;
pub use since::Since;
pub use stereo::StereoSink;
#[cfg(feature = "net")]
pub use tuio::{TuioSink, TuioVersion};
pub use wait_free::{SharedSender, WaitFreeReceiver, WaitFreeSender, wait_free, wait_free_shared};
#[cfg(all(unix, feature = "net"))]
pub use watchdog::Watchdog;
#[cfg(feature = "wav")]
pub use wav::{WavFormat, WavOptions, WavSink, WavSummary, WhenFull};
pub use within::ContactsWithin;
#[cfg(feature = "net")]
pub(crate) use worker::Worker;

pub use crack_rate::{CrackNews, CrackRateLimiter};
pub use latency::{Bucket, HandedOn, LatencyMeter, LatencyProbe, LatencyStages, LatencySummary};
#[cfg(feature = "net")]
pub use priority::{Rank, claim_priority, step_back};
#[cfg(feature = "net")]
pub use realtime::RealTime;

/// A sink for the renderer's samples.
pub trait ActuatorSink {
    /// Plays everything up to `now` on the floor's sample clock; a device with a clock of its own ignores the call.
    ///
    /// # Errors
    /// [`SinkError`] if the sink can no longer play samples.
    fn advance(&mut self, now: Instant) -> Result<(), SinkError>;

    /// Writes the status of the device into `status`; false if there is no device.
    fn device(&self, _status: &mut DeviceStatus) -> bool {
        false
    }
}

/// A sink for reports to other programs; it never blocks its caller.
pub trait EventSink: Send {
    /// Accepts one report; reports come in order.
    fn report(&mut self, report: &Report<'_>);

    /// Sends periodic and delayed reports. Called every few milliseconds, also while no frames come.
    fn poll(&mut self, _now: Instant) {}

    /// Returns the number of reports lost since the start: the receiver was too slow or absent.
    fn dropped(&self) -> u64 {
        0
    }
}

/// Reasons why a sink cannot accept samples.
#[derive(Debug, Error)]
pub enum SinkError {
    /// There is no such device, or it is in use; `message` gives advice.
    #[error("{message}")]
    Device {
        /// One sentence for the person who started the program.
        message: String,
    },
    /// Events cannot be sent or written; `message` gives advice.
    #[error("{message}")]
    Output {
        /// One sentence for the person who started the program.
        message: String,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error("cannot write {path}: {source}")]
    File {
        /// The file.
        path: std::path::PathBuf,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
}
