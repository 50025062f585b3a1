//! Scenarios: files with the actions of people on a floor, resolved against a layout and played.

mod dragging;
#[cfg(test)]
mod tests;

use std::path::Path;
use std::time::Duration;

use glam::Vec2;

use super::definition::{MOST_OTHERS, MOST_STEPS, PersonRecord, ScenarioRecord, Side, Step};
use super::performance::Performance;
use super::person::MoveError;
use super::script::Script;
use super::slide::Slide;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Layout, Widget};
use underfoot::units::Newtons;
use underfoot_format::describe::Description;
use underfoot_format::diagnostic::Diagnostics;
use underfoot_format::filed::Filed;
use underfoot_format::node::Node;
use underfoot_format::pairs::Limits;
use underfoot_format::problem::Problem;
use underfoot_format::reader::Reader;
use underfoot_format::source::{Source, read_text};
use underfoot_format::suggest::did_you_mean;
use underfoot_format::text::RonText;
use underfoot_format::{Codec, Rec, Record, Variants, filed};

/// A scenario file, parsed and with its numbers checked, not yet resolved against a layout.
///
/// ```ron
/// Scenario(
///     title: "Zoom in, then wander off",
///     // Everything about the person may be left out: 70 kg, 27 cm feet, 1.32 m/s.
///     person: (mass_kg: 70, foot_m: 0.27, speed_m_s: 1.3),
///     steps: [
///         Wait(ms: 800),
///         // Walks on from beside the floor and stops there; facing may be left out.
///         Enter(from: West, at: (1.5, 0.5), facing: North),
///         // Stops with the feet left and right of the place. Goes straight there or by the places of via.
///         WalkTo(at: (3.0, 0.6), via: [(2.2, 0.3)], facing: North),
///         // The ball of the nearer foot on the middle of the control. 120 N and 300 ms may be left out.
///         Press(widget: "zoom_in", force_n: 120, hold_ms: 300),
///         Tap(widget: "layers", force_n: 120),
///         // Along a slider's track or round a dial, in shares of its range; over a pad, in shares of its width and
///         // depth, such as (0.5, 0.5). 0.3 m/s and 80 N may be left out.
///         Drag(widget: "zoom", from: 0.2, to: 0.8, speed_m_s: 0.3, force_n: 80),
///         // Without a control: from place to place on the free floor.
///         Drag(from: (2.2, 2.0), to: (2.4, 2.2)),
///         // As Press, on a bare place.
///         Point(at: (2.0, 3.0), force_n: 120, hold_ms: 300),
///         // By small steps, looking where one looked before.
///         Sidestep(at: (3.5, 0.6)),
///         Turn(to: East),
///         Leave(to: East),
///     ],
///     // More people at the same time; each has a person and steps of its own.
///     others: [(person: (mass_kg: 55), steps: [Stand(at: (5, 5), facing: South), Wait(ms: 9000)])],
///     // What goes wrong on the way of the packets, as the option `--fault` has it.
///     faults: ["loss=1%", "board=2:10s..12s"],
/// )
/// ```
///
/// Places are in tiles (1.0 = one tile pitch) from the south-west corner.
/// `Stand` is for a person on the floor from the first moment, so it can only be the first step.
///
/// A pressing person stands on the other foot, which stays in place, so a control must lie within reach (about 0.85
/// m) and not under the feet. The foot returns after each press; the shortest press takes about two seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    file: String,
    text: String,
    written: ScenarioRecord,
}

/// Distance beside the floor at which people start and end (m): one and a half steps.
const BESIDE_M: f32 = 1.0;

/// Duration of a tap.
const TAP: Duration = Duration::from_millis(60);

impl Scenario {
    /// The built-in scenario of a person who crosses the floor and touches no control; fits floors of at least 4 x 3
    /// tiles.
    pub const CROSSING: &str = include_str!("../scenarios/crossing.ron");

    /// The built-in session on the shipped layout `map`: walk on, press a button, drag a slider, flip a switch, walk
    /// off.
    pub const SESSION: &str = include_str!("../scenarios/session.ron");

    /// The built-in scenario for layouts without controls: a stroll over the floor and back; fits floors of at least
    /// 6 x 5 tiles.
    pub const STROLL: &str = include_str!("../scenarios/stroll.ron");

    /// Loads the scenario in the file at `path`.
    ///
    /// # Errors
    /// All problems of the file, or the reason why it can't be read.
    pub fn load(path: &Path) -> Result<Self, Diagnostics> {
        Self::parse(&path.display().to_string(), &read_text(path)?)
    }

