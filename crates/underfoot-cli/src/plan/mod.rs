//! `underfoot plan`: the number of computers that a floor needs.

mod machine;
mod table;

use std::path::PathBuf;
use std::time::Duration;

use clap::ValueEnum;
use serde_json::json;
use underfoot::schema;
use underfoot::wire::SensorFormat;
use underfoot_lab::plan::{Crowd, FloorSize, MOST_PEOPLE, Plan, PlanError, plan_floor, plan_size};

use super::failure::Failure;
use super::number::{number, patience};

/// Options of `underfoot plan`.
///
/// Reports the number of computers, links, packets, megabits and cores that a floor and its people need, the best
/// division into areas, and the first limit. The performance of one computer is measured on this one, which takes
/// some twenty seconds, or read from a file. Without a floor, plans the paper's 6 x 6 tiles.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    /// Floor file: its boards, its actuators, and its areas if it names any.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["tiles", "no_actuators"])]
    floor: Option<PathBuf>,
    /// A floor of this many of the paper's tiles (columns x rows), at most 4096 to a side.
    #[arg(long, value_name = "CxR", default_value = "6x6", value_parser = tiles)]
    tiles: (u32, u32),
    /// A floor of that size without actuators.
    #[arg(long)]
    no_actuators: bool,
    /// Number of people on it.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=i64::from(MOST_PEOPLE)))]
    people: u32,
    /// Density of people in the fullest area, as a multiple of the average.
    #[arg(long, value_name = "TIMES", default_value = "2", value_parser = |text: &str| number(text, &(1.0..=1000.0), "times"))]
    crowding: f64,
    /// Format of the boards' readings.
    #[arg(long, value_enum, default_value = "counts")]
    format: Format,
    /// Share of processors and links that may be used; the rest is for everything else.
    #[arg(long, value_name = "SHARE", default_value = "0.5", value_parser = |text: &str| number(text, &(0.01..=1.0), "of the whole"))]
    usable: f64,
    /// Constants of a computer, as `--json` prints them under `machine`; without it, this computer is measured.
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Channels of a computer's sound card, in place of the constant (64 if the constants are measured).
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_535))]
    channels: Option<u32>,
    /// Megabits per second of a computer's network card, in place of the constant (1000 if the constants are
    /// measured).
    #[arg(long, value_name = "MBIT", value_parser = |text: &str| number(text, &(1.0..=1e7), "megabits per second"))]
    link: Option<f64>,
    /// How long each load is measured.
    #[arg(long, value_name = "S", default_value = "1", value_parser = patience)]
    seconds: Duration,
    /// Print the plan as JSON on standard output.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Raw 16-bit counts, one OSC integer per channel.
    Counts,
    /// Newtons, one OSC float per channel.
    Newtons,
    /// Raw counts in one OSC blob, big-endian.
    Blob,
}

/// Makes the plan and prints it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let plan = made(args)?;
    if args.json {
        let json = serde_json::to_string(&json!(plan)).map_err(|error| Failure::Other(error.to_string()))?;
        outln!("{json}");
    } else {
        table::print(&plan);
    }
    Ok(())
}

fn made(args: &Args) -> Result<Plan, Failure> {
    // Errors in a file are reported before anything is measured.
    let floor = args.floor.as_ref().map(|path| schema::load_floor(path)).transpose()?;
    let mut machine = match &args.machine {
        Some(path) => machine::read(path)?,
        None => machine::measured(args.seconds)?,
    };
    machine.channels = args.channels.unwrap_or(machine.channels);
    machine.link_mbit = args.link.unwrap_or(machine.link_mbit);
    let crowd = Crowd {
        people: args.people,
        crowding: args.crowding,
        format: match args.format {
            Format::Counts => SensorFormat::Counts,
            Format::Newtons => SensorFormat::Newtons,
            Format::Blob => SensorFormat::Blob,
        },
        usable: args.usable,
    };
    let plan = match &floor {
        Some(floor) => plan_floor(floor, &crowd, &machine),
        None => {
            let (columns, rows) = args.tiles;
            plan_size(FloorSize { columns, rows, actuators: !args.no_actuators }, &crowd, &machine)
        }
    };
    plan.map_err(|error| match error {
        PlanError::TooMuch { .. } => Failure::Other(format!(
            "{error}; fewer people, a larger `--usable` or a faster `--machine` would do"
        )),
        error => Failure::Other(error.to_string()),
    })
}

/// Parses `100x100`.
fn tiles(text: &str) -> Result<(u32, u32), String> {
    let expected = || "write it like 100x100: columns x rows, 1 to 4096 each".to_owned();
    let (columns, rows) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let side = |digits: &str| {
        let side = digits.trim().parse::<u32>().ok();
        side.filter(|side| (1..=underfoot_lab::plan::MOST_SIDE).contains(side)).ok_or_else(expected)
    };
    Ok((side(columns)?, side(rows)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_two_sides() {
        assert_eq!(tiles("1000x800"), Ok((1000, 800)));
        for wrong in ["", "6", "0x6", "6x", "6x5000", "axb", "-1x3"] {
            assert!(tiles(wrong).is_err(), "{wrong}");
        }
    }
}
