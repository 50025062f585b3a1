//! Alive signals for a service manager with systemd's protocol.

use std::env;
use std::io;
use std::os::unix::net::{SocketAddr, UnixDatagram};
use std::time::{Duration, Instant as HostInstant};

use tracing::warn;

use super::{EventSink, Report};
use crate::units::Instant;

/// Time between two signals: a quarter of the two seconds that the shipped units set as `WatchdogSec`.
const EVERY: Duration = Duration::from_millis(500);

/// Reports to a service manager that a program serves its floor: `READY=1` when it begins, `WATCHDOG=1` twice a
/// second from the thread that polls its sinks, `STOPPING=1` when it is dropped. A thread that hangs sends no signal.
///
/// # Source
/// sd_notify(3): datagrams to the socket that `NOTIFY_SOCKET` names, a path or, after `@`, an abstract name.
#[derive(Debug)]
pub struct Watchdog {
    socket: UnixDatagram,
    manager: SocketAddr,
    last_sign: Option<HostInstant>,
}

impl Watchdog {
    /// A watchdog for the service manager that started this process; `None` if there is no such manager, or, with a
    /// line in the log, if its socket cannot be used.
    #[must_use]
    pub fn of_environment() -> Option<Self> {
        let name = env::var("NOTIFY_SOCKET").ok()?;
        match Self::new(&name) {
            Ok(watchdog) => Some(watchdog),
            Err(error) => {
                warn!("the service manager at {name} gets no signs of life: {error}");
                None
            }
        }
    }

    fn new(name: &str) -> io::Result<Self> {
        let manager = match name.strip_prefix('@') {
            #[cfg(target_os = "linux")]
            Some(name) => <SocketAddr as std::os::linux::net::SocketAddrExt>::from_abstract_name(name)?,
            _ => SocketAddr::from_pathname(name)?,
        };
        let socket = UnixDatagram::unbound()?;
        socket.set_nonblocking(true)?;
        Ok(Self { socket, manager, last_sign: None })
    }

    fn send(&self, sign: &str) {
        // A manager with a full queue misses one signal of four and restarts nothing.
        let _ = self.socket.send_to_addr(sign.as_bytes(), &self.manager);
    }
}

impl EventSink for Watchdog {
    fn report(&mut self, _: &Report<'_>) {}

    fn poll(&mut self, _: Instant) {
        match self.last_sign {
            None => self.send("READY=1"),
            Some(last) if last.elapsed() < EVERY => return,
            Some(_) => self.send("WATCHDOG=1"),
        }
        self.last_sign = Some(HostInstant::now());
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.send("STOPPING=1");
    }
}
