//! The state of the map and its reactions to feet, independent of window and floor.

use eframe::egui::{Vec2, vec2};
use serde::Serialize;
use underfoot::runtime::{Event, Kind};
use underfoot::widget::{EventKind, Value};

use crate::mercator::Camera;

/// The map's first position.
pub const HOME: Camera = Camera { lon: 12.0, lat: 28.0, zoom: 2.0 };

/// The targets of the floor's buttons.
const PLACES: [(&str, Camera); 3] = [
    ("europe", Camera { lon: 12.0, lat: 50.0, zoom: 4.0 }),
    ("asia", Camera { lon: 95.0, lat: 34.0, zoom: 3.2 }),
    ("americas", Camera { lon: -80.0, lat: 15.0, zoom: 2.6 }),
];

/// Points a second at the pad's edge, and at a full lean.
const PAN: f32 = 150.0;

/// Levels a second at a full lean.
const ZOOM: f64 = 1.0;

/// Time constant of flights, in seconds.
const FLIGHT_S: f64 = 0.25;

/// Time without feet after which the map goes home, in seconds.
pub const HOME_AFTER_S: f64 = 60.0;

/// Time without movement after which the map counts as settled, in seconds.
const SETTLED_S: f64 = 0.3;

/// The holds of feet at one time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hold {
    /// The place on the pad, eastwards and northwards up to 1; zero while it is not held.
    pub pad: Vec2,
    /// The lean, likewise.
    pub lean: Vec2,
    /// Distance that feet dragged the map since the last call, in points.
    pub drag: Vec2,
    /// Number of levels by which a mouse wheel zoomed in since then.
    pub levels: f64,
    /// Number of feet on the floor.
    pub feet: usize,
}

/// The map.
#[derive(Clone, Debug)]
pub struct State {
    pub camera: Camera,
    pub names: bool,
    pub grid: bool,
    /// Whether the map was reset after a long time without feet; the floor's switches follow.
    pub was_reset: bool,
    flight: Option<Camera>,
    alone_s: f64,
    still_s: f64,
    home_after_s: f64,
}

/// The state that tests compare.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub lon: f64,
    pub lat: f64,
    pub zoom: f64,
    pub names: bool,
    pub grid: bool,
}

impl State {
    pub fn new(home_after_s: f64) -> Self {
        Self {
            camera: HOME,
            names: true,
            grid: false,
            was_reset: false,
            flight: None,
            alone_s: 0.0,
            still_s: 0.0,
            home_after_s,
        }
    }

    /// Reacts to a foot's event.
    pub fn hear(&mut self, event: &Event) {
        let Kind::Control(kind) = event.kind else { return };
        match (event.id(), kind) {
            ("zoom", EventKind::Changed(Value::Number(zoom))) => {
                let camera = self.flight.unwrap_or(self.camera);
                self.fly(Camera { zoom: f64::from(zoom), ..camera });
            }
            ("names", EventKind::Changed(Value::Switch(on))) => self.names = on,
            ("grid", EventKind::Changed(Value::Switch(on))) => self.grid = on,
            ("home", EventKind::Clicked) => self.fly(HOME),
            (id, EventKind::Clicked) => {
                if let Some((_, camera)) = PLACES.iter().find(|(name, _)| *name == id) {
                    self.fly(*camera);
                }
            }
            _ => return,
        }
        self.still_s = 0.0;
    }

    pub fn fly(&mut self, to: Camera) {
        self.flight = Some(to);
        self.still_s = 0.0;
    }

