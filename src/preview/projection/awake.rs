//! The screen is kept from going dark while the floor is projected.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

/// Keeps the screen awake until it is dropped.
///
/// Systems are asked over a bus that may not answer for seconds: a thread does it, and holds what they give.
pub(super) struct Awake {
    /// The thread lets go once this is gone.
    _held: Sender<()>,
    failed: Receiver<String>,
}

impl Awake {
    pub(super) fn begin() -> Self {
        let (held, until) = channel::<()>();
        let (failure, failed) = channel();
        let keep = move || {
            if let Err(why) = keep_awake_until(&until) {
                // A window that is closed already need not know.
                let _ = failure.send(why);
            }
        };
        if let Err(error) = thread::Builder::new().name("awake".into()).spawn(keep) {
            tracing::warn!("the screen is not kept awake: {error}");
        }
        Self { _held: held, failed }
    }

    /// Why the screen may go dark, once, if that became known.
    pub(super) fn failure(&self) -> Option<String> {
        self.failed.try_recv().ok()
    }
}

/// Keeps the screen awake until the other side hangs up, or says why it can't be.
#[cfg(feature = "desktop")]
fn keep_awake_until(until: &Receiver<()>) -> Result<(), String> {
    let _awake = keepawake::Builder::default()
        .display(true)
        .reason("The floor is projected")
        .app_name("underfoot")
        .app_reverse_domain("org.underfoot")
        .create()
        .map_err(|error| error.to_string())?;
    let _ = until.recv();
    Ok(())
}

#[cfg(not(feature = "desktop"))]
fn keep_awake_until(_: &Receiver<()>) -> Result<(), String> {
    Err("this underfoot was built without the feature `desktop`".into())
}
