//! A small simulated floor that sends real datagrams over loopback.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use underfoot::floor::{Floor, Geometry};
use underfoot::glam::Vec2;
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{Foot, SimConfig, SimFloor};

/// Any free port.
pub const ANY_PORT: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

/// Three columns and two rows, so two boards: small enough for a quick calibration.
pub fn small_floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(3, 2).unwrap())
}

/// `floor` with random parts.
pub fn simulated(floor: &Floor) -> SimFloor {
    SimFloor::new(floor, SimConfig::default(), 7)
}

/// A simulated floor that sends real datagrams, a millisecond's packets every millisecond, until dropped.
pub struct Sender {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Sender {
    /// Sends to `target`; `step` advances the floor to the given millisecond.
    pub fn start(
        floor: &Floor,
        mut sim: SimFloor,
        target: SocketAddr,
        step: impl Fn(&mut SimFloor, u32) + Send + 'static,
    ) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let mut encoder = SensorEncoder::new(floor, SensorFormat::Counts);
        let socket = UdpSocket::bind(ANY_PORT).unwrap();
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let started = std::time::Instant::now();
            for sequence in 0.. {
                if stopped.load(Ordering::Relaxed) {
                    return;
                }
                step(&mut sim, sequence);
                for (board, readings) in (0..).zip(sim.readings()) {
                    let readings = readings.clone();
                    let packet = SensorPacket { board, sequence, received: Instant::START, readings };
                    // The receiver may be gone.
                    let _ = socket.send_to(encoder.encode(&packet).unwrap(), target);
                }
                let due = Duration::from_millis(u64::from(sequence) + 1);
                std::thread::sleep(due.saturating_sub(started.elapsed()));
            }
        });
        Self { stop, thread: Some(thread) }
    }
}

impl Drop for Sender {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

/// A foot at `at`.
pub fn standing(at: Vec2) -> Foot {
    Foot { position: at, heading: 0.2, length_m: 0.27, force: Newtons(350.0), roll: 0.5, left: false }
}
