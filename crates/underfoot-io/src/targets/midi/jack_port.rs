//! An output port of JACK.
//!
//! Messages wait in a lock-free queue for the next cycle of the server, which takes all. One that has waited longer than
//! [`STALE`], since the server stood still, is left out, unless it lets something come up. Releases at the end of a server
//! or a guardian are repeated for [`REPEATED`].
//!
//! A port connects to its receivers with its first message, or once somebody asks for them. One that stands by does not:
//! its receivers would wait for it in each cycle, for ever if its process stands still.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use jack::{
    AsyncClient, Client, ClientOptions, ClientStatus, Control, MidiOut, NotificationHandler, Port, PortFlags,
    ProcessHandler, ProcessScope, RawMidi, RingBuffer, RingBufferReader, RingBufferWriter, Unowned,
};
use underfoot::messages::MidiTarget;

use super::super::outlet::OutletError;
use super::Urgency;
use super::bytes::MidiBytes;
use super::echoes::Echoes;

/// Longest time for which a message waits for the server.
const STALE: Duration = Duration::from_millis(200);

/// One message in the queue: its length, three bytes, and the millisecond in which it must have gone out (0: none).
const ENTRY: usize = 12;

/// Size of the queue in bytes: 1365 messages, more than a target gets in a second.
const QUEUE: usize = 16_384;

/// Time for which releases are repeated: JACK 1.9.21 needed about 25 ms to notice that a client had died.
const REPEATED: Duration = Duration::from_millis(80);

/// The millisecond of messages that are repeated.
const REPEAT: u64 = u64::MAX;

/// Longest wait for the last messages before the port closes.
const FAREWELL: Duration = Duration::from_millis(120);

/// The type of MIDI ports.
const MIDI: &str = "8 bit raw midi";

/// A port of JACK that is open.
pub(super) struct JackPort {
    client: Option<AsyncClient<ServerWatch, MidiProcess>>,
    /// Its full name.
    name: String,
    port: Port<Unowned>,
    /// Part of the name of a port that it connects to.
    into: Option<String>,
    /// The full names of ports to which it connects later; `None` once it has.
    standing_by: Option<BTreeSet<String>>,
    queue: RingBufferWriter,
    shared: Arc<PortStatus>,
    sent: u64,
}

/// Shared with the callbacks of JACK.
struct PortStatus {
    begun: Instant,
    /// Whether the server has ended, or has thrown this client out.
    is_gone: AtomicBool,
    /// The number of messages that the server has taken, or that were left out.
    taken: AtomicU64,
    /// Whether the next cycle repeats releases.
    repeats: AtomicBool,
}

/// Notices the end of the server.
struct ServerWatch(Arc<PortStatus>);

/// Passes messages on, in each cycle of the server.
struct MidiProcess {
    port: Port<MidiOut>,
    queue: RingBufferReader,
    echoes: Echoes,
    shared: Arc<PortStatus>,
}

impl PortStatus {
    fn millis(&self) -> u64 {
        u64::try_from(self.begun.elapsed().as_millis()).unwrap_or(u64::MAX)
    }
}

impl NotificationHandler for ServerWatch {
    // SAFETY: it stores into an atomic, which the rules of signal handlers allow.
    unsafe fn shutdown(&mut self, _: ClientStatus, _: &str) {
        self.0.is_gone.store(true, Ordering::Relaxed);
    }
}

impl ProcessHandler for MidiProcess {
    fn process(&mut self, _: &Client, scope: &ProcessScope) -> Control {
        let mut writer = self.port.writer(scope);
        // A buffer that is full takes no more in this cycle; the rate of a target is far below that.
        let mut send = |bytes: &[u8]| drop(writer.write(&RawMidi { time: 0, bytes }));
        let now = self.shared.millis();
        let mut repeats = self.echoes.repeat(&mut send);
        while self.queue.space() >= ENTRY {
            let mut entry = [0; ENTRY];
            if self.queue.read_buffer(&mut entry) < ENTRY {
                break;
            }
            let [length, first, second, third, until @ ..] = entry;
            let until = u64::from_le_bytes(until);
            let message = [first, second, third];
            if let Some(bytes) = message.get(..length.into())
                && (until == 0 || now <= until)
            {
                if until == REPEAT {
                    self.echoes.add(length, message);
                    repeats = true;
                    // Before the message counts as taken.
                    self.shared.repeats.store(true, Ordering::Release);
                } else {
                    self.echoes.cancel(first);
                }
                send(bytes);
            }
            self.shared.taken.fetch_add(1, Ordering::Release);
        }
        self.shared.repeats.store(repeats, Ordering::Relaxed);
        Control::Continue
    }
}

