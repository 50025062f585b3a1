//! The simulated floor of the page: one thread does all, a few milliseconds of the floor in each frame.

use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use std::time::Duration;

use thiserror::Error;
use triple_buffer::triple_buffer;
use underfoot::engine::Snapshot;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::{Floor, Geometry};
use underfoot::schema::{self, Diagnostics};
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot::sink::{Fanout, StereoSink};
use underfoot::source::{LinkFaults, SensorSource, TappedPackets};
use underfoot_sim::{
    CalibrationError, Host, Pace, RehearsalSource, SimConfig, SimFloor, SimulatedSource, arrivals,
    calibrated, feet_by_hand, watched,
};
use underfoot_window::edit::Document;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{
    DesignInput, Mouse, Notice, PreviewInput, ProgramChannels, ScopeFeed, SignalScopes, ToWindow, Warnings,
    channels, shoes, usual_state,
};

use super::clicks::Clicks;
use super::clock::PageClock;
use super::desk::PageDesk;
use super::kinds::OwnTexts;

/// Seed of the sensors, of their noise and of the faults.
const SEED: u64 = 1;

/// Samples per second and side of the sound.
pub const RATE: u32 = 48_000;

/// Maximum number of tiles of a floor that a page simulates.
const MOST_TILES: u32 = 144;

/// Maximum number of commands that wait for the floor.
const COMMANDS_WAITING: usize = 256;

/// Maximum time that a frame of the page adds to the floor, beside the 50 ms that it catches up. After a longer pause, as of a hidden page, the floor stands still for the
/// rest; a machine that is too slow has a slow floor and a page that answers.
const MOST_AT_ONCE: Duration = Duration::from_millis(16);

/// The reason why the page has no floor.
#[derive(Debug, Error)]
pub enum NoFloor {
    /// The layout, its kinds or its effects cannot be read.
    #[error("{0}")]
    Layout(#[from] Diagnostics),
    /// There is no such floor, or the page could not simulate it in real time.
    #[error(
        "the layout is for a floor of {columns} x {rows} tiles; a page has floors of 1 to {MOST_TILES} tiles"
    )]
    Size {
        /// Number of columns.
        columns: u16,
        /// Number of rows.
        rows: u16,
    },
    /// The simulated floor cannot be calibrated.
    #[error("the simulated floor can't be calibrated: {0}")]
    Calibration(#[from] CalibrationError),
}

/// The simulated floor of the page.
pub struct PageFloor {
    server: Server,
    clock: Arc<PageClock>,
    desk: PageDesk,
    clicks: Clicks,
    /// Whether the floor has ended, which happens only through a fault.
    is_over: bool,
}

/// The name of the layout with which the page begins unless a link has another.
pub const FIRST: &str = "map";

/// The shipped layout of this name; an empty text for an unknown one.
#[must_use]
pub fn shipped(name: &str) -> SharedLayout {
    let text = schema::builtin_layout(name).unwrap_or_default().to_owned();
    SharedLayout { name: name.to_owned(), text, ..SharedLayout::default() }
}

/// The floor of this many columns and rows, or the usual one.
fn geometry_of(grid: Option<(u16, u16)>) -> Result<Geometry, NoFloor> {
    let Some((columns, rows)) = grid else { return Ok(Geometry::default()) };
    let tiles = u32::from(columns) * u32::from(rows);
    let wrong = NoFloor::Size { columns, rows };
    if tiles > MOST_TILES { Err(wrong) } else { Geometry::of_paper_tiles(columns, rows).map_err(|_| wrong) }
}

