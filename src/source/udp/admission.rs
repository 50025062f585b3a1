//! Admission of datagrams: allowed networks, limits for each sender, and boards pinned to their first address.

use std::fmt;
use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

use arrayvec::ArrayVec;

use super::senders::Senders;
use crate::floor::{Board, Floor, Network};
use crate::units::Instant;
use crate::wire::{BOARD_RATES_HZ, Batch, LinkCounters};

/// Multiple of a board's rate in the floor file that a sender may send.
const MORE_THAN_WRITTEN: f32 = 2.0;

/// Least limit of a sender (1/s): twice the rate of a board that sends once a millisecond.
const FEWEST_HZ: f32 = 2000.0;

/// Packets a second of a board without a written rate: a quarter more than the fastest ones send.
const UNWRITTEN_HZ: f32 = 1.25 * BOARD_RATES_HZ[1];

/// Time for which a sender may send all its packets at once after a silence.
const BURST: Duration = Duration::from_millis(500);

/// Rate and burst of requests of one app: ten controls at the rate of a screen, and the state of every control of a
/// large layout at once.
const REQUEST_EVERY: Duration = Duration::from_millis(1);
const REQUEST_BURST: u32 = 2000;

/// The way in which OSC arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OscArrival {
    /// On the sensors' port, directly from boards or apps.
    Plain,
    /// On the sensors' port, sealed by another computer of the floor.
    Sealed,
    /// On the requests' own port.
    OwnPort,
}

/// Reasons to refuse a datagram of a known form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AdmissionRefusal {
    /// The sender is in no allowed network.
    Foreign,
    /// The sender may not send sensor packets.
    Packets,
    /// The sender may not send requests, or not on this port.
    Requests,
    /// The board's first packet came from this other address.
    Elsewhere(u16, IpAddr),
    /// The sender exceeded its rate limit.
    TooMany,
}

impl AdmissionRefusal {
    pub(super) fn count(self, counters: &mut LinkCounters) {
        match self {
            Self::TooMany => counters.limited += 1,
            Self::Foreign | Self::Packets | Self::Requests | Self::Elsewhere(..) => counters.foreign += 1,
        }
    }
}

impl fmt::Display for AdmissionRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign | Self::Packets => {
                f.write_str("sensor packets are not taken from there, since `allow` does not name its address")
            }
            Self::Requests => {
                f.write_str(
                    "requests are not taken from there: only from this machine, or on a port of their own from the \
                     networks named for it",
                )
            }
            Self::Elsewhere(board, known) => write!(f, "board {board} was first heard from {known}"),
            Self::TooMany => write!(f, "it sends more than a sender may"),
        }
    }
}

/// Maximum number of packets of `board` a second.
fn most_hz(board: &Board) -> f32 {
    board.rate_hz.map_or(UNWRITTEN_HZ, |hz| (MORE_THAN_WRITTEN * hz).max(FEWEST_HZ))
}

/// The admission rules of one source.
#[derive(Debug)]
pub(super) struct Admission {
    boards: Vec<Network>,
    /// Networks of apps; on the sensors' port unless requests have their own port.
    apps: Vec<Network>,
    has_own_port: bool,
    /// Other computers of the floor, which send sealed datagrams.
    computers: Vec<IpAddr>,
    datagrams: Senders,
    requests: Senders,
    /// First address of each board, if boards are pinned.
    homes: Option<Vec<Option<IpAddr>>>,
}

impl Admission {
    /// Allows boards from the floor's networks, or from this machine if it lists none; apps from this machine.
    pub(super) fn new(floor: &Floor) -> Self {
        // One computer may send for all boards.
        let hz = floor.boards.iter().map(most_hz).sum::<f32>().max(FEWEST_HZ);
        let every = Duration::from_secs_f32(hz.recip());
        // The cast saturates.
        let burst = (BURST.as_secs_f32() * hz) as u32;
        Self {
            boards: if floor.allow.is_empty() { Network::LOOPBACK.into() } else { floor.allow.clone() },
            apps: Network::LOOPBACK.into(),
            has_own_port: false,
            computers: Vec::new(),
            datagrams: Senders::new(burst, every),
            requests: Senders::new(REQUEST_BURST, REQUEST_EVERY),
            homes: None,
        }
    }

    pub(super) fn set_boards(&mut self, boards: Vec<Network>) {
        self.boards = boards;
    }

    /// Also allows board packets from these networks.
    pub(super) fn add_boards(&mut self, boards: impl Iterator<Item = Network>) {
        self.boards.extend(boards);
    }

    /// Allows sealed datagrams from these computers.
    pub(super) fn set_computers(&mut self, computers: Vec<IpAddr>) {
        self.computers = computers;
    }

    /// Allows requests from these networks on the sensors' port.
    pub(super) fn set_apps_here(&mut self, apps: Vec<Network>) {
        self.apps = apps;
    }

    /// Allows requests from `apps`, on a port of their own only.
    pub(super) fn set_apps(&mut self, apps: Vec<Network>) {
        self.apps = apps;
        self.has_own_port = true;
    }

