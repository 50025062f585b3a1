//! Packets and requests from a UDP socket.

mod log;
mod proc_net;
mod stamped;
mod timed;

use std::collections::VecDeque;
use std::io::ErrorKind;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::time::{Duration, Instant as HostInstant, SystemTime};

use rosc::OscTime;
use socket2::{Domain, Protocol, Socket, Type};

use self::log::RefusalLog;
use self::stamped::{Received, Stamped};
use self::timed::{Timed, delay};
use super::{SensorSource, SourceError};
use crate::floor::Floor;
use crate::outgoing::write_error;
use crate::units::{HostClock, Instant};
use crate::wire::{Batch, Decoder, LinkCounters, Prefix, Request, SensorPacket, WireError};

/// Receive buffer asked for: it holds through half a second of stalled reader on a large floor.
const BUFFER_BYTES: usize = 8 << 20;

/// Most control messages kept until they are taken; more are dropped and counted as overflowed.
const MAX_CONTROLS: usize = 1024;

/// Most datagrams examined in one call without patience, so that a flood of rubbish cannot hold it.
const MAX_UNWAITED: usize = 64;

/// How often the kernel is asked how many datagrams it dropped.
const DROPS_EVERY: Duration = Duration::from_secs(1);

/// Sensor packets and control messages from a UDP socket.
///
/// Its clock starts at zero when the socket is bound. On Linux packets are
/// stamped with the moment the kernel received them; elsewhere when the program
/// takes them, so that the stamp includes the time the thread needed to wake up.
#[derive(Debug)]
pub struct UdpSource {
    socket: UdpSocket,
    stamped: Stamped,
    /// When the last datagram came.
    received: Instant,
    granted: usize,
    started: HostInstant,
    patience: Option<Duration>,
    buffer: Vec<u8>,
    decoder: Decoder,
    batch: Batch,
    packets: VecDeque<SensorPacket>,
    requests: VecDeque<Request>,
    /// Requests whose time tag has not come.
    timed: Timed,
    answer: Vec<u8>,
    allowed: Vec<IpAddr>,
    counters: LinkCounters,
    drops_read: Instant,
    kernel_drops: u64,
    log: RefusalLog,
}

impl UdpSource {
    /// Listens on `address` for the boards of `floor`; port 0 takes any free one.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if the port is taken or the address is not this
    /// machine's; its message says what to do.
    pub fn bind(address: SocketAddr, floor: &Floor) -> Result<Self, SourceError> {
        let socket = open(address)
            .map_err(|source| SourceError::Socket { message: advice(address, &source), source })?;
        let granted = socket.recv_buffer_size().unwrap_or(0);
        if granted < BUFFER_BYTES {
            tracing::info!(
                granted,
                "the system grants less than the 8 MiB of receive buffer asked for; on Linux, \
                 `sysctl -w net.core.rmem_max=8388608` lets it be larger"
            );
        }
        let decoder = Decoder::new(floor);
        let socket = UdpSocket::from(socket);
        Ok(Self {
            stamped: Stamped::on(&socket),
            received: Instant::START,
            socket,
            granted,
            started: HostInstant::now(),
            patience: None,
            // One byte more than may come tells what was cut off from what just fits.
            buffer: vec![0; decoder.limits().bytes + 1],
            decoder,
            batch: Batch::default(),
            packets: VecDeque::new(),
            requests: VecDeque::new(),
            timed: Timed::default(),
            answer: Vec::new(),
            allowed: Vec::new(),
            counters: LinkCounters::default(),
            drops_read: Instant::START,
            kernel_drops: 0,
            log: RefusalLog::default(),
        })
    }

    /// Takes datagrams from these senders only; from everybody if there are none.
    #[must_use]
    pub fn allowing(mut self, senders: impl IntoIterator<Item = IpAddr>) -> Self {
        self.allowed = senders.into_iter().collect();
        self
    }

