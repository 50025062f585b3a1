//! Sensor packets and requests from a UDP socket.

mod admission;
mod drops;
mod forward;
mod log;
mod open;
mod parts;
mod proc_net;
mod reception;
mod seal;
mod senders;
mod stamped;
mod timed;

use std::collections::VecDeque;
use std::io::ErrorKind;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant as HostInstant, SystemTime};

use rosc::OscTime;

use self::admission::{Admission, AdmissionRefusal, OscArrival};
use self::drops::KernelDrops;
pub use self::forward::ForwardCounters;
use self::forward::Forwarder;
use self::log::RefusalLog;
use self::open::{BUFFER_BYTES, open};
use self::reception::Reception;
pub use self::seal::{Seal, Sealed};
use self::stamped::Received;
use self::timed::{Timed, delay};
use super::{Port, SourceError};
use crate::floor::{Floor, Forwarding, Network, canonical};
use crate::outgoing::write_error;
use crate::units::{HostClock, Instant};
use crate::wire::{
    Batch, Decoder, LinkCause, LinkCounters, Prefix, Request, SensorPacket, WireError, guess_format,
};

/// Maximum number of queued control messages; further ones are dropped and counted as overflowed.
const MAX_CONTROLS: usize = 1024;

/// Maximum number of datagrams examined in one call without patience, so that a flood of invalid ones can't block it.
const MAX_UNWAITED: usize = 64;

/// Interval between two reads of the requests' own port, and maximum number of datagrams per read.
const REQUESTS_EVERY: Duration = Duration::from_millis(1);
const MAX_REQUESTS: usize = 32;

/// Time for which a refusal of something from boards takes precedence over refused requests.
const KEPT_REFUSAL: Duration = Duration::from_secs(1);

/// Sensor packets and control messages from a UDP socket.
///
/// It accepts packets from the floor's networks ([`Floor::allow`]), by default from this machine only, and requests
/// from this machine only, on the same port, unless [`UdpSource::with_commands`] opens one for them.
///
/// As the input of a floor it consists of two parts, the packets and the [`Port`]: [`FloorInput`](super::FloorInput)
/// gets it whole. [`UdpSource::next`] receives both.
///
/// Its clock starts at zero when the socket is bound. On Linux the stamp of a packet is the time at which the kernel
/// received it; elsewhere it is the time at which the program reads it, which includes the wake-up time of the
/// thread.
#[derive(Debug)]
pub struct UdpSource {
    socket: UdpSocket,
    /// The requests' own port, if any, and the time of its last read.
    commands: Option<(UdpSocket, Instant)>,
    reception: Reception,
    started: HostInstant,
    decoder: Decoder,
    batch: Batch,
    packets: VecDeque<SensorPacket>,
    requests: VecDeque<Request>,
    /// Requests that wait for the time of their time tag.
    timed: Timed,
    answer: Vec<u8>,
    admission: Admission,
    forwarder: Option<Forwarder>,
    /// Authenticates other computers of the floor.
    seal: Option<Box<dyn Seal>>,
    boards: usize,
    counters: LinkCounters,
    kernel_drops: KernelDrops,
    log: RefusalLog,
    /// Cause and time of the last refusal.
    last_refused: Option<(LinkCause, Instant)>,
}

impl UdpSource {
    /// Listens on `address` for the boards of `floor`; port 0 takes a free one.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if the port is in use or the address is not this machine's; its message gives the
    /// remedy.
    pub fn bind(address: SocketAddr, floor: &Floor) -> Result<Self, SourceError> {
        let (socket, granted) = open(canonical(address))?;
        if granted < BUFFER_BYTES {
            tracing::info!(
                granted,
                "the system grants less than the 8 MiB of receive buffer asked for; on Linux, \
                 `sysctl -w net.core.rmem_max=8388608` lets it be larger"
            );
        }
        let decoder = Decoder::new(floor);
        Ok(Self {
            reception: Reception::on(&socket, granted),
            socket,
            commands: None,
            started: HostInstant::now(),
            decoder,
            batch: Batch::default(),
            packets: VecDeque::new(),
            requests: VecDeque::new(),
            timed: Timed::default(),
            answer: Vec::new(),
            admission: Admission::new(floor),
            forwarder: None,
            seal: None,
            boards: floor.boards.len(),
            counters: LinkCounters::default(),
            kernel_drops: KernelDrops::default(),
            log: RefusalLog::default(),
            last_refused: None,
        })
    }

