//! Checks that need all parts of a layout together, and the floor.

use std::collections::{HashMap, HashSet};

use super::area::{Placed, WrittenArea};
use super::control::WrittenControl;
use super::ground;
use super::number::plain;
use super::page::{WrittenPage, WrittenZone};
use super::pages;
use super::problem::Problem;
use super::reader::Reader;
use crate::floor::{Geometry, TileBlock};

/// Reports all conflicts between the parts of `page`, and between `page` and the floor.
pub(super) fn check(reader: &Reader<'_>, page: &WrittenPage, geometry: &Geometry) {
    let floor = WrittenArea::of_floor(geometry, page.units);
    check_zones(reader, page, &floor, geometry);
    check_ids(reader, page);
    pages::check(reader, &page.pages, &page.controls);
    ground::check(&page.grounds, page.units, &floor, |problem| reader.report(problem));
    if page.controls.is_empty() && page.grounds.is_empty() && reader.is_sound() {
        let problem = Problem::warning(page.widgets_at.clone(), "this layout has no controls");
        reader.report(problem.expected("expected some `widgets`"));
    }
    // Problems of a grid are reported for its first control only.
    let mut said = HashSet::new();
    for (index, control) in page.controls.iter().enumerate() {
        let Some(place) = &control.place else { continue };
        let name = control.name();
        let off = off_floor(page, &name, place, &floor).or_else(|| over_hole(page, &name, place, geometry));
        let outside = if off.is_none() { outside_region(page, &name, place) } else { None };
        let overlap = overlapping(reader, page, index, &name, place, &floor);
        for (what, problem) in [off, outside, overlap].into_iter().enumerate() {
            let Some(problem) = problem else { continue };
            let grid = control.written.repeat.as_ref().map(|repeat| (repeat.start, what));
            if grid.is_none_or(|grid| said.insert(grid)) {
                reader.report(problem);
            }
        }
    }
}

impl WrittenControl {
    fn name(&self) -> String {
        self.id.as_ref().map_or("this widget".into(), |id| format!("\"{id}\""))
    }
}

impl WrittenZone {
    fn named(&self, noun: &str) -> String {
        match self.name.value.as_str() {
            "" => format!("this {noun}"),
            name => format!("{noun} \"{name}\""),
        }
    }
}

fn check_zones(reader: &Reader<'_>, page: &WrittenPage, floor: &WrittenArea, geometry: &Geometry) {
    for (index, region) in page.regions.iter().enumerate() {
        let Some(place) = &region.place else { continue };
        let name = region.named("region");
        off_floor(page, &name, place, floor).into_iter().for_each(|problem| reader.report(problem));
        let earlier = page.regions[..index].iter().filter_map(|other| Some((other, other.place.as_ref()?)));
        for (other, other_place) in earlier {
            if place.area.shared(&other_place.area).is_some() {
                let message = format!("{name} overlaps {}", other.named("region"));
                let expected = format!("that one spans {}", other_place.area);
                let help = "a foot on both would be the cursor of two regions".to_owned();
                reader.report(Problem::error(place.at.clone(), message).expected(expected).help(help));
                break;
            }
        }
    }
    for stance in &page.stances {
        let Some(place) = &stance.place else { continue };
        let name = stance.named("stance zone");
        let off = off_floor(page, &name, place, floor).or_else(|| over_hole(page, &name, place, geometry));
        off.into_iter().for_each(|problem| reader.report(problem));
        let inside = |zone: &&WrittenZone| {
            zone.place.as_ref().is_some_and(|region| region.area.shared(&place.area).is_some())
        };
        if let Some(region) = page.regions.iter().find(inside) {
            let message = format!("a foot standing here takes the cursor of {}", region.named("region"));
            let expected = "a stance zone lies outside of the regions";
            reader.report(Problem::warning(place.at.clone(), message).expected(expected));
        }
    }
}

fn check_ids(reader: &Reader<'_>, page: &WrittenPage) {
    let is_read = |zone: &&WrittenZone| !zone.name.at.is_empty();
    let regions = page.regions.iter().filter(is_read);
    let regions = regions.map(|zone| (Some(zone.name.value.as_str()), &zone.name.at));
    check_unique(reader, "regions", regions);
    check_unique(
        reader,
        "widgets",
        page.controls.iter().map(|control| (control.id.as_deref(), &control.written.id)),
    );
}

