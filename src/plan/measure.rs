//! A computer's constants, measured on this one.

use std::net::{Ipv4Addr, UdpSocket};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::Machine;
use crate::capacity::{AssemblyLoad, BoardsLoad, RenderLoad, RenderWork, ServeLoad, square};
use crate::floor::{Board, Floor, Forwarding};
use crate::sink::{Rank, claim_priority};
use crate::source::{SensorSource, SourceError, UdpSource};

/// Loads that are measured.
pub const LOADS: u64 = 8;

/// Most channels that ALSA opens on a card.
const CHANNELS: u32 = 64;

/// An ordinary network card.
const LINK_MBIT: f64 = 1000.0;

/// The floor whose tiles and people are measured: as large as what an area senses.
const SIDE: u16 = 24;

/// Walkers on it: two on 6 x 6.
const WALKERS: u16 = SIDE * SIDE / 18;

/// The smallest floor that is measured, to tell what a floor takes whatever its size.
const SMALL: u16 = 6;

/// Channels of the loads that are rendered.
const RENDERED: f64 = 36.0;

/// Measures this computer, each of [`LOADS`] loads for `length`; `advance` hears of each that is done.
///
/// # Errors
/// [`SourceError`] if packets to this machine itself can't be had.
pub fn measure(length: Duration, advance: impl Fn()) -> Result<Machine, SourceError> {
    let paced = |side, walkers, take: &Take| {
        let us = paced_us(length, side, walkers, take);
        advance();
        us
    };
    let boards = square(SIDE).boards.len() as f64;
    let packet_us = paced(SIDE, 0, &receive)? / boards;
    let forwarded_us = paced(SIDE, 0, &forward)? / boards;
    let millisecond = |load: &mut dyn FnMut()| {
        let us = millisecond_us(length, load);
        advance();
        us
    };
    let mut assembly = AssemblyLoad::new(SIDE);
    let assemble_us = millisecond(&mut || _ = assembly.second());
    let small_us = paced(SMALL, 0, &serve)?;
    let empty_us = paced(SIDE, 0, &serve)?;
    let crowd_us = paced(SIDE, WALKERS, &serve)?;
    let [silent_us, active_us] =
        [RenderWork::of_modes(0), RenderWork::with_friction_and_limiter()].map(|work| {
            let mut load = RenderLoad::new(work);
            millisecond(&mut || load.second())
        });
    let tiles = |side: u16| f64::from(side).powi(2);
    // But for packets, what a floor takes.
    let small_us = small_us - square(SMALL).boards.len() as f64 * packet_us;
    let tile_us = (empty_us - boards * packet_us - small_us) / (tiles(SIDE) - tiles(SMALL));
    let assemble_tile_us = assemble_us / tiles(SIDE);
    // A machine that is busy with something else may measure less than nothing.
    Ok(Machine {
        cores: thread::available_parallelism().map_or(1, |cores| cores.get().min(1024) as u32),
        base_us: (small_us - tiles(SMALL) * tile_us).max(0.0),
        packet_us,
        forward_us: (forwarded_us - packet_us).max(0.0),
        assemble_tile_us,
        sense_tile_us: (tile_us - assemble_tile_us).max(0.0),
        person_us: ((crowd_us - empty_us) / f64::from(WALKERS)).max(0.0),
        channel_us: silent_us / RENDERED,
        active_channel_us: ((active_us - silent_us) / RENDERED).max(0.0),
        channels: CHANNELS,
        link_mbit: LINK_MBIT,
    })
}

/// What takes the packets of a floor, one at each call.
type Take = dyn Fn(&Floor, UdpSource) -> Result<Turn, SourceError> + Sync;
type Turn = Box<dyn FnMut() -> Result<(), SourceError>>;

/// Receives and reads.
fn receive(_: &Floor, mut source: UdpSource) -> Result<Turn, SourceError> {
    Ok(Box::new(move || source.next(PATIENCE).map(|_| ())))
}

/// Receives, reads, and forwards to another computer.
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
    // It takes them until none come any more.
    thread::spawn(move || while neighbour.recv(&mut [0; 2048]).is_ok() {});
    receive(floor, source)
}

/// Does all that a floor's sensing thread does.
fn serve(floor: &Floor, source: UdpSource) -> Result<Turn, SourceError> {
    let mut server = ServeLoad::server(floor, Box::new(source));
    Ok(Box::new(move || server.turn().map(|_| ())))
}

/// How long packets are taken before that is measured.
const WARM_UP: Duration = Duration::from_millis(300);

/// How long is waited for a packet.
const PATIENCE: Duration = Duration::from_millis(1);

/// Microseconds of work for each millisecond of a floor of `side` x `side` tiles, whose packets are taken for `length`
/// in real time and from the network, as a sensing thread does it. Between two packets it sleeps, and wakes to caches
/// that others have used; a load that never sleeps does not tell what that takes.
fn paced_us(length: Duration, side: u16, walkers: u16, take: &Take) -> Result<f64, SourceError> {
    let (floor, source, mut boards) = BoardsLoad::new(side, walkers)?;
    let (is_over, sent) = (&AtomicBool::new(false), &AtomicU64::new(0));
    let work = move || {
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
            let begun = Instant::now();
            while !is_over.load(Ordering::Relaxed) {
                boards.send();
                let millis = sent.fetch_add(1, Ordering::Relaxed) + 1;
                thread::sleep(Duration::from_millis(millis).saturating_sub(begun.elapsed()));
            }
        });
        // On a thread of its own, which takes its priority with it.
        let worked = scope.spawn(work).join();
        is_over.store(true, Ordering::Relaxed);
        worked.unwrap_or_else(|panic| resume_unwind(panic))
    })
}

/// Microseconds of work for each millisecond of a floor of which `second` does a second: the median of as many as are
/// done in `length`, three at least.
fn millisecond_us(length: Duration, second: &mut dyn FnMut()) -> f64 {
    // Tables, caches and the processor's clock warm up first.
    second();
    let mut all = Vec::new();
    let begun = Instant::now();
    while all.len() < 3 || begun.elapsed() < length {
        let start = busy();
        second();
        all.push(1e3 * (busy() - start).as_secs_f64());
    }
    median(all)
}

/// How long this thread has worked. What other programs take of the core in the meantime is not this floor's cost.
#[cfg(target_os = "linux")]
fn busy() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map(Duration::from).unwrap_or_default()
}

/// Elsewhere time that passes is all there is.
#[cfg(not(target_os = "linux"))]
fn busy() -> Duration {
    use std::sync::LazyLock;
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGUN.elapsed()
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_unstable_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_computer_can_be_measured() {
        let done = std::cell::Cell::new(0);
        let machine = measure(Duration::from_millis(1), || done.set(done.get() + 1)).unwrap();
        machine.check().unwrap();
        assert_eq!(done.get(), LOADS);
        assert!(machine.packet_us > 0.0 && machine.assemble_tile_us > 0.0 && machine.channel_us > 0.0);
    }
}