    /// Parses the scenario in `text`; messages call it `file`.
    ///
    /// # Errors
    /// All problems of the text.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let source = Source::new(file, text)?;
        let reader = Reader::new(&source, ScenarioRecord::NAME, Limits::LAYOUT);
        let written = reader.root("scenario").and_then(|node| node.record(None, &()));
        let (written, _) = reader.conclude(written)?;
        Ok(Self { file: file.into(), text: text.into(), written })
    }

    /// Returns the title.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.written.title
    }

    /// Describes the fields of scenarios, and of their steps.
    pub(crate) fn describe() -> (Description, Vec<Description>) {
        (ScenarioRecord::describe(), Step::describe())
    }

    /// Returns the faults of the packets during the scenario, in the format of `--fault`.
    #[must_use]
    pub fn faults(&self) -> &[String] {
        &self.written.faults
    }

    /// Resolves the scenario against this layout and floor.
    ///
    /// # Errors
    /// Every control that is not in the layout, every place that is not on the floor, and the first impossible move
    /// of each person, each with its position in the file.
    pub fn resolve(&self, layout: &Layout, geometry: &Geometry) -> Result<Script, Diagnostics> {
        let stage = Stage { layout, geometry, bounds: geometry.bounds() };
        let source = Source::new(&self.file, &self.text)?;
        let reader = Reader::new(&source, ScenarioRecord::NAME, Limits::LAYOUT);
        let ScenarioRecord { person, steps, others, .. } = &self.written;
        let cast = std::iter::once((person, steps));
        let cast = cast.chain(others.iter().map(|other| (&other.person, &other.steps)));
        let root = reader.root("scenario");
        let other_nodes =
            root.and_then(|node| node.peek(ScenarioRecord::NAME, "others")?.list("other", MOST_OTHERS));
        let nodes = root.into_iter().chain(other_nodes.unwrap_or_default());
        let performances: Vec<Option<Performance>> = (0..)
            .zip(cast.zip(nodes))
            .map(|(number, ((person, steps), node))| stage.perform(person, steps, node, number))
            .collect();
        let script = performances.into_iter().collect::<Option<_>>();
        let (script, _) = reader.conclude(script.map(|all| Script::new(all, stage.bounds)))?;
        Ok(script)
    }
}

filed!(Scenario);

/// A scenario file. Messages of a scenario that an app has read by serde call its file `Scenario`.
impl Filed for Scenario {
    fn written(&self) -> RonText {
        Rec.write(&self.written)
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        Self::parse(ScenarioRecord::NAME, text)
    }
}

/// Layout and floor that a scenario is resolved against.
struct Stage<'a> {
    layout: &'a Layout,
    geometry: &'a Geometry,
    bounds: Rect,
}

/// Position of a step in the file.
#[derive(Clone, Copy)]
struct Written<'r> {
    step: Node<'r>,
    name: &'static str,
}

impl Written<'_> {
    /// Reports a problem with the step's field of this name, or with the whole step.
    fn wrong(&self, field: &'static str, message: impl Into<String>, help: Option<String>) {
        let at = self.step.peek(self.name, field).unwrap_or(self.step);
        self.step.report(Problem::error(at.span(), message).help_if(help));
    }
}

