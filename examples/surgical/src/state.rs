//! The state of the viewer and its reactions to feet, independent of window and floor.

use serde::Serialize;
use underfoot::runtime::{Event, Kind};
use underfoot::widget::{EventKind, Value};
use underfoot::wire::LinkState;

use crate::beam::{Beam, Cause};
use crate::series::{Plane, Series, Window};

/// Number of series that a page of the floor offers.
pub const OFFERED: usize = 4;

/// At the pad's edge: rate at which the window widens, in powers of e per second, and share of its width by which the
/// level moves in a second.
const WIDENS: f64 = 0.9;
const MOVES: f64 = 0.5;

/// Narrowest and widest window: from one step of the value to all that 32 bits can hold.
const WIDTHS: [f64; 2] = [1.0, 4.3e9];

/// Greatest zoom.
pub const NEAREST: f64 = 8.0;

/// Distance below which two points of a measurement count as the same, in pixels along both axes.
const SAME: f64 = 0.5;

/// Time without change after which the viewer counts as settled, in seconds.
const SETTLED_S: f64 = 0.3;

/// Duration of a notice, in seconds.
const NOTICE_S: f64 = 4.0;

/// The state of feet at one time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hold {
    /// The place on the window pad, eastwards and northwards up to 1; zero while it is not held.
    pub window: [f64; 2],
    /// Distance that feet dragged the picture since the last call, to the right and downwards, in
    /// [units](View::middle).
    pub drag: [f64; 2],
    /// Whether the floor confirms a foot on the beam's control.
    pub beam: bool,
}

/// A place in a series: the slice, and the place in it, in [units](View::middle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    pub slice: usize,
    pub at: [f64; 2],
}

/// A distance between two marks of one slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    pub slice: usize,
    pub ends: [[f64; 2]; 2],
}

impl Measure {
    /// In units of the series.
    pub fn length(&self) -> f64 {
        let [from, to] = self.ends;
        (to[0] - from[0]).hypot(to[1] - from[1])
    }
}

/// The view of one series.
#[derive(Clone, Debug)]
pub struct View {
    pub slice: usize,
    pub window: Window,
    /// The zoom; 1 fits the picture to the window.
    pub zoom: f64,
    /// The point in the middle, from the picture's upper left corner to the right and down: in millimetres, or in
    /// pixels if the files lack their size.
    pub middle: [f64; 2],
    /// The first press of a measurement.
    pub first: Option<Mark>,
    pub measures: Vec<Measure>,
}

/// A series without its pixels.
#[derive(Clone, Debug)]
pub struct Sheet {
    pub title: String,
    /// Patient, number and day.
    pub about: String,
    pub frames: usize,
    pub size: [usize; 2],
    planes: Vec<Plane>,
    window: Window,
}

impl Sheet {
    pub fn of(series: &Series) -> Self {
        Self {
            title: series.title.clone(),
            about: series.about.clone(),
            frames: series.frames.len(),
            size: series.size,
            planes: series.frames.iter().map(|frame| frame.plane.clone()).collect(),
            window: series.window,
        }
    }

    fn spacing_mm(&self, slice: usize) -> Option<[f64; 2]> {
        self.planes.get(slice)?.spacing_mm
    }

    /// Width and height of a slice in its units.
    pub fn extent(&self, slice: usize) -> [f64; 2] {
        let spacing = self.spacing(slice);
        [0, 1].map(|axis| self.size[axis] as f64 * spacing[axis])
    }

    /// Distance between pixels, in units.
    fn spacing(&self, slice: usize) -> [f64; 2] {
        self.spacing_mm(slice).unwrap_or([1.0; 2])
    }

    /// The units of a slice: millimetres, or pixels if its file lacks their size.
    pub fn unit(&self, slice: usize) -> &'static str {
        if self.spacing_mm(slice).is_some() { "mm" } else { "px" }
    }

    /// The sides of the body at the right edge and the lower edge of a slice, in letters.
    pub fn towards(&self, slice: usize) -> Option<&[String; 2]> {
        self.planes.get(slice)?.towards.as_ref()
    }

    fn view(&self) -> View {
        let slice = self.frames / 2;
        View {
            slice,
            window: self.window,
            zoom: 1.0,
            middle: self.extent(slice).map(|extent| 0.5 * extent),
            first: None,
            measures: Vec::new(),
        }
    }
}