    /// Advances by `dt_s` seconds; returns whether the map has just come to rest.
    pub fn pass(&mut self, dt_s: f64, hold: &Hold) -> bool {
        let before = (self.camera, self.names, self.grid);
        let lean = vec2(hold.lean.x, 0.0);
        let way = (hold.pad + lean) * (PAN * dt_s as f32);
        let by = vec2(way.x, -way.y) - hold.drag;
        let levels = hold.levels + f64::from(hold.lean.y) * ZOOM * dt_s;
        if by != Vec2::ZERO || levels != 0.0 {
            self.flight = None;
            self.camera.pan(by);
            self.camera.zoom_by(levels);
        }
        if let Some(to) = self.flight {
            self.camera.approach(&to, 1.0 - (-dt_s / FLIGHT_S).exp());
            if self.camera.is_at(&to) {
                self.camera = to;
                self.flight = None;
            }
        }
        self.alone_s = if hold.feet == 0 { self.alone_s + dt_s } else { 0.0 };
        self.was_reset = self.alone_s >= self.home_after_s && (self.alone_s - dt_s) < self.home_after_s;
        if self.was_reset {
            (self.names, self.grid) = (true, false);
            self.fly(HOME);
        }
        let was_still = self.still_s >= SETTLED_S;
        let moved = before != (self.camera, self.names, self.grid) || self.flight.is_some();
        self.still_s = if moved { 0.0 } else { self.still_s + dt_s };
        !was_still && self.still_s >= SETTLED_S
    }

    /// The zoom level for the floor's slider: the target of a flight, else the present one.
    pub fn shown_zoom(&self) -> f64 {
        self.flight.map_or(self.camera.zoom, |to| to.zoom)
    }

    pub fn report(&self) -> Report {
        let round = |number: f64| (number * 100.0).round() / 100.0;
        let Camera { lon, lat, zoom } = self.camera;
        let (names, grid) = (self.names, self.grid);
        Report { lon: round(lon), lat: round(lat), zoom: round(zoom), names, grid }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 1.0 / 60.0;

    fn pass(state: &mut State, seconds: f64, hold: Hold) -> usize {
        let rests = (0..(seconds / DT_S).round() as usize).filter(|_| state.pass(DT_S, &hold));
        rests.count()
    }

    #[test]
    fn pad_and_lean_are_rates_and_a_drag_is_a_way() {
        let mut state = State::new(HOME_AFTER_S);
        let hold = Hold { feet: 2, ..Hold::default() };
        pass(&mut state, 1.0, Hold { pad: vec2(1.0, 0.0), ..hold });
        let east = 360.0 * 150.0 / 1024.0;
        assert!((state.camera.lon - HOME.lon - east).abs() < 0.5, "{:?}", state.camera);
        pass(&mut state, 0.5, Hold { lean: vec2(0.0, 1.0), ..hold });
        assert!((state.camera.zoom - 2.5).abs() < 0.05, "{:?}", state.camera);
        let lon = state.camera.lon;
        state.pass(DT_S, &Hold { drag: vec2(100.0, 0.0), ..hold });
        assert!(state.camera.lon < lon, "the map goes with the foot");
        pass(&mut state, 9.0, Hold { lean: vec2(0.0, -1.0), ..hold });
        assert_eq!(state.camera.zoom, Camera::LEAST);
    }

    #[test]
    fn a_minute_without_feet_sets_everything_back_once() {
        let mut state = State::new(HOME_AFTER_S);
        state.fly(PLACES[1].1);
        (state.names, state.grid) = (false, true);
        let resets = |state: &mut State, seconds: f64, feet| {
            let hold = Hold { feet, ..Hold::default() };
            let count = (seconds / DT_S) as usize;
            (0..count)
                .filter(|_| {
                    state.pass(DT_S, &hold);
                    state.was_reset
                })
                .count()
        };
        assert_eq!(resets(&mut state, 59.0, 0), 0);
        assert_eq!(resets(&mut state, 1.0, 1), 0, "somebody came");
        assert_eq!(resets(&mut state, 59.0, 0), 0);
        assert!(!state.names);
        assert_eq!(resets(&mut state, 70.0, 0), 1);
        assert!(state.camera == HOME && state.names && !state.grid);
    }

    #[test]
    fn it_comes_to_rest_once_after_each_flight() {
        let mut state = State::new(HOME_AFTER_S);
        assert_eq!(pass(&mut state, 1.0, Hold::default()), 1);
        state.fly(PLACES[0].1);
        assert_eq!(pass(&mut state, 5.0, Hold::default()), 1);
        assert_eq!(state.camera, PLACES[0].1);
        assert_eq!(pass(&mut state, 5.0, Hold::default()), 0);
    }
}
