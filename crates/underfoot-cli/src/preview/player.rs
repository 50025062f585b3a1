//! A recording behind the window: sensed again, at any speed and any number of times.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::recording::{Progress, Recording, Speed, Timeline, Transport};
use underfoot::runtime::Session;
use underfoot::sink::Since;
use underfoot::units::Instant;
use underfoot_window::preview::{
    EventNews, LayoutCause, Playback, PlaybackMark, PlaybackOrder, PlaybackState, ProgramChannels, ToWindow,
    announced,
};

use super::super::failure::Failure;
use super::LOOK;
use super::stop_and_wait;

/// A recording that is shown; ends when this is dropped.
pub(super) struct ShownRecording {
    orders: Option<SyncSender<PlaybackOrder>>,
    shown: Arc<Shown>,
    thread: Option<JoinHandle<()>>,
}

/// Maximum number of orders that wait for the player: seconds of a mouse that drags the time line.
const ORDERS_WAITING: usize = 256;

/// State from the player's threads for the window.
struct Shown {
    state: Mutex<PlaybackState>,
    is_over: AtomicBool,
}

impl Shown {
    fn state(&self) -> MutexGuard<'_, PlaybackState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ShownRecording {
    /// Plays the recording at `path` from its beginning; returns its floor, its first layout and its snapshots.
    pub(super) fn start(
        path: &Path,
        window: ProgramChannels,
    ) -> Result<(Self, Floor, Arc<Layout>, triple_buffer::Output<Snapshot>), Failure> {
        let (input, snapshots) = triple_buffer::triple_buffer(&Snapshot::default());
        let speed = Speed::Times(PlaybackState::default().speed);
        let run = Run::begin(path, speed, &window)?;
        let (floor, layout) = (run.floor.clone(), Arc::clone(&run.layout));
        let shown = Arc::new(Shown { state: Mutex::default(), is_over: AtomicBool::new(false) });
        let (sender, orders) = mpsc::sync_channel(ORDERS_WAITING);
        let playing = Playing {
            path: path.into(),
            run,
            window,
            snapshots: input,
            last: Snapshot::default(),
            orders,
            shown: Arc::clone(&shown),
        };
        read_marks(path, playing.run.first, Arc::clone(&shown))?;
        let thread = thread::Builder::new().name("player".into()).spawn(move || playing.play());
        let thread = Some(thread.map_err(|error| Failure::Other(error.to_string()))?);
        Ok((Self { orders: Some(sender), shown, thread }, floor, layout, snapshots))
    }
}

impl Playback for ShownRecording {
    fn state(&mut self) -> PlaybackState {
        self.shown.state().clone()
    }

    fn lead(&mut self, order: PlaybackOrder) {
        if let Some(orders) = &self.orders {
            // A failed player has reported its failure; one that is this far behind gets newer orders soon.
            let _ = orders.try_send(order);
        }
    }
}

