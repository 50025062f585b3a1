//! Data and commands that pass between the program and the window.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec2;

use super::channels::WindowChannels;
use super::design::DesignInput;
use super::playback::Playback;
use super::share::ShareDesk;
use super::visit::VisitDesk;
use underfoot::engine::Snapshot;
use underfoot::feel::{Effect, Gesture};
use underfoot::floor::{Floor, TileId};
use underfoot::layout::Layout;
use underfoot::messages::MessageNews;
use underfoot::schema::{Diagnostics, NamedEffect};
use underfoot::sink::{AreaNews, LatencyStages};
use underfoot::source::TappedPackets;
use underfoot::widget::{Value, WidgetEvent, WidgetId};
use underfoot_scene::scene::Shoe;
use underfoot_sim::{ArrivalHandle, FaultSwitch};

/// A shoe that the window moves; its `length_m` is the length of the sole, one centimetre more than the bare foot.
pub type PreviewFoot = Shoe;

/// Everything that the window shows and everything that it can do; the program fills it in.
///
/// The window only displays: sensing, sound and outputs run on other threads and continue while the window is
/// covered. A sender that hangs up is not a fault; the last value that it sent stays.
pub struct PreviewInput {
    /// The floor on display.
    pub floor: Arc<Floor>,
    /// The initial layout.
    pub layout: Arc<Layout>,
    /// The warnings of that layout.
    pub warnings: Warnings,
    /// The source of the floor in a few words: `simulated floor`, `walk.mcap`, `port 9000`.
    pub source: String,
    /// The server that provides the floor; `None` for a floor of this program or a recording.
    pub server: Option<ServerFeed>,
    /// The latest state, written by the sensing thread.
    pub snapshots: triple_buffer::Output<Snapshot>,
    /// The messages from the program, and the commands to it.
    pub channels: WindowChannels,
    /// The signals of the actuators; `None` without rendering.
    pub scopes: Option<Box<dyn ScopeFeed>>,
    /// The latency from a packet to the actuator; `None` if it is not measured.
    pub latency: Option<LatencyStages>,
    /// The feet of a simulated floor; `None` for a real floor or a recording, where the mouse cannot step.
    pub feet: Option<Box<dyn FootSink>>,
    /// Playback control of the recording; `None` for a floor.
    pub playback: Option<Box<dyn Playback>>,
    /// Records visits and exports them; `None` where neither is possible.
    pub visit: Option<Box<dyn VisitDesk>>,
    /// Fault injection for a simulated floor; `None` for a real floor or a recording.
    pub faults: Option<FaultSwitch>,
    /// Sends people onto a simulated floor; `None` for a real floor or a recording.
    pub people: Option<ArrivalHandle>,
    /// All feet on a simulated floor, from every source; `None` for a real floor or a recording.
    pub shoes: Option<ShoeFeed>,
    /// Names of the layouts that the window can open; empty if there is no choice.
    pub choices: Vec<String>,
    /// The effects that the tuner can edit, by name; empty without a tuner.
    pub effects: Vec<NamedEffect>,
    /// The packets of the boards, for checks of the floor; `None` where a check is impossible, such as for a
    /// recording.
    pub packets: Option<TappedPackets>,
    /// The layout as text for Design mode; `None` where it cannot be edited.
    pub design: Option<DesignInput>,
    /// Makes links of the layout of Design mode; `None` where no page could open them.
    pub share: Option<Box<dyn ShareDesk>>,
}

impl PreviewInput {
    /// A floor for display only: no rendering, no simulated feet, no choice of layouts and no Design mode.
    #[must_use]
    pub fn new(
        floor: Arc<Floor>,
        layout: Arc<Layout>,
        source: impl Into<String>,
        snapshots: triple_buffer::Output<Snapshot>,
        channels: WindowChannels,
    ) -> Self {
        Self {
            floor,
            layout,
            warnings: Warnings::default(),
            source: source.into(),
            server: None,
            snapshots,
            channels,
            scopes: None,
            latency: None,
            feet: None,
            playback: None,
            visit: None,
            faults: None,
            people: None,
            packets: None,
            shoes: None,
            choices: Vec::new(),
            effects: Vec::new(),
            design: None,
            share: None,
        }
    }
}

/// Replaces the content of the list by the shoes that are now on or above the floor.
pub type ShoeFeed = Box<dyn FnMut(&mut Vec<Shoe>)>;

/// Returns the state of the server; called for each frame.
pub type ServerFeed = Box<dyn FnMut() -> ServerState + Send>;

/// The state of the server that provides the floor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServerState {
    /// The address of the server, or the source of its lines: `127.0.0.1:9002`, `standard input`.
    pub address: String,
    /// The state of the connection.
    pub link: ServerLink,
    /// Whether the server accepts layouts from Design mode.
    pub takes_layouts: bool,
    /// Number of packets that the server dropped on the way to this program.
    pub left_out: u64,
    /// The state of each area of a floor that several computers serve; empty for a floor that one computer serves.
    pub areas: Vec<AreaNews>,
}

impl ServerState {
    /// Whether the floor is known from lines only, without packets and forces.
    #[must_use]
    pub const fn tells_by_lines(&self) -> bool {
        matches!(self.link, ServerLink::Followed | ServerLink::Ended(_))
    }
}

