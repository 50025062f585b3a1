//! The option `--quality` of every command that simulates a floor.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use underfoot_sim::FloorQuality;

/// Quality of the simulated floor.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub(crate) struct QualityArg {
    /// Quality of the simulated floor: without errors, the paper's parts, new and well built, built by hand, or worn.
    #[arg(long, value_name = "QUALITY", default_value_t, value_parser = quality())]
    pub(crate) quality: FloorQuality,
}

/// Reads the name of a quality, and lists all names in help and completions.
pub(crate) fn quality() -> impl TypedValueParser<Value = FloorQuality> {
    PossibleValuesParser::new(FloorQuality::ALL.map(FloorQuality::name))
        .try_map(|name| name.parse::<FloorQuality>())
}
