//! Which core a thread runs on.

/// Which of the cores that this program may use.
#[derive(Clone, Copy, Debug)]
pub(super) enum Core {
    /// That of the lowest number.
    First,
    /// That of the highest; the same if there is only one.
    Last,
}

/// Keeps this thread on a core. Boards have none of the computer that takes their packets: if sender and receiver came
/// to share one, waking would cost nothing.
#[cfg(target_os = "linux")]
pub(super) fn stay_on(core: Core) {
    use nix::sched::{CpuSet, sched_getaffinity, sched_setaffinity};
    use nix::unistd::Pid;
    use std::sync::LazyLock;
    const THIS_THREAD: Pid = Pid::from_raw(0);
    /// As the system allowed it before any thread stayed on a core: threads inherit where they may run.
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
        // Where that is not allowed, it stays where the system puts it.
        let _ = sched_setaffinity(THIS_THREAD, &only);
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn stay_on(_: Core) {}
