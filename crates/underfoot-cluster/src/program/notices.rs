//! Notices for the operator on standard error, written by a thread of their own, so that a slow reader never blocks.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

/// Greatest number of waiting notices; further ones are dropped.
const WAITING: usize = 256;

/// A handle to the thread that writes to standard error.
#[derive(Clone, Debug)]
pub(super) struct Notices(SyncSender<String>);

impl Notices {
    pub(super) fn start() -> Self {
        let (out, notices) = sync_channel::<String>(WAITING);
        thread::spawn(move || notices.iter().for_each(|notice| eprintln!("{notice}")));
        Self(out)
    }

    pub(super) fn say(&self, notice: impl Into<String>) {
        // With a slow reader, notices are dropped.
        let _ = self.0.try_send(notice.into());
    }
}
