//! The first steps of a new user, as cards on the floor: press, drag, stand. Each gets its tick once it is done.

use eframe::egui::accesskit::Role;
use eframe::egui::{Rect, Sense, Ui, WidgetInfo};
use glam::Vec2;

use crate::preview::handheld::is_for_fingers;
use crate::preview::icons::Icon;
use crate::preview::labels::{Labels, StepCard};
use crate::preview::messages::Happened;
use crate::preview::shown::ShownFloor;
use underfoot::engine::Snapshot;
use underfoot::floor;
use underfoot::layout::{Layout, Widget};
use underfoot::units::Instant;
use underfoot::widget::{Behaviour, EventKind, Value};
use underfoot_scene::egui_painter::ScreenFromFloor;
use underfoot_scene::scene::Theme;

/// Time for which the cards stay after the last step, in seconds: long enough to see its tick.
const STAY_S: f64 = 2.0;

/// Distance of cards from the edges of a window for fingers, in points.
const EDGE: f32 = 4.0;

/// Distance from the standing foot within which a contact counts as that foot, in metres: half a sole.
const FOOT_M: f32 = 0.15;

/// One of the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FirstStep {
    Press,
    Drag,
    Stand,
}

impl FirstStep {
    const ALL: [Self; 3] = [Self::Press, Self::Drag, Self::Stand];

    const fn text(self) -> &'static str {
        match self {
            Self::Press => "Press here",
            Self::Drag => "Drag this",
            Self::Stand => "Stand here with the other foot: Space",
        }
    }

    /// The same in a window for fingers, which has no keys.
    const fn text_for_fingers(self) -> &'static str {
        match self {
            Self::Press | Self::Drag => self.text(),
            Self::Stand => "Stand here with the other foot",
        }
    }

    /// The area on the floor that the step needs; `None` if the layout has none on this page.
    fn target(self, layout: &Layout, page: usize, floor: floor::Rect) -> Option<floor::Rect> {
        let first = |suits: fn(&Behaviour) -> bool| {
            let seen = |widget: &&Widget| widget.is_on(page) && suits(&widget.behaviour);
            layout.widgets.iter().find(seen).map(|widget| widget.area)
        };
        match self {
            Self::Press => first(|it| matches!(it, Behaviour::Button(_)))
                .or_else(|| first(|it| matches!(it, Behaviour::Switch(_)))),
            Self::Drag => first(|it| matches!(it, Behaviour::Slider(_) | Behaviour::Pad(_))),
            Self::Stand => {
                let south = floor.min + floor.size() * Vec2::new(0.5, 0.12);
                let usual = floor::Rect::from_centre_size(south, 0.12 * floor.size());
                Some(layout.stances.first().map_or(usual, |stance| stance.area))
            }
        }
    }
}

/// The progress of a new user.
#[derive(Debug, Default)]
pub(in crate::preview) struct FirstSteps {
    done: [bool; 3],
    /// Only what happens after this moment counts.
    since: Option<Instant>,
    /// The time of the last tick, on the window's clock, once all steps are done.
    all_done_s: Option<f64>,
}

impl FirstSteps {
    /// Starts again from the first step.
    pub(in crate::preview) fn restart(&mut self) {
        *self = Self::default();
    }

    /// Ticks the steps that the floor reports as done; returns whether all of them have been done for a while.
    ///
    /// `recent` is the list of events, newest first, and `standing` the place of the standing foot.
    pub(in crate::preview) fn follow<'a>(
        &mut self,
        now_s: f64,
        snapshot: &Snapshot,
        layout: &Layout,
        recent: impl Iterator<Item = &'a Happened>,
        standing: Option<Vec2>,
    ) -> bool {
        let since = *self.since.get_or_insert(snapshot.at);
        for happened in recent.take(16) {
            let Happened::Event(event) = happened else { continue };
            if event.at < since || event.contact.is_none() {
                continue;
            }
            match event.kind {
                EventKind::Pressed | EventKind::Clicked => self.done[0] = true,
                EventKind::Changed(Value::Number(_) | Value::Pair(_)) => self.done[1] = true,
                _ => {}
            }
        }
        let carries =
            |place: Vec2| snapshot.contacts.iter().any(|contact| contact.centroid.distance(place) < FOOT_M);
        self.done[2] |= standing.is_some_and(carries);
        let floor = floor::Rect::new(Vec2::ZERO, Vec2::ONE);
        let is_missing = |step: &FirstStep| step.target(layout, snapshot.page, floor).is_none();
        let mut steps = FirstStep::ALL.iter().zip(self.done);
        if !steps.all(|(step, done)| done || is_missing(step)) {
            self.all_done_s = None;
            return false;
        }
        now_s - *self.all_done_s.get_or_insert(now_s) > STAY_S
    }

    /// Whether the cards disappear soon without any news.
    pub(in crate::preview) fn ends_soon(&self) -> bool {
        self.all_done_s.is_some()
    }

    /// Draws the cards beside their controls, clear of all controls and of the texts at `written`.
    pub(super) fn show(
        &self,
        ui: &Ui,
        rect: Rect,
        map: ScreenFromFloor,
        theme: &Theme,
        shown: &ShownFloor,
        written: impl Iterator<Item = Rect>,
    ) {
        let (layout, page, floor) = (shown.layout(), shown.snapshot().page, shown.floor.geometry.bounds());
        let controls = layout.widgets.iter().filter(|widget| widget.is_on(page));
        let taken = controls.map(|widget| map.rect(widget.area)).chain(written);
        let for_fingers = is_for_fingers(ui);
        // At the edges of a small screen, cards keep clear of them.
        let mut labels = Labels::within(if for_fingers { rect.shrink(EDGE) } else { rect }, taken);
        let painter = ui.painter_at(rect);
        // The first step that is not done is the one to take now.
        let next = self.done.iter().position(|done| !done);
        for (index, step) in FirstStep::ALL.into_iter().enumerate() {
            let Some(target) = step.target(layout, page, floor) else { continue };
            let is_done = self.done.get(index).copied().unwrap_or_default();
            let colour = match (is_done, next == Some(index)) {
                (true, _) => theme.good,
                (false, true) => theme.accent,
                (false, false) => theme.quiet,
            };
            let mark = if is_done { Icon::Check.unicode().to_string() } else { (index + 1).to_string() };
            let text = if for_fingers { step.text_for_fingers() } else { step.text() };
            let card = StepCard { mark: &mark, text, colour };
            let place = labels.card(&painter, map.rect(target), &card, theme);
            let node = ui.interact(place, ui.scope_id().with(("first step", index)), Sense::hover());
            let state = if is_done { ", done" } else { "" };
            let spoken = format!("Step {}: {text}{state}", index + 1);
            node.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
        }
    }
}
