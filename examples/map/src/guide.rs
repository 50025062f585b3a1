//! Connects the floor and the map: events and holds go to the map, labels and values to the floor.

use std::time::{Duration, Instant};

use eframe::egui::{Vec2, vec2};
use underfoot::runtime::{Kind, Refusal, Session, SessionSnapshot};
use underfoot::widget::Value;

use crate::mercator::Camera;
use crate::state::{Hold, State};
use crate::world::World;

/// Longest time that one turn may cover, so that the map does not jump after its window was covered.
const LONGEST: Duration = Duration::from_millis(250);

/// Shortest time between two changes of the floor's labels: reading takes longer.
const LABEL_EVERY: Duration = Duration::from_millis(250);

/// Smallest change of the zoom level that the floor's slider receives.
const WORTH: f64 = 0.02;

pub struct Guide {
    pub floor: Session,
    pub world: World,
    pub state: State,
    /// The country at the map's middle.
    pub place: String,
    pub has_ended: bool,
    /// Whether to print the map's state each time it comes to rest.
    print: bool,
    last: Instant,
    labelled: Option<(Instant, [String; 2])>,
}

impl Guide {
    pub fn new(floor: Session, world: World, state: State, print: bool) -> Self {
        let (place, last) = (String::new(), Instant::now());
        Self { floor, world, state, place, has_ended: false, print, last, labelled: None }
    }

    /// Advances to the present; returns a snapshot of the floor.
    pub fn turn(&mut self, drag: Vec2, levels: f64) -> SessionSnapshot {
        while let Some(event) = self.floor.next_event() {
            self.has_ended |= matches!(event.kind, Kind::Ended(_));
            self.state.hear(&event);
        }
        let now = Instant::now();
        let dt = now.duration_since(self.last).min(LONGEST);
        self.last = now;
        let snapshot = self.floor.snapshot();
        let hold = Hold {
            pad: self.held(&snapshot, "pan"),
            lean: self.held(&snapshot, "lean"),
            drag,
            levels,
            feet: snapshot.floor.contacts.len(),
        };
        let rests = self.state.pass(dt.as_secs_f64(), &hold);
        let Camera { lon, lat, .. } = self.state.camera;
        self.place = self.world.country_at(lon, lat).map_or("Open sea", |country| &country.name).to_owned();
        if let Err(refusal) = self.tell(&snapshot, now)
            && !self.has_ended
            && matches!(refusal, Refusal::NoAnswer)
        {
            eprintln!("{refusal}");
        }
        if rests && self.print {
            print(&self.state);
        }
        snapshot
    }

    /// A pair of numbers while a foot certainly holds it; otherwise zero.
    fn held(&self, snapshot: &SessionSnapshot, id: &str) -> Vec2 {
        match snapshot.value(id) {
            Some(Value::Pair(pair)) if self.floor.held(id).is_ok_and(|held| held.is_fresh()) => {
                vec2(pair.x, pair.y)
            }
            _ => Vec2::ZERO,
        }
    }

    /// Updates labels and values on the floor from the map. A control in use refuses, and the next turn tries again.
    fn tell(&mut self, snapshot: &SessionSnapshot, now: Instant) -> Result<(), Refusal> {
        if self.state.was_reset {
            self.floor.control("names")?.set(self.state.names)?;
            self.floor.control("grid")?.set(self.state.grid)?;
        }
        let zoom = self.state.shown_zoom();
        let labels = [self.place.clone(), format!("Zoom {:.1}", self.state.camera.zoom)];
        let is_due = |labelled: &Instant| now.duration_since(*labelled) >= LABEL_EVERY;
        if self.labelled.as_ref().is_none_or(|(at, last)| is_due(at) && *last != labels) {
            for (id, label) in ["pan", "zoom"].into_iter().zip(&labels) {
                self.floor.control(id)?.set_label(label)?;
            }
            self.labelled = Some((now, labels));
        }
        let shown = snapshot.value("zoom");
        let differs = matches!(shown, Some(Value::Number(shown)) if (f64::from(shown) - zoom).abs() > WORTH);
        if differs && !snapshot.control("zoom").is_some_and(|zoom| zoom.pressed) {
            self.floor.control("zoom")?.set(zoom)?;
        }
        Ok(())
    }
}

/// Prints one line of JSON.
fn print(state: &State) {
    match serde_json::to_string(&state.report()) {
        Ok(line) => println!("{line}"),
        Err(error) => eprintln!("{error}"),
    }
}
