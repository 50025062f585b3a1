//! One way out: the seam between messages and the systems that receive them.

use std::time::Duration;

use thiserror::Error;
use underfoot::messages::{Act, Destination, Holdable, SendTarget};

use super::osc::OscOutlet;

/// Carries out orders at one target.
pub trait Outlet: Send {
    /// Carries out `act` at once.
    ///
    /// # Errors
    /// The act was not carried out: [`OutletError::Refused`] for this one only, [`OutletError::Gone`] if the target
    /// must be opened again.
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError>;

    /// Lets `what` come up, also if another program holds it down.
    ///
    /// # Errors
    /// As [`Outlet::carry_out`].
    fn release(&mut self, what: &Holdable) -> Result<(), OutletError>;

    /// Does what is due by now: states that wait for their time go out, a lost connection is made again. Returns the time
    /// until it must be called again; `None` for a target that has nothing to do by itself.
    ///
    /// # Errors
    /// The target cannot be reached; it tries again by itself, and stays open.
    fn work(&mut self) -> Result<Option<Duration>, OutletError> {
        Ok(None)
    }

    /// Forgets the states of an earlier layout.
    fn forget(&mut self) {}

    /// Says goodbye before the process ends in order.
    fn end(&mut self) {}

    /// Whether the way is still being opened.
    fn is_opening(&mut self) -> bool {
        false
    }

    /// The ports that receive from this target by connections that others may make and break; `None` for a target that
    /// knows of none.
    fn receivers(&mut self) -> Option<Vec<String>> {
        None
    }

    /// Connects this target to ports that received from the same one before; returns those that are not there.
    ///
    /// # Errors
    /// As [`Outlet::carry_out`].
    fn connect(&mut self, _receivers: &[String]) -> Result<Vec<String>, OutletError> {
        Ok(Vec::new())
    }
}

/// Reasons why an act was not carried out.
#[derive(Debug, Error)]
pub enum OutletError {
    /// The target does not take this act; it takes others.
    #[error("{0}")]
    Refused(String),
    /// The target cannot be reached.
    #[error("{0}")]
    Gone(String),
}

/// Opens the way to `target`.
///
/// # Errors
/// The target cannot be reached now.
pub(super) fn open(target: &SendTarget) -> Result<Box<dyn Outlet>, OutletError> {
    match &target.to {
        Destination::Osc(osc) => Ok(Box::new(OscOutlet::open(osc)?)),
        #[cfg(any(feature = "midi", feature = "jack"))]
        Destination::Midi(midi) => Ok(Box::new(super::midi::MidiOutlet::open(midi)?)),
        #[cfg(not(any(feature = "midi", feature = "jack")))]
        Destination::Midi(midi) => Err(OutletError::Gone(format!(
            "the MIDI port {}: this program was built without the features midi and jack",
            midi.port
        ))),
        #[cfg(feature = "dmx")]
        Destination::ArtNet(_) | Destination::Sacn(_) => Ok(Box::new(super::dmx::DmxOutlet::open(target)?)),
        #[cfg(not(feature = "dmx"))]
        Destination::ArtNet(_) | Destination::Sacn(_) => Err(left_out("dmx")),
        #[cfg(feature = "mqtt")]
        Destination::Mqtt(mqtt) => Ok(Box::new(super::mqtt::MqttOutlet::open(mqtt)?)),
        #[cfg(not(feature = "mqtt"))]
        Destination::Mqtt(_) => Err(left_out("mqtt")),
        #[cfg(feature = "run")]
        Destination::Run(program) => Ok(Box::new(super::run::ProgramOutlet::open(program)?)),
        #[cfg(not(feature = "run"))]
        Destination::Run(_) => Err(left_out("run")),
        #[cfg(all(unix, not(target_os = "macos")))]
        Destination::Keyboard(keyboard) => Ok(Box::new(super::x11::X11Outlet::open(keyboard)?)),
        #[cfg(not(all(unix, not(target_os = "macos"))))]
        Destination::Keyboard(_) => {
            Err(OutletError::Gone("keys and pointer work under X11 only so far".into()))
        }
    }
}

#[cfg(not(all(feature = "dmx", feature = "mqtt", feature = "run")))]
fn left_out(feature: &str) -> OutletError {
    OutletError::Gone(format!("this program was built without the feature {feature}"))
}