    /// Listens on `address` for requests alone, from these networks; port 0 takes a free one.
    ///
    /// # Errors
    /// [`SourceError::Socket`] as for [`UdpSource::bind`].
    pub fn requests(
        address: SocketAddr,
        networks: impl IntoIterator<Item = Network>,
    ) -> Result<Self, SourceError> {
        // A floor without boards accepts no packets.
        let mut source = Self::bind(address, &Floor { boards: Vec::new(), ..Floor::default() })?;
        source.admission.set_boards(Vec::new());
        source.admission.set_apps_here(networks.into_iter().collect());
        Ok(source)
    }

    /// Accepts sensor packets from these networks only, instead of the floor's; with an empty list, from no sender.
    #[must_use]
    pub fn allowing(mut self, networks: impl IntoIterator<Item = Network>) -> Self {
        self.admission.set_boards(networks.into_iter().collect());
        self
    }

    /// Also accepts sensor packets from these computers, which forward them.
    #[must_use]
    pub fn also_allowing(mut self, computers: impl IntoIterator<Item = IpAddr>) -> Self {
        self.admission.add_boards(computers.into_iter().map(Network::from));
        self
    }

    /// Forwards packets of some boards to other computers, from a port of its own; also returns the counters.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if the system provides no port.
    pub fn forwarding(
        mut self,
        forwardings: &[Forwarding],
    ) -> Result<(Self, Arc<ForwardCounters>), SourceError> {
        let local = self.local_addr().map_err(failed)?;
        let forwarder = Forwarder::new(local, forwardings).map_err(failed)?;
        let counters = forwarder.counters();
        self.forwarder = Some(forwarder);
        Ok((self, counters))
    }

    /// Seals forwarded packets and accepts sealed ones from these `computers`, even if it accepts no other packets
    /// from them.
    #[must_use]
    pub fn sealed_by(mut self, seal: Box<dyn Seal>, computers: impl IntoIterator<Item = IpAddr>) -> Self {
        self.admission.set_computers(computers.into_iter().collect());
        self.seal = Some(seal);
        self
    }

    /// Pins each board to the address of its first packet until the program ends.
    #[must_use]
    pub fn pinned(mut self) -> Self {
        self.admission.pin(self.boards);
        self
    }

    /// Accepts requests on a port of their own, from these networks only, and no longer on the sensors' port.
    ///
    /// # Errors
    /// [`SourceError::Socket`] as for [`UdpSource::bind`].
    pub fn with_commands(
        mut self,
        address: SocketAddr,
        networks: impl IntoIterator<Item = Network>,
    ) -> Result<Self, SourceError> {
        let (socket, _) = open(canonical(address))?;
        socket.set_nonblocking(true).map_err(failed)?;
        self.admission.set_apps(networks.into_iter().collect());
        self.commands = Some((socket, Instant::START));
        Ok(self)
    }

