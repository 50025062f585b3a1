//! How long a thread has worked.

use std::time::Duration;

/// How long this thread has worked: what other programs take of the core in the meantime is not this floor's cost.
#[cfg(target_os = "linux")]
pub(super) fn busy() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map(Duration::from).unwrap_or_default()
}

/// Elsewhere time that passes is all there is.
#[cfg(not(target_os = "linux"))]
pub(super) fn busy() -> Duration {
    use std::sync::LazyLock;
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGUN.elapsed()
}
