//! Arrangement of `widgets` entries: resolves neighbours, groups and grids to controls with places.
//!
//! Neighbours are entries of the same list, so that each list can be arranged by itself, in its own coordinates:
//! those of the floor or of its group.

use std::collections::HashMap;
use std::ops::Range;

use super::area::{Placed, WrittenArea};
use super::chain::Chains;
use super::context::LayoutContext;
use super::control::{Grid, Size, WrittenControl};
use super::lists::MAX_WIDGETS;
use super::node::Node;
use super::place::{NeighbourPlace, Placing, WrittenSpot};
use super::problem::Problem;
use super::suggest::{did_you_mean, nearest};
use underfoot_format::codec::By;
use underfoot_format::describe::FieldType;
use underfoot_format::text::Text;

/// Reads the entries of `widgets` into controls.
pub(super) const WIDGETS: By<Vec<WrittenControl>, LayoutContext> = By {
    shape: || FieldType::Words(WIDGET),
    read: |node, context| {
        let mut room = context.room;
        Some(read(node, context, &mut room))
    },
    write: |_| Text::List(Vec::new()),
    stand_in: Vec::new,
};

/// Description of a `widgets` entry, for people.
const WIDGET: &str = "a list of controls, each with `id`, `kind`, a place, `size`, `label`, `goto`, `repeat` and what it \
    overrides of its kind, and of Group(...)s with `id`, a place and `widgets`; a place is `at`, or one of `right_of`, \
    `left_of`, `above` and `below` with `gap` and `align`";

/// Reads the controls of the list at `node`, in its own coordinates, and takes their number off the `room`.
fn read(node: Node<'_>, context: &LayoutContext, room: &mut usize) -> Vec<WrittenControl> {
    let nodes = node.list("widget", MAX_WIDGETS).unwrap_or_default();
    let entries: Vec<Entry<'_>> =
        nodes.into_iter().filter_map(|node| Entry::read(node, context, room)).collect();
    arrange(entries)
}

/// One entry of a list: controls that are placed together, and their place.
struct Entry<'r> {
    placing: Placing<'r>,
    /// Name by which other entries of the list can refer to it.
    name: Option<&'r str>,
    body: EntryContent<'r>,
}

enum EntryContent<'r> {
    Grid(Grid<'r>),
    /// Controls with places within the group, and their bounds.
    Group(Vec<WrittenControl>, Option<WrittenArea>),
}

impl<'r> Entry<'r> {
    fn read(node: Node<'r>, context: &LayoutContext, room: &mut usize) -> Option<Self> {
        if node.is_called("Group") || node.peek("Group", "widgets").is_some() {
            return Self::group(node, context, room);
        }
        let mut grid = Grid::read(node, context, *room)?;
        *room = room.saturating_sub(grid.controls.len());
        let placing =
            std::mem::replace(&mut grid.placing, Placing { spot: None, at: 0..0, is_relative: false });
        Some(Self { placing, name: None, body: EntryContent::Grid(grid) })
    }

    fn group(node: Node<'r>, context: &LayoutContext, room: &mut usize) -> Option<Self> {
        let mut fields = node.fields("Group")?;
        let name = fields.read("id", Some(None), |node| node.id().map(Some)).flatten();
        let placing = Placing::read(&mut fields, context.units);
        let inside = fields.read("widgets", None, |node| Some(read(node, context, room)));
        fields.finish();
        let controls = inside.unwrap_or_default();
        let areas = controls.iter().filter_map(|control| Some(control.place.as_ref()?.area));
        let bounds = areas.reduce(|all, one| all.around(&one));
        Some(Self { placing, name, body: EntryContent::Group(controls, bounds) })
    }

    /// Returns its area relative to its own place; `None` if the area is unknown.
    fn extent(&self, neighbour: Option<&WrittenArea>) -> Option<WrittenArea> {
        match &self.body {
            EntryContent::Grid(grid) => {
                let cell = grid.cell_size(neighbour)?;
                let side = |axis: usize, count: u32| {
                    f64::from(count) * cell[axis] + f64::from(count - 1) * grid.gap[axis]
                };
                Some(WrittenArea::new([0.0; 2], [side(0, grid.columns), side(1, grid.rows)]))
            }
            EntryContent::Group(_, bounds) => *bounds,
        }
    }

    /// Places all of its controls; `by` is the shift of the entry.
    fn move_by(&mut self, by: [f64; 2], neighbour: Option<&WrittenArea>) {
        let at = self.placing.at.clone();
        match &mut self.body {
            EntryContent::Grid(grid) => {
                let Some(size) = grid.cell_size(neighbour) else { return };
                for (cell, control) in &mut grid.controls {
                    let (column, row) = (f64::from(cell.column), f64::from(grid.rows - 1 - cell.row));
                    let corner =
                        [by[0] + column * (size[0] + grid.gap[0]), by[1] + row * (size[1] + grid.gap[1])];
                    control.place = Some(Placed { area: WrittenArea::new(corner, size), at: at.clone() });
                }
            }
            EntryContent::Group(controls, bounds) => {
                for place in controls.iter_mut().filter_map(|control| control.place.as_mut()) {
                    place.area = place.area.moved_by(by);
                }
                *bounds = bounds.map(|bounds| bounds.moved_by(by));
            }
        }
    }

