//! The quantities that can be plotted: names, units, and the figure at one moment.

use super::history::{ControlIndex, PlotMoment};
use underfoot::floor::{Corner, Floor, Geometry, TileId};
use underfoot::layout::Layout;
use underfoot::sense::ContactId;
use underfoot::widget::{Behaviour, WidgetId};

/// One line of a plot.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(in crate::preview) enum Series {
    /// The force on the control in the side panel, whichever that is.
    Selected,
    /// The force of the foot on a control.
    Force(WidgetId),
    /// The value of a control: a switch as 0 or 1, a choice by its number, a pad by its first number.
    Value(WidgetId),
    /// The second number of a pad.
    SecondValue(WidgetId),
    /// The force on a tile.
    Tile(TileId),
    /// One of its sensors.
    Sensor(TileId, Corner),
    /// A foot: that contact; for `None` the working foot, or the heaviest one if none works.
    Foot(Option<ContactId>, FootQuantity),
}

/// The quantity of a foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::preview) enum FootQuantity {
    Force,
    East,
    North,
}

/// The unit of a plot's axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::preview) enum Unit {
    Newtons,
    Metres,
    Value,
}

impl Unit {
    /// In the order of their plots.
    pub(super) const ALL: [Self; 3] = [Self::Newtons, Self::Metres, Self::Value];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Newtons => "N",
            Self::Metres => "m",
            Self::Value => "value",
        }
    }

    /// Difference up to which a change counts as noise.
    pub(super) fn noise(self) -> f64 {
        match self {
            Self::Newtons => 3.0,
            Self::Metres => 0.002,
            Self::Value => 1e-4,
        }
    }

    /// A figure with its significant digits.
    pub(super) fn figure(self, value: f64) -> String {
        match self {
            Self::Newtons => format!("{value:.1} N"),
            Self::Metres => format!("{value:.3} m"),
            Self::Value => format!("{value:.3}"),
        }
    }
}

impl FootQuantity {
    const ALL: [Self; 3] = [Self::Force, Self::East, Self::North];

    fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::East => "east",
            Self::North => "north",
        }
    }
}

impl Series {
    pub(super) fn unit(&self) -> Unit {
        match self {
            Self::Value(_) | Self::SecondValue(_) => Unit::Value,
            Self::Foot(_, FootQuantity::East | FootQuantity::North) => Unit::Metres,
            _ => Unit::Newtons,
        }
    }

    /// Its name; `selected` is the control in the side panel.
    pub(super) fn name(&self, selected: Option<&WidgetId>) -> String {
        match self {
            Self::Selected => match selected {
                Some(id) => format!("selected: {id}"),
                None => "selected control".into(),
            },
            Self::Force(id) => format!("{id} force"),
            Self::Value(id) => format!("{id} value"),
            Self::SecondValue(id) => format!("{id} second value"),
            Self::Tile(tile) => format!("tile {}, {} force", tile.column, tile.row),
            Self::Sensor(tile, corner) => {
                format!("tile {}, {} sensor {}", tile.column, tile.row, corner.name())
            }
            Self::Foot(None, part) => format!("working foot {}", part.name()),
            Self::Foot(Some(contact), part) => format!("contact {} {}", contact.0, part.name()),
        }
    }

    /// Its figure at a moment; `None` if there is none, such as the place of an absent foot. `place` belongs to this
    /// line alone.
    pub(super) fn at(
        &self,
        moment: &PlotMoment,
        geometry: &Geometry,
        selected: Option<&WidgetId>,
        place: &mut ControlIndex,
    ) -> Option<f64> {
        let figure = match self {
            Self::Selected => place.control(moment, selected?)?.force,
            Self::Force(id) => place.control(moment, id)?.force,
            Self::Value(id) => place.control(moment, id)?.values[0]?,
            Self::SecondValue(id) => place.control(moment, id)?.values[1]?,
            Self::Tile(tile) => moment.tiles.get(geometry.index(*tile)?)?.force,
            Self::Sensor(tile, corner) => moment.tiles.get(geometry.index(*tile)?)?.sensors[corner.index()],
            Self::Foot(which, part) => {
                let foot = match which {
                    Some(contact) => moment.feet.iter().find(|foot| foot.contact == *contact),
                    None => moment
                        .feet
                        .iter()
                        .max_by(|a, b| a.leads.cmp(&b.leads).then(a.force.total_cmp(&b.force))),
                };
                match (part, foot) {
                    // Without a foot, the force is zero and the place is undefined.
                    (FootQuantity::Force, None) => 0.0,
                    (FootQuantity::Force, Some(foot)) => foot.force,
                    (FootQuantity::East, foot) => foot?.at.x,
                    (FootQuantity::North, foot) => foot?.at.y,
                }
            }
        };
        figure.is_finite().then(|| f64::from(figure))
    }

    /// Everything that can be plotted now.
    pub(super) fn all(layout: &Layout, floor: &Floor, contacts: &[ContactId]) -> Vec<Self> {
        let mut all = vec![Self::Selected];
        let feet = std::iter::once(None).chain(contacts.iter().copied().map(Some));
        all.extend(feet.flat_map(|foot| FootQuantity::ALL.map(|part| Self::Foot(foot, part))));
        for widget in &layout.widgets {
            all.push(Self::Force(widget.id.clone()));
            if widget.behaviour.initial().is_some() {
                all.push(Self::Value(widget.id.clone()));
            }
            if matches!(widget.behaviour, Behaviour::Pad(_) | Behaviour::Lean(_)) {
                all.push(Self::SecondValue(widget.id.clone()));
            }
        }
        for index in 0..floor.geometry.tile_count() {
            let tile = floor.geometry.tile_at_index(index);
            if floor.geometry.has(tile) {
                all.push(Self::Tile(tile));
            }
            all.extend(floor.geometry.sensors(tile).iter().map(|&corner| Self::Sensor(tile, corner)));
        }
        all
    }
}
