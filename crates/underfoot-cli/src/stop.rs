//! Ends a command in order on Ctrl-C, termination, a closed terminal or console, and a panic.

use std::io;
use std::panic;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::failure::Failure;

/// A flag that Ctrl-C, SIGTERM and a closed terminal set; a second Ctrl-C ends the program at once.
///
/// Only Ctrl-C has this effect: service managers send several signals to end a program once. On Windows, the end of a
/// user session and of the system also set the flag.
pub(crate) fn stop_flag() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    set_at_the_end(&stop).map_err(|error| Failure::Other(format!("signals can't be handled: {error}")))?;
    Ok(stop)
}

#[cfg(unix)]
fn set_at_the_end(stop: &Arc<AtomicBool>) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag;
    let interrupted = Arc::new(AtomicBool::new(false));
    flag::register_conditional_shutdown(SIGINT, 130, Arc::clone(&interrupted))?;
    flag::register(SIGINT, interrupted)?;
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        flag::register(signal, Arc::clone(stop))?;
    }
    Ok(())
}

#[cfg(windows)]
fn set_at_the_end(stop: &Arc<AtomicBool>) -> io::Result<()> {
    console::set_at_the_end(stop)
}

#[cfg(windows)]
mod console {
    //! Events of a Windows console: keys, and everything that ends it.

    use std::io;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Arc, Mutex, PoisonError};
    use std::time::Duration;

    use windows_sys::Win32::System::Console::{CTRL_BREAK_EVENT, CTRL_C_EVENT, SetConsoleCtrlHandler};

    static STOPS: Mutex<Vec<Arc<AtomicBool>>> = Mutex::new(Vec::new());

    /// Longer than Windows waits for a program after its console closes (5 s) or its user logs off (20 s).
    const UNTIL_KILLED: Duration = Duration::from_secs(30);

    /// Windows calls this on a thread of its own. After an event that is not a key, Windows ends the program as soon
    /// as this returns, so it does not return: the program ends by itself, or Windows ends it.
    unsafe extern "system" fn end(event: u32) -> i32 {
        let stops = STOPS.lock().unwrap_or_else(PoisonError::into_inner);
        let again = stops.iter().fold(false, |again, stop| stop.swap(true, Ordering::Relaxed) || again);
        drop(stops);
        if matches!(event, CTRL_C_EVENT | CTRL_BREAK_EVENT) {
            // 0 leaves a second key to Windows, which ends the program at once.
            return i32::from(!again);
        }
        std::thread::sleep(UNTIL_KILLED);
        1
    }

    pub(super) fn set_at_the_end(stop: &Arc<AtomicBool>) -> io::Result<()> {
        STOPS.lock().unwrap_or_else(PoisonError::into_inner).push(Arc::clone(stop));
        // SAFETY: the handler has the required signature, exists as long as the program, and runs on a thread of its
        // own, which may lock.
        let added = unsafe { SetConsoleCtrlHandler(Some(end), 1) };
        if added == 0 { Err(io::Error::last_os_error()) } else { Ok(()) }
    }
}

/// A flag that a panic in any thread sets together with `stop`: threads that still work end in order.
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
