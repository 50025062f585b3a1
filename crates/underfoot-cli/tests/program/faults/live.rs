//! A floor served in real time: the program, boards that send real datagrams, and a foot that a test moves.

use std::io::{BufRead, BufReader, Read};
use std::net::{SocketAddr, UdpSocket};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant as HostInstant};

use serde_json::Value;
use underfoot::floor::{Floor, Geometry};
use underfoot::glam::Vec2;
use underfoot::schema::save_floor;
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{self as sim, SimConfig, SimFloor};

use super::tape::{MIDDLE, events, foot};
use crate::end_to_end::{Served, terminate, underfoot};
use crate::ports::free_port;

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(60);

/// Change of a foot's force per millisecond of the boards' time, in newtons.
const RAMP_N: f32 = 3.0;

/// Changes the readings of a board before it sends them; `false` sends nothing.
type Change = Box<dyn FnMut(u16, &mut Readings) -> bool + Send>;

/// A floor of two by two tiles on two boards, served by a program of its own.
pub struct Live {
    pub address: SocketAddr,
    pub folder: tempfile::TempDir,
    pub served: Served,
    boards: Option<Boards>,
    lines: Arc<Mutex<Vec<Value>>>,
    chatter: Arc<Mutex<Vec<String>>>,
    readers: Vec<JoinHandle<()>>,
}

impl Live {
    /// The floor with this page on it, and these options of `underfoot run`.
    pub fn start(page: &str, more: &[&str]) -> Self {
        Self::start_as(page, |run| {
            run.args(more);
        })
    }

    /// Like [`Live::start`], with a command that `change` has changed.
    pub fn start_as(page: &str, change: impl FnOnce(&mut Command)) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let wired = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
        let sim = SimFloor::new(&wired, SimConfig::default(), 3);
        let floor = sim::calibrated(&wired, &sim, 3).unwrap();
        save_floor(&floor, &folder.path().join("floor.ron")).unwrap();
        std::fs::write(folder.path().join("page.ron"), page).unwrap();
        let address = SocketAddr::from(([127, 0, 0, 1], free_port()));
        let mut run = underfoot();
        run.current_dir(folder.path());
        run.args(["run", "page.ron", "--floor", "floor.ron", "--no-osc", "--json", "--listen"]);
        run.arg(address.to_string());
        change(&mut run);
        let mut child =
            run.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (lines, chatter) = (Arc::<Mutex<Vec<Value>>>::default(), Arc::<Mutex<Vec<String>>>::default());
        let json = |line: &str| serde_json::from_str(line).unwrap();
        let out = keep(child.stdout.take().unwrap(), Arc::clone(&lines), json);
        let err = keep(child.stderr.take().unwrap(), Arc::clone(&chatter), str::to_owned);
        let (served, readers) = (Served(child), vec![out, err]);
        let boards = Some(Boards::start(&floor, sim, address));
        let live = Self { address, folder, served, boards, lines, chatter, readers };
        live.wait_until("the floor is live", |live| live.has(|line| line["state"] == "live"));
        live
    }

    /// Waits until an event that must happen.
    pub fn wait_until(&self, what: &str, happened: impl Fn(&Self) -> bool) {
        let end = HostInstant::now() + AT_LAST;
        while !happened(self) {
            let told = (self.lines.lock().unwrap().clone(), self.chatter.lock().unwrap().clone());
            assert!(HostInstant::now() < end, "never happened: {what}; {told:#?}");
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Whether there was a line of JSON for which `wanted` holds.
    pub fn has(&self, wanted: impl Fn(&Value) -> bool) -> bool {
        self.lines.lock().unwrap().iter().any(wanted)
    }

    /// Whether the program has printed this on standard error.
    pub fn has_said(&self, text: &str) -> bool {
        self.chatter.lock().unwrap().iter().any(|line| line.contains(text))
    }

    /// The program's latest line on standard error with this text.
    pub fn chatter_line(&self, text: &str) -> String {
        let chatter = self.chatter.lock().unwrap();
        chatter.iter().rfind(|line| line.contains(text)).cloned().unwrap_or_default()
    }

    /// All lines of JSON so far.
    pub fn lines(&self) -> Vec<Value> {
        self.lines.lock().unwrap().clone()
    }

    /// Number of events such as `it pressed`.
    pub fn count(&self, event: &str) -> usize {
        events(&self.lines.lock().unwrap()).iter().filter(|one| *one == event).count()
    }

    fn boards(&self) -> &Boards {
        self.boards.as_ref().unwrap()
    }

    /// Puts the foot with `force` newtons onto the control's middle; 0 lifts it.
    pub fn press(&self, force: f32) {
        self.press_at(MIDDLE, force);
    }

    pub fn press_at(&self, at: Vec2, force: f32) {
        self.boards().work.lock().unwrap().target = (at, force);
    }

    /// Changes the readings of boards from now on.
    pub fn change(&self, change: impl FnMut(u16, &mut Readings) -> bool + Send + 'static) {
        self.boards().work.lock().unwrap().change = Box::new(change);
    }

    /// Every datagram that the boards have sent since the last call.
    pub fn take_sent(&self) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.boards().work.lock().unwrap().sent)
    }

    /// Presses the control until it is held: a busy machine may lose packets, and then the foot must lift first.
    pub fn press_until_it_is_held(&self) {
        let before = self.count("it pressed");
        let end = HostInstant::now() + AT_LAST;
        while self.count("it pressed") == before {
            assert!(HostInstant::now() < end, "it is never held: {:?}", self.lines());
            self.press(0.0);
            thread::sleep(Duration::from_millis(300));
            self.press(150.0);
            thread::sleep(Duration::from_millis(1000));
        }
    }

    /// Number of ended presses of the control.
    pub fn ends(&self) -> usize {
        self.count("it cancelled") + self.count("it released")
    }

    /// Whether packets of boards were missing for so long that the floor or a part of it was lost.
    pub fn was_lost(&self) -> bool {
        self.has(|line| line["state"] == "lost" || line["state"] == "partial")
    }

    /// Taps the control until it has clicked once more: a busy machine may stall and lose a press.
    pub fn tap_until_it_clicks(&self) {
        let before = self.count("it clicked");
        let end = HostInstant::now() + AT_LAST;
        while self.count("it clicked") == before {
            assert!(HostInstant::now() < end, "it never clicks: {:?}", self.lines());
            self.press(150.0);
            thread::sleep(Duration::from_millis(300));
            self.press(0.0);
            thread::sleep(Duration::from_millis(300));
        }
    }

    /// A request and its answer, if one comes.
    pub fn ask(&self, request: &[u8]) -> Option<Vec<u8>> {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
        let mut answer = [0; 512];
        (0..50).find_map(|_| {
            socket.send_to(request, self.address).unwrap();
            let length = socket.recv(&mut answer).ok()?;
            Some(answer[..length].to_vec())
        })
    }

    /// Sends a signal to the program.
    pub fn signal(&self, name: &str) {
        let status = Command::new("kill").args(["-s", name, &self.served.0.id().to_string()]).status();
        assert!(status.unwrap().success());
    }

    /// Ends the program by SIGTERM; returns its exit status and its standard error.
    pub fn end(mut self) -> (Option<i32>, String) {
        self.boards = None;
        terminate(&self.served.0);
        let status = self.served.0.wait().unwrap();
        self.readers.drain(..).for_each(|reader| reader.join().unwrap());
        (status.code(), self.chatter.lock().unwrap().join("\n"))
    }
}

