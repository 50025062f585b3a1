//! The floor on display: its latest state, the messages about it, and the way for commands to it.

use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use super::feed::{PreviewCommand, ServerFeed, ServerState};
use super::messages::WindowMessages;
use super::scopes::ActuatorScopes;
use super::watch::{Banner, LinkNotices};
use underfoot::engine::Snapshot;
use underfoot::floor::{Floor, TileId};
use underfoot::layout::Layout;

/// The floor on display.
pub(super) struct ShownFloor {
    pub(super) floor: Arc<Floor>,
    /// The source of the floor in a few words.
    pub(super) source: String,
    /// `None` unless the floor belongs to a server.
    pub(super) server_feed: Option<ServerFeed>,
    /// The state of the server in this frame.
    pub(super) server: Option<ServerState>,
    pub(super) snapshots: triple_buffer::Output<Snapshot>,
    pub(super) messages: WindowMessages,
    pub(super) scopes: ActuatorScopes,
    pub(super) watch: LinkNotices,
    pub(super) commands: SyncSender<PreviewCommand>,
    /// The window's clock, in seconds.
    pub(super) now_s: f64,
}

impl ShownFloor {
    /// The state of the floor in this frame.
    pub(super) fn snapshot(&self) -> &Snapshot {
        self.snapshots.output_buffer()
    }

    /// The layout to which the snapshot belongs.
    pub(super) fn layout(&self) -> &Arc<Layout> {
        &self.messages.layout
    }

    /// Takes in the news at `now_s` on the window's clock: the state of the server, the snapshot, and all messages.
    pub(super) fn receive(&mut self, now_s: f64) {
        self.now_s = now_s;
        self.server = self.server_feed.as_mut().map(|feed| feed());
        let fresh = self.snapshots.update();
        let snapshot = self.snapshots.output_buffer();
        self.messages.receive(now_s, snapshot.layout_revision);
        self.messages.relabel(&snapshot.labels);
        self.messages.note_grounds(snapshot);
        self.watch.observe(now_s, snapshot, fresh);
    }

    /// Takes in the signals of the actuators since the last frame, which was `elapsed_s` ago.
    pub(super) fn receive_signals(&mut self, selected: TileId, elapsed_s: f32) {
        self.scopes.update(&self.floor, self.snapshots.output_buffer(), selected, elapsed_s);
    }

    /// Whether the floor is known from lines only, without packets and forces.
    pub(super) fn is_told_by_lines(&self) -> bool {
        self.server.as_ref().is_some_and(ServerState::tells_by_lines)
    }

    /// The message across the floor, if there is a problem.
    pub(super) fn banner(&self) -> Option<Banner> {
        self.watch.banner(self.now_s, self.snapshot().link, &self.source, self.server.as_ref())
    }

    /// Sends a command to the program; drops it if the program has hung up.
    pub(super) fn command(&self, command: PreviewCommand) {
        if let Err(error) = self.commands.try_send(command) {
            tracing::debug!("the program takes no command of the window: {error}");
        }
    }
}
