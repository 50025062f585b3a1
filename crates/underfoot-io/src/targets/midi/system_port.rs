//! An output port of ALSA, macOS or Windows, by `midir`.

use midir::{MidiOutput, MidiOutputConnection};
use underfoot::messages::MidiTarget;

use super::super::outlet::OutletError;
use super::Urgency;
use super::bytes::MidiBytes;

/// The name of this program among the programs of the system.
const PROGRAM: &str = "underfoot";

/// A port of the system that is open.
pub(super) struct SystemPort(MidiOutputConnection);

impl SystemPort {
    /// Opens a port with the name of the target, or connects to the port that it names.
    pub(super) fn open(target: &MidiTarget) -> Result<Self, OutletError> {
        let gone = |error: &dyn std::fmt::Display| {
            OutletError::Gone(format!("the MIDI port {} can't be opened: {error}", target.port))
        };
        let output = MidiOutput::new(PROGRAM).map_err(|error| gone(&error))?;
        match &target.into {
            Some(into) => connected(output, into, &target.port).map_err(|error| gone(&error)),
            None => virtual_port(output, &target.port).map_err(|error| gone(&error)),
        }
    }

    /// The system does not report that a port has gone.
    pub(super) const fn check(&self) -> Result<(), OutletError> {
        Ok(())
    }

    /// Sends `message` at once.
    pub(super) fn send(&mut self, message: &MidiBytes, _: Urgency) -> Result<(), OutletError> {
        let sent = self.0.send(message.as_slice());
        sent.map_err(|error| OutletError::Gone(format!("the MIDI port has failed: {error}")))
    }

    /// The system does not tell who receives from a port.
    #[allow(clippy::unused_self)]
    pub(super) fn receivers(&mut self) -> Option<Vec<String>> {
        None
    }

    /// As [`Self::receivers`].
    #[allow(clippy::unused_self)]
    pub(super) fn connect(&mut self, _: &[String]) -> Vec<String> {
        Vec::new()
    }
}

/// Connects to the first port with `into` in its name.
fn connected(output: MidiOutput, into: &str, own: &str) -> Result<SystemPort, String> {
    let is_wanted =
        |port: &midir::MidiOutputPort| output.port_name(port).is_ok_and(|name| name.contains(into));
    let port = output.ports().into_iter().find(is_wanted);
    let port = port.ok_or_else(|| format!("there is no port with {into:?} in its name"))?;
    output.connect(&port, own).map(SystemPort).map_err(|error| error.to_string())
}

#[cfg(unix)]
fn virtual_port(output: MidiOutput, name: &str) -> Result<SystemPort, String> {
    use midir::os::unix::VirtualOutput as _;
    output.create_virtual(name).map(SystemPort).map_err(|error| error.to_string())
}

/// Windows has no virtual ports: another program, such as a loop-back driver, provides one.
#[cfg(not(unix))]
fn virtual_port(output: MidiOutput, name: &str) -> Result<SystemPort, String> {
    connected(output, name, name)
}
