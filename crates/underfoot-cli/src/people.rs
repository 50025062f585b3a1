//! People on a simulated floor: those of a scenario, or of the visit in a link.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::source::LinkFaults;
use underfoot::units::Instant;
use underfoot_sim::{FloorBuild, Foot, FootDriver, PlayedFeet, RecordedFeet, Script};

use super::failure::Failure;
use super::linked::{Linked, LinkedVisit, is_link};
use super::play;

/// The feet of people over time.
#[derive(Clone)]
pub(crate) enum People {
    /// Of a scenario.
    Script(Script),
    /// Of a visit in a link.
    Visit(Arc<RecordedFeet>),
}

impl People {
    /// A driver from the beginning.
    pub(crate) fn driver(&self) -> Box<dyn FootDriver> {
        match self {
            Self::Script(script) => Box::new(script.clone()),
            Self::Visit(feet) => Box::new(PlayedFeet::new(Arc::clone(feet))),
        }
    }

    pub(crate) fn duration(&self) -> Duration {
        match self {
            Self::Script(script) => script.duration(),
            Self::Visit(feet) => feet.duration(),
        }
    }

    /// Replaces `feet` by those at the moment `at`.
    pub(crate) fn feet_at(&self, at: Instant, feet: &mut Vec<Foot>) {
        match self {
            Self::Script(script) => {
                feet.clear();
                script.feet_at(at, feet);
            }
            Self::Visit(recorded) => recorded.feet_at(at, feet),
        }
    }
}

/// A layout on a floor that is not built yet, and the people who use it.
pub(crate) struct Scenery {
    pub(crate) floor: Floor,
    pub(crate) layout: Layout,
    pub(crate) people: People,
    /// The way to the simulated floor: that of a link with a visit, or the usual one.
    pub(crate) build: FloorBuild,
    /// Faults of a scenario.
    pub(crate) faults: LinkFaults,
}

impl Scenery {
    /// The content of a link; without a visit, `usual` is the floor, and the people are those of [`play::script`].
    pub(crate) fn of_link(link: &str, scenario: Option<&Path>, usual: FloorBuild) -> Result<Self, Failure> {
        let Linked { floor, layout, visit } = Linked::read(link)?;
        match (visit, scenario) {
            (Some(_), Some(_)) => {
                Err(Failure::Other("the link has a visit already: leave out --scenario".into()))
            }
            (Some(LinkedVisit { feet, build }), None) => {
                let (people, faults) = (People::Visit(feet), LinkFaults::default());
                Ok(Self { floor, layout, people, build, faults })
            }
            (None, _) => Self::of_scenario(floor, layout, scenario, usual),
        }
    }

    /// `layout` on `floor`, with the people of a scenario or of [`play::script`].
    pub(crate) fn of_scenario(
        floor: Floor,
        layout: Layout,
        scenario: Option<&Path>,
        build: FloorBuild,
    ) -> Result<Self, Failure> {
        let (script, faults) = play::script(scenario, &layout, &floor.geometry)?;
        Ok(Self { floor, layout, people: People::Script(script), build, faults })
    }
}

/// The link in the place of a layout, if one is there.
pub(crate) fn link_in(layout: Option<&Path>) -> Option<&str> {
    layout.filter(|layout| is_link(layout)).and_then(Path::to_str)
}
