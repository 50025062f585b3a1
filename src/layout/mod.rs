//! A checked page of controls on a floor: the engine's input, made by [`crate::schema`].
//!
//! Everything here is in floor metres and newtons, with unique ids, positive sizes and finite numbers;
//! [`crate::schema`] rejects everything else.

mod ground;
mod hit;
mod icon;
mod look;
mod page;
mod region;

pub use ground::Ground;
pub use icon::Icon;
pub(crate) use look::HEX;
pub use look::{Colour, Look, Shape};
pub use page::Page;
pub use region::{CursorRule, Region, Stance};

pub use hit::HitIndex;

use glam::Vec2;

use crate::feel::Feel;
use crate::floor::{Area, Geometry, Rect};
use crate::messages::{MessagePlan, SendTarget, Sending};
use crate::widget::{Behaviour, WidgetId};

/// Controls placed on one floor, on one page or on several that take turns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Its title for people.
    pub title: String,
    /// The active control areas, each with its own cursor.
    pub regions: Vec<Region>,
    /// Places meant for the standing foot: a foot there is never a cursor.
    pub stances: Vec<Stance>,
    /// The pages that take turns, the first one first; empty if there is only one.
    pub pages: Vec<Page>,
    /// The programs and devices that messages go to.
    pub targets: Vec<SendTarget>,
    /// The grounds on all pages; where two overlap, both respond.
    pub grounds: Vec<Ground>,
    /// The controls of all pages, in drawing order.
    pub widgets: Vec<Widget>,
}

/// One control.
#[derive(Clone, Debug, PartialEq)]
pub struct Widget {
    /// Unique in the layout.
    pub id: WidgetId,
    /// The name of the kind it was made from.
    pub kind: String,
    /// Index in [`Layout::regions`] of the region that contains its middle.
    pub region: usize,
    /// Index in [`Layout::pages`] of its page; `None` if it is on all of them.
    pub page: Option<usize>,
    /// Index in [`Layout::pages`] of the page that a click on it shows; `None` if it switches none.
    pub goto: Option<usize>,
    /// Its area.
    pub area: Rect,
    /// The text on it; may be empty.
    pub label: String,
    /// Its function.
    pub behaviour: Behaviour,
    /// Its effects.
    pub feel: Feel,
    /// Its shape and colours.
    pub look: Look,
    /// Its messages to other programs.
    pub send: Vec<Sending>,
}

impl Layout {
    /// The index in [`Layout::widgets`] of the control named `id`.
    #[must_use]
    pub fn widget_index(&self, id: &str) -> Option<usize> {
        self.widgets.iter().position(|widget| widget.id == id)
    }

    /// The part of the layout for the computer of `area`, on the floor of this `geometry`: the controls with their
    /// middle in the area, and the grounds that overlap it. Keeps pages, regions and stances.
    ///
    /// Of the parts for a floor's areas, exactly one has a given control.
    #[must_use]
    pub fn part(mut self, area: &Area, geometry: &Geometry) -> Self {
        self.widgets.retain(|widget| area.holds(geometry, widget.area.centre()));
        let own = geometry.part(&area.tiles).map(|own| own.bounds());
        self.grounds.retain(|ground| own.is_some_and(|own| own.overlaps(ground.spec.area)));
        self
    }

    /// The targets, and the messages of all controls and of the feet in regions.
    #[must_use]
    pub fn plan(&self) -> MessagePlan {
        let mut plan = MessagePlan::new(self.targets.clone());
        for widget in &self.widgets {
            plan.add(&widget.id, &widget.behaviour, &widget.send);
        }
        for region in self.regions.iter().filter(|region| !region.send.is_empty()) {
            let within = self.widgets.iter().map(|widget| widget.area);
            let controls: Vec<Rect> = within.filter(|area| area.overlaps(region.area)).collect();
            plan.add_region(&WidgetId::new(&region.id), region.area, &controls, &region.send);
        }
        plan
    }

    /// Whether a control or a foot in a region sends messages.
    #[must_use]
    pub fn sends(&self) -> bool {
        self.widgets.iter().any(|widget| !widget.send.is_empty())
            || self.regions.iter().any(|region| !region.send.is_empty())
    }

    /// The index in [`Layout::pages`] of the page named `id`.
    #[must_use]
    pub fn page_index(&self, id: &str) -> Option<usize> {
        self.pages.iter().position(|page| page.id == id)
    }

    /// The index in [`Layout::widgets`] of the control at `point` of page number `page` (0 without pages); the last
    /// one drawn wins.
    ///
    /// Searches all controls; `HitIndex` finds the same one faster.
    #[must_use]
    pub fn widget_at(&self, page: usize, point: Vec2) -> Option<usize> {
        self.widgets.iter().rposition(|widget| widget.is_on(page) && hit::hits(widget, point))
    }
}

impl Widget {
    /// Whether it is on page number `page`.
    #[must_use]
    pub fn is_on(&self, page: usize) -> bool {
        self.page.is_none_or(|own| own == page)
    }

    /// The name of its page of `layout`; `None` if it is on all of them.
    pub(crate) fn page_of(&self, layout: &Layout) -> Option<WidgetId> {
        Some(layout.pages.get(self.page?)?.id.clone())
    }
}
