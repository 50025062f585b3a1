//! A floor known from JSON lines, behind the window: one of several computers, which has no common stream of packets.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, Builder};
use std::time::Instant as HostInstant;

use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::mirror::TextMirror;
use underfoot::schema::Diagnostics;
use underfoot::sink::{EventSink, Report};
use underfoot_window::preview::{
    LayoutCause, LayoutNews, Notice, PreviewCommand, ProgramChannels, ServerFeed, ServerLink, ServerState,
    ToWindow, Warnings,
};

use super::super::failure::Failure;
use super::super::layout_args::{DEFAULT_LAYOUT, LayoutArgs};
use super::super::watch::FileWatch;
use super::LOOK;
use super::commands::keep_floor;

/// Maximum number of waiting lines: beyond, their writer blocks, and counts the lines that it drops.
const WAITING: usize = 64;

/// Maximum number of waiting layouts; beyond, the watcher of files blocks.
const CHANGES_WAITING: usize = 16;

/// Maximum length of a line in bytes: a thousand contacts.
const LONGEST: u64 = 1 << 18;

/// A floor that is followed; ends when the window closes its channels.
pub(super) struct FollowedFeed {
    pub(super) snapshots: triple_buffer::Output<Snapshot>,
    /// Reports the state of the server to the window.
    pub(super) feed: ServerFeed,
    /// Name of the origin of the lines.
    pub(super) name: String,
}

impl FollowedFeed {
    /// Follows the lines in the file at `path`, or on standard input for `-`, on a floor with this layout; `files`
    /// belong to the layout.
    pub(super) fn start(
        path: &Path,
        window: ProgramChannels,
        files: &LayoutArgs,
        floor: &Floor,
        layout: Layout,
    ) -> Result<Self, Failure> {
        let failed = |error: io::Error| Failure::Other(format!("can't follow {}: {error}", path.display()));
        let (name, lines): (_, Box<dyn Read + Send>) = if path == Path::new("-") {
            ("standard input".to_owned(), Box::new(io::stdin()))
        } else {
            (path.display().to_string(), Box::new(File::open(path).map_err(failed)?))
        };
        let (sender, read) = sync_channel(WAITING);
        Builder::new().name("lines".into()).spawn(move || pass_on(lines, &sender)).map_err(failed)?;
        let (input, snapshots) = triple_buffer::triple_buffer(&Snapshot::default());
        let mirror = TextMirror::new(floor, layout);
        let state = ServerState {
            address: name.clone(),
            link: ServerLink::Followed,
            takes_layouts: false,
            left_out: 0,
            areas: mirror.areas().cloned().collect(),
        };
        let shared = Arc::new(Mutex::new(state));
        let told = Arc::clone(&shared);
        let (changed, changes) = sync_channel(CHANGES_WAITING);
        // The window may be closed.
        let watch = FileWatch::start(files, floor.geometry, move |layout| drop(changed.send(layout)))?;
        let floor = FollowedFloor {
            lines: read,
            changes,
            events: ToWindow::new(window.events.clone()),
            window,
            mirror,
            snapshots: input,
            shared,
            layout_name: files.path().map_or(DEFAULT_LAYOUT.into(), |path| path.display().to_string()),
            ended: false,
            _watch: watch,
        };
        Builder::new().name("followed".into()).spawn(move || floor.run()).map_err(failed)?;
        let feed = Box::new(move || told.lock().unwrap_or_else(PoisonError::into_inner).clone());
        Ok(Self { snapshots, feed, name })
    }
}

/// Passes lines on until their end, or until the receiver is gone; splits those that exceed the maximum length.
fn pass_on(lines: Box<dyn Read + Send>, to: &SyncSender<io::Result<Vec<u8>>>) {
    let mut lines = BufReader::new(lines);
    loop {
        let mut line = Vec::new();
        let read = lines.by_ref().take(LONGEST).read_until(b'\n', &mut line);
        let has_failed = read.is_err();
        if matches!(read, Ok(0)) || to.send(read.map(|_| line)).is_err() || has_failed {
            return;
        }
    }
}

struct FollowedFloor {
    lines: Receiver<io::Result<Vec<u8>>>,
    changes: Receiver<Result<Layout, Diagnostics>>,
    window: ProgramChannels,
    events: ToWindow,
    mirror: TextMirror,
    snapshots: triple_buffer::Input<Snapshot>,
    shared: Arc<Mutex<ServerState>>,
    layout_name: String,
    ended: bool,
    _watch: Option<FileWatch>,
}

impl FollowedFloor {
    /// Shows the floor until the window closes its channels.
    fn run(mut self) {
        loop {
            self.hear();
            loop {
                match self.window.commands.try_recv() {
                    Ok(command) => self.answer(command),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return,
                }
            }
            while let Ok(change) = self.changes.try_recv() {
                self.take_layout(change);
            }
            let shown = self.snapshots.input_buffer_mut();
            shown.clone_from(self.mirror.snapshot());
            shown.unsent_events += self.events.dropped();
            self.snapshots.publish();
            let mut state = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
            if !state.areas.iter().eq(self.mirror.areas()) {
                state.areas = self.mirror.areas().cloned().collect();
            }
        }
    }

    /// Processes lines until the next update of the window is due.
    fn hear(&mut self) {
        let until = HostInstant::now() + LOOK;
        if self.ended {
            return thread::sleep(LOOK);
        }
        loop {
            match self.lines.recv_timeout(until.saturating_duration_since(HostInstant::now())) {
                Ok(Ok(line)) => self.take(&String::from_utf8_lossy(&line)),
                Ok(Err(error)) => return self.end(&error.to_string()),
                Err(RecvTimeoutError::Disconnected) => return self.end("the other program has ended"),
                Err(RecvTimeoutError::Timeout) => return,
            }
        }
    }

    fn take(&mut self, line: &str) {
        match self.mirror.take(line) {
            Ok(Some(event)) => {
                self.events.report(&Report::Event(Cow::Owned(event)));
            }
            Ok(None) => {}
            Err(error) => {
                if self.mirror.snapshot().counters.malformed == 1 {
                    self.say(error.to_string());
                }
            }
        }
    }

    fn end(&mut self, why: &str) {
        self.ended = true;
        self.mirror.end();
        self.shared.lock().unwrap_or_else(PoisonError::into_inner).link = ServerLink::Ended(why.into());
    }

    fn take_layout(&mut self, change: Result<Layout, Diagnostics>) {
        let name = self.layout_name.clone();
        let news = match change {
            Ok(layout) => LayoutNews::Loaded {
                revision: self.mirror.set_layout(layout.clone()),
                layout: Arc::new(layout),
                name,
                cause: LayoutCause::Saved,
                warnings: Warnings::default(),
            },
            Err(problems) => LayoutNews::Refused { name, diagnostics: problems.to_string() },
        };
        let _ = self.window.layouts.send(news);
    }

    fn answer(&self, command: PreviewCommand) {
        match command {
            PreviewCommand::SaveFloor { floor, path } => self.say(keep_floor(&floor, &path)),
            _ => self.say("That is done where the floor is served."),
        }
    }

    fn say(&self, notice: impl Into<Notice>) {
        // Messages never wait for a window that is closed or does not draw.
        let _ = self.window.notices.try_send(notice.into());
    }
}
