//! A floor of two boards with a dead man's pedal and a slider, feet on both, and faults of the boards.

use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant as HostInstant};

use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot::schema::save_floor;
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{Readings, SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{self as sim, Foot, PartConfig, SimConfig, SimFloor, SimulatedSensors};

use super::client::Client;
use crate::end_to_end::underfoot_at;
use crate::sender::{simulated, small_floor};

const PAGE: &str = r#"Layout(
    version: 1,
    regions: [(id: "left", at: (0, 0), size: (1, 2)), (id: "right", at: (1, 0), size: (2, 2))],
    widgets: [
        (id: "drive", kind: "dead_man", at: (0, 0), size: (0.9, 0.9)),
        (id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9), press_n: 60, release_n: 40),
    ],
)"#;

/// Time at which the feet come, in milliseconds of the boards' time.
const LANDING_MS: u32 = 600;

/// A free port.
fn any_port() -> UdpSocket {
    UdpSocket::bind("127.0.0.1:0").unwrap()
}

pub struct Site {
    pub folder: tempfile::TempDir,
    pub floor: Floor,
    /// The environment of the program, in addition to that of the test.
    pub environment: Vec<(&'static str, String)>,
    /// The program's file.
    program: PathBuf,
    sim: SimFloor,
    format: SensorFormat,
}

impl Site {
    pub fn new() -> Self {
        Self::sending(SensorFormat::Counts)
    }

    /// Like [`Site::new`], with boards that send this format.
    pub fn sending(format: SensorFormat) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let wired = small_floor();
        let sim = match format {
            SensorFormat::Newtons => {
                let sensing = SimulatedSensors::Newtons(PartConfig::default());
                SimFloor::new(&wired, SimConfig { sensing, ..SimConfig::default() }, 7)
            }
            SensorFormat::Counts | SensorFormat::Blob => simulated(&wired),
        };
        let floor = sim::calibrated(&wired, &sim, 7).unwrap();
        save_floor(&floor, &folder.path().join("floor.ron")).unwrap();
        std::fs::write(folder.path().join("page.ron"), PAGE).unwrap();
        let program = PathBuf::from(env!("CARGO_BIN_EXE_underfoot"));
        Self { folder, floor, environment: Vec::new(), program, sim, format }
    }

    /// Runs a copy of the program from now on; returns its file.
    pub fn copy_program(&mut self) -> &Path {
        let copy = self.folder.path().join("underfoot");
        std::fs::copy(&self.program, &copy).unwrap();
        self.program = copy;
        &self.program
    }

    /// The folder of its files: `page.ron` and `floor.ron`.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The program, which serves this floor and reports to `client`.
    pub fn run(&self, client: &Client, more: &[&str]) -> Run {
        let address = any_port().local_addr().unwrap();
        let [osc, tuio] = client.addresses().map(|address| address.to_string());
        let mut child = underfoot_at(&self.program)
            .current_dir(self.folder.path())
            .envs(self.environment.iter().cloned())
            .args(["run", "page.ron", "--floor", "floor.ron", "--json", "--listen", &address.to_string()])
            .args(["--osc", &osc, "--tuio", &tuio])
            .args(more)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut chatter = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
        let said: Vec<String> =
            chatter.by_ref().take_while(|line| !line.starts_with("Listening on")).collect();
        let reader = thread::spawn(move || said.into_iter().chain(chatter).collect());
        Run { child, address, chatter: Some(reader) }
    }
}

/// The running program; it ends with the test in any case.
pub struct Run {
    pub child: Child,
    pub address: SocketAddr,
    chatter: Option<JoinHandle<Vec<String>>>,
}

impl Run {
    /// Ends it if it has not ended, and returns its standard error.
    pub fn end(mut self) -> Vec<String> {
        self.kill();
        self.chatter.take().map(|reader| reader.join().unwrap()).unwrap_or_default()
    }
}

impl Run {
    fn kill(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.kill();
    }
}

/// The fault of the boards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum BoardFault {
    /// None.
    Well,
    /// No packet comes through.
    Silent,
    /// No packet of the second board comes through.
    OneSilent,
    /// The converters repeat their readings while the packets continue.
    Frozen,
    /// A row jumps to 60,000 counts within a millisecond.
    Jumped,
    /// Two corners of the plate under the pedal repeat, and the foot leaves.
    TwoCorners,
    /// All four do.
    FourCorners,
    /// The converters repeat except for one bit, which toggles, and the foot leaves.
    AllButOneBit,
}

impl BoardFault {
    /// Whether the foot on the pedal leaves meanwhile.
    fn foot_leaves(self) -> bool {
        matches!(self, Self::TwoCorners | Self::FourCorners | Self::AllButOneBit)
    }

    /// Whether this channel of the first board repeats its reading at the start of the fault.
    fn holds(self, channel: usize) -> bool {
        match self {
            Self::TwoCorners => [0, 3].contains(&channel),
            Self::FourCorners => channel < 4,
            Self::AllButOneBit => true,
            _ => false,
        }
    }

