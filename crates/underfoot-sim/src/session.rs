//! Sessions on simulated floors.

use std::path::Path;

use thiserror::Error;

use super::Scenario;
use super::build::{BuildError, FloorBuild};
use super::foot::FootDriver;
use super::quality::FloorQuality;
use super::simulated::{Pace, SimulatedSource};
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::runtime::{Session, SessionBuilder};
use underfoot::schema;
use underfoot::source::{BadFault, FaultInjector, FloorInput, LinkFaults};
use underfoot::units::HostClock;
use underfoot_format::diagnostic::Diagnostics;

/// Seed of the parts of the floor, of their calibration and of the faults.
const SEED: u64 = 1;

/// Why a session can't be simulated.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The file of the layout, its kinds or its effects have errors.
    #[error(transparent)]
    Layout(Diagnostics),
    /// The scenario has errors, or does not fit the layout.
    #[error(transparent)]
    Scenario(#[from] Diagnostics),
    /// A fault of the scenario is invalid.
    #[error(transparent)]
    Fault(#[from] BadFault),
    /// The simulated floor can't be measured.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// A session on a simulated floor of the default size and of this quality, with the people and the faults of
/// `scenario`: `session(layout, &scenario, FloorQuality::Slight)?.start()?`. It ends with the scenario.
///
/// # Errors
/// [`SimulationError`] has the problems of the scenario on this layout.
pub fn session(
    layout: Layout,
    scenario: &Scenario,
    quality: FloorQuality,
) -> Result<SessionBuilder, SimulationError> {
    let floor = Floor::default();
    let mut faults = LinkFaults::default();
    for fault in scenario.faults() {
        faults = faults.and(fault.parse()?);
    }
    let script = scenario.resolve(&layout, &floor.geometry)?;
    let (source, clock, floor) = simulated(&floor, quality, Box::new(script))?;
    let input: FloorInput = if faults == LinkFaults::default() {
        source.into()
    } else {
        FaultInjector::new(source, faults, SEED).into()
    };
    Ok(Session::source(input, clock).floor(floor).layout(layout))
}

/// A session like [`session`], from files: the page in the file `layout`, with the kinds and effects in the folders
/// `widgets` and `effects` beside the file or beside its folder, and the scenario in the file `scenario`; without one
/// [`Scenario::SESSION`], which fits the shipped layout `map`. Logs warnings about the layout.
///
/// # Errors
/// [`SimulationError`] has the problems of the files, or the reasons why they can't be read.
pub fn session_from_files(
    layout: impl AsRef<Path>,
    scenario: Option<&Path>,
    quality: FloorQuality,
) -> Result<SessionBuilder, SimulationError> {
    let loaded = schema::load_layout_and_kinds(layout.as_ref(), &Floor::default().geometry);
    let layout = loaded.map_err(SimulationError::Layout)?.log_warnings();
    let scenario = match scenario {
        Some(path) => Scenario::load(path)?,
        None => Scenario::parse("session", Scenario::SESSION)?,
    };
    session(layout, &scenario, quality)
}

/// A session on a simulated `floor` of this quality, calibrated as in the lab, with the feet that `driver` moves. Set
/// the layout, but no other floor.
///
/// # Errors
/// [`SimulationError::Build`] if the sensors of the floor can't be calibrated.
pub fn session_with(
    floor: &Floor,
    quality: FloorQuality,
    driver: Box<dyn FootDriver>,
) -> Result<SessionBuilder, SimulationError> {
    let (source, clock, floor) = simulated(floor, quality, driver)?;
    Ok(Session::source(source, clock).floor(floor))
}

/// Returns the packets of a simulated `floor` in real time, their clock, and the floor with its calibration.
fn simulated(
    floor: &Floor,
    quality: FloorQuality,
    driver: Box<dyn FootDriver>,
) -> Result<(SimulatedSource, HostClock, Floor), BuildError> {
    let (sim, floor) = FloorBuild::of(quality, SEED).in_use(floor)?;
    let source = SimulatedSource::new(sim, driver, Pace::RealTime);
    let clock = source.clock();
    Ok((source, clock, floor))
}
