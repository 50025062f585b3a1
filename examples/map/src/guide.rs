//! Between the floor and the map: events and holds to the one, labels and values to the other.

use std::time::{Duration, Instant};

use eframe::egui::{Vec2, vec2};
use underfoot::runtime::{Kind, Refusal, Session, Snapshot};
use underfoot::widget::Value;

use crate::mercator::Camera;
use crate::state::{Hold, State};
use crate::world::World;

/// Longest time that one turn may stand for: a window that was covered does not jump.
const LONGEST: Duration = Duration::from_millis(250);

/// How often the floor's labels may change: reading takes longer.
const LABEL_EVERY: Duration = Duration::from_millis(250);

/// What of a zoom level is worth telling the floor's slider.
const WORTH: f64 = 0.02;

pub struct Guide {
    pub floor: Session,
    pub world: World,
    pub state: State,
    /// What the map's middle is on.
    pub place: String,
    pub has_ended: bool,
    /// Whether each rest of the map is printed.
    print: bool,
    last: Instant,
    labelled: Option<(Instant, [String; 2])>,
}

impl Guide {
    pub fn new(floor: Session, world: World, state: State, print: bool) -> Self {
        let (place, last) = (String::new(), Instant::now());
        Self { floor, world, state, place, has_ended: false, print, last, labelled: None }
    }

    /// Lets time pass until now; gives what the floor looks like.
    pub fn turn(&mut self, drag: Vec2, levels: f64) -> Snapshot {
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

    /// A pair of numbers while a foot holds it, and nobody doubts that it does.
    fn held(&self, snapshot: &Snapshot, id: &str) -> Vec2 {
        match snapshot.value(id) {
            Some(Value::Pair(pair)) if self.floor.held(id).is_ok_and(|held| held.is_fresh()) => {
                vec2(pair.x, pair.y)
            }
            _ => Vec2::ZERO,
        }
    }

    /// Lets labels and values on the floor follow the map. A control in use refuses, and is asked again.
    fn tell(&mut self, snapshot: &Snapshot, now: Instant) -> Result<(), Refusal> {
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

/// One line of JSON.
fn print(state: &State) {
    match serde_json::to_string(&state.report()) {
        Ok(line) => println!("{line}"),
        Err(error) => eprintln!("{error}"),
    }
}