    const ALL: [Self; 8] = [
        Self::Well,
        Self::Silent,
        Self::OneSilent,
        Self::Frozen,
        Self::Jumped,
        Self::TwoCorners,
        Self::FourCorners,
        Self::AllButOneBit,
    ];
}

/// The boards: real datagrams, a millisecond's every millisecond, until dropped.
pub struct Boards {
    fault: Arc<AtomicU8>,
    thread: Option<JoinHandle<()>>,
}

/// Set in place of a fault to end the boards.
const OVER: u8 = u8::MAX;

impl Boards {
    pub fn start(site: &Site, target: SocketAddr) -> Self {
        let fault = Arc::new(AtomicU8::new(BoardFault::Well as u8));
        let (floor, mut sim, suffered) = (site.floor.clone(), site.sim.clone(), Arc::clone(&fault));
        let format = site.format;
        let thread = thread::spawn(move || {
            let mut encoder = SensorEncoder::new(&floor, format);
            let socket = any_port();
            let begun = HostInstant::now();
            let mut frozen: Option<Vec<Readings>> = None;
            let mut left_at = None;
            for sequence in 0.. {
                let suffers = suffered.load(Ordering::Relaxed);
                if suffers == OVER {
                    return;
                }
                let fault = BoardFault::ALL[usize::from(suffers)];
                if fault.foot_leaves() {
                    left_at.get_or_insert(sequence);
                }
                let mut all: Vec<Readings> = sim.step(&feet(sequence, left_at)).to_vec();
                if fault == BoardFault::Frozen {
                    all.clone_from(frozen.get_or_insert(all.clone()));
                } else if fault == BoardFault::Jumped
                    && let Some(Readings::Counts(counts)) = all.first_mut()
                {
                    counts.fill(Some(60_000));
                } else if fault.foot_leaves() {
                    let before = frozen.get_or_insert(all.clone());
                    hold_still(&mut all[0], &before[0], fault, sequence);
                }
                for (board, readings) in (0..).zip(all) {
                    let packet = SensorPacket { board, sequence, received: Instant::START, readings };
                    let is_cut =
                        fault == BoardFault::Silent || (fault == BoardFault::OneSilent && board == 1);
                    if !is_cut {
                        // The receiver may be gone.
                        let _ = socket.send_to(encoder.encode(&packet).unwrap(), target);
                    }
                }
                let due = Duration::from_millis(u64::from(sequence) + 1);
                thread::sleep(due.saturating_sub(begun.elapsed()));
            }
        });
        Self { fault, thread: Some(thread) }
    }

    pub fn suffer(&self, fault: BoardFault) {
        self.fault.store(fault as u8, Ordering::Relaxed);
    }
}

impl Drop for Boards {
    fn drop(&mut self) {
        self.fault.store(OVER, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

/// Makes the repeating channels read their values in `before`.
fn hold_still(now: &mut Readings, before: &Readings, fault: BoardFault, sequence: u32) {
    let toggles = |channel| fault == BoardFault::AllButOneBit && channel == 1;
    match (now, before) {
        (Readings::Counts(now), Readings::Counts(before)) => {
            for channel in (0..now.len()).filter(|channel| fault.holds(*channel)) {
                let bit = u16::from(toggles(channel)) & sequence as u16;
                now[channel] = before[channel].map(|count| count ^ bit);
            }
        }
        (Readings::Newtons(now), Readings::Newtons(before)) => {
            for channel in (0..now.len()).filter(|channel| fault.holds(*channel)) {
                let bit = u32::from(toggles(channel)) & sequence;
                now[channel] = f32::from_bits(before[channel].to_bits() ^ bit);
            }
        }
        _ => unreachable!("a board does not change what it sends"),
    }
}

/// One foot lands on the pedal, then one on the slider, which it drags to the right and stays there. The first leaves
/// at `left_at`.
fn feet(ms: u32, left_at: Option<u32>) -> Vec<Foot> {
    let on = |at: Vec2, since: u32, until: Option<u32>, newtons: f32| {
        let left = until.map_or(1.0, |until| 1.0 - ms.saturating_sub(until) as f32 / 60.0);
        let share = (ms.saturating_sub(since) as f32 / 60.0).min(left).clamp(0.0, 1.0);
        let mut foot = Foot {
            position: Vec2::ZERO,
            heading: 0.0,
            length_m: 0.24,
            force: Newtons(newtons * share),
            roll: 0.6,
            left: false,
        };
        foot.position = at - foot.centre_of_pressure();
        (share > 0.0).then_some(foot)
    };
    let dragged = (ms.saturating_sub(LANDING_MS + 900) as f32 / 500.0).min(1.0);
    let zoom = Vec2::new(0.62 + 0.2 * dragged, 0.14);
    [on(Vec2::new(0.14, 0.14), LANDING_MS, left_at, 150.0), on(zoom, LANDING_MS + 600, None, 120.0)]
        .into_iter()
        .flatten()
        .collect()
}
