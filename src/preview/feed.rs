//! What the program hands to the window and takes from it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender};

use glam::Vec2;

use super::channels::WindowChannels;
use super::design::DesignInput;
use super::playback::Playback;
use crate::engine::Snapshot;
use crate::feel::{Effect, Gesture};
use crate::floor::{Floor, TileId};
use crate::layout::Layout;
use crate::recording::TappedPackets;
use crate::scene::Shoe;
use crate::schema::{Diagnostics, NamedEffect};
use crate::sim::ArrivalHandle;
use crate::sink::{AreaNews, LatencyStages};
use crate::source::FaultSwitch;
use crate::widget::{Value, WidgetEvent, WidgetId};

/// A shoe that the window moves; its `length_m` is the sole's, a centimetre more than the bare foot's.
pub type PreviewFoot = Shoe;

/// Everything the window shows and everything it can do, filled in by the program.
///
/// The window only looks: sensing, sound and outputs run on other threads and
/// go on while it is covered. A sender that hangs up is not a fault; what it sent
/// last stays.
pub struct PreviewInput {
    /// The floor that is shown.
    pub floor: Arc<Floor>,
    /// The layout to begin with.
    pub layout: Arc<Layout>,
    /// Its warnings.
    pub warnings: Warnings,
    /// What the floor is, in a few words: `simulated floor`, `walk.mcap`, `port 9000`.
    pub source: String,
    /// The server whose floor is shown; `None` for a floor of this program's own or a recording.
    pub server: Option<ServerFeed>,
    /// The latest state, written by the sensing thread.
    pub snapshots: triple_buffer::Output<Snapshot>,
    /// Every event, in order.
    pub events: Receiver<EventNews>,
    /// What became of changes to the layout file.
    pub layouts: Receiver<LayoutNews>,
    /// Sentences for the person at the window, such as why there is no sound.
    pub notices: Receiver<String>,
    /// What the actuators do; `None` where nothing is rendered.
    pub scopes: Option<Box<dyn ScopeFeed>>,
    /// How long it takes from a packet to what is felt; `None` where nobody measures it.
    pub latency: Option<LatencyStages>,
    /// The feet of a simulated floor; `None` for a real floor or a recording, which nobody can step on with a mouse.
    pub feet: Option<Box<dyn FootSink>>,
    /// What leads the recording that is shown; `None` for a floor.
    pub playback: Option<Box<dyn Playback>>,
    /// What breaks a simulated floor; `None` for a real one or a recording.
    pub faults: Option<FaultSwitch>,
    /// Sends people onto a simulated floor; `None` for a real one or a recording.
    pub people: Option<ArrivalHandle>,
    /// The feet on a simulated floor, whoever moves them; `None` for a real floor or a recording.
    pub shoes: Option<ShoeFeed>,
    /// Names of layouts that can be opened from the window; empty if there is no choice.
    pub choices: Vec<String>,
    /// The effects that can be tuned, by name; empty if there is no tuner.
    pub effects: Vec<NamedEffect>,
    /// What the boards send, for checks of the floor; `None` where it can't be checked, such as a recording.
    pub packets: Option<TappedPackets>,
    /// The layout as text, to be designed in the window; `None` where that can't be done.
    pub design: Option<DesignInput>,
    /// What the person at the window wants.
    pub commands: SyncSender<PreviewCommand>,
}

impl PreviewInput {
    /// A floor that is only looked at: nothing is rendered, nobody steps on it, nothing can be chosen or designed.
    #[must_use]
    pub fn new(
        floor: Arc<Floor>,
        layout: Arc<Layout>,
        source: impl Into<String>,
        snapshots: triple_buffer::Output<Snapshot>,
        channels: WindowChannels,
    ) -> Self {
        let WindowChannels { events, layouts, notices, commands } = channels;
        Self {
            floor,
            layout,
            warnings: Warnings::default(),
            source: source.into(),
            server: None,
            snapshots,
            events,
            layouts,
            notices,
            scopes: None,
            latency: None,
            feet: None,
            playback: None,
            faults: None,
            people: None,
            packets: None,
            shoes: None,
            choices: Vec::new(),
            effects: Vec::new(),
            design: None,
            commands,
        }
    }
}

/// Puts the shoes on or above the floor, as they are now, in place of those of the last call.
pub type ShoeFeed = Box<dyn FnMut(&mut Vec<Shoe>)>;

/// How it is with the server, to be asked for each frame.
pub type ServerFeed = Box<dyn FnMut() -> ServerState + Send>;

/// A server whose floor is shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServerState {
    /// Where it is, or what its lines are read from: `127.0.0.1:9002`, `standard input`.
    pub address: String,
    /// Whether it is there.
    pub link: ServerLink,
    /// Whether it takes layouts that are designed in the window.
    pub takes_layouts: bool,
    /// Packets that it could not tell.
    pub left_out: u64,
    /// How the areas stand of a floor that several computers serve; empty for one that one computer serves.
    pub areas: Vec<AreaNews>,
}

impl ServerState {
    /// Whether only lines tell of the floor, and neither packets nor forces are known.
    #[must_use]
    pub const fn tells_by_lines(&self) -> bool {
        matches!(self.link, ServerLink::Followed | ServerLink::Ended(_))
    }
}

