//! Work beside the frames of the window, on a thread.

use std::thread;
use std::time::Instant;

/// Calls `work` again and again, on a thread called `name`: at `first`, and then at each time that it returns, until
/// it returns `None`.
///
/// # Errors
/// The error of a system that starts no thread.
pub(crate) fn repeat(
    name: &str,
    first: Instant,
    mut work: impl FnMut() -> Option<Instant> + Send + 'static,
) -> std::io::Result<()> {
    let run = move || {
        let mut due = first;
        loop {
            thread::sleep(due.saturating_duration_since(Instant::now()));
            let Some(next) = work() else { return };
            due = next;
        }
    };
    thread::Builder::new().name(name.into()).spawn(run).map(drop)
}
