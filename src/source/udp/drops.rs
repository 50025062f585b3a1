//! Datagrams that the kernel drops because the program does not read them in time.

use std::net::UdpSocket;
use std::time::Duration;

use tracing::warn;

use super::proc_net;
use crate::rate_limit::RateLimit;
use crate::units::Instant;

/// Interval between two reads of the kernel's counter, which is in a file.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// Minimum time between two log messages.
const TELL_EVERY: Duration = Duration::from_secs(60);

/// The kernel's counter of datagrams dropped on a socket.
#[derive(Debug)]
pub(super) struct KernelDrops {
    looked: Instant,
    count: u64,
    notices: RateLimit,
}

impl Default for KernelDrops {
    fn default() -> Self {
        Self { looked: Instant::START, count: 0, notices: RateLimit::new(1, TELL_EVERY) }
    }
}

impl KernelDrops {
    /// Number of datagrams dropped on `socket` since the last read: 0 if that was less than a second ago, or if the
    /// kernel does not report it. Logs drops once a minute, with the setting that helps.
    pub(super) fn look(&mut self, socket: &UdpSocket, now: Instant) -> u64 {
        if now.since(self.looked) < LOOK_EVERY {
            return 0;
        }
        self.looked = now;
        let count = proc_net::drops(socket).unwrap_or_default().max(self.count);
        let dropped = count - std::mem::replace(&mut self.count, count);
        if dropped > 0 && self.notices.take(now).is_some() {
            warn!(
                "the system dropped {dropped} datagrams, since this program did not read them in time and its receive \
                 buffer was full; on Linux, `sysctl -w net.core.rmem_max=8388608` allows a larger one"
            );
        }
        dropped
    }
}
