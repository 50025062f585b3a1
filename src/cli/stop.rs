//! Ctrl-C, termination, a terminal or console that is closed and a panic end a command in order.

use std::io;
use std::panic;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::failure::Failure;

/// A flag that Ctrl-C, a polite kill and a terminal that is closed set; a second Ctrl-C ends the program at once.
///
/// Only that: service managers send several signals to end a program once. On Windows the end of a session and of the
/// system set it too.
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

    /// Longer than Windows waits for a program whose console closes, or whose user logs off: 5 and 20 s.
    const UNTIL_KILLED: Duration = Duration::from_secs(30);

    /// Windows calls this on a thread of its own. It ends the program as soon as this returns from an event that is not a
    /// key, so that it does not: the program ends by itself, or is ended.
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
        // SAFETY: the handler has the signature that is asked for, lives as long as the program, and runs on a
        // thread of its own, which may lock.
        let added = unsafe { SetConsoleCtrlHandler(Some(end), 1) };
        if added == 0 { Err(io::Error::last_os_error()) } else { Ok(()) }
    }
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
