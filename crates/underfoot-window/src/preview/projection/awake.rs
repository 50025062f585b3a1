//! Keeps the screen on while the floor is projected.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

/// Keeps the screen on until it is dropped.
///
/// The request goes over a bus that may not answer for seconds: a thread sends it and holds the result.
pub(super) struct Awake {
    /// Dropping it ends the thread.
    _held: Sender<()>,
    failed: Receiver<String>,
}

impl Awake {
    pub(super) fn begin() -> Self {
        let (held, until) = channel::<()>();
        let (failure, failed) = channel();
        let keep = move || {
            if let Err(why) = keep_awake_until(&until) {
                // A window that is already closed does not need the message.
                let _ = failure.send(why);
            }
        };
        if let Err(error) = thread::Builder::new().name("awake".into()).spawn(keep) {
            tracing::warn!("the screen is not kept awake: {error}");
        }
        Self { _held: held, failed }
    }

    /// The reason why the screen may go dark, returned once.
    pub(super) fn failure(&self) -> Option<String> {
        self.failed.try_recv().ok()
    }
}

/// Keeps the screen on until the other side hangs up; returns the reason if that is impossible.
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
