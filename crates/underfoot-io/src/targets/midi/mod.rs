//! MIDI: one output port for each target.
//!
//! With the feature `jack` it is a port of JACK, by the crate `jack`: `midir` has JACK as well, but does not notice that
//! its server ends, loses the last messages before a port closes, and knows no connections, and the guarantee needs all
//! three. Without that feature it is a port of ALSA, macOS or Windows, by `midir`.

mod bytes;
#[cfg(feature = "jack")]
mod echoes;
#[cfg(feature = "jack")]
mod jack_port;
#[cfg(not(feature = "jack"))]
mod system_port;

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::Builder;
use std::time::Duration;

use underfoot::messages::{Act, Holdable, MidiTarget};

use self::bytes::{pressed, released, said, silenced};
#[cfg(feature = "jack")]
use self::jack_port::JackPort as OpenPort;
#[cfg(not(feature = "jack"))]
use self::system_port::SystemPort as OpenPort;
use super::outlet::{Outlet, OutletError};

/// The urgency of a message for a port that stalls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Urgency {
    /// It goes out at once or not at all.
    Now,
    /// It goes out whenever the port works again, since it lets something come up.
    Whenever,
    /// The same, since a server or a guardian has ended; receivers may miss it the first time.
    Repeated,
}

/// A port of MIDI as a target.
pub(super) struct MidiOutlet {
    name: String,
    port: PortState,
}

enum PortState {
    /// The system takes its time to open a port, on a thread of its own.
    Opening(Receiver<Result<OpenPort, OutletError>>),
    Open(OpenPort),
    /// It could not be opened, for this reason.
    Failed(String),
}

impl MidiOutlet {
    /// Opens the port of `target`.
    pub(super) fn open(target: &MidiTarget) -> Result<Self, OutletError> {
        let (done, opened) = channel();
        let wanted = target.clone();
        // The outlet may be gone.
        let open = move || drop(done.send(OpenPort::open(&wanted)));
        Builder::new()
            .name("midi open".into())
            .spawn(open)
            .map_err(|error| OutletError::Gone(format!("{}: {error}", target.port)))?;
        Ok(Self { name: target.port.clone(), port: PortState::Opening(opened) })
    }

    fn opened(&mut self) -> Result<&mut OpenPort, OutletError> {
        if let PortState::Opening(opened) = &self.port {
            match opened.try_recv() {
                Ok(Ok(port)) => self.port = PortState::Open(port),
                Ok(Err(error)) => self.port = PortState::Failed(error.to_string()),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => {
                    self.port = PortState::Failed(format!("the MIDI port {} can't be opened", self.name));
                }
            }
        }
        match &mut self.port {
            PortState::Open(port) => Ok(port),
            PortState::Failed(reason) => Err(OutletError::Gone(reason.clone())),
            PortState::Opening(_) => {
                Err(OutletError::Refused(format!("the MIDI port {} is not open yet", self.name)))
            }
        }
    }

    fn send(&mut self, messages: &[bytes::MidiBytes], urgency: Urgency) -> Result<(), OutletError> {
        let port = self.opened()?;
        messages.iter().try_for_each(|message| port.send(message, urgency))
    }
}

impl Outlet for MidiOutlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Midi(message) => self.send(&said(*message), Urgency::Now),
            Act::Down(what @ (Holdable::Note(_) | Holdable::Controller(_)), velocity) => {
                self.send(&pressed(what, *velocity), Urgency::Now)
            }
            Act::Up(what @ (Holdable::Note(_) | Holdable::Controller(_))) => {
                self.send(&released(what), Urgency::Whenever)
            }
            _ => {
                Err(OutletError::Refused("a MIDI port has neither keys, a pointer nor OSC addresses".into()))
            }
        }
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        self.send(&released(what), Urgency::Repeated)?;
        self.send(&silenced(what), Urgency::Repeated)
    }

    fn work(&mut self) -> Result<Option<Duration>, OutletError> {
        match self.opened() {
            Ok(port) => port.check().map(|()| None),
            Err(OutletError::Refused(_)) => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn is_opening(&mut self) -> bool {
        matches!(self.opened(), Err(OutletError::Refused(_)))
    }

    fn receivers(&mut self) -> Option<Vec<String>> {
        self.opened().ok()?.receivers()
    }

    fn connect(&mut self, receivers: &[String]) -> Result<Vec<String>, OutletError> {
        Ok(self.opened()?.connect(receivers))
    }
}
