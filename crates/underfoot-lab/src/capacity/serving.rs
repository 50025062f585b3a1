//! Speed of serving a whole floor without network and sound: packets from memory, contacts and events out.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::crowd::{TileLoads, walkers_on};
use super::receiving::{MILLIS, RESTING, millisecond, tared};
use underfoot::engine::Snapshot;
use underfoot::floor::{Calibration, Corner, Floor, SensorId};
use underfoot::schema::{self, Kinds};
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::source::{FloorInput, SensorSource, SourceError, UdpSource};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{LinkCounters, Readings, SensorEncoder, SensorFormat, SensorPacket};

/// A square floor with people walking on it, and with the built-in layout `first_steps` in its south-west.
pub struct ServeLoad {
    server: Server,
    queue: Arc<Mutex<Queue>>,
    boards: Boards,
}

/// Readings of a floor's boards.
#[derive(Debug)]
struct Boards {
    /// Packets of the empty floor; the sequence repeats.
    empty: Vec<Vec<SensorPacket>>,
    /// Loads at each millisecond, as counts of a board's channel; the sequence repeats.
    moments: Vec<Vec<(usize, usize, u16)>>,
    millis: u32,
}

/// The boards of a floor that is served over this machine's own network.
#[derive(Debug)]
pub struct BoardsLoad {
    floor: Floor,
    boards: Boards,
    encoder: SensorEncoder,
    socket: UdpSocket,
    /// Address of the receiver.
    to: Option<SocketAddr>,
}

impl BoardsLoad {
    /// Prepares the boards of a floor as in [`ServeLoad`], without a receiver.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if no port is free.
    pub fn new(side: u16, walkers: u16) -> Result<Self, SourceError> {
        let (floor, boards) = Boards::of(side, walkers);
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).map_err(no_port)?;
        let encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
        Ok(Self { floor, boards, encoder, socket, to: None })
    }

    /// Binds a source and sends the packets to it from now on; returns the floor of the packets and the source.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if no port is free.
    pub fn source(&mut self) -> Result<(Floor, UdpSource), SourceError> {
        let source = UdpSource::bind((Ipv4Addr::LOCALHOST, 0).into(), &self.floor)?;
        self.to = Some(source.local_addr().map_err(no_port)?);
        Ok((self.floor.clone(), source))
    }

    /// Sends the packets of the next millisecond; calls `pause` after about half of them.
    pub fn send(&mut self, pause: impl Fn()) {
        let mut packets = VecDeque::new();
        self.boards.next(&mut packets);
        let half = packets.len() / 2;
        for (number, packet) in packets.iter().enumerate() {
            if number == half {
                pause();
            }
            if let Ok(datagram) = self.encoder.encode(packet) {
                // A lost packet counts as missing at the receiver.
                let _ = self.to.map(|to| self.socket.send_to(datagram, to));
            }
        }
    }
}

fn no_port(source: std::io::Error) -> SourceError {
    let message = format!("packets can't be sent to this machine itself: {source}");
    SourceError::Socket { message, source }
}

/// Packets in the queue, and the current time.
#[derive(Debug, Default)]
struct Queue {
    packets: VecDeque<SensorPacket>,
    now: Instant,
}

/// Sensor source of the server: reads the queue.
struct Memory(Arc<Mutex<Queue>>);

impl SensorSource for Memory {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        Ok(self.0.lock().unwrap_or_else(PoisonError::into_inner).packets.pop_front())
    }

    fn now(&self) -> Instant {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).now
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

impl ServeLoad {
    /// Prepares a floor of `side` x `side` tiles with `walkers` people, two on each stretch of 6 x 6 tiles.
    ///
    /// `side` is clamped to 6 and the largest side of a floor; the number of walkers is limited to two for each
    /// stretch.
    #[must_use]
    pub fn new(side: u16, walkers: u16) -> Self {
        let (floor, boards) = Boards::of(side, walkers);
        let queue = Arc::<Mutex<Queue>>::default();
        let source = Memory(Arc::clone(&queue));
        Self { server: server(&floor, source), queue, boards }
    }

    /// Returns a server of such a floor, fed by `input`.
    #[must_use]
    pub fn server(floor: &Floor, input: impl Into<FloorInput>) -> Server {
        server(floor, input)
    }

    /// Serves one second of floor time, 1000 frames; returns the number of contacts in the last frame.
    pub fn second(&mut self) -> usize {
        for _ in 0..1000 {
            self.send();
            // One turn for each packet, and one more that finds the queue empty.
            for _ in 0..=self.boards.empty.first().map_or(0, Vec::len) {
                // Reading from memory does not fail.
                let _ = self.server.turn();
            }
        }
        let mut snapshot = Snapshot::default();
        self.server.snapshot(&mut snapshot);
        snapshot.contacts.len()
    }

