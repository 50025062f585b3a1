//! What a person is told on standard error, by a thread of its own: a reader that stalls holds nobody up.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

/// Notices that may wait; further ones are left out.
const WAITING: usize = 256;

/// The way to standard error.
#[derive(Clone, Debug)]
pub(super) struct Notices(SyncSender<String>);

impl Notices {
    pub(super) fn start() -> Self {
        let (out, notices) = sync_channel::<String>(WAITING);
        thread::spawn(move || notices.iter().for_each(|notice| eprintln!("{notice}")));
        Self(out)
    }

    pub(super) fn say(&self, notice: impl Into<String>) {
        // Who reads so slowly misses some.
        let _ = self.0.try_send(notice.into());
    }
}
