//! DMX: one universe for each target, by Art-Net or sACN.
//!
//! ```text
//! level of a value  -> the latest levels, at most 44 packets a second, the rate of DMX itself
//! hold, its end     -> a packet at once
//! after each change -> three more packets, so that a lost one does no harm
//! otherwise         -> a packet every 0.8 s: receivers give up a source that is silent
//! ```
//!
//! A packet has all channels. So the outlet keeps the levels when a packet fails, and goes on with the latest ones.

mod packet;
#[cfg(all(test, unix))]
mod tests;
mod universe;

use std::io;
use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
use std::thread;
use std::time::{Duration, Instant};

use socket2::{Domain, Protocol, Socket, Type};
use underfoot::messages::{Act, Destination, Holdable, SendTarget};

use self::packet::UniversePackets;
use self::universe::Universe;
use super::outlet::{Outlet, OutletError};

/// Shortest time between two packets of values: DMX itself has 44 a second at most.
const PACE: Duration = Duration::from_millis(23);

/// Time between two packets without changes (E1.31 asks for 0.8 s to 1 s, Art-Net for less than 4 s).
const ALIVE: Duration = Duration::from_millis(800);

/// Number of packets that repeat a change.
const REPEATS: u8 = 3;

/// A universe of lights.
pub(super) struct DmxOutlet {
    socket: UdpSocket,
    packets: UniversePackets,
    universe: Universe,
    /// Whether the channels of a layout are still being set: they go out together.
    begins: bool,
    /// The time of the last packet.
    sent: Option<Instant>,
    /// The number of packets that must go out at the pace of values; more than [`REPEATS`] for a change that has not gone
    /// out yet.
    due: u8,
    /// The failure of the last packet.
    failed: Option<String>,
}

impl DmxOutlet {
    /// Opens a socket to the universe of `target`.
    pub(super) fn open(target: &SendTarget) -> Result<Self, OutletError> {
        let gone = |error: io::Error| OutletError::Gone(format!("no packets of DMX can be sent: {error}"));
        let missing = || OutletError::Gone("this is no universe of DMX".into());
        let packets = UniversePackets::new(target).ok_or_else(missing)?;
        let via = match &target.to {
            Destination::Sacn(sacn) => sacn.via.as_deref().and_then(|via| via.parse().ok()),
            _ => None,
        };
        let socket = socket(via).map_err(gone)?;
        let universe = Universe::default();
        Ok(Self { socket, packets, universe, begins: true, sent: None, due: REPEATS + 1, failed: None })
    }

    /// Sends the levels at once; a failure leaves them for the next time.
    fn send(&mut self) -> Result<(), OutletError> {
        let receiver = self.packets.receiver();
        for packet in self.packets.of(&self.universe, self.sent.is_none())? {
            if let Err(error) = self.socket.send_to(&packet, receiver) {
                self.failed = Some(format!("{receiver}: {error}"));
                return self.standing();
            }
        }
        self.failed = None;
        (self.sent, self.begins) = (Some(Instant::now()), false);
        self.due = self.due.saturating_sub(1);
        Ok(())
    }

    /// The failure of the last packet, since which nothing has gone out.
    fn standing(&self) -> Result<(), OutletError> {
        self.failed.clone().map_or(Ok(()), |problem| Err(OutletError::Refused(problem)))
    }

    /// Sends the levels after a change that must not wait.
    fn send_now(&mut self) -> Result<(), OutletError> {
        self.due = REPEATS + 1;
        self.send()
    }
}

impl Outlet for DmxOutlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Dmx(level) => {
                if self.universe.set(*level) {
                    self.due = REPEATS + 1;
                }
                self.standing()
            }
            Act::Down(Holdable::Dmx(settings), _) => {
                self.universe.set(settings.with(settings.top()));
                self.send_now()
            }
            Act::Up(Holdable::Dmx(settings)) => {
                self.universe.set(settings.with(settings.from));
                self.send_now()
            }
            _ => Err(OutletError::Refused("a universe of DMX has channels only".into())),
        }
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        let Holdable::Dmx(settings) = what else { return Ok(()) };
        let was_down = self.universe.set(settings.with(settings.from));
        let is_unsent = was_down || self.due > REPEATS;
        if is_unsent && !self.begins { self.send_now() } else { self.standing() }
    }

    fn work(&mut self) -> Result<Option<Duration>, OutletError> {
        let rest = if self.due > 0 { PACE } else { ALIVE };
        let waits = self.sent.map_or(Duration::ZERO, |sent| rest.saturating_sub(sent.elapsed()));
        if !waits.is_zero() {
            return self.standing().map(|()| Some(waits));
        }
        self.send()?;
        Ok(Some(if self.due > 0 { PACE } else { ALIVE }))
    }

    fn forget(&mut self) {
        (self.universe, self.begins, self.due) = (Universe::default(), true, REPEATS + 1);
    }

    fn end(&mut self) {
        // The last levels also reach a receiver that lost a packet; a failure has been reported before.
        for _ in 0..REPEATS {
            thread::sleep(PACE);
            let _ = self.send();
        }
        for packet in self.packets.farewell() {
            let _ = self.socket.send_to(&packet, self.packets.receiver());
        }
    }
}

/// A socket that sends to all receivers, its multicasts by the network card with the address `via`.
fn socket(via: Option<Ipv4Addr>) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, Some(Protocol::UDP))?;
    socket.set_nonblocking(true)?;
    socket.set_broadcast(true)?;
    socket.bind(&SocketAddrV4::new(via.unwrap_or(Ipv4Addr::UNSPECIFIED), 0).into())?;
    if let Some(via) = via {
        socket.set_multicast_if_v4(&via)?;
    }
    Ok(socket.into())
}