    /// Puts one millisecond's packets into the queue.
    fn send(&mut self) {
        let mut queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        let Queue { packets, now } = &mut *queue;
        packets.clear();
        *now = self.boards.next(packets);
    }
}

/// A server of a floor with a layout.
fn server(floor: &Floor, input: impl Into<FloorInput>) -> Server {
    let text = schema::builtin_layout("first_steps").unwrap_or_default();
    let layout = schema::parse_layout(text, "first_steps", &Kinds::builtin(), &floor.geometry);
    // The built-in layout fits on 6 x 6 tiles.
    let layout = layout.map(|read| read.layout).unwrap_or_default();
    let (snapshots, _) = triple_buffer::triple_buffer(&Snapshot::default());
    Server::new(floor, layout, Method::Tracker, input).with_snapshots(snapshots)
}

impl Boards {
    /// Returns a floor and its boards.
    fn of(side: u16, walkers: u16) -> (Floor, Self) {
        let (geometry, loads) = walkers_on(side, walkers);
        let floor = tared(Floor::of(geometry));
        let places = places(&floor);
        let boards = Self {
            empty: (0..MILLIS).map(|seed| millisecond(&floor, seed as u64)).collect(),
            moments: loads.iter().map(|loads| as_counts(loads, &places)).collect(),
            millis: 0,
        };
        (floor, boards)
    }

    /// Adds the packets of the next millisecond to `packets`, and returns the time of that millisecond.
    fn next(&mut self, packets: &mut VecDeque<SensorPacket>) -> Instant {
        self.millis = self.millis.wrapping_add(1);
        let at = Instant::from_millis(self.millis.into());
        let now = self.millis as usize;
        if let Some(empty) = self.empty.get(now % MILLIS) {
            packets.extend(empty.iter().cloned());
        }
        for packet in packets.iter_mut() {
            (packet.sequence, packet.received) = (self.millis, at);
        }
        let loads = self.moments.get(now % self.moments.len().max(1)).into_iter().flatten();
        for &(board, channel, counts) in loads {
            if let Some(SensorPacket { readings: Readings::Counts(readings), .. }) = packets.get_mut(board)
                && let Some(reading) = readings.get_mut(channel)
            {
                *reading = Some(counts);
            }
        }
        at
    }
}

/// Board and channel of each tile's sensors, in tile-index order.
fn places(floor: &Floor) -> Vec<[(usize, usize); 4]> {
    let mut places = vec![[(0, 0); 4]; floor.geometry.tile_count()];
    for (number, board) in floor.boards.iter().enumerate() {
        for (channel, sensor) in board.channels.iter().enumerate() {
            let Some(SensorId { tile, corner }) = sensor else { continue };
            if let Some(place) = floor.geometry.index(*tile).and_then(|index| places.get_mut(index)) {
                place[corner.index()] = (number, channel);
            }
        }
    }
    places
}

/// Readings of nominal sensors under `loads` and the weight of the plates: board, channel and counts.
fn as_counts(loads: &TileLoads, places: &[[(usize, usize); 4]]) -> Vec<(usize, usize, u16)> {
    let law = Calibration::NOMINAL;
    let counts = |force: f32| {
        let volts = law.volts_at(Newtons(force.max(0.0)) + law.force(RESTING));
        (volts / Calibration::FULL_SCALE_VOLTS * f32::from(u16::MAX)).clamp(0.0, f32::from(u16::MAX)) as u16
    };
    let tiles = loads.iter().filter_map(|(tile, forces)| Some((places.get(*tile)?, forces)));
    tiles
        .flat_map(|(places, forces)| {
            Corner::ALL.map(|corner| {
                let (board, channel) = places[corner.index()];
                (board, channel, counts(forces[corner.index()]))
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walkers_are_found_through_their_sensors() {
        let mut load = ServeLoad::new(12, 8);
        let contacts = (0..3).map(|_| load.second()).max();
        // Each walker has one or two feet on the floor.
        assert!((8..=16).contains(&contacts.unwrap()), "{contacts:?}");
        let counters = load.server.counters();
        assert_eq!((counters.frames, counters.lost, counters.late, counters.wrong_shape), (3000, 0, 0, 0));
    }

    #[test]
    fn nobody_is_found_where_nobody_walks() {
        let mut load = ServeLoad::new(6, 0);
        assert_eq!(load.second(), 0);
        assert_eq!(load.server.engine().layout().widgets.len(), 3, "there are controls to look after");
    }
}