/// The viewer.
#[derive(Clone, Debug)]
pub struct State {
    pub sheets: Vec<Sheet>,
    views: Vec<View>,
    pub current: usize,
    /// The first of the series that the floor offers.
    pub offered: usize,
    pub beam: Beam,
    pub longest_s: f64,
    pub is_lost: bool,
    /// Whether one more press clears the measurements.
    pub is_armed: bool,
    notice: Option<(String, f64)>,
    still_s: f64,
}

/// The state that tests compare.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    pub series: String,
    pub frames: usize,
    /// The range of the floor's own slider.
    pub range: Option<[f64; 2]>,
    pub slice: usize,
    pub level: f64,
    pub width: f64,
    pub zoom: f64,
    pub middle: [f64; 2],
    pub measures: Vec<f64>,
    pub beam: bool,
    pub warned: bool,
    pub ended: Option<Cause>,
    pub shots: u32,
    pub lost: bool,
}

impl State {
    /// A viewer of at least one series; `longest_s` is the longest time of the beam.
    pub fn new(sheets: Vec<Sheet>, longest_s: f64) -> Self {
        let views = sheets.iter().map(Sheet::view).collect();
        Self {
            sheets,
            views,
            current: 0,
            offered: 0,
            beam: Beam::default(),
            longest_s,
            is_lost: false,
            is_armed: false,
            notice: None,
            still_s: 0.0,
        }
    }

    pub fn sheet(&self) -> &Sheet {
        &self.sheets[self.current]
    }

    pub fn view(&self) -> &View {
        &self.views[self.current]
    }

    fn view_mut(&mut self) -> &mut View {
        &mut self.views[self.current]
    }

