//! Loads in real time, on a thread with the priority of a sensing thread, which sleeps between packets.

use std::net::{Ipv4Addr, UdpSocket};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::cores::{Core, stay_on};
use super::listener::Listener;
use super::work_time::busy;
use crate::capacity::{BoardsLoad, ServeLoad, square};
use underfoot::floor::{Board, Floor, Forwarding};
use underfoot::sink::{Rank, claim_priority};
use underfoot::source::{SourceError, UdpSource};

/// Side of the floor whose tiles and people are measured: as large as the sensed part of an area.
const SIDE: u16 = 24;

/// Number of walkers on that floor: two on 6 x 6 tiles.
const WALKERS: u16 = SIDE * SIDE / 18;

/// Side of the smallest measured floor, which gives the fixed time independent of the size.
const SMALL: u16 = 6;

/// Delay of a neighbour's packets behind those of the area's own boards, for measuring a wake-up: long enough for the
/// thread to sleep again. The cost is the same after 0.1 ms and after 0.5 ms.
const LATER: Duration = Duration::from_micros(200);

/// Floors for the loads.
#[derive(Debug)]
pub(super) struct Floors {
    small: BoardsLoad,
    empty: BoardsLoad,
    crowd: BoardsLoad,
}

impl Floors {
    pub(super) fn new() -> Result<Self, SourceError> {
        Ok(Self {
            small: BoardsLoad::new(SMALL, 0)?,
            empty: BoardsLoad::new(SIDE, 0)?,
            crowd: BoardsLoad::new(SIDE, WALKERS)?,
        })
    }
}

/// Microseconds of work per millisecond of floor time, for each real-time load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    /// Receiving and decoding the packets of the empty floor.
    pub(super) received: f64,
    /// Receiving, decoding and forwarding them to another computer.
    pub(super) forwarded: f64,
    /// Serving the small floor.
    pub(super) small: f64,
    /// Serving the small floor, with half of the packets delayed by [`LATER`].
    pub(super) twice: f64,
    /// Serving the empty floor.
    pub(super) empty: f64,
    /// Serving the floor with a crowd.
    pub(super) crowd: f64,
}

impl Round {
    /// Measures each load for `length`; calls `advance` after each.
    pub(super) fn measure(
        floors: &mut Floors,
        length: Duration,
        advance: &impl Fn(),
    ) -> Result<Self, SourceError> {
        let paced = |boards: &mut BoardsLoad, pause: &Pause, take: &Take| {
            let us = paced_us(length, boards, pause, take);
            advance();
            us
        };
        let later = || thread::sleep(LATER);
        let Floors { small, empty, crowd } = floors;
        Ok(Self {
            received: paced(empty, &|| {}, &receive)?,
            forwarded: paced(empty, &|| {}, &forward)?,
            small: paced(small, &|| {}, &serve)?,
            twice: paced(small, &later, &serve)?,
            empty: paced(empty, &|| {}, &serve)?,
            crowd: paced(crowd, &|| {}, &serve)?,
        })
    }

    /// Time of one packet from the socket to its readings.
    pub(super) fn packet_us(&self) -> f64 {
        self.received / boards(SIDE)
    }

    /// Time to forward one packet to one other computer.
    pub(super) fn forward_us(&self) -> f64 {
        (self.forwarded - self.received) / boards(SIDE)
    }

    /// Time of one more wake-up per millisecond.
    pub(super) fn wake_us(&self) -> f64 {
        self.twice - self.small
    }

    /// Time of the small floor without its packets.
    fn small_us(&self) -> f64 {
        self.small - boards(SMALL) * self.packet_us()
    }

    /// Time to assemble and sense a tile without load.
    pub(super) fn tile_us(&self) -> f64 {
        (self.empty - self.received - self.small_us()) / (tiles(SIDE) - tiles(SMALL))
    }

    /// Fixed time of a running floor, independent of its size.
    pub(super) fn base_us(&self) -> f64 {
        self.small_us() - tiles(SMALL) * self.tile_us()
    }

