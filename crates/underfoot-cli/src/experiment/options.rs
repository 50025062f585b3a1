//! Options of the experiments.

use std::path::PathBuf;

use underfoot_sim::FloorQuality;

use crate::quality_arg::{QualityArg, quality};

#[derive(clap::Args, Debug)]
pub(super) struct FigureArgs {
    /// Folder for the PNG, SVG and CSV files; created if it is missing.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(super) out: PathBuf,
    /// Seed of the parts of the simulated floor.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Width of the PNG, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1800)]
    pub(super) width: u32,
}

#[derive(clap::Args, Debug)]
pub(super) struct SpotArgs {
    /// Number of floors, each of other parts.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub(super) floors: u64,
    #[command(flatten)]
    pub(super) quality: QualityArg,
    /// Seed of the first floor's parts; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    pub(super) json: bool,
}

/// The floors of a calibration by standing have parts of their own spread and noise.
#[derive(clap::Args, Debug)]
pub(super) struct StandArgs {
    /// Number of floors, each of other parts.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub(super) floors: u64,
    /// Seed of the first floor's parts; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(clap::Args, Debug)]
pub(super) struct FeetArgs {
    /// Number of people, each on a floor of other parts.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub(super) people: u64,
    #[command(flatten)]
    pub(super) quality: QualityArg,
    /// Seed of the first person; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(clap::Args, Debug)]
pub(super) struct ScenesArgs {
    /// Number of people, each on floors of other parts.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub(super) people: u64,
    /// Seed of the first person; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Qualities of the simulated floors, separated by commas; each scene is played on a floor of each.
    #[arg(long, value_name = "QUALITY", value_delimiter = ',', default_values_t = [FloorQuality::default()], value_parser = quality())]
    pub(super) quality: Vec<FloorQuality>,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(clap::Args, Debug)]
pub(super) struct IntentArgs {
    /// Number of people, each on a floor of other parts.
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub(super) people: u64,
    /// Number of steps of each person over a shipped layout; 167 of 120 people are 20,000.
    #[arg(long, value_name = "N", default_value_t = 167, value_parser = clap::value_parser!(u64).range(0..=1_000_000))]
    pub(super) steps: u64,
    /// Number of intended presses of each person on a shipped layout.
    #[arg(long, value_name = "N", default_value_t = 167, value_parser = clap::value_parser!(u64).range(0..=1_000_000))]
    pub(super) presses: u64,
    #[command(flatten)]
    pub(super) quality: QualityArg,
    /// Seed of the first person; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Folder for the tables as CSV and the plot as PNG and SVG; created if it is missing.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(super) out: PathBuf,
    /// Width of the PNG, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1800)]
    pub(super) width: u32,
    /// Print one JSON object instead of tables; no files.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(clap::Args, Debug)]
pub(super) struct PondArgs {
    /// Number of crack events.
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1000..=10_000_000))]
    pub(super) events: u64,
    /// Number of steps for each manner of walking.
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub(super) steps: u64,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u32,
    /// Folder for the pictures of the pond (PNG) and the table of walking (CSV); created if it is missing.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(super) out: PathBuf,
    /// Width of the pictures, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1400)]
    pub(super) width: u32,
    /// Print one JSON object instead of tables; no files.
    #[arg(long)]
    pub(super) json: bool,
}
