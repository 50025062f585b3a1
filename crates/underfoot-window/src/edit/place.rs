//! Converts places on the floor to fields of a record: moving, sizing, turning.

use glam::{DVec2, Vec2};

use super::address::{Address, RecordList};
use super::change::Edit;
use super::document::Document;
use super::item::{Item, around};
use super::refusal::EditRefusal;
use super::rename::NEIGHBOURS;
use super::snap::Edges;
use underfoot::floor::Rect;
use underfoot::widget::{Axis, Behaviour, SliderTrack};
use underfoot_format::text::{Entry, RonText};

/// Fields that define a place relative to a neighbour.
pub(super) const RELATIVE: [&str; 6] =
    [NEIGHBOURS[0], NEIGHBOURS[1], NEIGHBOURS[2], NEIGHBOURS[3], "gap", "align"];

impl Document {
    /// The edits that give `items` these areas, in floor metres. A group or a grid only moves: it keeps its size.
    ///
    /// # Errors
    /// [`EditRefusal::PlacedByGroup`] for a record relative to a neighbour within a group whose own place is relative
    /// too.
    pub fn placing(&self, moved: &[(&Item, Rect)]) -> Result<Vec<Edit>, EditRefusal> {
        let mut edits = Vec::new();
        for (item, area) in moved {
            self.place(item, *area, false, &mut edits)?;
        }
        Ok(edits)
    }

    /// [`Self::placing`] for records whose neighbours move as well: each is written with a place of its own, also
    /// where it stays.
    ///
    /// # Errors
    /// As [`Self::placing`].
    pub(super) fn placing_alone(&self, moved: &[(&Item, Rect)]) -> Result<Vec<Edit>, EditRefusal> {
        let mut edits = Vec::new();
        for (item, area) in moved {
            self.place(item, *area, true, &mut edits)?;
        }
        Ok(edits)
    }

    /// With `is_alone`, a record beside a neighbour gets a place of its own even if it stays.
    fn place(
        &self,
        item: &Item,
        area: Rect,
        is_alone: bool,
        edits: &mut Vec<Edit>,
    ) -> Result<(), EditRefusal> {
        let record = &item.record;
        let unit = self.unit_m();
        let written = self.pair(record, "at");
        let is_relative = NEIGHBOURS.iter().any(|side| self.written(record, side).is_some());
        let corner = |metres: Vec2| metres.as_dvec2() / unit;
        let at = match written {
            // Add the displacement to the written place: the other digits in the file stay unchanged.
            Some(written) => written + corner(area.min - item.area.min),
            None if item.is_group => return Err(EditRefusal::PlacedByGroup(record.clone())),
            None => corner(area.min) - self.origin(record)?,
        };
        let old = corner(item.area.size());
        let size = corner(area.size());
        let is_resized = (size - old).abs().max_element() > 1e-4;
        let is_whole = written.is_none() && !is_relative;
        let is_moved = written.is_none_or(|written| (written - at).abs().max_element() > 1e-6);
        if is_moved && (!is_relative || is_alone || area.min.distance(item.area.min) > 1e-5) {
            if is_relative {
                let fields = RELATIVE.iter().filter(|field| self.written(record, field).is_some());
                edits.extend(fields.map(|field| Edit::unset(record, field)));
            }
            edits.push(Edit::set(record, "at", pair(at).inline()));
        }
        let has_own_size = !item.is_group && item.widgets.len() <= 1;
        // A size that came from the neighbour must be written once the neighbour no longer defines it.
        let needs_size = is_whole || (is_relative && is_moved && self.written(record, "size").is_none());
        if has_own_size && (is_resized || needs_size) {
            edits.push(Edit::set(record, "size", pair(size).inline()));
        }
        Ok(())
    }

    /// The two written numbers of a field.
    pub(super) fn pair(&self, record: &Address, field: &str) -> Option<DVec2> {
        let (east, north) = self.written(record, field)?.trim_matches(['(', ')']).split_once(',')?;
        let number = |text: &str| text.trim().trim_end_matches(',').trim_end().parse::<f64>().ok();
        Some(DVec2::new(number(east)?, number(north)?))
    }

    /// The origin of the places in the list of `record`, in the layout's units.
    pub(super) fn origin(&self, record: &Address) -> Result<DVec2, EditRefusal> {
        let Some((parent, RecordList::Widgets, _)) = record.split() else { return Ok(DVec2::ZERO) };
        if parent.list() != Some(RecordList::Widgets) {
            return Ok(DVec2::ZERO);
        }
        // Any member of the group with a written place reveals the place of the group.
        let items = self.items();
        let unit = self.unit_m();
        let siblings = items.iter().filter(|item| item.record.split().is_some_and(|(of, ..)| of == parent));
        let told = siblings
            .filter(|item| !item.is_group)
            .find_map(|item| Some(item.area.min.as_dvec2() / unit - self.pair(&item.record, "at")?));
        told.ok_or_else(|| EditRefusal::PlacedByGroup(record.clone()))
    }

