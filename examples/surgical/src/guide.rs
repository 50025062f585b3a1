//! Connects the floor and the viewer: events and holds go to the viewer; ranges, values and labels to the floor.

use std::time::{Duration, Instant};

use underfoot::engine::ValueRange;
use underfoot::runtime::{Kind, Refusal, Session, SessionSnapshot};
use underfoot::widget::Value;

use crate::state::{Hold, OFFERED, State};

/// Longest time that one turn may cover, so that the viewer does not jump after its window was covered.
const LONGEST: Duration = Duration::from_millis(250);

/// Shortest time between two changes of the floor's labels: reading takes longer.
const LABEL_EVERY: Duration = Duration::from_millis(250);

pub struct Guide {
    pub floor: Session,
    pub state: State,
    pub has_ended: bool,
    /// Whether to print the viewer's state each time it comes to rest.
    print: bool,
    last: Instant,
    /// The series with the range that the floor's slider has.
    ranged: Option<usize>,
    labelled: Option<Instant>,
}

impl Guide {
    pub fn new(floor: Session, state: State, print: bool) -> Self {
        let last = Instant::now();
        Self { floor, state, has_ended: false, print, last, ranged: None, labelled: None }
    }

    /// Advances to the present; `drag` is the distance that feet dragged the picture, in units of the series. Returns
    /// a snapshot of the floor.
    pub fn turn(&mut self, drag: [f64; 2]) -> SessionSnapshot {
        let before = self.state.report(None);
        while let Some(event) = self.floor.next_event() {
            self.has_ended |= matches!(event.kind, Kind::Ended(_));
            self.state.hear(&event);
        }
        if before != self.state.report(None) {
            self.state.stir();
        }
        let now = Instant::now();
        let dt = now.duration_since(self.last).min(LONGEST);
        self.last = now;
        let snapshot = self.floor.snapshot();
        let window = match snapshot.value("window") {
            Some(Value::Pair(pair)) if self.is_held("window") => [pair.x, pair.y].map(f64::from),
            _ => [0.0; 2],
        };
        let hold = Hold { window, drag, beam: self.is_held("beam") };
        let rests = self.state.pass(dt.as_secs_f64(), &hold);
        if let Err(refusal) = self.tell(&snapshot, now)
            && !self.has_ended
            && matches!(refusal, Refusal::NoAnswer)
        {
            eprintln!("{refusal}");
        }
        if rests && self.print {
            self.print(&snapshot);
        }
        snapshot
    }

    /// Updates the floor from the viewer. A control in use refuses, and the next turn tries again.
    fn tell(&mut self, snapshot: &SessionSnapshot, now: Instant) -> Result<(), Refusal> {
        let (sheet, view) = (self.state.sheet(), self.state.view());
        if self.ranged != Some(self.state.current) {
            let slice = self.floor.control("slice")?;
            // With a single picture, there is nothing to slide.
            slice.set_enabled(sheet.frames > 1)?;
            if sheet.frames > 1 {
                slice.set_range(1.0..=sheet.frames as f64)?;
            }
            self.ranged = Some(self.state.current);
        }
        for (id, value) in [("slice", (view.slice + 1) as f64), ("zoom", view.zoom)] {
            let Some(control) = snapshot.control(id) else { continue };
            let differs = matches!(control.value, Some(Value::Number(shown)) if (f64::from(shown) - value).abs() > 0.01);
            if differs && control.enabled && !control.pressed {
                self.floor.control(id)?.set(value)?;
            }
        }
        // A press on a locked control is refused with a haptic cue: there is nothing to clear.
        let is_locked = snapshot.control("clear").is_some_and(|clear| clear.locked);
        if is_locked == self.state.has_marks() {
            self.floor.control("clear")?.set_locked(!is_locked)?;
        }
        if self.labelled.is_none_or(|at| now.duration_since(at) >= LABEL_EVERY) {
            self.labelled = Some(now);
            self.label(snapshot)?;
        }
        Ok(())
    }

    /// Writes the labels on the floor.
    fn label(&self, snapshot: &SessionSnapshot) -> Result<(), Refusal> {
        let state = &self.state;
        let (sheet, view) = (state.sheet(), state.view());
        let mut labels = vec![
            ("slice".to_owned(), format!("Slice {} of {}", view.slice + 1, sheet.frames)),
            ("zoom".to_owned(), format!("Zoom {:.1}", view.zoom)),
            ("mark".to_owned(), if view.first.is_some() { "To here" } else { "Mark" }.to_owned()),
        ];
        for button in 1..=OFFERED {
            let offered = state.sheets.get(state.offered + button - 1);
            let title = offered.map_or("-", |sheet| sheet.title.as_str());
            labels.push((format!("series_{button}"), title.chars().take(40).collect()));
        }
        for (id, label) in labels {
            if snapshot.control(&id).is_some_and(|control| control.label != label) {
                self.floor.control(&id)?.set_label(&label)?;
            }
        }
        for button in 1..=OFFERED {
            self.enable(snapshot, &format!("series_{button}"), state.offered + button <= state.sheets.len())?;
        }
        self.enable(snapshot, "more", state.sheets.len() > OFFERED)
    }

    fn enable(&self, snapshot: &SessionSnapshot, id: &str, wanted: bool) -> Result<(), Refusal> {
        let control = self.floor.control(id)?;
        let is_so = snapshot.control(id).is_some_and(|state| state.enabled == wanted);
        if is_so { Ok(()) } else { control.set_enabled(wanted) }
    }

    /// Whether a foot certainly holds a control.
    fn is_held(&self, id: &str) -> bool {
        self.floor.held(id).is_ok_and(|held| held.is_fresh())
    }

    /// Prints one line of JSON.
    fn print(&self, snapshot: &SessionSnapshot) {
        let range = snapshot.control("slice").and_then(|slice| match slice.range {
            Some(ValueRange::Number(scale)) => Some([scale.min, scale.max].map(f64::from)),
            _ => None,
        });
        match serde_json::to_string(&self.state.report(range)) {
            Ok(line) => println!("{line}"),
            Err(error) => eprintln!("{error}"),
        }
    }
}