/// Whether a server is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ServerLink {
    /// What its boards send comes here as well.
    Joined,
    /// It is gone, for this reason; it is tried again each second.
    Lost(String),
    /// What it tells is heard: its lines, not its packets.
    Followed,
    /// What it tells has ended, for this reason; nothing more is to come.
    Ended(String),
}

/// What happened on the floor.
#[derive(Clone, Debug, PartialEq)]
pub enum EventNews {
    /// A control's event.
    Event(WidgetEvent),
    /// A recording begins anew, with the layout that it has at its beginning: what was told so far is past.
    Restarted(Arc<Layout>),
}

/// What feet and eyes will have trouble with in a layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Warnings {
    /// How many there are.
    pub count: usize,
    /// All of them, as the program would print them.
    pub text: String,
}

impl From<&Diagnostics> for Warnings {
    fn from(all: &Diagnostics) -> Self {
        let text = if all.is_empty() { String::new() } else { all.to_string() };
        Self { count: all.warnings() + all.errors(), text }
    }
}

/// Why there is another layout on the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutCause {
    /// Somebody chose it in the window.
    Opened,
    /// Its file was saved by another program.
    Saved,
    /// Somebody designs it in the window, who need not be told.
    Designed,
    /// The recording goes on with it.
    Recorded,
    /// The server has put it on its floor.
    Served,
}

/// What became of a layout file that changed.
#[derive(Clone, Debug)]
pub enum LayoutNews {
    /// Its file, or that of a kind or an effect, was saved: the window, which has the text, takes it in.
    Changed,
    /// The engine was given this one.
    Loaded {
        /// The layout.
        layout: Arc<Layout>,
        /// The [`Snapshot::layout_revision`] from which on snapshots belong to it. The window
        /// shows it from then on, so that controls and their states always match.
        revision: u64,
        /// What to say about it: `map.ron`.
        name: String,
        /// Why it came.
        cause: LayoutCause,
        /// What the program would print of it as warnings; empty if nothing.
        warnings: Warnings,
    },
    /// It has problems; the last good layout stays.
    Refused {
        /// What to say about it: `map.ron`.
        name: String,
        /// All problems, as the program would print them.
        diagnostics: String,
    },
}

/// What the person at the window wants from the program.
#[derive(Clone, Debug, PartialEq)]
pub enum PreviewCommand {
    /// Open the layout at this place in [`PreviewInput::choices`].
    Open(usize),
    /// Put the layout on the floor that is being designed.
    Try {
        /// The layout.
        layout: Arc<Layout>,
        /// What to say about it: `map.ron`.
        name: String,
        /// What feet and eyes will have trouble with in it.
        warnings: Warnings,
        /// Why it comes.
        cause: LayoutCause,
    },
    /// Tell of changes to this file from now on, and to those of its kinds and effects; `None` for a layout that has
    /// no file.
    Watch(Option<PathBuf>),
    /// Switch a control on or off, as an app would.
    Enable {
        /// Which control.
        id: WidgetId,
        /// Whether it shall work.
        enabled: bool,
    },
    /// Give a control a value, as an app would.
    Set {
        /// Which control.
        id: WidgetId,
        /// What it shall hold.
        value: Value,
    },
    /// Let nothing be felt or heard, or everything again.
    Mute(bool),
    /// Let the actuator of one tile not be felt, or again.
    MuteTile {
        /// Which tile.
        tile: TileId,
        /// Whether to.
        on: bool,
    },
    /// Play an effect on a tile, in place of what was being played so.
    Feel {
        /// What is felt.
        effect: Arc<Effect>,
        /// What an imagined foot does.
        gesture: Gesture,
        /// Index of the tile.
        tile: usize,
    },
    /// Switch all controls off that are on, or those on again.
    TurnControlsOff(bool),
    /// Keep the floor in a file; what that held before is kept beside it.
    SaveFloor {
        /// The floor.
        floor: Box<Floor>,
        /// The file.
        path: PathBuf,
    },
    /// Keep an effect in the folder `effects`.
    SaveEffect {
        /// Its name, which is that of its file.
        name: String,
        /// The file's text.
        text: String,
    },
}

/// What each actuator channel did lately.
pub trait ScopeFeed {
    /// Takes in what happened since the last call; called once for each frame.
    fn update(&mut self) {}

    /// Lowest and highest sample of short stretches of `channel`, oldest first, in full scales:
    /// about 128 of them over 100 ms. Empty for a channel that does not exist.
    fn scope(&mut self, channel: usize) -> &[(f32, f32)];
}

/// A simulated floor's feet.
pub trait FootSink {
    /// Leads each foot along its path, which took the hand `over_s` seconds; called for each frame.
    ///
    /// The sink makes steps and slides of it, with the force and the speed of a leg. A foot's place in the list is
    /// its identity; one without a path is lifted where it is.
    fn lead(&mut self, over_s: f32, paths: &[Vec<PreviewFoot>]);

    /// Where the force of `foot` acts, in floor metres: the window puts that point under the mouse.
    ///
    /// As it stands, a straight line from 36 % of the sole's length behind its
    /// middle (heel) to 32 % before it (toes).
    fn centre_of_pressure(&self, foot: &PreviewFoot) -> Vec2 {
        let forward = Vec2::from_angle(foot.heading_rad).rotate(Vec2::Y);
        let roll = foot.roll.clamp(0.0, 1.0);
        foot.position + forward * (foot.length_m * (0.68 * roll - 0.36))
    }
}
