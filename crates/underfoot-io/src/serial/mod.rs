//! Boards behind serial ports: OSC in SLIP frames, or lines of text.
//!
//! Each port has a thread that opens it, stamps and decodes the bytes, and opens it again after it was unplugged. The
//! packets reach the sensing thread through a bounded queue. [`SerialPorts::beside`] mixes them with the packets of
//! another input, such as a UDP socket, and both sorts of boards are parts of one floor.
//!
//! ```no_run
//! use underfoot::floor::{Floor, SerialWire};
//! use underfoot::source::{FloorInput, UdpSource};
//! use underfoot_io::serial::{IfAbsent, SerialPorts};
//!
//! let floor = Floor::default();
//! let network = UdpSource::bind(([127, 0, 0, 1], 9000).into(), &floor)?;
//! let wires = [SerialWire::slip("usb:A9003XYZ".parse()?)];
//! let ports = SerialPorts::open(&wires, &floor, network.clock(), IfAbsent::Refuse)?;
//! let input = ports.beside(FloorInput::from(network));
//! # drop(input);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod beside;
mod decode;
mod device;
mod find;
mod probe;
mod sequence;
mod thread;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::JoinHandle;

use thiserror::Error;
use underfoot::floor::{Floor, PortName, SerialWire};
use underfoot::source::FloorInput;
use underfoot::units::HostClock;
use underfoot::wire::{LinkCause, LinkCounters, SensorPacket};

pub use self::find::{absent, plugged_ports};
pub use self::probe::{PortPart, PortProbe};
use self::thread::PortThread;

/// Maximum number of waiting news: one second of 16 boards. Packets beyond are counted as overflowed.
const MAX_NEWS: usize = 16_384;

/// Reason for which a serial port is not used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SerialError {
    /// A port of the floor file has no name, and none was given.
    #[error(
        "port {number} of `serial` in the floor file has no name: give --serial PORT, or write port: there"
    )]
    Nameless {
        /// Its place in the list, from 1.
        number: usize,
    },
    /// Two wires name one port.
    #[error("the serial port {0} is named twice")]
    Twice(PortName),
    /// The system has no such port.
    #[error("there is no serial port {port}: {help}")]
    Absent {
        /// Its name.
        port: PortName,
        /// The remedy, with the ports of this machine.
        help: String,
    },
    /// The system does not open it.
    #[error("the serial port {port} does not open: {source}{remedy}")]
    Closed {
        /// Its name.
        port: PortName,
        /// The rest of the sentence for the user of the program; empty if no remedy is known.
        remedy: &'static str,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
    /// The system starts no thread.
    #[error("no thread for a serial port: {0}")]
    Thread(#[source] std::io::Error),
}

/// The action for a port that is absent at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IfAbsent {
    /// An error.
    Refuse,
    /// Waits until it is plugged in.
    Wait,
}

/// Returns the serial ports of `floor` and of `named`: ports of the file without a name get those of `named` in order,
/// and each further one carries OSC in SLIP frames.
///
/// # Errors
/// [`SerialError::Nameless`] if there are too few names, [`SerialError::Twice`] if two are equal.
pub fn wires(floor: &Floor, named: &[PortName]) -> Result<Vec<SerialWire>, SerialError> {
    let mut names = named.iter().cloned();
    let mut wires = Vec::new();
    for (number, wire) in (1..).zip(&floor.serial) {
        let port = wire.port.clone().or_else(|| names.next()).ok_or(SerialError::Nameless { number })?;
        wires.push(SerialWire { port: Some(port), ..wire.clone() });
    }
    wires.extend(names.map(SerialWire::slip));
    let is_twice = |(index, wire): (usize, &SerialWire)| {
        let earlier = wires.iter().take(index).any(|other| other.port == wire.port);
        wire.port.clone().filter(|_| earlier)
    };
    match wires.iter().enumerate().find_map(is_twice) {
        Some(port) => Err(SerialError::Twice(port)),
        None => Ok(wires),
    }
}

/// News of a port for the sensing thread.
#[derive(Debug)]
enum News {
    /// A sample of a board.
    Packet(SensorPacket),
    /// Counts since the last news of this kind.
    Counts(LinkCounters),
    /// The cause of the last refusal.
    Refused(LinkCause),
}

/// Open serial ports of one floor; dropping them closes all.
#[derive(Debug)]
pub struct SerialPorts {
    news: Receiver<News>,
    clock: HostClockOf,
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

/// A clock that can be shown in debug output.
struct HostClockOf(HostClock);

impl std::fmt::Debug for HostClockOf {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("HostClock")
    }
}

impl SerialPorts {
    /// Opens the ports of `wires` for the boards of `floor`; `clock` stamps their packets and is that of the input
    /// beside them.
    ///
    /// # Errors
    /// [`SerialError`] of the first port that cannot be used; its message gives the remedy.
    pub fn open(
        wires: &[SerialWire],
        floor: &Floor,
        clock: HostClock,
        if_absent: IfAbsent,
    ) -> Result<Self, SerialError> {
        let (sender, news) = sync_channel(MAX_NEWS);
        let stop = Arc::<AtomicBool>::default();
        let mut ports =
            Self { news, clock: HostClockOf(clock), stop: Arc::clone(&stop), threads: Vec::new() };
        for (number, wire) in (1..).zip(wires) {
            let name = wire.port.clone().ok_or(SerialError::Nameless { number })?;
            let device = match device::open(&name, wire.baud) {
                Err(SerialError::Absent { .. }) if if_absent == IfAbsent::Wait => None,
                opened => Some(opened?),
            };
            let thread = PortThread::new(wire, name, floor, ports.clock.0.clone(), sender.clone());
            ports.threads.push(thread.start(device, Arc::clone(&stop)).map_err(SerialError::Thread)?);
        }
        Ok(ports)
    }

    /// Mixes the packets of these ports with those of `input`, whose requests, replay and journals stay as they are.
    #[must_use]
    pub fn beside(self, input: FloorInput) -> FloorInput {
        beside::beside(self, input)
    }
}

impl Drop for SerialPorts {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            if thread.join().is_err() {
                tracing::error!("the thread of a serial port failed");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(names: &[&str]) -> Vec<PortName> {
        names.iter().map(|name| name.parse().unwrap()).collect()
    }

    #[test]
    fn names_go_to_the_nameless_ports_of_the_file_and_then_to_slip() {
        let nameless = SerialWire { port: None, ..SerialWire::slip(named(&["x"]).remove(0)) };
        let fast = SerialWire { baud: 1_000_000, ..nameless.clone() };
        let fixed = SerialWire::slip(named(&["COM3"]).remove(0));
        let floor = Floor { serial: vec![fast, fixed, nameless], ..Floor::default() };
        let found = wires(&floor, &named(&["a", "b", "c"])).unwrap();
        let found: Vec<(String, u32)> =
            found.iter().map(|wire| (wire.port.as_ref().unwrap().to_string(), wire.baud)).collect();
        let expected = [("a", 1_000_000), ("COM3", 115_200), ("b", 115_200), ("c", 115_200)];
        assert_eq!(found, expected.map(|(name, baud)| (name.to_owned(), baud)));
        let few = wires(&floor, &named(&["a"])).unwrap_err();
        assert!(matches!(few, SerialError::Nameless { number: 3 }), "{few}");
        for twice in [["a", "COM3"], ["a", "a"]] {
            let error = wires(&floor, &named(&twice)).unwrap_err();
            assert!(matches!(error, SerialError::Twice(_)), "{error}");
        }
    }
}