    /// Returns the area of the neighbour called `name`, which is this entry or a part of it.
    fn area_of(&self, name: &str) -> Option<WrittenArea> {
        match &self.body {
            EntryContent::Grid(grid) => {
                let found = grid.controls.iter().find(|(_, control)| control.id.as_deref() == Some(name))?;
                Some(found.1.place.as_ref()?.area)
            }
            EntryContent::Group(_, bounds) => *bounds,
        }
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let controls = match &self.body {
            EntryContent::Grid(grid) => grid.controls.as_slice(),
            EntryContent::Group(..) => &[],
        };
        self.name.into_iter().chain(controls.iter().filter_map(|(_, control)| control.id.as_deref()))
    }

    fn into_controls(self) -> Vec<WrittenControl> {
        match self.body {
            EntryContent::Grid(grid) => grid.controls.into_iter().map(|(_, control)| control).collect(),
            EntryContent::Group(controls, _) => controls,
        }
    }
}

impl Grid<'_> {
    fn cell_size(&self, neighbour: Option<&WrittenArea>) -> Option<[f64; 2]> {
        match self.size? {
            Size::Fixed(size) => Some(size),
            Size::Neighbours => neighbour.map(WrittenArea::size),
        }
    }
}

/// Places the controls of all entries; a control has no place if that is unknown, which has been reported.
fn arrange(mut entries: Vec<Entry<'_>>) -> Vec<WrittenControl> {
    let follows = neighbours(&entries);
    let chains = Chains::of(&follows);
    for circle in &chains.circles {
        report_circle(circle, &entries);
    }
    for &index in chains.order.iter().filter(|&&index| !chains.is_circular(index)) {
        let Some(entry) = entries.get(index) else { continue };
        let moved = match entry.placing.spot {
            Some(WrittenSpot::At(at)) => Some((at, None)),
            Some(WrittenSpot::Beside(beside)) => {
                beside_neighbour(&beside, entry, follows[index].map(|at| &entries[at]))
            }
            None => None,
        };
        if let (Some((by, neighbour)), Some(entry)) = (moved, entries.get_mut(index)) {
            entry.move_by(by, neighbour.as_ref());
        } else if let Some(Entry { body: EntryContent::Group(controls, bounds), .. }) = entries.get_mut(index)
        {
            // Without a place of the group, the places of its controls are unknown.
            controls.iter_mut().for_each(|control| control.place = None);
            *bounds = None;
        }
    }
    for &index in chains.circles.iter().flatten() {
        if let Some(Entry { body: EntryContent::Group(controls, _), .. }) = entries.get_mut(index) {
            controls.iter_mut().for_each(|control| control.place = None);
        }
    }
    entries.into_iter().flat_map(Entry::into_controls).collect()
}

/// Returns the shift of `entry`, and the area of its neighbour.
fn beside_neighbour(
    beside: &NeighbourPlace<'_>,
    entry: &Entry<'_>,
    neighbour: Option<&Entry<'_>>,
) -> Option<([f64; 2], Option<WrittenArea>)> {
    let area = neighbour?.area_of(beside.neighbour)?;
    let extent = entry.extent(Some(&area))?;
    let corner = beside.corner(&area, extent.size());
    Some(([corner[0] - extent.min()[0], corner[1] - extent.min()[1]], Some(area)))
}

/// Returns for each entry the index of the entry that contains its neighbour.
fn neighbours(entries: &[Entry<'_>]) -> Vec<Option<usize>> {
    let mut owners: HashMap<&str, usize> = HashMap::new();
    for (index, entry) in entries.iter().enumerate() {
        for name in entry.names() {
            owners.entry(name).or_insert(index);
        }
    }
    let owner = |entry: &Entry<'_>| {
        let Some(WrittenSpot::Beside(beside)) = entry.placing.spot else { return None };
        let found = owners.get(beside.neighbour).copied();
        if found.is_none() {
            let others = owners.keys().copied().filter(|name| entry.names().all(|own| own != *name));
            report_unknown(&beside, others.collect());
        }
        found
    };
    entries.iter().map(owner).collect()
}

/// Maximum number of names in a message.
const LISTED: usize = 8;

fn report_unknown(beside: &NeighbourPlace<'_>, mut names: Vec<&str>) {
    names.sort_unstable();
    let help = if names.len() <= LISTED || nearest(beside.neighbour, names.iter().copied()).is_some() {
        did_you_mean(beside.neighbour, &names, '"')
    } else {
        None
    };
    let problem =
        Problem::error(beside.node.span(), format!("there is no \"{}\" beside this", beside.neighbour));
    beside.node.report(problem.expected("expected the id of something in the same list").help_if(help));
}

fn report_circle(circle: &[usize], entries: &[Entry<'_>]) {
    let beside = |&index: &usize| match entries.get(index)?.placing.spot {
        Some(WrittenSpot::Beside(beside)) => Some(beside),
        _ => None,
    };
    let members: Vec<NeighbourPlace<'_>> = circle.iter().filter_map(beside).collect();
    let Some(first) = members.first() else { return };
    let span: Range<usize> = first.node.span();
    let message = match members.as_slice() {
        [_] => "nothing can stand beside itself".to_owned(),
        [_, _] => "these two stand beside each other".to_owned(),
        more => format!("these {} stand beside each other in a circle", more.len()),
    };
    let names: Vec<String> =
        members.iter().take(LISTED).map(|beside| format!("\"{}\"", beside.neighbour)).collect();
    let problem = Problem::error(span, message).expected(format!("beside {}", names.join(", beside ")));
    let which = if members.len() == 1 { "it" } else { "one of them" };
    first.node.report(problem.help(format!("give {which} a place of its own: at: (2, 3)")));
}