/// Stores each line of `from`, converted by `read`.
fn keep<T: Send + 'static>(
    from: impl Read + Send + 'static,
    kept: Arc<Mutex<Vec<T>>>,
    read: impl Fn(&str) -> T + Send + 'static,
) -> JoinHandle<()> {
    thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            kept.lock().unwrap().push(read(&line));
        }
    })
}

/// The boards' instructions.
struct Work {
    target: (Vec2, f32),
    change: Change,
    sent: Vec<Vec<u8>>,
    is_over: bool,
}

/// Boards that send a millisecond's packets every millisecond, until dropped.
struct Boards {
    work: Arc<Mutex<Work>>,
    thread: Option<JoinHandle<()>>,
}

impl Boards {
    fn start(floor: &Floor, mut sim: SimFloor, target: SocketAddr) -> Self {
        let idle =
            Work { target: (MIDDLE, 0.0), change: Box::new(|_, _| true), sent: Vec::new(), is_over: false };
        let work = Arc::new(Mutex::new(idle));
        let asked = Arc::clone(&work);
        let mut counts = SensorEncoder::new(floor, SensorFormat::Counts);
        let mut newtons = SensorEncoder::new(floor, SensorFormat::Newtons);
        let thread = thread::spawn(move || {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            let begun = HostInstant::now();
            let mut force = 0.0;
            for sequence in 0.. {
                let mut work = asked.lock().unwrap();
                if work.is_over {
                    return;
                }
                let (at, wanted) = work.target;
                force += (wanted - force).clamp(-RAMP_N, RAMP_N);
                let feet = [foot(at, force)];
                let all = sim.step(if force > 0.0 { &feet } else { &[] });
                for (board, readings) in (0..).zip(all) {
                    let mut readings = readings.clone();
                    if !(work.change)(board, &mut readings) {
                        continue;
                    }
                    let encoder =
                        if matches!(readings, Readings::Newtons(_)) { &mut newtons } else { &mut counts };
                    let packet = SensorPacket { board, sequence, received: Instant::START, readings };
                    let datagram = encoder.encode(&packet).unwrap().to_vec();
                    // The receiver may be gone.
                    let _ = socket.send_to(&datagram, target);
                    work.sent.push(datagram);
                }
                drop(work);
                let due = Duration::from_millis(u64::from(sequence) + 1);
                thread::sleep(due.saturating_sub(begun.elapsed()));
            }
        });
        Self { work, thread: Some(thread) }
    }
}

impl Drop for Boards {
    fn drop(&mut self) {
        self.work.lock().unwrap_or_else(PoisonError::into_inner).is_over = true;
        // A thread that has panicked has printed so.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}
