//! The visit of a link in the window: simulated at once, then shown as a recording, until the window's feet take over.

use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use underfoot::layout::Layout;
use underfoot::recording::{Recorded, Recorder, WhenBehind};
use underfoot::sense::Method;
use underfoot::serve::{Ended, FloorCommand, Server};
use underfoot::units::Instant;
use underfoot::wire::ControlMessage;
use underfoot_scene::scene::Shoe;
use underfoot_sim::{Foot, Pace, PlayedFeet, SimulatedSource};
use underfoot_window::preview::{
    self, Playback, PlaybackOrder, PlaybackState, PreviewError, PreviewInput, Warnings, channels,
};

use super::super::failure::Failure;
use super::super::linked::LinkedVisit;
use super::player::ShownRecording;
use super::visits::Visits;
use super::{AfterVisit, Args, LiveFloor};

/// Shows `visit` on the layout and the floor of `args`.
pub(super) fn run(args: Args, visit: LinkedVisit) -> Result<(), Failure> {
    let folder = tempfile::tempdir().map_err(|error| Failure::File(std::env::temp_dir(), error))?;
    let file = folder.path().join("visit.mcap");
    let (layout, warnings) = args.layout.reviewed(&args.floor.load()?)?;
    errln!("The visit is simulated ...");
    simulate(&args, layout, &visit, &file)?;
    let (window, program) = channels();
    let (player, floor, layout, snapshots) = ShownRecording::start(&file, program)?;
    let options = args.window();
    let (live, played) = (Rc::<RefCell<Option<LiveFloor>>>::default(), visit.clone());
    let playback = PlayedVisit {
        player: Some(player),
        at_s: Rc::default(),
        args,
        visit,
        live: Rc::clone(&live),
        failed: None,
    };
    let at_s = Rc::clone(&playback.at_s);
    let mut feet: Vec<Foot> = Vec::new();
    let input = PreviewInput {
        warnings: Warnings::from(&warnings),
        playback: Some(Box::new(playback)),
        visit: Some(Box::new(Visits::of_recording(&file))),
        shoes: Some(Box::new(move |shoes: &mut Vec<Shoe>| {
            played.feet.feet_at(moment(*at_s.borrow()), &mut feet);
            shoes.clear();
            shoes.extend(feet.iter().map(Shoe::from));
        })),
        ..PreviewInput::new(Arc::new(floor), layout, "a visit", snapshots, window)
    };
    // A floor that has taken over ends in order, even after a failure of the window.
    let shown = panic::catch_unwind(AssertUnwindSafe(|| preview::run(input, &options)));
    let taken = live.borrow_mut().take();
    match taken {
        Some(live) => live.end(shown),
        None => match shown.unwrap_or_else(|reason| panic::resume_unwind(reason)) {
            Ok(()) => Ok(()),
            Err(PreviewError::NoWindow(reason)) => Err(Failure::NoWindow(reason)),
        },
    }
}

/// Simulates the visit faster than in real time, and records its floor into `file`.
fn simulate(args: &Args, layout: Layout, visit: &LinkedVisit, file: &Path) -> Result<(), Failure> {
    let (sim, floor) = visit.build.in_use(&args.floor.load()?)?;
    let driver = Box::new(PlayedFeet::new(Arc::clone(&visit.feet)));
    let source = SimulatedSource::new(sim, driver, Pace::FreeRunning);
    let method = Method::default();
    let Recorded { recorder, input, floor, layout } =
        Recorder::around(Some(file), source, floor, layout, method, WhenBehind::Wait)?;
    let mut server = Server::new(&floor, layout, method, input);
    if let Some(recorder) = &recorder {
        server = server.with_events(Box::new(recorder.events()?.waiting()));
    }
    while server.turn()? == Ended::No {}
    Ok(())
}

/// The visit behind the window.
struct PlayedVisit {
    /// `None` once the window's feet have taken over.
    player: Option<ShownRecording>,
    /// The time on display, for the feet.
    at_s: Rc<RefCell<f64>>,
    args: Args,
    visit: LinkedVisit,
    live: Rc<RefCell<Option<LiveFloor>>>,
    /// The reason why the floor could not go on.
    failed: Option<String>,
}

impl Playback for PlayedVisit {
    fn state(&mut self) -> PlaybackState {
        let mut state = self.player.as_mut().map(Playback::state).unwrap_or_default();
        *self.at_s.borrow_mut() = state.at_s;
        state.can_take_over = self.player.is_some();
        state.broken = state.broken.or_else(|| self.failed.clone());
        state
    }

    fn lead(&mut self, order: PlaybackOrder) {
        if let Some(player) = &mut self.player {
            player.lead(order);
        }
    }

    fn take_over(&mut self) -> Option<PreviewInput> {
        let at = moment(self.player.as_mut()?.state().at_s);
        let after = AfterVisit { visit: self.visit.clone(), at };
        match LiveFloor::start(&self.args, Some(&after)) {
            Ok((live, mut input)) => {
                // The floor hurries to the moment, in silence: some hundredths of the visit's own time.
                let mute = |on| live.session.send(FloorCommand::Control(ControlMessage::Mute { on }));
                mute(true);
                while input.snapshots.read().at < at && !live.session.has_ended() {
                    thread::sleep(Duration::from_millis(2));
                }
                mute(false);
                *self.live.borrow_mut() = Some(live);
                self.player = None;
                Some(input)
            }
            Err(failure) => {
                self.failed = Some(failure.to_string());
                None
            }
        }
    }
}

/// A time of the time line as a moment of the floor.
fn moment(at_s: f64) -> Instant {
    Instant::START + Duration::try_from_secs_f64(at_s).unwrap_or_default()
}
