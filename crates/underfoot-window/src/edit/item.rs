//! The records of a layout as areas on the floor.

use std::ops::Range;

use glam::{DVec2, Vec2};

use super::address::{Address, RecordList};
use super::document::Document;
use underfoot::floor::Rect;
use underfoot_format::outline::Outline;

/// A record that covers a part of the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// The address of the record.
    pub record: Address,
    /// Its name: an id, a label or a material; may be empty.
    pub name: String,
    /// Its area, in floor metres; for a group or a grid, the area around its controls.
    pub area: Rect,
    /// Its page; `None` if it is on all pages.
    pub page: Option<usize>,
    /// The indices of its controls in the layout; empty for a region, a stance zone or a ground.
    pub widgets: Range<usize>,
    /// Whether it is a group, which contains other records.
    pub is_group: bool,
}

impl Item {
    /// Whether it is on the page with this index.
    #[must_use]
    pub fn is_on(&self, page: usize) -> bool {
        self.page.is_none_or(|own| own == page)
    }
}

/// The smallest rectangle around all of `areas`; `None` if there are none.
#[must_use]
pub fn around(areas: impl IntoIterator<Item = Rect>) -> Option<Rect> {
    areas.into_iter().reduce(|all, one| Rect::new(all.min.min(one.min), all.max.max(one.max)))
}

impl Document {
    /// All records that cover a part of the floor: grounds, regions, stance zones, then controls; each list is in the
    /// order of the text, with a group before its members.
    #[must_use]
    pub fn items(&self) -> Vec<Item> {
        let layout = self.layout();
        let all = Address::all(self.root());
        let mut items = Vec::new();
        let mut grounds = layout.grounds.iter();
        for (address, record) in &all {
            let area = match address.list() {
                Some(RecordList::Grounds) => grounds.next().map(|ground| ground.spec.area),
                Some(RecordList::Regions) => {
                    index(address).and_then(|at| layout.regions.get(at)).map(|it| it.area)
                }
                Some(RecordList::Stances) => {
                    index(address).and_then(|at| layout.stances.get(at)).map(|it| it.area)
                }
                _ => None,
            };
            if let Some(area) = area {
                items.push(item(address, record, area, address.page(), 0..0));
            }
        }
        items.sort_by_key(|item| item.record.list() != Some(RecordList::Grounds));
        let homes: Vec<Option<&Address>> = (0..layout.widgets.len())
            .map(|widget| home(&all, self.loaded().places.id_span(widget)))
            .collect();
        for (address, record) in all.iter().filter(|(address, _)| address.list() == Some(RecordList::Widgets))
        {
            let is_in = |home: &Option<&Address>| home.is_some_and(|home| home.is_within(address));
            let Some(first) = homes.iter().position(is_in) else { continue };
            let count = homes[first..].iter().take_while(|home| is_in(home)).count();
            let widgets = first..first + count;
            let areas = layout.widgets.get(widgets.clone()).unwrap_or_default();
            let Some(area) = around(areas.iter().map(|widget| widget.area)) else { continue };
            items.push(item(address, record, area, address.page(), widgets));
        }
        items
    }

    /// The record of the control with this index in the layout: the innermost one around it.
    #[must_use]
    pub fn record_of(&self, widget: usize) -> Option<Address> {
        home(&Address::all(self.root()), self.loaded().places.id_span(widget)).cloned()
    }

    /// The innermost record around the byte at `offset` of the text; `None` outside all lists.
    #[must_use]
    pub fn record_at(&self, offset: usize) -> Option<Address> {
        home(&Address::all(self.root()), Some(offset..offset)).filter(|at| at.split().is_some()).cloned()
    }

    /// The written id of a record.
    #[must_use]
    pub fn id_of(&self, record: &Address) -> Option<&str> {
        record.find(self.root())?.field("id")?.value.says.as_deref()
    }

    /// The unit of the layout's places, in metres east and north.
    #[must_use]
    pub fn unit_m(&self) -> DVec2 {
        let units = self.written(&Address::LAYOUT, "units");
        if units == Some("Metres") { DVec2::ONE } else { self.floor().geometry.pitch_m().as_dvec2() }
    }

    /// The topmost control, stance zone, region or ground at `point` on the page with index `page`; for a group, one
    /// of its controls; never a ground that covers the whole floor.
    #[must_use]
    pub fn item_at(&self, items: &[Item], page: usize, point: Vec2) -> Option<Address> {
        let rank = |item: &Item| match item.record.list() {
            Some(RecordList::Widgets) => 3,
            Some(RecordList::Stances) => 2,
            Some(RecordList::Regions) => 1,
            _ => 0,
        };
        let here = items.iter().enumerate().filter(|(_, item)| {
            let is_placed =
                item.record.list() != Some(RecordList::Grounds) || self.written(&item.record, "at").is_some();
            !item.is_group && is_placed && item.is_on(page) && item.area.contains(point)
        });
        here.max_by_key(|(at, item)| (rank(item), *at)).map(|(_, item)| item.record.clone())
    }
}

fn index(address: &Address) -> Option<usize> {
    address.split().map(|(_, _, index)| index)
}

fn item(address: &Address, record: &Outline, area: Rect, page: Option<usize>, widgets: Range<usize>) -> Item {
    let says = |field: &str| record.field(field).and_then(|field| field.value.says.clone());
    let name = says("id").or_else(|| says("label")).or_else(|| record.name.clone()).unwrap_or_default();
    let is_group = record.field("widgets").is_some();
    Item { record: address.clone(), name, area, page, widgets, is_group }
}

/// The innermost record of `all` around `place`.
fn home<'a>(all: &'a [(Address, &Outline)], place: Option<Range<usize>>) -> Option<&'a Address> {
    let place = place?;
    let holds =
        |(_, record): &&(Address, &Outline)| record.span.start <= place.start && place.end <= record.span.end;
    all.iter().filter(holds).min_by_key(|(_, record)| record.span.len()).map(|(address, _)| address)
}