/// The state of the connection to a server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ServerLink {
    /// Connected: the packets of its boards arrive here as well.
    Joined,
    /// Disconnected for this reason; a new attempt follows each second.
    Lost(String),
    /// Connected by lines only: reports arrive, packets do not.
    Followed,
    /// The lines have ended for this reason; no more will arrive.
    Ended(String),
}

/// An event on the floor.
#[derive(Clone, Debug, PartialEq)]
pub enum EventNews {
    /// A control's event.
    Event(WidgetEvent),
    /// A message that a control or a foot gives to another program.
    Sent(MessageNews),
    /// A recording starts again with its initial layout; earlier events no longer apply.
    Restarted(Arc<Layout>),
}

/// Problems of a layout that affect feet or eyes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Warnings {
    /// Number of warnings and errors.
    pub count: usize,
    /// All of them, in the program's output format.
    pub text: String,
}

impl From<&Diagnostics> for Warnings {
    fn from(all: &Diagnostics) -> Self {
        let text = if all.is_empty() { String::new() } else { all.to_string() };
        Self { count: all.warnings() + all.errors(), text }
    }
}

/// The reason for a new layout on the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutCause {
    /// The user chose it in the window.
    Opened,
    /// Another program saved its file.
    Saved,
    /// The user edits it in the window and needs no message.
    Designed,
    /// The recording switches to it.
    Recorded,
    /// The server put it on its floor.
    Served,
}

/// The result of a change to a layout file.
#[derive(Clone, Debug)]
pub enum LayoutNews {
    /// Its file, or that of a kind or an effect, was saved: the window, which holds the text, reads it again.
    Changed,
    /// The engine received this layout.
    Loaded {
        /// The layout.
        layout: Arc<Layout>,
        /// The first [`Snapshot::layout_revision`] of snapshots that belong to it. The window shows the layout from
        /// then on, so that controls and their states always match.
        revision: u64,
        /// Its name in messages: `map.ron`.
        name: String,
        /// The reason for the change.
        cause: LayoutCause,
        /// Its warnings in the program's output format; empty if there are none.
        warnings: Warnings,
    },
    /// It has errors; the last good layout stays.
    Refused {
        /// Its name in messages: `map.ron`.
        name: String,
        /// All problems, in the program's output format.
        diagnostics: String,
    },
}

/// A command of the user to the program.
#[derive(Clone, Debug, PartialEq)]
pub enum PreviewCommand {
    /// Open the layout with this index in [`PreviewInput::choices`].
    Open(usize),
    /// Put the layout that is being edited on the floor.
    Try {
        /// The layout.
        layout: Arc<Layout>,
        /// Its name in messages: `map.ron`.
        name: String,
        /// Its problems that affect feet or eyes.
        warnings: Warnings,
        /// The reason for the change.
        cause: LayoutCause,
    },
    /// From now on, report changes to this file and to those of its kinds and effects; `None` for a layout without a
    /// file.
    Watch(Option<PathBuf>),
    /// Switch a control on or off, as an app would.
    Enable {
        /// The control.
        id: WidgetId,
        /// Whether the control is to be enabled.
        enabled: bool,
    },
    /// Give a control a value, as an app would.
    Set {
        /// The control.
        id: WidgetId,
        /// The new value.
        value: Value,
    },
    /// Mute all sound and vibration, or unmute it.
    Mute(bool),
    /// Mute the actuator of one tile, or unmute it.
    MuteTile {
        /// The tile.
        tile: TileId,
        /// Whether to mute it.
        on: bool,
    },
    /// Play an effect on a tile, in place of the effect that this command started before.
    Feel {
        /// The effect.
        effect: Arc<Effect>,
        /// The gesture of an imagined foot.
        gesture: Gesture,
        /// Index of the tile.
        tile: usize,
    },
    /// Disable all controls that are enabled, or enable those again.
    TurnControlsOff(bool),
    /// Save the floor to a file; the previous content stays as a copy beside it.
    SaveFloor {
        /// The floor.
        floor: Box<Floor>,
        /// The file.
        path: PathBuf,
    },
    /// Save an effect in the folder `effects`.
    SaveEffect {
        /// Its name, which is also the name of its file.
        name: String,
        /// The file's text.
        text: String,
    },
}

/// The recent signal of each actuator channel.
pub trait ScopeFeed {
    /// Takes in the samples since the last call; called once for each frame.
    fn update(&mut self) {}

    /// Lowest and highest sample of short stretches of `channel`, oldest first, in full scales: about 128 stretches
    /// over 100 ms. Empty for a channel that does not exist.
    fn scope(&mut self, channel: usize) -> &[(f32, f32)];
}

/// The feet of a simulated floor.
pub trait FootSink {
    /// Moves each foot along its path, which the hand covered in `over_s` seconds; called for each frame.
    ///
    /// The sink turns the paths into steps and slides with the force and the speed of a leg. The index of a foot in
    /// the list is its identity; a foot without a path is lifted where it is.
    fn lead(&mut self, over_s: f32, paths: &[Vec<PreviewFoot>]);

    /// Point of action of the force of `foot`, in floor metres: the window puts that point under the mouse.
    ///
    /// This default moves along a straight line from 36 % of the sole's length behind its middle (heel) to 32 %
    /// before it (toes).
    fn centre_of_pressure(&self, foot: &PreviewFoot) -> Vec2 {
        let forward = Vec2::from_angle(foot.heading_rad).rotate(Vec2::Y);
        let roll = foot.roll.clamp(0.0, 1.0);
        foot.position + forward * (foot.length_m * (0.68 * roll - 0.36))
    }
}
