//! The floor as a widget on which the mouse acts as a foot.

use egui::{Context, RawInput, Sense, Ui, ViewportId};
use underfoot::floor::Geometry;
use underfoot::glam::Vec2;
use underfoot::runtime::{Session, SessionSnapshot};
use underfoot::units::Newtons;
use underfoot::wire::LinkState;
use underfoot_scene::scene::{Show, Theme};
use underfoot_sim::{Foot, FootHandle};

use crate::{FloorView, FootInput};

/// Force of the mouse's foot: enough for the built-in kind with the greatest threshold.
const PRESS: Newtons = Newtons(140.0);

/// Length of the mouse's foot in metres.
const FOOT_M: f32 = 0.27;

/// A small image of the floor in a corner of an app; on a simulated floor, the mouse presses it.
#[derive(Debug)]
pub struct SmallFloor {
    view: FloorView,
    hand: Option<FootHandle>,
    is_played: bool,
}

impl SmallFloor {
    /// A small floor in these colours. `hand` moves the foot of a simulated floor ([`underfoot_sim::feet_by_hand`]);
    /// without it, this only shows the floor.
    #[must_use]
    pub fn new(theme: Theme, hand: Option<FootHandle>) -> Self {
        let show = Show { sensors: false, loads: false, ruler: false, ..Show::WINDOW };
        Self { view: FloorView::new(theme, show), hand, is_played: false }
    }

    /// Whether the mouse can press it.
    #[must_use]
    pub fn is_simulated(&self) -> bool {
        self.hand.is_some()
    }

    /// Advice for a user of a floor without feet; `None` while there are contacts on a working floor.
    #[must_use]
    pub fn advice(&self, session: &Session, snapshot: &SessionSnapshot) -> Option<&'static str> {
        Some(match (snapshot.floor.link, snapshot.floor.contacts.is_empty()) {
            _ if session.has_ended() => "The floor is gone",
            (LinkState::Lost, _) => "The floor is silent",
            (LinkState::Waiting, _) => "Waiting for the floor",
            (_, true) if self.is_simulated() => "Press the small floor with the mouse",
            (_, true) => "Step onto the floor",
            (_, false) => return None,
        })
    }

    /// Fills the remaining room in `ui` with the floor, upright and as large as possible, and moves the mouse's foot.
    pub fn ui(&mut self, ui: &mut Ui, geometry: &Geometry, snapshot: &SessionSnapshot) {
        let (response, map) = self.view.ui(ui, geometry, &snapshot.layout, &snapshot.floor);
        let Some(hand) = &mut self.hand else { return };
        let pressed = ui.interact(response.rect, response.id.with("mouse"), Sense::drag());
        self.is_played = pressed.is_pointer_button_down_on();
        let place = pressed.interact_pointer_pos().filter(|_| self.is_played);
        let foot = place.map(|at| foot_at(map.floor(at)));
        hand.lead(ui.input(|input| input.unstable_dt), vec![foot.into_iter().collect()]);
        if self.is_played {
            ui.ctx().request_repaint();
        }
    }

    /// Call this in `eframe::App::raw_input_hook` in place of [`FootInput::follow`]: while the mouse acts as the
    /// foot, that foot cannot be a pointer as well, since egui has only one. Other windows of the app have no feet.
    pub fn lead(&self, feet: &mut FootInput, session: &Session, context: &Context, raw: &mut RawInput) {
        if raw.viewport_id != ViewportId::ROOT {
            return;
        }
        if self.is_played {
            feet.cancel(context, raw);
        } else {
            feet.follow(context, session, raw);
        }
    }
}

/// A foot that points north and presses at `place` with its ball.
fn foot_at(place: Vec2) -> Foot {
    let foot = Foot { position: place, heading: 0.0, length_m: FOOT_M, force: PRESS, roll: 0.7, left: false };
    Foot { position: place - (foot.centre_of_pressure() - place), ..foot }
}
