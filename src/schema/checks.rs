//! What only shows when all parts of a layout are seen together, and on which floor.

use std::collections::HashMap;

use super::area::{Area, Placed};
use super::number::plain;
use super::page::{Control, Page, Zone};
use super::pages;
use super::problem::Problem;
use super::reader::Reader;
use crate::floor::Geometry;

/// Side below which feet miss a target, in metres (Saunders and Vogel 2015).
const MISSED_BELOW_M: f64 = 0.05;

/// Notes everything wrong between the parts of `page`, and between it and the floor.
pub(super) fn check(reader: &Reader<'_>, page: &Page<'_>, geometry: &Geometry) {
    let floor = Area::of_floor(geometry);
    check_zones(reader, page, &floor);
    check_ids(reader, page);
    pages::check(reader, page);
    if page.controls.is_empty() && reader.is_sound() {
        let problem = Problem::warning(page.widgets_at.clone(), "this layout has no controls");
        reader.report(problem.expected("expected some `widgets`"));
    }
    for (index, control) in page.controls.iter().enumerate() {
        let Some(place) = &control.place else { continue };
        let name = control.name();
        if check_on_floor(reader, &name, place, &floor) {
            check_region(reader, page, &name, place);
        }
        check_size(reader, &name, place, geometry);
        check_overlap(reader, &page.controls[..index], control, &name, place, &floor);
    }
}

impl Control<'_> {
    fn name(&self) -> String {
        self.id.map_or("this widget".into(), |id| format!("\"{id}\""))
    }
}

impl Zone<'_> {
    fn named(&self, noun: &str) -> String {
        match self.name {
            Some(name) if !name.is_empty() => format!("{noun} \"{name}\""),
            _ => format!("this {noun}"),
        }
    }
}

fn check_zones(reader: &Reader<'_>, page: &Page<'_>, floor: &Area) {
    for (index, region) in page.regions.iter().enumerate() {
        let Some(place) = &region.place else { continue };
        let name = region.named("region");
        check_on_floor(reader, &name, place, floor);
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
        check_on_floor(reader, &stance.named("stance zone"), place, floor);
        let inside = |zone: &&Zone<'_>| {
            zone.place.as_ref().is_some_and(|region| region.area.shared(&place.area).is_some())
        };
        if let Some(region) = page.regions.iter().find(inside) {
            let message = format!("a foot standing here takes the cursor of {}", region.named("region"));
            let expected = "a stance zone lies outside of the regions";
            reader.report(Problem::warning(place.at.clone(), message).expected(expected));
        }
    }
}

fn check_ids(reader: &Reader<'_>, page: &Page<'_>) {
    let regions = page.regions.iter().map(|zone| (zone.name, &zone.name_at));
    check_unique(reader, "regions", regions);
    check_unique(reader, "widgets", page.controls.iter().map(|control| (control.id, &control.id_at)));
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

/// Whether all of it is.
fn check_on_floor(reader: &Reader<'_>, name: &str, place: &Placed, floor: &Area) -> bool {
    let inside = place.area.within(floor);
    if !inside {
        let problem = Problem::error(place.at.clone(), format!("{name} reaches beyond the floor"));
        let expected = format!("it spans {}, the floor {floor}", place.area);
        reader.report(
            problem.expected(expected).help("places count in tiles from the floor's south-west corner"),
        );
    }
    inside
}

fn check_region(reader: &Reader<'_>, page: &Page<'_>, name: &str, place: &Placed) {
    match page.region_of(&place.area).and_then(|index| page.regions.get(index)) {
        Some(region) => {
            if region.place.as_ref().is_some_and(|outer| !place.area.within(&outer.area)) {
                let message = format!("part of {name} lies outside of {}", region.named("region"));
                let expected = "feet on that part don't count";
                reader.report(Problem::warning(place.at.clone(), message).expected(expected));
            }
        }
        // A region that could not be read might be the one.
        None if !page.regions_known => {}
        None => {
            let [east, north] = place.area.middle().map(plain);
            let help = match page.regions.first().and_then(|zone| Some((zone, zone.place.as_ref()?))) {
                None => "add regions: [(id: \"map\", at: (0, 2), size: (6, 4))]".to_owned(),
                Some((zone, region)) => format!("{} spans {}", zone.named("region"), region.area),
            };
            let problem = Problem::error(place.at.clone(), format!("{name} lies in no region"));
            reader.report(problem.expected(format!("its middle is at ({east}, {north})")).help(help));
        }
    }
}

fn check_size(reader: &Reader<'_>, name: &str, place: &Placed, geometry: &Geometry) {
    let [width, depth] = place.area.size().map(|tiles| tiles * f64::from(geometry.pitch_m()));
    if width.min(depth) < MISSED_BELOW_M {
        let message = format!("{name} is too small for a foot");
        let expected =
            format!("it is {} x {} cm", plain((width * 100.0).round()), plain((depth * 100.0).round()));
        let problem = Problem::warning(place.at.clone(), message).expected(expected);
        reader.report(problem.help("feet miss targets below 5 cm; 12 cm and more work well"));
    }
}

/// Reports the first of the `earlier` controls that this one overlaps.
fn check_overlap(
    reader: &Reader<'_>,
    earlier: &[Control<'_>],
    control: &Control<'_>,
    name: &str,
    place: &Placed,
    floor: &Area,
) {
    let mut overlapped = earlier.iter().filter(|other| pages::meet(control, other)).filter_map(|other| {
        let there = other.place.as_ref()?;
        Some((other, there, place.area.shared(&there.area)?))
    });
    if let Some((other, there, [width, depth])) = overlapped.next() {
        let more = match overlapped.count() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let message = format!("{name} overlaps {}{more}", other.name());
        let line = reader.line(&there.at);
        let expected =
            format!("{} x {} tiles of {} on line {line}", plain(width), plain(depth), other.name());
        let help = place.area.way_off(&there.area, floor);
        reader.report(Problem::error(place.at.clone(), message).expected(expected).help_if(help));
    }
}
