//! Opening serial ports, with errors that name the remedy.

use std::io::{Error, ErrorKind, Read, Write};
use std::time::Duration;

use serialport::SerialPort;
use underfoot::floor::PortName;

use super::SerialError;
use super::find::{absent, find};

/// Maximum time that a read waits for a byte: a thread that has to stop, or to ask again, does so this late.
const WAIT: Duration = Duration::from_millis(10);

/// An open port.
pub(super) struct Device(Box<dyn SerialPort>);

/// The result of a read.
#[derive(Debug)]
pub(super) enum PortRead {
    /// So many bytes.
    Bytes(usize),
    /// None in time.
    Nothing,
    /// The port is gone.
    Gone(Error),
}

/// Opens `name`, raw, for this program alone, with 8 data bits, no parity and one stop bit. The terminal counts as
/// ready: some boards send only then, others start anew.
pub(super) fn open(name: &PortName, baud: u32) -> Result<Device, SerialError> {
    let Some(path) = find(name) else {
        let help = absent(name).unwrap_or_else(|| "it has just gone".to_owned());
        return Err(SerialError::Absent { port: name.clone(), help });
    };
    let opened = serialport::new(path, baud).timeout(WAIT).dtr_on_open(true).open();
    opened.map(Device).map_err(|error| {
        let is_busy = error.kind() == serialport::ErrorKind::NoDevice;
        let source = Error::from(error);
        let remedy = match source.kind() {
            ErrorKind::PermissionDenied => {
                "; on Linux, `sudo usermod -aG dialout $USER` permits it after the next login"
            }
            _ if is_busy => "; another program may have it open",
            _ => "",
        };
        SerialError::Closed { port: name.clone(), remedy, source }
    })
}

impl Device {
    /// Reads the bytes that have arrived; waits 10 ms for the first.
    pub(super) fn read(&mut self, buffer: &mut [u8]) -> PortRead {
        match self.0.read(buffer) {
            Ok(0) => PortRead::Gone(ErrorKind::UnexpectedEof.into()),
            Ok(count) => PortRead::Bytes(count),
            Err(error) if is_passing(error.kind()) => PortRead::Nothing,
            Err(error) => PortRead::Gone(error),
        }
    }

    /// Changes the bits a second; false if the port does not take them.
    pub(super) fn set_baud(&mut self, baud: u32) -> bool {
        self.0.set_baud_rate(baud).is_ok()
    }

    /// Sends a request; false if the port does not take it. A port that is gone is noticed by reading.
    pub(super) fn send(&mut self, request: &[u8]) -> bool {
        self.0.write_all(request).is_ok()
    }
}

const fn is_passing(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::TimedOut | ErrorKind::Interrupted | ErrorKind::WouldBlock)
}
