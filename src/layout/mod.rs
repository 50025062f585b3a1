//! A checked page of controls on a floor: the engine's input, made by [`crate::schema`].
//!
//! Everything here is in floor metres and newtons, with ids unique, sizes
//! positive and numbers finite; [`crate::schema`] is where nonsense stops.

mod hit;
mod icon;
mod look;

pub use icon::Icon;
pub use look::{Colour, Look, Shape};

use glam::Vec2;

use crate::feel::Feel;
use crate::floor::Rect;
use crate::widget::{Behaviour, WidgetId};

/// A page of controls, placed on one floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// What people call it.
    pub title: String,
    /// The active control areas, each with its own cursor.
    pub regions: Vec<Region>,
    /// Places meant for the standing foot: drawn, never active.
    pub stances: Vec<Stance>,
    /// The controls, in drawing order.
    pub widgets: Vec<Widget>,
}

/// An active control area: the contact with the largest force in it is its cursor.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Unique among the layout's regions.
    pub id: String,
    /// Where it is.
    pub area: Rect,
}

/// A place to stand while using the controls.
#[derive(Clone, Debug, PartialEq)]
pub struct Stance {
    /// Where it is.
    pub area: Rect,
    /// What is written on it; may be empty.
    pub label: String,
}

/// One control.
#[derive(Clone, Debug, PartialEq)]
pub struct Widget {
    /// Unique in the layout.
    pub id: WidgetId,
    /// The name of the kind it was made from.
    pub kind: String,
    /// Which of [`Layout::regions`] holds its middle.
    pub region: usize,
    /// Where it is.
    pub area: Rect,
    /// What is written on it; may be empty.
    pub label: String,
    /// What it does.
    pub behaviour: Behaviour,
    /// What it feels like.
    pub feel: Feel,
    /// What it looks like.
    pub look: Look,
}

impl Layout {
    /// The position in [`Layout::widgets`] of the control named `id`.
    #[must_use]
    pub fn widget_index(&self, id: &str) -> Option<usize> {
        self.widgets.iter().position(|widget| widget.id == id)
    }

    /// The position in [`Layout::widgets`] of the control at `point`; the one drawn last wins.
    #[must_use]
    pub fn widget_at(&self, point: Vec2) -> Option<usize> {
        self.widgets.iter().rposition(|widget| hit::hits(widget, point))
    }
}
