//! Working time of a thread.

use std::time::Duration;

/// Processor time of this thread. It excludes the time that other programs use the core.
#[cfg(target_os = "linux")]
pub(super) fn busy() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map(Duration::from).unwrap_or_default()
}

/// Wall-clock time on other systems; it includes other programs.
#[cfg(not(target_os = "linux"))]
pub(super) fn busy() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGUN.elapsed()
}