impl JackPort {
    /// Opens the port `out` of a client with the name of the target.
    pub(super) fn open(target: &MidiTarget) -> Result<Self, OutletError> {
        let gone = |error: jack::Error| {
            OutletError::Gone(format!("the MIDI port {}: JACK can't be used: {error}", target.port))
        };
        let (client, _) = Client::new(&target.port, ClientOptions::NO_START_SERVER).map_err(gone)?;
        let port = client.register_port("out", MidiOut::default()).map_err(gone)?;
        let (name, kept) = (port.name().map_err(gone)?, port.clone_unowned());
        let (queue, waiting) = RingBuffer::new(QUEUE).map_err(gone)?.into_reader_writer();
        let (is_gone, taken, repeats) = (AtomicBool::new(false), AtomicU64::new(0), AtomicBool::new(false));
        let shared = Arc::new(PortStatus { begun: Instant::now(), is_gone, taken, repeats });
        let echoes = Echoes::new((REPEATED.as_secs_f64() / cycle(&client).as_secs_f64()).ceil() as u32);
        let process = MidiProcess { port, queue, echoes, shared: Arc::clone(&shared) };
        let client = client.activate_async(ServerWatch(Arc::clone(&shared)), process).map_err(gone)?;
        let into = target.into.clone();
        let (client, standing_by) = (Some(client), Some(BTreeSet::new()));
        Ok(Self { client, name, port: kept, into, standing_by, queue: waiting, shared, sent: 0 })
    }

    /// Makes all connections for which it waited, each once: the server takes a cycle or more for one.
    fn take_part(&mut self) {
        if self.standing_by.is_some() {
            self.connect_into();
        }
        if let Some(wanted) = self.standing_by.take() {
            self.connect(&Vec::from_iter(wanted));
        }
    }

    /// Gives `message` to the next cycle.
    pub(super) fn send(&mut self, message: &MidiBytes, urgency: Urgency) -> Result<(), OutletError> {
        self.check()?;
        self.take_part();
        let until = match urgency {
            Urgency::Now => self.shared.millis() + STALE.as_millis() as u64,
            Urgency::Whenever => 0,
            Urgency::Repeated => REPEAT,
        };
        if self.queue.space() < ENTRY {
            return Err(OutletError::Gone("the JACK server stands still".into()));
        }
        let mut entry = [0; ENTRY];
        let (head, tail) = entry.split_at_mut(4);
        head.copy_from_slice(&message.packed());
        tail.copy_from_slice(&until.to_le_bytes());
        self.queue.write_buffer(&entry);
        self.sent += 1;
        Ok(())
    }

    /// # Errors
    /// [`OutletError::Gone`] once the server has ended.
    pub(super) fn check(&self) -> Result<(), OutletError> {
        if self.shared.is_gone.load(Ordering::Relaxed) {
            return Err(OutletError::Gone("the JACK server has ended".into()));
        }
        Ok(())
    }

    /// The full names of the ports that receive from this one; `None` without a server.
    pub(super) fn receivers(&mut self) -> Option<Vec<String>> {
        self.check().ok()?;
        self.take_part();
        let mut names = self.port.get_connections();
        if names.is_empty() && self.connect_into() {
            names = self.port.get_connections();
        }
        Some(names)
    }

    /// Connects this port to those with these full names, now or once it takes part; returns those that are not there.
    pub(super) fn connect(&mut self, receivers: &[String]) -> Vec<String> {
        let Some(client) = self.client.as_ref().filter(|_| self.check().is_ok()) else {
            return receivers.to_vec();
        };
        let client = client.as_client();
        let (there, missing): (Vec<_>, Vec<_>) =
            receivers.iter().cloned().partition(|name| client.port_by_name(name).is_some());
        match &mut self.standing_by {
            // Others appeared earlier, or appear later.
            Some(wanted) => wanted.extend(there),
            None => {
                for receiver in there {
                    // It may be connected already.
                    let _ = client.connect_ports_by_name(&self.name, &receiver);
                }
            }
        }
        missing
    }

    /// Connects this port to those that its target names; returns whether there is one.
    fn connect_into(&mut self) -> bool {
        let (Some(client), Some(into)) = (&self.client, &self.into) else { return false };
        let ports = client.as_client().ports(None, Some(MIDI), PortFlags::IS_INPUT);
        let wanted: Vec<String> = ports.into_iter().filter(|name| name.contains(into.as_str())).collect();
        self.connect(&wanted);
        !wanted.is_empty()
    }
}

/// Time between two cycles of the server.
fn cycle(client: &Client) -> Duration {
    let frames = f64::from(client.buffer_size().max(1));
    Duration::from_secs_f64(frames / f64::from(client.sample_rate().max(1)))
}

impl Drop for JackPort {
    /// Waits for the last messages.
    fn drop(&mut self) {
        let begun = Instant::now();
        let all_taken = || self.shared.taken.load(Ordering::Acquire) >= self.sent;
        let all_said = || all_taken() && !self.shared.repeats.load(Ordering::Acquire);
        while self.check().is_ok() && !all_said() && begun.elapsed() < FAREWELL {
            thread::sleep(Duration::from_millis(1));
        }
        if let Some(client) = self.client.take() {
            // The receivers get them within the cycle in which they were taken.
            if self.sent > 0 && self.check().is_ok() {
                thread::sleep(cycle(client.as_client()).min(FAREWELL));
            }
            let _ = client.deactivate();
        }
    }
}