    /// The edits that turn `items` by a quarter: width and depth are exchanged, and an axis changes to the other one.
    /// A control that would stick out of its region moves back into it.
    ///
    /// # Errors
    /// As [`Document::placing`].
    pub fn turning(&self, items: &[&Item]) -> Result<Vec<Edit>, EditRefusal> {
        let mut edits = Vec::new();
        for item in items.iter().filter(|item| !item.is_group && item.widgets.len() <= 1) {
            let (middle, size) = (item.area.centre(), item.area.size());
            let widget = item.widgets.clone().next().and_then(|at| self.layout().widgets.get(at));
            let turned = Rect::from_centre_size(middle, Vec2::new(size.y, size.x));
            let region = widget.and_then(|widget| self.layout().regions.get(widget.region));
            let stopped = region.map_or(turned, |region| Edges::ALL.stopped(turned, region.area).0);
            self.place(item, stopped, false, &mut edits)?;
            let axis = match widget.map(|widget| &widget.behaviour) {
                Some(Behaviour::Slider(slider)) => match slider.track {
                    SliderTrack::Line { degrees: 0.0 } => Some("North"),
                    SliderTrack::Line { degrees: 90.0 } => Some("East"),
                    _ => None,
                },
                Some(Behaviour::Selector(selector)) => Some(other(selector.axis)),
                Some(Behaviour::Stepper(stepper)) => Some(other(stepper.axis)),
                _ => None,
            };
            if let Some(axis) = axis {
                for field in ["angle_deg", "arc_deg"] {
                    edits.extend(self.written(&item.record, field).map(|_| Edit::unset(&item.record, field)));
                }
                edits.push(Edit::set(&item.record, "axis", axis));
            }
        }
        Ok(edits)
    }

    /// The text of a control of this kind on this area, in floor metres. It has a unique id, after its `label` if that
    /// has Latin letters; without a `label`, it gets one after its id.
    #[must_use]
    pub fn new_control(&self, kind: &str, area: Rect, label: Option<&str>) -> String {
        let id = label.map(as_id).filter(|id| !id.is_empty());
        let id = self.free_id(id.as_deref().unwrap_or(kind), &[]);
        let label = label.map_or_else(
            || {
                let mut label = id.replace('_', " ");
                if let Some(first) = label.get_mut(0..1) {
                    first.make_ascii_uppercase();
                }
                label
            },
            str::to_owned,
        );
        let [at, size] = self.placed(area);
        let fields = vec![
            ("id", RonText::quoted(id)),
            ("kind", RonText::quoted(kind)),
            at,
            size,
            ("label", RonText::quoted(label)),
        ];
        RonText::Record("Widget", fields).inline()
    }

    /// `at` and `size` of this area, in floor metres, as fields.
    #[must_use]
    pub fn placed(&self, area: Rect) -> [Entry; 2] {
        let unit = self.unit_m();
        let (at, size) = (area.min.as_dvec2() / unit, area.size().as_dvec2() / unit);
        [("at", pair(at)), ("size", pair(size))]
    }

    /// `wish`, or `wish` with a number, such that no record and none of `taken` has this id.
    #[must_use]
    pub fn free_id(&self, wish: &str, taken: &[String]) -> String {
        let written: Vec<&str> = Address::all(self.root())
            .into_iter()
            .filter_map(|(_, record)| record.field("id")?.value.says.as_deref())
            .collect();
        let layout = self.layout();
        let is_free = |id: &str| {
            !written.contains(&id)
                && layout.widget_index(id).is_none()
                && taken.iter().all(|other| other != id)
        };
        if is_free(wish) {
            return wish.to_owned();
        }
        let stem = wish.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
        // There are fewer records than numbers.
        let numbered = (2_u32..).map(|number| format!("{stem}_{number}")).find(|id| is_free(id));
        numbered.unwrap_or_default()
    }

    /// The area around all of `records`.
    #[must_use]
    pub fn bounds_of(&self, items: &[Item], records: &[Address]) -> Option<Rect> {
        around(items.iter().filter(|item| records.contains(&item.record)).map(|item| item.area))
    }
}

/// A label as an id: small letters, digits and `_`, at most 40 of them.
fn as_id(label: &str) -> String {
    let words = label.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let id = words.map(str::to_ascii_lowercase).collect::<Vec<String>>().join("_");
    id.get(..40).map_or_else(|| id.clone(), |short| short.trim_end_matches('_').to_owned())
}

fn other(axis: Axis) -> &'static str {
    match axis {
        Axis::East => "North",
        Axis::North => "East",
    }
}

/// Two numbers in the file's notation: to a ten-thousandth of a unit, which is below 0.1 mm.
pub(super) fn pair(place: DVec2) -> RonText {
    RonText::pair(((place * 1e4).round() / 1e4).into())
}