impl Stage<'_> {
    /// Performs the steps of one person; `None` after reporting an impossible move.
    fn perform(
        &self,
        person: &PersonRecord,
        steps: &[Step],
        node: Node<'_>,
        number: u64,
    ) -> Option<Performance> {
        let owner = if number == 0 { ScenarioRecord::NAME } else { super::definition::Other::NAME };
        let nodes = node.peek(owner, "steps")?.list("step", MOST_STEPS)?;
        let mut performance = Performance::new(person.person(), number);
        // After an impossible move the later ones start from the wrong place, so only their names are still checked.
        let mut lost = false;
        for (index, (step, node)) in steps.iter().zip(nodes).enumerate() {
            let written = Written { step: node, name: step.variant() };
            if index > 0 && matches!(step, Step::Stand(_)) {
                written.wrong("", "Stand must be the first step; later on, Enter", None);
                lost = true;
            }
            match self.ready(step, written) {
                None => lost = true,
                Some(ready) if !lost => {
                    if let Err(error) = self.act(&mut performance, &ready) {
                        written.wrong("", error.to_string(), None);
                        lost = true;
                    }
                }
                Some(_) => {}
            }
        }
        (!lost).then_some(performance)
    }

    /// Looks up the step's names and places; `None` after reporting those that do not exist.
    fn ready(&self, step: &Step, written: Written<'_>) -> Option<Ready> {
        let middle = |id: &str| Some(self.widget(id, written)?.area.centre());
        let place = |at: Vec2| self.place(at, written.step.peek(written.name, "at")?);
        Some(match step {
            Step::Wait(step) => Ready::Wait(step.time),
            Step::Stand(step) => Ready::Stand(place(step.at)?, step.facing.heading()),
            Step::Enter(step) => Ready::Enter(step.from, place(step.at)?, step.facing.map(Side::heading)),
            Step::WalkTo(step) => {
                let via = written.step.peek(written.name, "via").and_then(|via| via.list("via", MOST_STEPS));
                let via = step.via.iter().zip(via.unwrap_or_default());
                let way: Vec<Option<Vec2>> = via
                    .map(|(point, node)| self.place(*point, node))
                    .chain(std::iter::once(place(step.at)))
                    .collect();
                Ready::Walk(way.into_iter().collect::<Option<_>>()?, step.facing.map(Side::heading))
            }
            Step::Sidestep(step) => Ready::Sidestep(place(step.at)?),
            Step::Turn(step) => Ready::Turn(step.to.heading()),
            Step::Press(step) => Ready::Press(middle(&step.widget)?, step.force, step.hold),
            Step::Tap(step) => Ready::Press(middle(&step.widget)?, step.force, TAP),
            Step::Point(step) => Ready::Press(place(step.at)?, step.force, step.hold),
            Step::Drag(step) => Ready::Drag(self.way(step, written)?, step.speed_m_s, step.force),
            Step::Leave(step) => Ready::Leave(step.to),
        })
    }

    fn act(&self, performance: &mut Performance, ready: &Ready) -> Result<(), MoveError> {
        match *ready {
            Ready::Wait(time) => {
                performance.wait(time);
                Ok(())
            }
            Ready::Stand(at, facing) => performance.appear(at, facing),
            Ready::Enter(from, at, facing) => {
                performance.appear(from.outside(self.bounds, at, BESIDE_M), from.opposite().heading())?;
                performance.walk(&[at])?;
                facing.map_or(Ok(()), |facing| performance.turn(facing))
            }
            Ready::Walk(ref way, facing) => {
                performance.walk(way)?;
                facing.map_or(Ok(()), |facing| performance.turn(facing))
            }
            Ready::Sidestep(at) => performance.sidestep(at),
            Ready::Turn(facing) => performance.turn(facing),
            Ready::Press(target, force, hold) => performance.press(target, force, hold),
            Ready::Drag(way, speed_m_s, force) => performance.drag(way, speed_m_s, force),
            Ready::Leave(to) => {
                let from = performance.place().ok_or(MoveError::NotThere)?;
                performance.walk(&[to.outside(self.bounds, from, BESIDE_M)])?;
                performance.disappear()
            }
        }
    }

    /// Converts the place `at` (tiles), written at `node`, to floor metres.
    fn place(&self, at: Vec2, node: Node<'_>) -> Option<Vec2> {
        let metres = self.geometry.metres_from_tiles(at);
        let is_there = self.bounds.contains(metres);
        if !is_there {
            let message = format!("({}, {}) is not on this floor of {}", at.x, at.y, self.geometry.block());
            node.report(Problem::error(node.span(), message));
        }
        is_there.then_some(metres)
    }

    fn widget(&self, id: &str, written: Written<'_>) -> Option<&Widget> {
        let widgets = &self.layout.widgets;
        let found = widgets.iter().find(|widget| widget.id == id);
        if found.is_none() {
            let ids: Vec<&str> = widgets.iter().map(|widget| widget.id.as_str()).collect();
            let help = did_you_mean(id, &ids, '"').unwrap_or_else(|| "it has no controls at all".to_owned());
            written.wrong("widget", format!("the layout has no control \"{id}\""), Some(help));
        }
        found
    }
}

/// A step with its names and places resolved.
enum Ready {
    Wait(Duration),
    Stand(Vec2, f32),
    Enter(Side, Vec2, Option<f32>),
    Walk(Vec<Vec2>, Option<f32>),
    Sidestep(Vec2),
    Turn(f32),
    Press(Vec2, Newtons, Duration),
    Drag(Slide, f32, Newtons),
    Leave(Side),
}