impl Drop for ShownRecording {
    fn drop(&mut self) {
        self.shown.is_over.store(true, Ordering::Relaxed);
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Reads the whole recording for its length and its marks, on a thread of its own.
fn read_marks(path: &Path, first: Instant, shown: Arc<Shown>) -> Result<(), Failure> {
    let recording = Recording::open(path)?;
    let tell = move |timeline: &Timeline| {
        let mut state = shown.state();
        state.length_s = timeline.span.map_or(0.0, |(_, last)| last.since(first).as_secs_f64());
        let marks = &timeline.marks[state.marks.len().min(timeline.marks.len())..];
        let told = marks.iter().map(|mark| PlaybackMark::of_recording(mark, first));
        Arc::make_mut(&mut state.marks).extend(told);
        state.broken.clone_from(&timeline.broken);
        !shown.is_over.load(Ordering::Relaxed)
    };
    thread::Builder::new()
        .name("time line".into())
        .spawn(move || recording.read_timeline(tell))
        .map(drop)
        .map_err(|error| Failure::Other(error.to_string()))
}

/// One pass through the recording, from its first moment.
struct Run {
    session: Session,
    floor: Floor,
    layout: Arc<Layout>,
    transport: Arc<Transport>,
    progress: Arc<Progress>,
    snapshots: triple_buffer::Output<Snapshot>,
    first: Instant,
}

impl Run {
    fn begin(path: &Path, speed: Speed, window: &ProgramChannels) -> Result<Self, Failure> {
        let recording = Recording::open(path)?;
        let (floor, layout, method) =
            (recording.floor().clone(), recording.layout().clone(), recording.method());
        let begins = recording.begins().unwrap_or(Instant::START);
        let source = recording.source(speed);
        source.transport().stay_at_the_end();
        let first = begins.max(source.now());
        source.transport().hurry_to(first);
        let (transport, progress) = (source.transport(), source.progress());
        let clock = source.clock();
        let input = announced(source, window.layouts.clone(), LayoutCause::Recorded);
        let session = Session::source(input, clock)
            .floor(floor.clone())
            .layout(layout.clone())
            .method(method)
            .sink(Since::new(ToWindow::new(window.events.clone()), first))
            .start()?;
        let snapshots = session.take_snapshots();
        Ok(Self { session, floor, layout: Arc::new(layout), transport, progress, snapshots, first })
    }

    fn at_s(&self) -> f64 {
        self.progress.now().max(self.first).since(self.first).as_secs_f64()
    }
}

/// The recording and the state of its playback.
struct Playing {
    path: PathBuf,
    run: Run,
    window: ProgramChannels,
    snapshots: triple_buffer::Input<Snapshot>,
    /// The last snapshot before a jump to another moment.
    last: Snapshot,
    orders: Receiver<PlaybackOrder>,
    shown: Arc<Shown>,
}

impl Playing {
    /// Plays until the window closes its channels.
    fn play(mut self) {
        loop {
            match self.orders.recv_timeout(LOOK) {
                Ok(order) => self.apply(order),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.look();
        }
    }

    fn apply(&mut self, order: PlaybackOrder) {
        let speed_of = |times: f64| if times.is_finite() { Speed::Times(times) } else { Speed::Max };
        match order {
            PlaybackOrder::Pause(is_paused) => {
                // At the end, playing can only continue from the beginning.
                if !is_paused && self.run.progress.is_over() {
                    self.go_to(0.0);
                }
                self.run.transport.set_paused(is_paused);
                self.shown.state().is_paused = is_paused;
            }
            PlaybackOrder::Speed(times) => {
                self.run.transport.set_speed(speed_of(times));
                self.shown.state().speed = times;
            }
            PlaybackOrder::GoTo(at_s) => self.go_to(at_s),
            PlaybackOrder::Repeat(stretch) => {
                self.shown.state().repeats = stretch;
                if let Some((from, _)) = stretch.filter(|(from, to)| !(*from..*to).contains(&self.run.at_s()))
                {
                    self.go_to(from);
                }
            }
        }
    }

    /// Senses the floor again up to this moment; an earlier moment is only reachable from the beginning.
    fn go_to(&mut self, at_s: f64) {
        let length_s = self.shown.state().length_s;
        // NaN stands for the first moment.
        let at_s = at_s.max(0.0).min(length_s);
        if at_s < self.run.at_s() {
            let speed = self.run.transport.speed();
            stop_and_wait(&self.run.session);
            let _ = self.window.events.send(EventNews::Restarted(Arc::clone(&self.run.layout)));
            match Run::begin(&self.path, speed, &self.window) {
                Ok(run) => self.run = run,
                Err(failure) => {
                    self.shown.state().broken = Some(failure.to_string());
                    return;
                }
            }
            self.run.transport.set_paused(self.shown.state().is_paused);
        }
        self.shown.state().goes_to_s = Some(at_s);
        self.run.transport.hurry_to(self.run.first + Duration::from_secs_f64(at_s));
    }

    /// Passes on the latest snapshot.
    fn look(&mut self) {
        let at_s = self.run.at_s();
        let is_fresh = self.run.snapshots.update();
        let mut state = self.shown.state();
        let is_there = state.goes_to_s.is_none_or(|to| at_s + ARRIVED_S >= to || self.run.progress.is_over());
        if is_there {
            (state.goes_to_s, state.at_s) = (None, at_s);
            if is_fresh {
                self.last.clone_from(self.run.snapshots.output_buffer());
            }
        }
        // During a jump, the snapshot from before stays visible.
        self.snapshots.input_buffer_mut().clone_from(&self.last);
        self.snapshots.publish();
        let (is_paused, repeats) = (state.is_paused, state.repeats);
        drop(state);
        let is_over = self.run.progress.is_over();
        match repeats.filter(|_| is_there && !is_paused) {
            Some((from, to)) if at_s >= to || is_over => self.go_to(from),
            _ if is_over && is_there && !is_paused => self.apply(PlaybackOrder::Pause(true)),
            _ => {}
        }
    }
}

/// Maximum time from the last packet to the target moment, in seconds: boards send a thousand a second.
const ARRIVED_S: f64 = 0.005;

#[cfg(test)]
mod tests {
    use std::time::Instant as HostInstant;

    use clap::Parser;

    use super::super::super::session;
    use super::*;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        session: session::Args,
    }

    /// Waits until `what` holds, on a machine of any speed.
    fn until(player: &mut ShownRecording, what: impl Fn(&PlaybackState) -> bool) -> PlaybackState {
        let begun = HostInstant::now();
        loop {
            let state = player.state();
            if what(&state) {
                return state;
            }
            assert!(begun.elapsed() < Duration::from_secs(120), "{state:?}");
            thread::sleep(Duration::from_millis(5));
        }
    }

    #[test]
    fn a_recording_is_seen_to_its_end_and_again_from_any_moment() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("visit.mcap");
        let out = folder.path().join("out");
        let arguments = ["session".as_ref(), "--out".as_ref(), out.as_os_str(), "--record".as_ref()];
        session::run(&Line::parse_from(arguments.into_iter().chain([file.as_os_str()])).session).unwrap();

        let (events, told) = mpsc::sync_channel(100_000);
        let (_window, program) = underfoot_window::preview::channels();
        let (mut player, _, layout, mut snapshots) =
            ShownRecording::start(&file, ProgramChannels { events, ..program }).unwrap();
        assert!(layout.widget_index("home").is_some());
        player.lead(PlaybackOrder::Speed(f64::INFINITY));
        let end = until(&mut player, |state| state.is_paused);
        assert!(end.at_s > 19.0 && (end.at_s - end.length_s).abs() < 0.1, "{end:?}");
        assert!(end.marks.iter().any(|mark| mark.what == "home pressed" && (mark.at_s - 4.4).abs() < 0.3));
        let first: Vec<EventNews> = told.try_iter().collect();
        assert!(first.len() > 10);

        // Jumps back to a moment after the first press, and stays there.
        player.lead(PlaybackOrder::GoTo(5.0));
        let back = until(&mut player, |state| state.goes_to_s.is_none() && state.at_s < 6.0);
        assert!((back.at_s - 5.0).abs() < 0.02 && back.is_paused, "{back:?}");
        let shown = snapshots.read().at;
        let again: Vec<EventNews> = told.try_iter().collect();
        let begins = again.iter().position(|news| matches!(news, EventNews::Restarted(_))).unwrap();
        let again = &again[begins + 1..];
        assert!(!again.is_empty() && again == &first[..again.len()], "{again:?}");
        assert!(shown < Instant::from_millis(6000), "{shown:?}");

        // Plays again, in a loop.
        player.lead(PlaybackOrder::Repeat(Some((4.0, 4.5))));
        player.lead(PlaybackOrder::Pause(false));
        let restarts = || told.try_iter().filter(|news| matches!(news, EventNews::Restarted(_))).count();
        let begun = HostInstant::now();
        let mut count = 0;
        while count < 3 {
            count += restarts();
            assert!(begun.elapsed() < Duration::from_secs(120), "{:?}", player.state());
            thread::sleep(Duration::from_millis(5));
        }
    }
}
