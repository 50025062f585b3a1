//! Binds a thread to a core.

/// One of the cores that this program may use.
#[derive(Clone, Copy, Debug)]
pub(super) enum Core {
    /// The core with the lowest number.
    First,
    /// The core with the highest number; the same as `First` if there is only one.
    Last,
}

/// Binds this thread to a core. On a real floor the boards do not run on the receiving computer: if the simulated
/// sender and the receiver shared a core, waking would cost nothing.
#[cfg(target_os = "linux")]
pub(super) fn stay_on(core: Core) {
    use nix::sched::{CpuSet, sched_getaffinity, sched_setaffinity};
    use nix::unistd::Pid;
    use std::sync::LazyLock;
    const THIS_THREAD: Pid = Pid::from_raw(0);
    /// Cores that the system allowed before any thread was bound: threads inherit their allowed cores.
    static ALLOWED: LazyLock<Vec<usize>> = LazyLock::new(|| {
        let allowed = sched_getaffinity(THIS_THREAD).unwrap_or_default();
        (0..CpuSet::count()).filter(|core| allowed.is_set(*core).unwrap_or(false)).collect()
    });
    let number = match core {
        Core::First => ALLOWED.first(),
        Core::Last => ALLOWED.last(),
    };
    let mut only = CpuSet::new();
    if number.is_some_and(|number| only.set(*number).is_ok()) {
        // If the system refuses, the thread stays on the core that the system chooses.
        let _ = sched_setaffinity(THIS_THREAD, &only);
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn stay_on(_: Core) {}
