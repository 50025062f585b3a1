//! Addresses of records in a layout.

use std::fmt;

use underfoot_format::outline::{Element, Outline, OutlineShape};

/// A list of records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RecordList {
    /// Active parts of the floor.
    Regions,
    /// Places to stand.
    Stances,
    /// Controls and groups, including those of a group or a page.
    Widgets,
    /// Materials underfoot, including those of a page.
    Grounds,
    /// Pages, one of which is on the floor at a time.
    Pages,
}

impl RecordList {
    /// All lists, in the order in which layouts write them.
    pub const ALL: [Self; 5] = [Self::Regions, Self::Stances, Self::Widgets, Self::Grounds, Self::Pages];

    /// The field that holds the list.
    #[must_use]
    pub const fn field(self) -> &'static str {
        match self {
            Self::Regions => "regions",
            Self::Stances => "stances",
            Self::Widgets => "widgets",
            Self::Grounds => "grounds",
            Self::Pages => "pages",
        }
    }
}

/// The path to a record: entry by entry from the layout itself, which has the empty address.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address(Vec<(RecordList, usize)>);

impl Address {
    /// The layout itself.
    pub const LAYOUT: Self = Self(Vec::new());

    /// The entry at `index` of the layout's own `list`.
    #[must_use]
    pub fn of(list: RecordList, index: usize) -> Self {
        Self::LAYOUT.entry(list, index)
    }

    /// The entry at `index` of this record's `list`.
    #[must_use]
    pub fn entry(&self, list: RecordList, index: usize) -> Self {
        let mut steps = self.0.clone();
        steps.push((list, index));
        Self(steps)
    }

    /// The record that contains its list, the list, and its index there; `None` for the layout itself.
    #[must_use]
    pub fn split(&self) -> Option<(Self, RecordList, usize)> {
        let (&(list, index), parents) = self.0.split_last()?;
        Some((Self(parents.to_vec()), list, index))
    }

    /// The list that contains it; `None` for the layout itself.
    #[must_use]
    pub fn list(&self) -> Option<RecordList> {
        self.0.last().map(|(list, _)| *list)
    }

    /// The index of the page that it is, or is part of; `None` for a record outside all pages.
    #[must_use]
    pub fn page(&self) -> Option<usize> {
        self.0.first().filter(|(list, _)| *list == RecordList::Pages).map(|(_, index)| *index)
    }

    /// Whether it is `other` or a part of it.
    #[must_use]
    pub fn is_within(&self, other: &Self) -> bool {
        self.0.starts_with(&other.0)
    }

    /// The record in the outline of a layout.
    pub(super) fn find<'o>(&self, layout: &'o Outline) -> Option<&'o Outline> {
        self.0.iter().try_fold(layout, |record, (list, index)| {
            Some(&list_of(record, *list)?.elements.get(*index)?.value)
        })
    }

    /// All records of a layout; each comes after the record that contains it.
    pub(super) fn all(layout: &Outline) -> Vec<(Self, &Outline)> {
        let mut found = vec![(Self::LAYOUT, layout)];
        let mut next = 0;
        while let Some((address, record)) = found.get(next).cloned() {
            for list in RecordList::ALL {
                let entries: &[Element] = list_of(record, list).map_or(&[], |list| &list.elements);
                let entries = entries.iter().enumerate();
                found.extend(entries.map(|(index, element)| (address.entry(list, index), &element.value)));
            }
            next += 1;
        }
        found
    }
}

/// The list of `record`, if it is present.
pub(super) fn list_of(record: &Outline, list: RecordList) -> Option<&Outline> {
    let value = &record.field(list.field())?.value;
    (value.shape == OutlineShape::List).then_some(value)
}

impl fmt::Display for Address {
    /// The notation of diagnostics: `pages[1].widgets[0]`; empty for the layout itself.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, (list, index)) in self.0.iter().enumerate() {
            let dot = if at > 0 { "." } else { "" };
            write!(f, "{dot}{}[{index}]", list.field())?;
        }
        Ok(())
    }
}