    /// The present notice, if any.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_ref().map(|(words, _)| words.as_str())
    }

    fn notify(&mut self, words: impl Into<String>) {
        self.notice = Some((words.into(), NOTICE_S));
    }

    /// Reacts to an event of the floor.
    pub fn hear(&mut self, event: &Event) {
        match event.kind {
            Kind::Control(kind) if event.id() == "beam" => {
                self.beam.hear(kind, event.at, self.longest_s);
                self.still_s = 0.0;
            }
            Kind::Control(kind) => self.hear_control(event.id(), kind),
            Kind::Link(link) => self.link(link, event.at),
            Kind::Ended(_) => self.link(LinkState::Lost, event.at),
            _ => {}
        }
    }

    fn link(&mut self, link: LinkState, at: underfoot::units::Instant) {
        self.is_lost = link == LinkState::Lost;
        if self.is_lost {
            self.beam.lose(at);
            self.is_armed = false;
        }
        self.still_s = 0.0;
    }

    fn hear_control(&mut self, id: &str, kind: EventKind) {
        match (id, kind) {
            ("slice", EventKind::Changed(Value::Number(number))) => self.turn_to(f64::from(number)),
            ("zoom", EventKind::Changed(Value::Number(number))) => {
                self.view_mut().zoom = f64::from(number).clamp(1.0, NEAREST);
            }
            ("mark", EventKind::Clicked) => self.mark(),
            ("clear", EventKind::Clicked) => {
                let view = self.view_mut();
                view.measures.clear();
                view.first = None;
                self.notify("Measurements cleared");
            }
            ("clear", EventKind::Armed) => self.is_armed = true,
            ("clear", EventKind::Disarmed) => self.is_armed = false,
            ("clear", EventKind::Refused) => self.notify("There is nothing to clear"),
            ("more", EventKind::Clicked) => {
                let next = self.offered + OFFERED;
                self.offered = if next < self.sheets.len() { next } else { 0 };
            }
            (id, EventKind::Clicked) => {
                let number = id.strip_prefix("series_").and_then(|number| number.parse::<usize>().ok());
                let chosen = number.and_then(|number| (self.offered + number).checked_sub(1));
                if let Some(chosen) = chosen.filter(|chosen| *chosen < self.sheets.len()) {
                    self.current = chosen;
                }
            }
            _ => {}
        }
    }

    /// Turns to the slice with this number, from 1, or the nearest one.
    fn turn_to(&mut self, number: f64) {
        let last = self.sheet().frames.saturating_sub(1);
        // A number that is not finite becomes 0.
        let slice = ((number - 1.0).round().max(0.0) as usize).min(last);
        let (before, after) = (self.sheet().extent(self.view().slice), self.sheet().extent(slice));
        let view = self.view_mut();
        view.slice = slice;
        // Slices may have pixels of different sizes: the same pixel stays in the middle.
        view.middle = [0, 1].map(|axis| view.middle[axis] * after[axis] / before[axis]);
        if view.first.is_some_and(|first| first.slice != slice) {
            view.first = None;
            self.notify("The first point was on another slice: begin again");
        }
    }

    /// Turns by this number of slices, for mouse and keys; stops at the first one and the last one.
    pub fn step(&mut self, slices: f64) {
        self.turn_to(self.view().slice as f64 + 1.0 + slices);
        self.still_s = 0.0;
    }

    /// A press of the marking button: the first point of a measurement, or its second.
    fn mark(&mut self) {
        let spacing = self.sheet().spacing(self.view().slice);
        let view = self.view_mut();
        let (slice, at) = (view.slice, view.middle);
        let Some(first) = view.first.take() else {
            view.first = Some(Mark { slice, at });
            return;
        };
        let is_same = [0, 1].iter().all(|axis| (at[*axis] - first.at[*axis]).abs() < SAME * spacing[*axis]);
        if is_same {
            view.first = Some(first);
            self.notify("Both points are the same: slide the picture to the second one");
        } else {
            view.measures.push(Measure { slice, ends: [first.at, at] });
        }
    }

    /// Whether there is anything to clear.
    pub fn has_marks(&self) -> bool {
        self.view().first.is_some() || !self.view().measures.is_empty()
    }

    /// Advances time; returns whether the viewer has just come to rest.
    pub fn pass(&mut self, dt_s: f64, hold: &Hold) -> bool {
        let before = self.report(None);
        let extent = self.sheet().extent(self.view().slice);
        let view = self.view_mut();
        let [wider, brighter] =
            hold.window.map(|share| if share.is_finite() { share.clamp(-1.0, 1.0) } else { 0.0 });
        view.window.width = (view.window.width * (wider * WIDENS * dt_s).exp()).clamp(WIDTHS[0], WIDTHS[1]);
        // A lower level shows the same values brighter.
        view.window.level -= brighter * MOVES * view.window.width * dt_s;
        for axis in [0, 1] {
            let to = view.middle[axis] - hold.drag[axis];
            if to.is_finite() {
                view.middle[axis] = to.clamp(0.0, extent[axis]);
            }
        }
        self.beam.pass(dt_s, hold.beam && !self.is_lost);
        if let Some((_, left_s)) = &mut self.notice {
            *left_s -= dt_s;
        }
        self.notice = self.notice.take().filter(|(_, left_s)| *left_s > 0.0);
        let was_still = self.still_s >= SETTLED_S;
        // Changes between two turns have reset this already.
        self.still_s = if before == self.report(None) { self.still_s + dt_s } else { 0.0 };
        !was_still && self.still_s >= SETTLED_S
    }

    /// Marks a change that `pass` does not make itself.
    pub fn stir(&mut self) {
        self.still_s = 0.0;
    }

    pub fn report(&self, range: Option<[f64; 2]>) -> Report {
        let round = |number: f64| (number * 10.0).round() / 10.0;
        let (sheet, view) = (self.sheet(), self.view());
        Report {
            series: sheet.title.clone(),
            frames: sheet.frames,
            range,
            slice: view.slice + 1,
            level: round(view.window.level),
            width: round(view.window.width),
            zoom: round(view.zoom),
            middle: view.middle.map(round),
            measures: view.measures.iter().map(|measure| round(measure.length())).collect(),
            beam: self.beam.is_on,
            warned: self.beam.has_warned,
            ended: self.beam.ended,
            shots: self.beam.shots,
            lost: self.is_lost,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::{Frame, Pixels};

    const DT_S: f64 = 1.0 / 60.0;

    fn series(title: &str, frames: usize, spacing_mm: Option<[f64; 2]>) -> Sheet {
        let window = Window { level: 40.0, width: 400.0 };
        let plane = Plane { spacing_mm, ..Plane::default() };
        let frame = Frame { pixels: Pixels::Grey(vec![0.0; 100 * 50]), plane };
        Sheet::of(&Series {
            title: title.into(),
            about: String::new(),
            size: [100, 50],
            window,
            is_inverted: false,
            frames: vec![frame; frames],
        })
    }

    fn viewer() -> State {
        let some = |number: usize| series(&format!("Series {number}"), 10 + number, Some([0.5, 2.0]));
        State::new((0..6).map(some).collect(), 5.0)
    }

    fn pass(state: &mut State, seconds: f64, hold: Hold) -> usize {
        (0..(seconds / DT_S).round() as usize).filter(|_| state.pass(DT_S, &hold)).count()
    }

    #[test]
    fn each_series_keeps_its_own_view_and_pages_offer_all() {
        let mut state = viewer();
        state.hear_control("slice", EventKind::Changed(Value::Number(3.0)));
        state.hear_control("zoom", EventKind::Changed(Value::Number(4.0)));
        state.hear_control("more", EventKind::Clicked);
        assert_eq!(state.offered, 4);
        state.hear_control("series_2", EventKind::Clicked);
        assert_eq!((state.current, state.view().slice, state.view().zoom), (5, 7, 1.0));
        state.hear_control("series_3", EventKind::Clicked);
        assert_eq!(state.current, 5, "there is none on that button");
        state.hear_control("more", EventKind::Clicked);
        state.hear_control("series_1", EventKind::Clicked);
        assert_eq!((state.current, state.view().slice, state.view().zoom), (0, 2, 4.0));
    }

    #[test]
    fn slices_stay_in_their_series() {
        let mut state = viewer();
        for (asked, shown) in [(1.0, 0), (10.0, 9), (99.0, 9), (-4.0, 0), (f32::NAN, 0)] {
            state.hear_control("slice", EventKind::Changed(Value::Number(asked)));
            assert_eq!(state.view().slice, shown, "{asked}");
        }
    }

    #[test]
    fn two_presses_measure_in_millimetres_or_else_in_pixels() {
        let mut state = viewer();
        assert_eq!(state.sheet().extent(0), [50.0, 100.0]);
        state.hear_control("mark", EventKind::Clicked);
        // The picture moves to the left and up, so that the middle moves to the right and down in it.
        state.pass(DT_S, &Hold { drag: [-3.0, -4.0], ..Hold::default() });
        state.hear_control("mark", EventKind::Clicked);
        assert_eq!(state.report(None).measures, [5.0]);
        assert_eq!(state.sheet().unit(0), "mm");
        state.hear_control("clear", EventKind::Armed);
        assert!(state.is_armed && state.has_marks());
        state.hear_control("clear", EventKind::Clicked);
        state.hear_control("clear", EventKind::Disarmed);
        assert!(!state.is_armed && !state.has_marks());
        assert_eq!(series("Bare", 1, None).unit(0), "px");
        assert_eq!(series("Bare", 1, None).extent(0), [100.0, 50.0]);
    }

    #[test]
    fn a_second_point_on_the_first_one_measures_nothing() {
        let mut state = viewer();
        state.hear_control("mark", EventKind::Clicked);
        // A foot sways: 0.2 mm are 0.4 pixels to the right.
        state.pass(DT_S, &Hold { drag: [-0.2, 0.0], ..Hold::default() });
        state.hear_control("mark", EventKind::Clicked);
        assert_eq!(state.report(None).measures, [0.0; 0]);
        assert!(state.notice().is_some_and(|words| words.contains("the same")));
        // The first point is kept.
        state.pass(DT_S, &Hold { drag: [-2.8, 0.0], ..Hold::default() });
        state.hear_control("mark", EventKind::Clicked);
        assert_eq!(state.report(None).measures, [3.0]);
    }

    #[test]
    fn mouse_and_keys_step_through_slices_to_both_ends() {
        let mut state = viewer();
        assert_eq!(state.view().slice, 5);
        for (slices, shown) in [(1.0, 6), (-2.0, 4), (-100.0, 0), (f64::INFINITY, 9)] {
            state.step(slices);
            assert_eq!(state.view().slice, shown, "{slices}");
        }
    }

    #[test]
    fn each_slice_is_measured_by_its_own_pixels() {
        let mut sheet = series("Mixed", 3, Some([0.5, 2.0]));
        sheet.planes[1].spacing_mm = Some([1.0, 4.0]);
        sheet.planes[2].spacing_mm = None;
        let mut state = State::new(vec![sheet], 5.0);
        assert_eq!((state.view().slice, state.view().middle), (1, [50.0, 100.0]));
        state.step(-1.0);
        assert_eq!((state.view().middle, state.sheet().unit(0)), ([25.0, 50.0], "mm"));
        state.step(2.0);
        assert_eq!((state.view().middle, state.sheet().unit(2)), ([50.0, 25.0], "px"));
    }

    #[test]
    fn a_first_point_is_dropped_aloud_on_another_slice() {
        let mut state = viewer();
        state.hear_control("mark", EventKind::Clicked);
        state.hear_control("slice", EventKind::Changed(Value::Number(2.0)));
        assert!(state.notice().is_some_and(|words| words.contains("another slice")));
        state.hear_control("mark", EventKind::Clicked);
        assert_eq!(state.report(None).measures, [0.0; 0]);
        pass(&mut state, 5.0, Hold::default());
        assert_eq!(state.notice(), None);
    }

    #[test]
    fn the_pad_is_a_rate_for_width_and_level() {
        let mut state = viewer();
        pass(&mut state, 1.0, Hold { window: [1.0, 0.0], ..Hold::default() });
        let wide = state.view().window.width;
        assert!((wide - 400.0 * 0.9_f64.exp()).abs() < 1.0, "{wide}");
        pass(&mut state, 1.0, Hold { window: [0.0, 1.0], ..Hold::default() });
        assert!((state.view().window.level - (40.0 - 0.5 * wide)).abs() < 1.0);
        pass(&mut state, 60.0, Hold { window: [-1.0, f64::NAN], ..Hold::default() });
        assert_eq!(state.view().window.width, 1.0);
    }

    #[test]
    fn panning_keeps_the_picture_and_nonsense_moves_nothing() {
        let mut state = viewer();
        state.pass(DT_S, &Hold { drag: [1e9, f64::NAN], ..Hold::default() });
        assert_eq!(state.view().middle, [0.0, 50.0]);
    }

    #[test]
    fn a_lost_floor_ends_the_beam_and_it_comes_to_rest_once() {
        let mut state = viewer();
        let now = underfoot::units::Instant::from_millis;
        state.beam.hear(EventKind::Pressed, now(100), 5.0);
        let held = Hold { beam: true, ..Hold::default() };
        assert_eq!(pass(&mut state, 1.0, held), 1);
        assert!(state.beam.is_on);
        state.link(LinkState::Lost, now(1100));
        state.pass(DT_S, &held);
        assert!(!state.beam.is_on && state.is_lost);
        assert_eq!(state.beam.ended, Some(Cause::FloorLost));
        assert_eq!(pass(&mut state, 2.0, Hold::default()), 1);
        state.link(LinkState::Live, now(3000));
        assert!(!state.is_lost);
    }
}