    /// Takes requests whose addresses begin with `prefix`.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.decoder = self.decoder.with_prefix(prefix);
        self
    }

    /// Where it listens, with the port the system chose if 0 was asked for.
    ///
    /// # Errors
    /// What the system says; it should not happen on a bound socket.
    pub fn local_addr(&self) -> std::io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    /// The receive buffer granted, in bytes as the system counts them (Linux
    /// reports twice the size asked for, its bookkeeping included); 0 if it does not say.
    #[must_use]
    pub const fn granted_buffer(&self) -> usize {
        self.granted
    }

    /// The clock that stamps packets, for measuring how long what follows takes.
    #[must_use]
    pub fn clock(&self) -> HostClock {
        let started = self.started;
        Arc::new(move || Instant::START + started.elapsed())
    }

    /// Receives one datagram and sorts what it holds; false if none came.
    fn receive(&mut self, patience: Duration) -> Result<bool, SourceError> {
        self.set_patience(patience).map_err(failed)?;
        let Received { length, sender, waited } = match self.stamped.receive(&self.socket, &mut self.buffer) {
            Ok(received) => received,
            Err(error) if is_passing(error.kind()) => return Ok(false),
            Err(error) => return Err(failed(error)),
        };
        self.counters.datagrams += 1;
        let now = self.now();
        // The wall clock that the kernel stamps by may be slewed; time still never goes back.
        self.received = self.received.max(now.before(waited));
        if !self.allowed.is_empty() && !self.allowed.contains(&sender.ip().to_canonical()) {
            self.counters.foreign += 1;
            self.log.foreign(now, sender);
            return Ok(true);
        }
        let decoded = self.decoder.decode(&self.buffer[..length], self.received, &mut self.batch);
        match decoded.and_then(|()| self.wait()) {
            Ok(wait) => {
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
            Err(error) => {
                error.count(&mut self.counters);
                self.log.refused(now, sender, &error);
                if let Some(address) = self.decoder.is_answered(&error) {
                    let mut answer = std::mem::take(&mut self.answer);
                    write_error(self.decoder.prefix(), address, &error.to_string(), &mut answer);
                    self.answer(sender, &answer);
                    self.answer = answer;
                }
            }
        }
        Ok(true)
    }

    /// How long the requests of the batch are to wait.
    fn wait(&self) -> Result<Duration, WireError> {
        let Some(due) = self.batch.due else { return Ok(Duration::ZERO) };
        // Without a wall clock nothing can be waited for.
        OscTime::try_from(SystemTime::now()).map_or(Ok(Duration::ZERO), |clock| delay(due, clock))
    }

    /// Sets how long the socket waits; zero means not at all. A system call only if it changes.
    fn set_patience(&mut self, patience: Duration) -> std::io::Result<()> {
        if self.patience == Some(patience) {
            return Ok(());
        }
        self.socket.set_nonblocking(patience.is_zero())?;
        if !patience.is_zero() {
            self.socket.set_read_timeout(Some(patience))?;
        }
        self.patience = Some(patience);
        Ok(())
    }

    /// Asks the kernel now and then how many datagrams it dropped on this socket.
    fn read_drops(&mut self, now: Instant) {
        if now.since(self.drops_read) < DROPS_EVERY {
            return;
        }
        self.drops_read = now;
        if let Some(dropped) = proc_net::drops(&self.socket) {
            let before = self.kernel_drops;
            self.kernel_drops = self.kernel_drops.max(dropped);
            self.counters.overflowed += self.kernel_drops - before;
        }
    }
}

impl SensorSource for UdpSource {
    /// A datagram with several packets gives them one by one. Returns after
    /// twice `patience` at most, even while datagrams arrive that hold no sensor packet.
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let begun = self.now();
        self.read_drops(begun);
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

    fn now(&self) -> Instant {
        Instant::START + self.started.elapsed()
    }

    fn take_request(&mut self) -> Option<Request> {
        self.requests.pop_front().or_else(|| self.timed.take(self.now()))
    }

    /// Whoever asked and went away hears nothing; that is not an error of this end.
    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        if let Err(error) = self.socket.send_to(datagram, to) {
            tracing::debug!(%to, "an answer could not be sent: {error}");
        }
    }

    fn counters(&self) -> LinkCounters {
        self.counters
    }
}

fn open(address: SocketAddr) -> std::io::Result<Socket> {
    let socket = Socket::new(Domain::for_address(address), Type::DGRAM, Some(Protocol::UDP))?;
    // A smaller buffer than asked for works too; the granted size is reported.
    let _ = socket.set_recv_buffer_size(BUFFER_BYTES);
    socket.bind(&address.into())?;
    Ok(socket)
}

/// One sentence for somebody whose floor program does not start.
fn advice(address: SocketAddr, error: &std::io::Error) -> String {
    let port = address.port();
    match error.kind() {
        ErrorKind::AddrInUse => {
            let owner = proc_net::owner(address).unwrap_or_else(|| "another program".into());
            let other = SocketAddr::new(address.ip(), if port == u16::MAX { port - 1 } else { port + 1 });
            format!(
                "UDP port {port} is in use by {owner}: stop it, or listen elsewhere with `--listen {other}` \
                 and send there"
            )
        }
        ErrorKind::AddrNotAvailable => format!(
            "{ip} is no address of this machine: `--listen 0.0.0.0:{port}` takes packets on all of them",
            ip = address.ip()
        ),
        ErrorKind::PermissionDenied => {
            format!("UDP port {port} needs special rights: choose one above 1023 with `--listen`")
        }
        _ => format!("cannot listen on {address}: {error}"),
    }
}

/// Errors after which the next datagram may well come: nothing there, a signal,
/// or the echo of something sent to a port that is closed.
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