    /// Pins `boards` boards to the addresses of their first packets.
    pub(super) fn pin(&mut self, boards: usize) {
        self.homes = Some(vec![None; boards]);
    }

    fn is_app(&self, ip: IpAddr) -> bool {
        self.apps.iter().any(|network| network.contains(ip))
    }

    fn is_board(&self, ip: IpAddr) -> bool {
        self.boards.iter().any(|network| network.contains(ip))
    }

    fn is_computer(&self, ip: IpAddr) -> bool {
        self.computers.iter().any(|computer| computer.to_canonical() == ip.to_canonical())
    }

    /// Accepts a sealed datagram from the floor's computers only.
    pub(super) fn sealed(&self, sender: SocketAddr, on_own_port: bool) -> Result<(), AdmissionRefusal> {
        (!on_own_port && self.is_computer(sender.ip())).then_some(()).ok_or(AdmissionRefusal::Foreign)
    }

    /// Whether to examine a datagram from `sender` at all.
    pub(super) fn datagram(
        &mut self,
        sender: SocketAddr,
        on_own_port: bool,
        now: Instant,
    ) -> Result<(), AdmissionRefusal> {
        let takes_requests = on_own_port == self.has_own_port;
        let is_known = (!on_own_port && (self.is_board(sender.ip()) || self.is_computer(sender.ip())))
            || (takes_requests && self.is_app(sender.ip()));
        match (is_known, on_own_port) {
            (false, true) => Err(AdmissionRefusal::Requests),
            (false, false) => Err(AdmissionRefusal::Foreign),
            (true, true) => Ok(()),
            (true, false) => self.datagrams.take(sender, now).then_some(()).ok_or(AdmissionRefusal::TooMany),
        }
    }

    /// Removes from `batch` everything that `sender` may not send; returns each reason once.
    pub(super) fn batch(
        &mut self,
        sender: SocketAddr,
        way: OscArrival,
        batch: &mut Batch,
        now: Instant,
    ) -> ArrayVec<AdmissionRefusal, 3> {
        let mut refusals = ArrayVec::new();
        let takes_packets = match way {
            OscArrival::Plain => self.is_board(sender.ip()),
            OscArrival::Sealed => true,
            OscArrival::OwnPort => false,
        };
        if !batch.packets.is_empty() && !takes_packets {
            batch.packets.clear();
            refusals.push(AdmissionRefusal::Packets);
        }
        if !batch.controls.is_empty() && !self.is_answered(sender, way) {
            batch.controls.clear();
            refusals.push(AdmissionRefusal::Requests);
        }
        let admitted = batch.controls.iter().take_while(|_| self.request(sender, now).is_ok()).count();
        if admitted < batch.controls.len() {
            batch.controls.truncate(admitted);
            refusals.push(AdmissionRefusal::TooMany);
        }
        let ip = sender.ip().to_canonical();
        let Some(homes) = &mut self.homes else { return refusals };
        let mut elsewhere = None;
        batch.packets.retain(|packet| {
            let Some(home) = homes.get_mut(usize::from(packet.board)) else { return true };
            let known = *home.get_or_insert(ip);
            if known != ip {
                elsewhere = Some(AdmissionRefusal::Elsewhere(packet.board, known));
            }
            known == ip
        });
        refusals.extend(elsewhere);
        refusals
    }

    /// Counts one more request of `sender`, also an invalid one; an error if it exceeds the limit.
    pub(super) fn request(&mut self, sender: SocketAddr, now: Instant) -> Result<(), AdmissionRefusal> {
        self.requests.take(sender, now).then_some(()).ok_or(AdmissionRefusal::TooMany)
    }

    /// Whether `sender` may send requests that way and gets answers.
    pub(super) fn is_answered(&self, sender: SocketAddr, way: OscArrival) -> bool {
        let is_port = way == if self.has_own_port { OscArrival::OwnPort } else { OscArrival::Plain };
        is_port && self.is_app(sender.ip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;

    /// Share of the packets of a board at `hz` that pass in eight seconds, on a floor of one board with this rate.
    fn passed(written: Option<f32>, hz: u32) -> f32 {
        let mut floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        floor.boards[0].rate_hz = written;
        let mut admission = Admission::new(&floor);
        let sender = SocketAddr::from(([127, 0, 0, 1], 9000));
        let at = |n: u32| Instant::from_micros(u64::from(n) * 1_000_000 / u64::from(hz));
        let passed = (0..8 * hz).filter(|n| admission.datagram(sender, false, at(*n)).is_ok()).count();
        passed as f32 / (8 * hz) as f32
    }

    #[test]
    fn a_board_passes_at_every_rate_that_the_assembler_takes() {
        for hz in [20, 1000, 2000, 4000] {
            assert_eq!(passed(None, hz), 1.0, "{hz} Hz");
            assert_eq!(passed(Some(hz as f32), hz), 1.0, "{hz} Hz, written");
        }
    }

    #[test]
    fn a_sender_of_more_than_its_boards_send_is_limited() {
        assert!(passed(None, 20_000) < 0.35);
        assert!(passed(Some(1000.0), 20_000) < 0.15);
        assert!(passed(Some(20.0), 20_000) < 0.15);
    }
}
