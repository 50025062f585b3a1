//! Tables of accuracy.

use serde::Serialize;
use underfoot_lab::experiment::{
    BesideTable, BrokenTable, PeopleTable, PlaceTable, SceneTable, SeamTable, SeatedTable, SpotTable,
    StandTable, TapTable,
};
use underfoot_sim::SceneKind;

use super::options::{FeetArgs, ScenesArgs, SpotArgs, StandArgs};
use super::parallel::gathered;
use crate::failure::Failure;
use crate::output::print_json;
use crate::progress::ProgressLine;

pub(super) fn spot(args: &SpotArgs) -> Result<(), Failure> {
    let quality = args.quality.quality;
    let (mut tile, mut seam) = (SpotTable::on(quality, 15), SeamTable::on(quality));
    let progress = ProgressLine::of("floor", 2 * args.floors);
    for number in 0..args.floors {
        tile.add_floor(args.seed.wrapping_add(number))?;
        progress.advance();
    }
    if !args.json {
        progress.print(&tile);
    }
    for number in 0..args.floors {
        seam.add_floor(args.seed.wrapping_add(number))?;
        progress.advance();
    }
    if !args.json {
        progress.print(&seam);
        return Ok(());
    }
    #[derive(Serialize)]
    struct Tables<L> {
        lines: Vec<L>,
    }
    print_json(&Tables { lines: tile.lines().chain(seam.lines()).collect() })
}

pub(super) fn place(args: &SpotArgs) -> Result<(), Failure> {
    let mut table = PlaceTable::on(args.quality.quality, 96);
    let progress = ProgressLine::of("floor", args.floors);
    for number in 0..args.floors {
        table.add_floor(args.seed.wrapping_add(number))?;
        progress.advance();
    }
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table);
    Ok(())
}

pub(super) fn calibration(args: &StandArgs) -> Result<(), Failure> {
    let progress = ProgressLine::of("floor", args.floors);
    let add = |table: &mut StandTable, number| table.add_floor(args.seed.wrapping_add(number));
    let table = gathered(&progress, args.floors, StandTable::default, add, StandTable::append)?;
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table);
    Ok(())
}

/// Plays scene after scene with all people, and prints the rows of each as soon as it is complete.
pub(super) fn scenes(args: &ScenesArgs) -> Result<(), Failure> {
    let mut table = SceneTable::on(&args.quality);
    let progress = ProgressLine::of("scene", args.people * SceneKind::ALL.len() as u64);
    if !args.json {
        out!("{}", SceneTable::heading(args.people));
    }
    for kind in SceneKind::ALL {
        let add = |table: &mut SceneTable, number| table.add_scene(kind, args.seed.wrapping_add(number));
        let empty = || SceneTable::on(&args.quality);
        table.append(gathered(&progress, args.people, empty, add, SceneTable::append)?);
        if !args.json {
            progress.print(&table.rows(Some(kind)));
        }
    }
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table.rows(None));
    Ok(())
}

pub(super) fn feet(args: &FeetArgs) -> Result<(), Failure> {
    let quality = args.quality.quality;
    let progress = ProgressLine::of("visit", 2 * args.people);
    let seed = |number: u64| args.seed.wrapping_add(number);
    let add = |table: &mut PeopleTable, number| table.add_person(seed(number));
    let people = gathered(&progress, args.people, || PeopleTable::on(quality), add, PeopleTable::append)?;
    if !args.json {
        progress.print(&people);
    }
    let add = |table: &mut TapTable, number| table.add_person(seed(number));
    let taps = gathered(&progress, args.people, || TapTable::on(quality), add, TapTable::append)?;
    if !args.json {
        progress.print(&taps);
        return Ok(());
    }
    #[derive(Serialize)]
    struct Tables<P, T> {
        people: Vec<P>,
        taps: Vec<T>,
    }
    print_json(&Tables { people: people.lines().collect(), taps: taps.lines().collect() })
}

pub(super) fn sensors(args: &FeetArgs) -> Result<(), Failure> {
    let progress = ProgressLine::of("person", args.people);
    let add = |table: &mut BrokenTable, number| table.add_person(args.seed.wrapping_add(number));
    let empty = || BrokenTable::on(args.quality.quality);
    let table = gathered(&progress, args.people, empty, add, BrokenTable::append)?;
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table);
    Ok(())
}

pub(super) fn controls(args: &FeetArgs) -> Result<(), Failure> {
    let quality = args.quality.quality;
    let progress = ProgressLine::of("visit", 2 * args.people);
    let seed = |number: u64| args.seed.wrapping_add(number);
    let add = |table: &mut SeatedTable, number| table.add_person(seed(number));
    let seated = gathered(&progress, args.people, || SeatedTable::on(quality), add, SeatedTable::append)?;
    if !args.json {
        progress.print(&seated);
    }
    let add = |table: &mut BesideTable, number| table.add_person(seed(number));
    let beside =
        gathered(&progress, args.people, || BesideTable::on(quality), add, |all, visit| all.append(&visit))?;
    if !args.json {
        progress.print(&beside);
        return Ok(());
    }
    #[derive(Serialize)]
    struct Tables<S, B> {
        seated: Vec<S>,
        beside: Vec<B>,
    }
    print_json(&Tables { seated: seated.lines().collect(), beside: beside.lines().collect() })
}
