//! Options for a simulated floor, and the scenario played on it.

use std::path::Path;

use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::source::LinkFaults;
use underfoot_sim::{self as sim, BuildError, FloorBuild, Scenario, Script};

use super::failure::Failure;
use super::quality_arg::QualityArg;

/// Options of the simulated floor on which a scenario is played.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct SimArgs {
    /// Seed of the floor: it determines sensors and noise.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    quality: QualityArg,
    /// Also press known points on every tile and use the resulting position maps.
    #[arg(long)]
    mapped: bool,
}

impl Default for SimArgs {
    fn default() -> Self {
        Self { seed: 1, quality: QualityArg::default(), mapped: false }
    }
}

impl SimArgs {
    /// The way to the simulated floor, with boards that send counts unless its sensors are exact.
    pub(crate) const fn build(&self) -> FloorBuild {
        let Self { seed, quality, mapped } = self;
        FloorBuild { is_mapped: *mapped, ..FloorBuild::of(quality.quality, *seed) }
    }
}

impl From<BuildError> for Failure {
    fn from(error: BuildError) -> Self {
        Self::Other(error.to_string())
    }
}

/// The scenario in `file`, or the built-in session if it fits `layout`, or a visit to each of its controls; without
/// controls, a stroll. Also returns the faults of the scenario.
pub(crate) fn script(
    file: Option<&Path>,
    layout: &Layout,
    geometry: &Geometry,
) -> Result<(Script, LinkFaults), Failure> {
    let scenario = match file {
        Some(path) => Scenario::load(path)?,
        None if layout.widgets.is_empty() => Scenario::parse("the built-in stroll", Scenario::STROLL)?,
        None => {
            let session = Scenario::parse("the built-in session", Scenario::SESSION)?;
            let script = session.resolve(layout, geometry).unwrap_or_else(|_| made_for(layout, geometry));
            return Ok((script, LinkFaults::default()));
        }
    };
    let mut faults = LinkFaults::default();
    for written in scenario.faults() {
        let fault: LinkFaults = written.parse().map_err(|error| {
            let file = file.unwrap_or(Path::new("the built-in scenario")).display();
            Failure::Other(format!("{file}: {error}"))
        })?;
        faults = faults.and(fault);
    }
    Ok((scenario.resolve(layout, geometry)?, faults))
}

/// A visit to the controls of `layout`.
fn made_for(layout: &Layout, geometry: &Geometry) -> Script {
    let visit = sim::visit(layout, geometry);
    for id in &visit.missed {
        tracing::warn!(
            "the visitor finds no place from which a foot reaches \"{id}\", or no way to its page"
        );
    }
    visit.script
}
