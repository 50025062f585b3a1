//! Signs of life for a service manager that speaks systemd's protocol.

use std::env;
use std::io;
use std::os::unix::net::{SocketAddr, UnixDatagram};
use std::time::{Duration, Instant as HostInstant};

use tracing::warn;
use underfoot::sink::{EventSink, Report};
use underfoot::units::Instant;

/// From one sign to the next: half of the second that `WatchdogSec` should at least be.
const EVERY: Duration = Duration::from_millis(500);

/// Tells a service manager that the floor is served, from the thread that serves it: one that hangs gives no sign.
///
/// # Source
/// sd_notify(3): datagrams to the socket that `NOTIFY_SOCKET` names, a path or, after `@`, an abstract name.
pub(crate) struct Watchdog {
    socket: UnixDatagram,
    manager: SocketAddr,
    told: Option<HostInstant>,
}

impl Watchdog {
    /// One that tells whoever started this program, if that wants to know.
    pub(crate) fn of_environment() -> Option<Self> {
        let name = env::var("NOTIFY_SOCKET").ok()?;
        match Self::new(&name) {
            Ok(watchdog) => Some(watchdog),
            Err(error) => {
                warn!("the service manager at {name} is not told that this program lives: {error}");
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
        Ok(Self { socket, manager, told: None })
    }

    fn say(&self, what: &str) {
        // A manager that reads nothing starts the program again, which is what it is for.
        let _ = self.socket.send_to_addr(what.as_bytes(), &self.manager);
    }
}

impl EventSink for Watchdog {
    fn report(&mut self, _: Report<'_>) {}

    fn poll(&mut self, _: Instant) {
        match self.told {
            None => self.say("READY=1"),
            Some(told) if told.elapsed() < EVERY => return,
            Some(_) => self.say("WATCHDOG=1"),
        }
        self.told = Some(HostInstant::now());
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.say("STOPPING=1");
    }
}
