//! Where samples and events go: sound cards, files, other programs.

#[cfg(feature = "audio")]
mod device;
mod latency;
mod lockstep;
mod manual;
mod wav;

use thiserror::Error;

use crate::sense::Contact;
use crate::units::Instant;
use crate::widget::WidgetEvent;

#[cfg(feature = "audio")]
pub use device::{DeviceOptions, DeviceSink, DeviceStatus, Mix, OutputDevice, output_device_names};
pub use latency::{HostClock, LatencyMeter, LatencyProbe, LatencySummary};
pub use manual::ManualSink;
pub use wav::{WavFormat, WavOptions, WavSink, WavSummary, WhenFull};

/// Something that plays the renderer's samples.
pub trait ActuatorSink {
    /// Plays everything up to `now` on the floor's sample clock; a device with a clock of its own ignores it.
    ///
    /// # Errors
    /// [`SinkError`] if samples can no longer be taken.
    fn advance(&mut self, now: Instant) -> Result<(), SinkError>;
}

/// Something that tells other programs what happened; it never blocks its caller.
pub trait EventSink: Send {
    /// Takes the events of one frame, in order; may be empty.
    fn events(&mut self, events: &[WidgetEvent]);

    /// Takes the contacts of one frame; called for every frame, so a sink thins them out itself.
    fn contacts(&mut self, at: Instant, contacts: &[Contact]);
}

/// Why a sink cannot take samples.
#[derive(Debug, Error)]
pub enum SinkError {
    /// There is no such device, or it is in use; `message` says what to do.
    #[error("{message}")]
    Device {
        /// One sentence for the person who started the program.
        message: String,
    },
    /// The file cannot be written.
    #[error("cannot write {path}: {source}")]
    File {
        /// Which file.
        path: std::path::PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
}
