//! How long a thread has worked.

use std::time::Duration;

/// Processor time of this thread: the time that other programs take of the core is not this floor's cost.
#[cfg(target_os = "linux")]
pub(super) fn busy() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map(Duration::from).unwrap_or_default()
}

/// Elsewhere the time that passes: other programs count.
#[cfg(not(target_os = "linux"))]
pub(super) fn busy() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGUN.elapsed()
}