impl PageFloor {
    /// A floor with the layout of `shared`, and the input of the window that shows it. `play` gets the sound of each
    /// frame: left and right in turn, [`RATE`] samples per second and side.
    ///
    /// # Errors
    /// [`NoFloor::Layout`] with all problems of the texts; [`NoFloor::Size`] for a floor that a page cannot simulate.
    pub fn new(
        shared: &SharedLayout,
        play: impl FnMut(&[f32]) + 'static,
    ) -> Result<(Self, PreviewInput), NoFloor> {
        let nominal = Floor::of(geometry_of(shared.grid)?);
        let own = OwnTexts::of(shared);
        let kinds = own.read()?;
        let document = Document::read(&shared.name, &shared.text, &kinds, &Arc::new(nominal.clone()))?;
        let sim = SimFloor::new(&nominal, SimConfig::default(), SEED);
        let floor = Arc::new(calibrated(&nominal, &sim, SEED)?);

        let (hand, driver) = feet_by_hand();
        let (people, driver) = arrivals(Box::new(driver));
        let (driver, seen) = watched(Box::new(driver));
        let clock = Arc::<PageClock>::default();
        let host = Arc::clone(&clock);
        let source = SimulatedSource::on(sim, Box::new(driver), Pace::RealTime, host);
        let (source, faults) = RehearsalSource::new(source, LinkFaults::default(), SEED);
        let start = source.now();
        let (tap, packets) = TappedPackets::new();

        let (window, ProgramChannels { events, layouts, notices, commands }) = channels();
        let (feel, mut renderer) = renderer(RendererConfig::of(&floor, RATE));
        let scopes = renderer.scope().map(|scope| Box::new(SignalScopes::new(scope)) as Box<dyn ScopeFeed>);
        let (written, shown) = triple_buffer(&Snapshot::default());
        let (to_floor, received) = sync_channel(COMMANDS_WAITING);
        let (layout, clicks) = (document.layout().clone(), Clicks::default());
        let mut server = Server::new(&floor, layout.clone(), Method::default(), tap.wrap(source))
            .with_events(Box::new(Fanout::new().with(ToWindow::new(events)).with(clicks.clone())))
            .with_feel(feel, Box::new(StereoSink::new(renderer, &floor, start, play)))
            .with_snapshots(written)
            .with_commands(received);
        // The first snapshot, before the window asks for it.
        let _ = server.turn();

        let choices: Vec<String> = schema::builtin_layouts().map(String::from).collect();
        let kinds_of = own.clone();
        let design = DesignInput {
            name: shared.name.clone(),
            text: shared.text.clone(),
            path: None,
            kinds_of: Box::new(move |_| kinds_of.read()),
            state: usual_state(),
        };
        let input = PreviewInput {
            warnings: Warnings::from(&document.review()),
            scopes,
            feet: Some(Box::new(Mouse(hand))),
            faults: Some(faults),
            people: Some(people),
            packets: Some(packets),
            shoes: Some(shoes(seen)),
            choices: choices.clone(),
            effects: kinds.effects().iter().cloned().collect(),
            design: Some(design),
            ..PreviewInput::new(Arc::clone(&floor), Arc::new(layout), "simulated floor", shown, window)
        };
        let desk = PageDesk {
            floor,
            choices,
            own,
            asked: commands,
            to_floor,
            layouts,
            notices,
            late: Vec::new(),
            revision: 0,
            off: Vec::new(),
        };
        let floor = Self { server, clock, desk, clicks, is_over: false };
        Ok((floor, input))
    }

    /// The user's kinds and effects, for links.
    #[must_use]
    pub fn own_texts(&self) -> OwnTexts {
        self.desk.own.clone()
    }

    /// Whether a control clicked under a foot since the last call.
    #[must_use]
    pub fn has_clicked(&self) -> bool {
        self.clicks.take()
    }

    /// Describes the sound, or why there is none, once there is something to hear.
    pub fn tell_sound(&self, text: impl Into<String>) {
        let _ = self.desk.notices.try_send(Notice::Sound(text.into()));
    }

    /// Shows a message in the window.
    pub fn tell(&self, text: impl Into<String>) {
        let _ = self.desk.notices.try_send(Notice::Text(text.into()));
    }

    /// Carries out the commands of the window and advances the floor to `now`, the time of the page since some fixed
    /// moment.
    pub fn run_until(&mut self, now: Duration) {
        if self.is_over {
            return;
        }
        self.desk.work(&self.server);
        self.clock.set(now.saturating_sub(MOST_AT_ONCE));
        while self.clock.elapsed() < now {
            match self.server.turn() {
                Ok(Ended::No) => {}
                Ok(Ended::Yes) => return self.end("The floor has ended: load the page again."),
                Err(error) => return self.end(&error.to_string()),
            }
        }
    }

    fn end(&mut self, why: &str) {
        self.is_over = true;
        self.tell(why);
    }
}