    /// Accepts requests whose addresses begin with `prefix`.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.decoder = self.decoder.with_prefix(prefix);
        self
    }

    /// The listening address, with the port that the system chose for port 0.
    ///
    /// # Errors
    /// The error of the system; it should not happen on a bound socket.
    pub fn local_addr(&self) -> std::io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    /// The granted receive buffer, in bytes as the system counts them (Linux reports twice the requested size, which
    /// includes its bookkeeping); 0 if the system does not report it.
    #[must_use]
    pub const fn granted_buffer(&self) -> usize {
        self.reception.granted()
    }

    /// The clock that stamps packets, for latency measurements of later stages.
    #[must_use]
    pub fn clock(&self) -> HostClock {
        let started = self.started;
        Arc::new(move || Instant::START + started.elapsed())
    }

    /// The next packet; waits for it at most `patience` and returns `None` if none arrived.
    ///
    /// Returns the packets of one datagram one by one. Returns after twice `patience` at most, even while datagrams
    /// without sensor packets arrive.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if the socket fails.
    pub fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let begun = self.now();
        self.counters.overflowed += self.kernel_drops.look(&self.socket, begun);
        if self.commands.as_ref().is_some_and(|(_, looked)| begun.since(*looked) >= REQUESTS_EVERY) {
            self.receive_commands()?;
        }
        for looked_at in 1.. {
            if let Some(packet) = self.packets.pop_front() {
                return Ok(Some(packet));
            }
            let came = self.receive(patience)?;
            let enough = if patience.is_zero() {
                looked_at >= MAX_UNWAITED
            } else {
                self.now().since(begun) >= patience
            };
            if self.packets.is_empty() && (!came || enough) {
                break;
            }
        }
        Ok(None)
    }

    /// The present on the clock that stamps packets.
    #[must_use]
    pub fn now(&self) -> Instant {
        Instant::START + self.started.elapsed()
    }

    /// Numbers of datagrams received and refused.
    #[must_use]
    pub const fn counters(&self) -> LinkCounters {
        self.counters
    }

    /// Receives one datagram and sorts its content; false if none arrived.
    fn receive(&mut self, patience: Duration) -> Result<bool, SourceError> {
        self.reception.set_patience(&self.socket, patience).map_err(failed)?;
        let Received { length, sender, waited } = match self.reception.receive(&self.socket) {
            Ok(received) => received,
            Err(error) if is_passing(error.kind()) => return Ok(false),
            Err(error) => return Err(failed(error)),
        };
        let now = self.now();
        self.reception.note_arrival(now, waited);
        self.sort(sender, length, false, now);
        Ok(true)
    }

    /// Receives datagrams on the requests' own port.
    fn receive_commands(&mut self) -> Result<(), SourceError> {
        for _ in 0..MAX_REQUESTS {
            let now = self.now();
            let Some((socket, looked)) = &mut self.commands else { return Ok(()) };
            match socket.recv_from(&mut self.reception.buffer) {
                Ok((length, sender)) => self.sort(sender, length, true, now),
                Err(error) if is_passing(error.kind()) => {
                    *looked = now;
                    return Ok(());
                }
                Err(error) => return Err(failed(error)),
            }
        }
        if let Some((_, looked)) = &mut self.commands {
            *looked = Instant::START + self.started.elapsed();
        }
        Ok(())
    }

    /// Sorts the content of the datagram in the buffer: packets, requests, or a reason to refuse it.
    fn sort(&mut self, sender: SocketAddr, length: usize, on_own_port: bool, now: Instant) {
        self.counters.datagrams += 1;
        if let Err(refusal) = self.admission.datagram(sender, on_own_port, now) {
            return self.turn_away(sender, refusal, now);
        }
        let datagram = self.reception.buffer.get(..length).unwrap_or_default();
        // An OSC datagram begins with a slash or a hash.
        let is_osc = datagram.first().is_none_or(|first| b"/#".contains(first));
        match self.seal.as_mut().filter(|_| !is_osc) {
            Some(seal) => match self.admission.sealed(sender, on_own_port).map(|()| seal.open(datagram)) {
                Ok(Sealed::Forwarded(range)) => self.sort_osc((sender, OscArrival::Sealed), range, now),
                // The owner of the seal counts these two.
                Ok(Sealed::Taken | Sealed::Refused) => {}
                Err(refusal) => self.turn_away(sender, refusal, now),
            },
            None => {
                let way = if on_own_port { OscArrival::OwnPort } else { OscArrival::Plain };
                self.sort_osc((sender, way), 0..length, now);
            }
        }
    }

    /// Sorts the OSC datagram in these bytes of the buffer.
    fn sort_osc(&mut self, from: (SocketAddr, OscArrival), bytes: Range<usize>, now: Instant) {
        let (sender, way) = from;
        let datagram = self.reception.buffer.get(bytes.clone()).unwrap_or_default();
        if let Err(error) = self.decoder.decode(datagram, self.reception.received(), &mut self.batch) {
            if let WireError::Malformed(_) = error {
                let why = guess_format(datagram).map_or_else(|| error.to_string(), str::to_owned);
                self.note_refused(LinkCause::NotOsc { why }, now);
            }
            return self.refuse(from, &error, now);
        }
        let wait = self.wait().unwrap_or_else(|error| {
            // Only requests wait: the packets of the same bundle are used.
            self.batch.controls.clear();
            self.batch.refused.push(error);
            Duration::ZERO
        });
        self.refuse_parts(from, now);
        let refusals = self.admission.batch(sender, way, &mut self.batch, now);
        // A packet is forwarded only once.
        let is_forwarded = refusals.is_empty() && !self.batch.packets.is_empty() && way != OscArrival::Sealed;
        refusals.into_iter().for_each(|refusal| self.turn_away(sender, refusal, now));
        if let Some(forwarder) = self.forwarder.as_ref().filter(|_| is_forwarded) {
            let datagram = self.reception.buffer.get(bytes).unwrap_or_default();
            forwarder.forward(datagram, now.since(self.reception.received()), self.seal.as_deref_mut());
        }
        self.packets.extend(self.batch.packets.drain(..));
        let room = MAX_CONTROLS.saturating_sub(self.requests.len() + self.timed.len());
        self.counters.overflowed += self.batch.controls.len().saturating_sub(room) as u64;
        for message in self.batch.controls.drain(..).take(room) {
            let request = Request { message, sender: Some(sender) };
            if wait.is_zero() {
                self.requests.push_back(request);
            } else {
                self.timed.push(now + wait, request);
            }
        }
    }

    /// Counts and logs a refused datagram of `sender`.
    fn turn_away(&mut self, sender: SocketAddr, refusal: AdmissionRefusal, now: Instant) {
        refusal.count(&mut self.counters);
        self.log.not_admitted(now, sender, refusal);
        let why = || format!("{}: {refusal}", sender.ip().to_canonical());
        match refusal {
            AdmissionRefusal::Foreign | AdmissionRefusal::Packets | AdmissionRefusal::Elsewhere(..) => {
                self.note_refused(LinkCause::SenderRefused { why: why() }, now);
            }
            AdmissionRefusal::Requests | AdmissionRefusal::TooMany => {
                self.note_refused(LinkCause::Unknown { last_refused: why() }, now);
            }
        }
    }

    /// Counts and logs a refused datagram or message, and answers its sender if it was a request to this floor.
    fn refuse(&mut self, (sender, way): (SocketAddr, OscArrival), error: &WireError, now: Instant) {
        error.count(&mut self.counters);
        if let Some(cause) = self.decoder.cause_of(error) {
            self.note_refused(cause, now);
        }
        self.log.refused(now, sender, error);
        self.answer_refusal(sender, way, error, now);
    }

    /// Refuses the unused messages of the batch. Skips those for other receivers if the rest of their bundle is used.
    fn refuse_parts(&mut self, from: (SocketAddr, OscArrival), now: Instant) {
        let mut refused = std::mem::take(&mut self.batch.refused);
        let is_used = self.batch.is_used();
        for error in refused.drain(..) {
            match &error {
                WireError::UnknownAddress { address, .. }
                    if is_used && self.decoder.is_answered(&error).is_none() =>
                {
                    self.counters.skipped += 1;
                    self.log.skipped(now, from.0, address);
                }
                _ => self.refuse(from, &error, now),
            }
        }
        // Put back to reuse its allocation.
        self.batch.refused = refused;
    }

    /// Stores the cause of a refusal. The cause of a refused request does not replace a recent one of refused board
    /// data.
    fn note_refused(&mut self, cause: LinkCause, now: Instant) {
        let is_of_boards = |cause: &LinkCause| !matches!(cause, LinkCause::Unknown { .. });
        let keeps = self.last_refused.as_ref().is_some_and(|(last, at)| {
            is_of_boards(last) && !is_of_boards(&cause) && now.since(*at) < KEPT_REFUSAL
        });
        if !keeps {
            self.last_refused = Some((cause, now));
        }
    }

    /// Waiting time of the requests of the batch.
    fn wait(&self) -> Result<Duration, WireError> {
        let Some(due) = self.batch.due else { return Ok(Duration::ZERO) };
        // Without a wall clock, requests do not wait.
        OscTime::try_from(SystemTime::now()).map_or(Ok(Duration::ZERO), |clock| delay(due, clock))
    }

    /// Reports to `sender` why its request was refused, if it may send requests and is within its rate limit.
    fn answer_refusal(&mut self, sender: SocketAddr, way: OscArrival, error: &WireError, now: Instant) {
        let Some(address) = self.decoder.is_answered(error) else { return };
        if !self.admission.is_answered(sender, way) {
            return;
        }
        if let Err(refusal) = self.admission.request(sender, now) {
            refusal.count(&mut self.counters);
            return;
        }
        let mut answer = std::mem::take(&mut self.answer);
        write_error(self.decoder.prefix(), address, &error.to_string(), &mut answer);
        self.answer(sender, &answer);
        self.answer = answer;
    }
}

/// Errors after which the next datagram may well arrive: no datagram, a signal, or the response to something sent to
/// a closed port.
fn is_passing(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::WouldBlock
            | ErrorKind::TimedOut
            | ErrorKind::Interrupted
            | ErrorKind::ConnectionReset
            | ErrorKind::ConnectionRefused
    )
}

fn failed(source: std::io::Error) -> SourceError {
    SourceError::Socket { message: format!("the sensor socket failed: {source}"), source }
}