fn check_unique<'a>(
    reader: &Reader<'_>,
    nouns: &str,
    names: impl Iterator<Item = (Option<&'a str>, &'a std::ops::Range<usize>)>,
) {
    let mut first: HashMap<&str, usize> = HashMap::new();
    for (name, span) in names {
        let Some(name) = name else { continue };
        let line = reader.line(span);
        if let Some(earlier) = first.get(name) {
            let problem = Problem::error(span.clone(), format!("two {nouns} have the id \"{name}\""));
            reader.report(problem.expected(format!("the first is on line {earlier}")));
        } else {
            first.insert(name, line);
        }
    }
}

/// Returns the problem of an area that is not completely on the floor.
fn off_floor(page: &WrittenPage, name: &str, place: &Placed, floor: &WrittenArea) -> Option<Problem> {
    if place.area.within(floor) {
        return None;
    }
    let problem = Problem::error(place.at.clone(), format!("{name} reaches beyond the floor"));
    let expected = format!("it spans {}, the floor {floor}", place.area);
    let help = format!("places count in {} from the floor's south-west corner", page.units.name());
    Some(problem.expected(expected).help(help))
}

/// Returns the problem of a control or a stance zone over a missing tile.
fn over_hole(page: &WrittenPage, name: &str, place: &Placed, geometry: &Geometry) -> Option<Problem> {
    let cell =
        |tile| WrittenArea::of_tiles(&TileBlock { first: tile, columns: 1, rows: 1 }, geometry, page.units);
    let missing = geometry.missing().iter().filter(|tile| geometry.index(**tile).is_some());
    let tile = missing.copied().find(|tile| place.area.shared(&cell(*tile)).is_some())?;
    let problem = Problem::error(place.at.clone(), format!("{name} lies over the missing tile {tile}"));
    let expected = format!("it spans {}, the hole {}", place.area, cell(tile));
    Some(problem.expected(expected).help("move it to where the floor has tiles"))
}

/// Returns the problem of a control that is not completely within one region.
fn outside_region(page: &WrittenPage, name: &str, place: &Placed) -> Option<Problem> {
    match page.region_of(&place.area).and_then(|index| page.regions.get(index)) {
        Some(region) => {
            let within = region.place.as_ref().is_none_or(|outer| place.area.within(&outer.area));
            let message = format!("part of {name} lies outside of {}", region.named("region"));
            let expected = "feet on that part don't count";
            (!within).then(|| Problem::warning(place.at.clone(), message).expected(expected))
        }
        // The right region may be one that could not be read.
        None if !page.regions_known => None,
        None => {
            let [east, north] = place.area.middle().map(plain);
            let help = match page.regions.first().and_then(|zone| Some((zone, zone.place.as_ref()?))) {
                None => "add regions: [(id: \"map\", at: (0, 2), size: (6, 4))]".to_owned(),
                Some((zone, region)) => format!("{} spans {}", zone.named("region"), region.area),
            };
            let problem = Problem::error(place.at.clone(), format!("{name} lies in no region"));
            Some(problem.expected(format!("its middle is at ({east}, {north})")).help(help))
        }
    }
}

/// Returns the problem of the first earlier control that overlaps the one at `index`.
fn overlapping(
    reader: &Reader<'_>,
    page: &WrittenPage,
    index: usize,
    name: &str,
    place: &Placed,
    floor: &WrittenArea,
) -> Option<Problem> {
    let control = &page.controls[index];
    let earlier = page.controls[..index].iter().filter(|other| pages::can_both_show(control, other));
    let mut overlapped = earlier.filter_map(|other| {
        let there = other.place.as_ref()?;
        Some((other, there, place.area.shared(&there.area)?))
    });
    let (other, there, [width, depth]) = overlapped.next()?;
    let more = match overlapped.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let message = format!("{name} overlaps {}{more}", other.name());
    let line = reader.line(&there.at);
    let (width, depth, units) = (plain(width), plain(depth), page.units.suffix());
    let expected = format!("{width} x {depth}{units} of {} on line {line}", other.name());
    let help = place.area.way_off(&there.area, floor);
    Some(Problem::error(place.at.clone(), message).expected(expected).help_if(help))
}