    /// Time of a person walking.
    pub(super) fn person_us(&self) -> f64 {
        (self.crowd - self.empty) / f64::from(WALKERS)
    }
}

fn boards(side: u16) -> f64 {
    square(side).boards.len() as f64
}

fn tiles(side: u16) -> f64 {
    f64::from(side).powi(2)
}

/// Prepares a load on a floor's packets; each call of the returned function takes one packet.
type Take = dyn Fn(&Floor, UdpSource) -> Result<Turn, SourceError> + Sync;
type Turn = Box<dyn FnMut() -> Result<(), SourceError>>;

/// Called between the two halves of a millisecond's packets.
type Pause = dyn Fn() + Sync;

/// Receives and decodes.
fn receive(_: &Floor, mut source: UdpSource) -> Result<Turn, SourceError> {
    Ok(Box::new(move || source.next(PATIENCE).map(|_| ())))
}

/// Receives, decodes, and forwards to another computer.
fn forward(floor: &Floor, source: UdpSource) -> Result<Turn, SourceError> {
    let failed = |source: std::io::Error| SourceError::Socket {
        message: format!("packets can't be forwarded to this machine itself: {source}"),
        source,
    };
    let neighbour = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).map_err(failed)?;
    neighbour.set_read_timeout(Some(WARM_UP)).map_err(failed)?;
    let to = vec![neighbour.local_addr().map_err(failed)?];
    let forwarding = |board: &Board| Forwarding { address: board.address.clone(), to: to.clone() };
    let (source, _) = source.forwarding(&floor.boards.iter().map(forwarding).collect::<Vec<_>>())?;
    // The neighbour receives packets until the socket reports an error.
    thread::spawn(move || {
        stay_on(Core::First);
        while neighbour.recv(&mut [0; 2048]).is_ok() {}
    });
    receive(floor, source)
}

/// Does the work of a node's sensing thread.
fn serve(floor: &Floor, source: UdpSource) -> Result<Turn, SourceError> {
    let mut server = ServeLoad::server(floor, source).with_events(Box::new(Listener::start()));
    Ok(Box::new(move || server.turn().map(|_| ())))
}

/// Warm-up time before the measurement.
const WARM_UP: Duration = Duration::from_millis(150);

/// Time-out of waiting for a packet.
const PATIENCE: Duration = Duration::from_millis(1);

/// Microseconds of work per millisecond of a floor: takes its packets from the network in real time for `length`, as
/// a sensing thread does. The thread sleeps between two packets and wakes to caches that other threads have used; a
/// load that never sleeps would not include this cost.
fn paced_us(
    length: Duration,
    boards: &mut BoardsLoad,
    pause: &Pause,
    take: &Take,
) -> Result<f64, SourceError> {
    let (floor, source) = boards.source()?;
    let (is_over, sent) = (&AtomicBool::new(false), &AtomicU64::new(0));
    let work = move || {
        stay_on(Core::Last);
        claim_priority(Rank::Sensing);
        let mut turn = take(&floor, source)?;
        let mut work_for = |length: Duration| {
            let (begun, worked, before) = (Instant::now(), busy(), sent.load(Ordering::Relaxed));
            while begun.elapsed() < length {
                turn()?;
            }
            let millis = sent.load(Ordering::Relaxed).saturating_sub(before).max(1);
            Ok::<f64, SourceError>(1e6 * (busy() - worked).as_secs_f64() / millis as f64)
        };
        work_for(WARM_UP)?;
        work_for(length)
    };
    thread::scope(|scope| {
        scope.spawn(move || {
            stay_on(Core::First);
            let begun = Instant::now();
            while !is_over.load(Ordering::Relaxed) {
                boards.send(pause);
                let millis = sent.fetch_add(1, Ordering::Relaxed) + 1;
                thread::sleep(Duration::from_millis(millis).saturating_sub(begun.elapsed()));
            }
        });
        // A new thread, so that its priority ends with it.
        let worked = scope.spawn(work).join();
        is_over.store(true, Ordering::Relaxed);
        worked.unwrap_or_else(|panic| resume_unwind(panic))
    })
}
