//! Ctrl-C, termination, a terminal that is closed and a panic end a command in order.

use std::panic;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

use super::failure::Failure;

/// A flag that Ctrl-C, a polite kill and a terminal that is closed set; a second Ctrl-C ends the program at once.
///
/// Only that: service managers send several signals to end a program once.
pub(crate) fn stop_flag() -> Result<Arc<AtomicBool>, Failure> {
    let (stop, interrupted) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
    let shutdown = flag::register_conditional_shutdown(SIGINT, 130, Arc::clone(&interrupted));
    shutdown
        .and_then(|_| flag::register(SIGINT, interrupted))
        .and_then(|_| {
            [SIGINT, SIGTERM, SIGHUP]
                .into_iter()
                .try_for_each(|signal| flag::register(signal, Arc::clone(&stop)).map(|_| ()))
        })
        .map_err(|error| Failure::Other(format!("signals can't be handled: {error}")))?;
    Ok(stop)
}

/// A flag that a panic in any thread sets, besides `stop`: threads that still work end in order.
pub(crate) fn panic_flag(stop: &Arc<AtomicBool>) -> Arc<AtomicBool> {
    let panicked = Arc::new(AtomicBool::new(false));
    let (stop, set, report) = (Arc::clone(stop), Arc::clone(&panicked), panic::take_hook());
    panic::set_hook(Box::new(move |info| {
        set.store(true, Ordering::Relaxed);
        stop.store(true, Ordering::Relaxed);
        report(info);
    }));
    panicked
}
