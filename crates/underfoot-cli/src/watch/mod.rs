//! Live reload: a saved layout, kind or effect is on the floor at once.
//!
//! The program checks the files some times a second, through all links: their state shows every change by an editor,
//! a container platform or a network file system. Notifications of the operating system would arrive a little
//! earlier, but not at all from network folders, for a file behind a link, or for a link that replaces another; and
//! they would also arrive for every other file of the folder, such as the program's own log.

mod stamps;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tracing::warn;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema::{self, Diagnostics};

use super::failure::Failure;
use super::layout_args::LayoutArgs;
use stamps::Stamps;

/// Interval between checks of the files, and time for which they must stay the same before they are read: editors
/// write in several steps, some milliseconds apart.
const EVERY: Duration = Duration::from_millis(50);

/// Reciprocal of the maximum share of the time spent on checks: a folder that answers slowly is checked less often.
const SHARE: u32 = 50;

/// Time for which a file may be missing before that is reported: editors and container platforms replace files.
const GONE: Duration = Duration::from_millis(500);

/// Time after a change, or after the start, in which contents are compared too: longer than the coarsest clock of
/// file systems, of 2 s.
const COMPARED: Duration = Duration::from_secs(3);

/// Watches files until it is dropped.
pub(crate) struct FileWatch {
    /// `None` only during the drop.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl FileWatch {
    /// Calls `tell` with the layout, or with all its errors, each time its file or a kind's or an effect's file is
    /// saved.
    ///
    /// Returns `None` for a built-in layout, which has no file.
    pub(crate) fn start(
        files: &LayoutArgs,
        geometry: Geometry,
        tell: impl Fn(Result<Layout, Diagnostics>) + Send + 'static,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = files.path().map(PathBuf::from) else { return Ok(None) };
        let own = files.clone();
        Self::on_change(files, move || tell(read(&own, &path, &geometry)))
    }

    /// Calls `tell` each time the layout's file or a kind's or an effect's file is saved.
    ///
    /// Returns `None` for a built-in layout, which has no file.
    pub(crate) fn on_change(
        files: &LayoutArgs,
        tell: impl Fn() + Send + 'static,
    ) -> Result<Option<Self>, Failure> {
        if files.path().is_none() {
            return Ok(None);
        }
        let files = files.clone();
        let mut lookout = Lookout::new(Stamps::of(&files, true), Instant::now());
        let (end, ended) = channel();
        let watch = move || {
            let mut wait = EVERY;
            while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(wait) {
                let now = Instant::now();
                if lookout.look(Stamps::of(&files, lookout.compares_contents(now)), now) {
                    tell();
                }
                wait = EVERY.max(SHARE * now.elapsed());
            }
        };
        let thread = Builder::new()
            .name("watcher".into())
            .spawn(watch)
            .map_err(|error| Failure::Other(format!("the layout can't be watched for changes: {error}")))?;
        Ok(Some(Self { end: Some(end), thread: Some(thread) }))
    }
}

impl Drop for FileWatch {
    fn drop(&mut self) {
        self.end = None;
        // The thread is at most reading; a panic in it has been reported.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// Detects when changed files are stable.
struct Lookout {
    /// The reported states.
    reported: Stamps,
    /// The states since then, and the time since which they are the same.
    changed: Option<(Stamps, Instant)>,
    compared_until: Instant,
}

impl Lookout {
    fn new(now_so: Stamps, now: Instant) -> Self {
        Self { reported: now_so, changed: None, compared_until: now + COMPARED }
    }

    fn compares_contents(&self, now: Instant) -> bool {
        now < self.compared_until
    }

    /// Whether files have changed since the last report and are stable; `now_so` is their state at `now`.
    fn look(&mut self, now_so: Stamps, now: Instant) -> bool {
        if now_so.is_same(&self.reported) {
            (self.reported, self.changed) = (now_so, None);
            return false;
        }
        self.compared_until = now + COMPARED;
        let since = match &self.changed {
            Some((before, since)) if now_so.is_same(before) => *since,
            _ => now,
        };
        let rest = if now_so.lacks_any_of(&self.reported) { GONE } else { EVERY };
        if now.duration_since(since) < rest {
            self.changed = Some((now_so, since));
            return false;
        }
        (self.reported, self.changed) = (now_so, None);
        true
    }
}

fn read(files: &LayoutArgs, path: &std::path::Path, geometry: &Geometry) -> Result<Layout, Diagnostics> {
    let kinds = files.kinds()?;
    let loaded = schema::load_layout(path, &kinds, geometry)?;
    if !loaded.warnings.is_empty() {
        warn!("{}", loaded.warnings);
    }
    Ok(loaded.layout)
}
