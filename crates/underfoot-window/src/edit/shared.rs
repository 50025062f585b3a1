//! Place and size of several records together: one value, or several, and changes relative to it.

use glam::Vec2;

use super::change::Edit;
use super::document::Document;
use super::item::Item;
use super::refusal::EditRefusal;
use underfoot::floor::Rect;

/// One number of a place or size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceNumber {
    /// The western edge.
    East,
    /// The southern edge.
    North,
    /// The size from west to east.
    Width,
    /// The size from south to north.
    Depth,
}

impl PlaceNumber {
    /// All four.
    pub const ALL: [Self; 4] = [Self::East, Self::North, Self::Width, Self::Depth];

    /// Its name for users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::East => "east",
            Self::North => "north",
            Self::Width => "width",
            Self::Depth => "depth",
        }
    }

    const fn is_size(self) -> bool {
        matches!(self, Self::Width | Self::Depth)
    }

    const fn axis(self) -> usize {
        match self {
            Self::East | Self::Width => 0,
            Self::North | Self::Depth => 1,
        }
    }

    fn of(self, area: Rect) -> f32 {
        if self.is_size() { area.size()[self.axis()] } else { area.min[self.axis()] }
    }

    fn set(self, area: Rect, to: f32) -> Rect {
        let mut by = Vec2::ZERO;
        by[self.axis()] = to - self.of(area);
        if self.is_size() {
            Rect::new(area.min, area.max + by)
        } else {
            Rect::new(area.min + by, area.max + by)
        }
    }
}

/// A number of several records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SharedNumber {
    /// All have this value.
    Same(f64),
    /// They differ: the least and the greatest value.
    Mixed(f64, f64),
}

/// A change of a number, as people type it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TypedChange {
    /// All get this value: `1.5`.
    To(f64),
    /// Each grows by this amount: `+0.2`, `-0.2`.
    By(f64),
    /// Each is multiplied by this factor: `*2`, `/2`.
    Times(f64),
}

impl TypedChange {
    /// Reads a change; `None` for anything else. A number behind `+` or `-` is an amount, so an absolute negative
    /// number follows `=`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let number = |text: &str| {
            text.trim().replace(',', ".").parse::<f64>().ok().filter(|number| number.is_finite())
        };
        if let Some(rest) = text.strip_prefix('=') {
            return number(rest).map(Self::To);
        }
        if let Some(rest) = text.strip_prefix('*') {
            return number(rest).map(Self::Times);
        }
        if let Some(rest) = text.strip_prefix('/') {
            return number(rest).filter(|number| *number != 0.0).map(|number| Self::Times(1.0 / number));
        }
        let is_amount = text.starts_with(['+', '-']);
        number(text).map(|number| if is_amount { Self::By(number) } else { Self::To(number) })
    }

    fn of(self, value: f64) -> f64 {
        match self {
            Self::To(to) => to,
            Self::By(by) => value + by,
            Self::Times(factor) => value * factor,
        }
    }
}

