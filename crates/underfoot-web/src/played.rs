//! A reel in a page: the visit of a link or a recording, played from any moment and steered by the time line. The
//! window's feet can take over from a visit.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use triple_buffer::{Input, triple_buffer};
use underfoot::engine::Snapshot;
use underfoot::units::Instant;
use underfoot::widget::EventKind;
use underfoot_sim::TakeOver;
use underfoot_window::preview::{
    EventNews, MarkWeight, Notice, Playback, PlaybackMark, PlaybackOrder, PlaybackState, PreviewInput,
    ProgramChannels, channels,
};

use super::floor::PageFloor;
use super::plan::NoFloor;

/// Maximum time of the machine that one frame of the page spends on the floor.
const BUDGET: Duration = Duration::from_millis(12);

/// Time of the floor between two looks at the machine's clock.
const STEP: Duration = Duration::from_millis(10);

/// Maximum time of the page that counts for one frame: a hidden page plays nothing.
const LONGEST_FRAME: Duration = Duration::from_millis(60);

/// Maximum number of marks on the time line.
const MOST_MARKS: usize = 10_000;

/// A source of floors that begin again and again, each with the same events.
pub trait Reel {
    /// A floor at the beginning, the input of its window, and the handle for taking over, if that is possible.
    ///
    /// # Errors
    /// [`NoFloor`] if the floor cannot begin.
    fn begin(&self) -> Result<(PageFloor, PreviewInput, Option<TakeOver>), NoFloor>;

    /// Time from the beginning to the end.
    fn duration(&self) -> Duration;

    /// All marks of the time line; `None` where they become known as it is played.
    fn marks(&self) -> Option<Vec<PlaybackMark>> {
        None
    }

    /// Why it breaks off before the end that it should have, if it does.
    fn broken(&self) -> Option<String> {
        None
    }
}

/// A reel on its floor.
pub struct Played {
    reel: Box<dyn Reel>,
    floor: PageFloor,
    /// Time of the floor that is wanted.
    at: Duration,
    /// Time of the page in the last frame.
    last: Option<Duration>,
    /// How far the marks reach.
    marked: Duration,
    window: ProgramChannels,
    written: Input<Snapshot>,
    /// The last snapshot before a jump to another moment.
    latest: Snapshot,
    shared: Rc<RefCell<Steering>>,
}

/// The state that the window and the floor share.
struct Steering {
    state: PlaybackState,
    orders: VecDeque<PlaybackOrder>,
    /// The window's input on the floor of the visit, until the window takes it to go on by itself.
    live: Option<PreviewInput>,
    take_over: Option<TakeOver>,
    /// Whether the window's feet have taken over.
    is_live: bool,
    /// The moment of the floor.
    at: Duration,
}

/// The window's end.
struct PagePlayback(Rc<RefCell<Steering>>);

impl Playback for PagePlayback {
    fn state(&mut self) -> PlaybackState {
        self.0.borrow().state.clone()
    }

    fn lead(&mut self, order: PlaybackOrder) {
        self.0.borrow_mut().orders.push_back(order);
    }

    fn take_over(&mut self) -> Option<PreviewInput> {
        let mut steering = self.0.borrow_mut();
        let take_over = steering.take_over.clone()?;
        let input = steering.live.take()?;
        take_over.at(Instant::START + steering.at);
        steering.is_live = true;
        Some(input)
    }
}

impl Played {
    /// Plays `reel` from its beginning; also returns the input of the window that shows it. The window calls its floor
    /// `source`.
    ///
    /// # Errors
    /// Those of [`Reel::begin`].
    pub fn new(reel: Box<dyn Reel>, source: &str) -> Result<(Self, PreviewInput), NoFloor> {
        let (floor, mut live, take_over) = reel.begin()?;
        let (window, program) = channels();
        let latest = live.snapshots.read().clone();
        let (written, shown) = triple_buffer(&latest);
        let marks = reel.marks();
        let marked = if marks.is_some() { Duration::MAX } else { Duration::ZERO };
        let state = PlaybackState {
            marks: Arc::new(marks.unwrap_or_default()),
            length_s: reel.duration().as_secs_f64(),
            can_take_over: take_over.is_some(),
            broken: reel.broken(),
            ..PlaybackState::default()
        };
        let (layout, warnings) = (Arc::clone(&live.layout), live.warnings.clone());
        let shown_floor = Arc::clone(&live.floor);
        let steering = Steering {
            state,
            orders: VecDeque::new(),
            live: Some(live),
            take_over,
            is_live: false,
            at: Duration::ZERO,
        };
        let shared = Rc::new(RefCell::new(steering));
        let shoes = Rc::clone(&shared);
        let input = PreviewInput {
            warnings,
            playback: Some(Box::new(PagePlayback(Rc::clone(&shared)))),
            shoes: Some(Box::new(move |into| {
                if let Some(feed) = shoes.borrow_mut().live.as_mut().and_then(|live| live.shoes.as_mut()) {
                    feed(into);
                }
            })),
            ..PreviewInput::new(shown_floor, layout, source, shown, window)
        };
        let played = Self {
            reel,
            floor,
            at: Duration::ZERO,
            last: None,
            marked,
            window: program,
            written,
            latest,
            shared,
        };
        Ok((played, input))
    }

    /// The floor.
    #[must_use]
    pub fn floor(&self) -> &PageFloor {
        &self.floor
    }

    /// Whether the window's feet have taken over.
    #[must_use]
    pub fn is_live(&self) -> bool {
        self.shared.borrow().is_live
    }

    /// Shows a message in the window.
    pub fn tell(&self, text: impl Into<String>) {
        if self.is_live() {
            self.floor.tell(text);
        } else {
            let _ = self.window.notices.try_send(Notice::Text(text.into()));
        }
    }

    /// Whether the sound of the floor is to be heard: only at its own speed.
    #[must_use]
    pub fn is_heard(&self) -> bool {
        let steering = self.shared.borrow();
        let state = &steering.state;
        steering.is_live || (!state.is_paused && state.goes_to_s.is_none() && state.speed == 1.0)
    }

    /// Advances the reel by a frame of the page at `now`, the time of the page; `clock` returns the machine's time, by
    /// which a frame that has much to catch up ends.
    pub fn run_until(&mut self, now: Duration, clock: &dyn Fn() -> Duration) {
        let passed = now.saturating_sub(self.last.unwrap_or(now)).min(LONGEST_FRAME);
        self.last = Some(now);
        let begun = clock();
        let is_late = || clock().saturating_sub(begun) > BUDGET;
        if self.shared.borrow().is_live {
            self.run_to(self.at + passed, &is_late);
            // A machine that is too slow has a slow floor.
            return;
        }
        self.process_orders();
        let (goes_to_s, is_paused, speed) = {
            let state = &self.shared.borrow().state;
            (state.goes_to_s, state.is_paused, state.speed)
        };
        let end = self.reel.duration();
        let goal = match goes_to_s {
            Some(to_s) => seconds(to_s),
            None if is_paused => self.at,
            None if speed.is_finite() => self.at + passed.mul_f64(speed.clamp(0.0, 100.0)),
            None => end,
        };
        self.run_to(goal.min(end), &is_late);
        let is_there = goes_to_s.is_none_or(|_| self.at >= goal.min(end));
        self.pass_on(is_there);
        self.note_progress(is_there);
    }

    /// Advances the floor to `goal`, or as far as the frame has time for.
    fn run_to(&mut self, goal: Duration, is_late: &dyn Fn() -> bool) {
        while self.at < goal {
            self.at = (self.at + STEP).min(goal);
            self.floor.run_until(self.at);
            self.shared.borrow_mut().at = self.at;
            if is_late() {
                break;
            }
        }
    }

    fn process_orders(&mut self) {
        loop {
            let Some(order) = self.shared.borrow_mut().orders.pop_front() else { return };
            match order {
                PlaybackOrder::Pause(is_paused) => {
                    if !is_paused && self.at >= self.reel.duration() {
                        self.go_to(0.0);
                    }
                    self.shared.borrow_mut().state.is_paused = is_paused;
                }
                PlaybackOrder::Speed(speed) => self.shared.borrow_mut().state.speed = speed,
                PlaybackOrder::GoTo(at_s) => self.go_to(at_s),
                PlaybackOrder::Repeat(part) => {
                    self.shared.borrow_mut().state.repeats = part;
                    if let Some((from, to)) = part
                        && !(from..to).contains(&self.at.as_secs_f64())
                    {
                        self.go_to(from);
                    }
                }
            }
        }
    }