/// The value of `number` of `items`, in the layout's units; `None` without items.
#[must_use]
pub fn shared_number(document: &Document, items: &[&Item], number: PlaceNumber) -> Option<SharedNumber> {
    let unit = document.unit_m()[number.axis()];
    let values = items.iter().map(|item| f64::from(number.of(item.area)) / unit);
    let round = |value: f64| (value * 1e4).round() / 1e4;
    let (least, most) = values.map(|value| (value, value)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    let is_same = most - least < 1e-4;
    Some(if is_same {
        SharedNumber::Same(round(least))
    } else {
        SharedNumber::Mixed(round(least), round(most))
    })
}

/// The edits that change `number` of each of `items`; the values count in the layout's units.
///
/// # Errors
/// [`EditRefusal::NoSize`] for the size of a group or a grid; [`EditRefusal::PlacedByGroup`] as
/// [`Document::placing`].
pub fn changing(
    document: &Document,
    items: &[&Item],
    number: PlaceNumber,
    change: TypedChange,
) -> Result<Vec<Edit>, EditRefusal> {
    let has_no_size = |item: &&&Item| item.is_group || item.widgets.len() > 1;
    if let Some(item) = items.iter().find(has_no_size).filter(|_| number.is_size()) {
        return Err(EditRefusal::NoSize(item.record.clone()));
    }
    let unit = document.unit_m()[number.axis()];
    let placed = items.iter().map(|item| {
        let value = change.of(f64::from(number.of(item.area)) / unit);
        (*item, number.set(item.area, (value * unit) as f32))
    });
    document.placing(&placed.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use underfoot::floor::Floor;
    use underfoot::schema::{Kinds, builtin_layout};

    fn map() -> Document {
        let floor = Arc::new(Floor::default());
        Document::read("map", builtin_layout("map").unwrap(), &Arc::new(Kinds::builtin()), &floor).unwrap()
    }

    fn pair(document: &Document) -> Vec<Item> {
        document
            .items()
            .into_iter()
            .filter(|item| ["pan_north", "pan_south"].contains(&&*item.name))
            .collect()
    }

    #[test]
    fn changes_are_read_as_people_type_them() {
        for (text, change) in [
            ("1.5", Some(TypedChange::To(1.5))),
            (" 1,5 ", Some(TypedChange::To(1.5))),
            ("+0.2", Some(TypedChange::By(0.2))),
            ("-0.2", Some(TypedChange::By(-0.2))),
            ("=-0.2", Some(TypedChange::To(-0.2))),
            ("*2", Some(TypedChange::Times(2.0))),
            ("/4", Some(TypedChange::Times(0.25))),
            ("/0", None),
            ("inf", None),
            ("a", None),
        ] {
            assert_eq!(TypedChange::parse(text), change, "{text}");
        }
    }

    #[test]
    fn two_controls_move_and_grow_together_and_keep_what_they_differ_in() {
        let mut document = map();
        let first = document.text().to_owned();
        let items = pair(&document);
        let both: Vec<&Item> = items.iter().collect();
        assert_eq!(shared_number(&document, &both, PlaceNumber::East), Some(SharedNumber::Same(1.9)));
        assert_eq!(shared_number(&document, &both, PlaceNumber::North), Some(SharedNumber::Mixed(2.2, 2.9)));
        assert_eq!(shared_number(&document, &[], PlaceNumber::North), None);
        let up = changing(&document, &both, PlaceNumber::North, TypedChange::By(0.1)).unwrap();
        document.edit(&up).unwrap();
        let items = pair(&document);
        let both: Vec<&Item> = items.iter().collect();
        assert_eq!(shared_number(&document, &both, PlaceNumber::North), Some(SharedNumber::Mixed(2.3, 3.0)));
        let wide = changing(&document, &both, PlaceNumber::Width, TypedChange::Times(0.5)).unwrap();
        document.edit(&wide).unwrap();
        assert!(document.text().contains("at: (1.9, 3), size: (0.3, 0.5)"), "{}", document.text());
        document.undo().unwrap();
        document.undo().unwrap();
        assert_eq!(document.text(), first);
    }

    #[test]
    fn a_group_has_no_size_to_change() {
        let mut document = map();
        let items = pair(&document);
        let (edits, _) = super::super::grouping(&document, &items.iter().collect::<Vec<_>>()).unwrap();
        document.edit(&edits).unwrap();
        let items = document.items();
        let group = items.iter().find(|item| item.is_group).unwrap();
        let refused = changing(&document, &[group], PlaceNumber::Depth, TypedChange::By(0.1));
        assert_eq!(refused, Err(EditRefusal::NoSize(group.record.clone())));
        assert!(changing(&document, &[group], PlaceNumber::East, TypedChange::By(0.1)).is_ok());
    }
}