    /// Goes to a moment; an earlier one is only reachable from the beginning.
    fn go_to(&mut self, at_s: f64) {
        let to = seconds(at_s).min(self.reel.duration());
        if to < self.at {
            match self.reel.begin() {
                Ok((floor, live, take_over)) => self.begin_again(floor, live, take_over),
                Err(error) => return self.shared.borrow_mut().state.broken = Some(error.to_string()),
            }
        }
        self.shared.borrow_mut().state.goes_to_s = Some(to.as_secs_f64());
    }

    fn begin_again(&mut self, floor: PageFloor, live: PreviewInput, take_over: Option<TakeOver>) {
        (self.floor, self.at) = (floor, Duration::ZERO);
        // A full channel has more than the window can show.
        let _ = self.window.events.try_send(EventNews::Restarted(Arc::clone(&live.layout)));
        let mut steering = self.shared.borrow_mut();
        (steering.live, steering.take_over, steering.at) = (Some(live), take_over, self.at);
    }

    /// Passes the news of the floor on to the window; during a jump, the picture from before stays.
    fn pass_on(&mut self, is_there: bool) {
        let mut steering = self.shared.borrow_mut();
        let Steering { state, live: Some(live), .. } = &mut *steering else { return };
        for news in live.channels.events.try_iter() {
            self.marked = note_mark(&news, self.marked, state).unwrap_or(self.marked);
            let _ = self.window.events.try_send(news);
        }
        for news in live.channels.layouts.try_iter() {
            let _ = self.window.layouts.try_send(news);
        }
        for news in live.channels.notices.try_iter() {
            let _ = self.window.notices.try_send(news);
        }
        for command in self.window.commands.try_iter() {
            let _ = live.channels.commands.try_send(command);
        }
        if live.snapshots.update() && is_there {
            self.latest.clone_from(live.snapshots.output_buffer());
        }
        // A floor that sends nothing would count as lost.
        self.written.input_buffer_mut().clone_from(&self.latest);
        self.written.publish();
    }

    fn note_progress(&mut self, is_there: bool) {
        let (at_s, is_over) = (self.at.as_secs_f64(), self.at >= self.reel.duration());
        let repeats = {
            let state = &mut self.shared.borrow_mut().state;
            if !is_there {
                return;
            }
            (state.goes_to_s, state.at_s) = (None, at_s);
            if state.is_paused { None } else { state.repeats }
        };
        match repeats {
            Some((from, to)) if at_s >= to || is_over => self.go_to(from),
            _ if is_over => self.shared.borrow_mut().state.is_paused = true,
            _ => {}
        }
    }
}

/// A time in seconds; NaN and negative ones are the beginning, and years from then on are the end of any reel.
fn seconds(at_s: f64) -> Duration {
    let at_s = if at_s.is_nan() { 0.0 } else { at_s };
    Duration::from_secs_f64(at_s.clamp(0.0, 1e9))
}

/// Marks a press that comes after `marked`; returns how far the marks reach then.
fn note_mark(news: &EventNews, marked: Duration, state: &mut PlaybackState) -> Option<Duration> {
    let EventNews::Event(event) = news else { return None };
    let at = event.at.since(Instant::START);
    let (what, weight) = match event.kind {
        EventKind::Pressed => ("pressed", MarkWeight::Usual),
        EventKind::Cancelled => ("cancelled", MarkWeight::Odd),
        _ => return None,
    };
    if at <= marked || state.marks.len() >= MOST_MARKS {
        return None;
    }
    let mark = PlaybackMark { at_s: at.as_secs_f64(), what: format!("{} {what}", event.id), weight };
    Arc::make_mut(&mut state.marks).push(mark);
    Some(at)
}
