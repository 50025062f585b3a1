//! Intended and unintended actions of controls: false activations by people who walk over them, and missed and wrong
//! presses by people who use them.

use std::collections::BTreeMap;
use std::fmt;
use std::fmt::Write;
use std::time::Duration;

use serde::Serialize;

use super::intent_act::{PlannedAct, Somebody};
use super::people::quality_note;
use super::rig::{ExperimentError, Rig};
use super::wilson::Counted;
use underfoot::engine::Engine;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Layout, Widget};
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};
use underfoot::sense::{Method, Sensing};
use underfoot::units::Instant;
use underfoot::widget::{Behaviour, Confirm, EventKind, Guard, HoldToRun, WidgetEvent};
use underfoot_sim::{FloorQuality, Load};

/// Force above which a foot counts as down (N).
const DOWN_N: f32 = 20.0;

/// Time that the floor is empty between two acts (ms).
const PAUSE_MS: u32 = 300;

/// Number of crossings in a row, and number of presses before a person leaves.
const CROSSINGS: usize = 6;
const PRESSES: usize = 12;

/// Counts of intended and unintended actions, for one kind of control and guard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct IntentScore {
    /// Number of intended presses.
    pub intended: u64,
    /// Number of intended presses without an effect.
    pub missed: u64,
    /// Number of intended presses that made another control act, or the same one act twice.
    pub wrong: u64,
    /// Number of actions of a control without an intended press.
    pub false_activations: u64,
    /// Number of unintended presses that were cancelled before they had an effect.
    pub taken_back: u64,
}

impl IntentScore {
    fn add(&mut self, other: &Self) {
        let Self { intended, missed, wrong, false_activations, taken_back } = other;
        self.intended += intended;
        self.missed += missed;
        self.wrong += wrong;
        self.false_activations += false_activations;
        self.taken_back += taken_back;
    }
}

/// Guard of a layout's controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Guarded {
    /// Unguarded.
    Free,
    /// Armed by a first press.
    Confirm,
    /// Acting while held.
    HoldToRun,
}

impl Guarded {
    /// All guards, in the order of the table.
    pub const ALL: [Self; 3] = [Self::Free, Self::Confirm, Self::HoldToRun];

    const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Confirm => "confirm",
            Self::HoldToRun => "hold to run",
        }
    }

    fn of(widget: &Widget) -> Self {
        match widget.behaviour.thresholds().guard {
            Guard::Free => Self::Free,
            Guard::Confirm { .. } => Self::Confirm,
            Guard::HoldToRun { .. } => Self::HoldToRun,
        }
    }

    /// Returns `layout` with this guard on its buttons (for Confirm, also on its switches); thresholds stay the same.
    fn put_on(self, layout: &Layout) -> Layout {
        let mut layout = layout.clone();
        let guard = match self {
            Self::Free => return layout,
            Self::Confirm => Guard::Confirm(Confirm { within: Duration::from_secs(3) }),
            Self::HoldToRun => Guard::HoldToRun(HoldToRun { max: Duration::from_secs(60), warn: None }),
        };
        for widget in &mut layout.widgets {
            if widget.behaviour.thresholds().guard != Guard::Free {
                continue;
            }
            match &mut widget.behaviour {
                Behaviour::Button(button) => {
                    button.thresholds.guard = guard;
                    if self == Self::Confirm {
                        // As in a real layout: a confirmation already takes two presses.
                        button.gestures.double_tap = None;
                    }
                }
                Behaviour::Switch(switch) if self == Self::Confirm => switch.thresholds.guard = guard,
                _ => {}
            }
        }
        layout
    }
}

/// Results of the controls of shipped layouts, by kind and guard.
///
/// Each layout is tried with its own guards, with its buttons and switches guarded by `Confirm`, and with its buttons
/// guarded by `HoldToRun`, all with their own thresholds. The crossings are the same for all three; the uses differ
/// for each guard. These events count as actions: a button's click, a switch's change, and the press of any control
/// that follows the foot or acts while held.
#[derive(Clone, Debug, PartialEq)]
pub struct IntentTable {
    floor: FloorQuality,
    scores: BTreeMap<(String, Guarded), IntentScore>,
    /// Number of steps on floors with each guard.
    steps: [u64; 3],
    people: u64,
}

/// A table for the paper's floor.
impl Default for IntentTable {
    fn default() -> Self {
        Self::on(FloorQuality::Paper)
    }
}

/// Amount of activity of one person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntentEffort {
    /// Number of steps over the layout.
    pub steps: u64,
    /// Number of intended presses.
    pub presses: u64,
}

impl IntentTable {
    /// Creates an empty table for floors of this quality. On floors with real errors ([`FloorQuality::REAL`]), feet
    /// roll like those of recorded people.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        Self { floor, scores: BTreeMap::new(), steps: [0; 3], people: 0 }
    }

    /// Simulates the person drawn from `seed` crossing and using one of the shipped layouts, on a floor with parts
    /// drawn from `seed` too; `number` selects the layout and the person's walking speed.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`]; [`ExperimentError::Layout`] and [`ExperimentError::Move`], which no seed should
    /// cause.
    pub fn add_person(
        &mut self,
        seed: u64,
        number: u64,
        effort: IntentEffort,
    ) -> Result<(), ExperimentError> {
        let geometry = Geometry::default();
        let number = number as usize;
        let layout = shipped(number, &geometry)?;
        let layouts = Guarded::ALL.map(|guard| guard.put_on(&layout));
        let mut stage = IntentStage::new(self.floor, seed)?;
        let mut body = Somebody::of(seed, number / layouts_with_controls().count(), geometry.bounds())
            .rolling(self.floor.is_real());
        let area =
            layout.regions.iter().map(|region| region.area).reduce(joined).unwrap_or(geometry.bounds());

        let trial =
            |(guard, layout): (Guarded, &Layout)| IntentTrial::new(stage.engine(layout.clone()), guard);
        let mut trials: Vec<IntentTrial> = Guarded::ALL.into_iter().zip(&layouts).map(trial).collect();
        let mut walked = 0;
        while walked < effort.steps {
            for _ in 0..CROSSINGS {
                let act = body.cross(area)?;
                walked += stage.play(&act, &mut trials);
            }
        }
        for (guard, mut trial) in Guarded::ALL.into_iter().zip(trials) {
            let mut pressed = 0;
            // A third of the presses for each guard.
            while pressed < effort.presses.div_ceil(3) {
                let page = trial.engine.layout().clone();
                let wanted = |widget: &Widget| {
                    widget.goto.is_none()
                        && widget.is_on(0)
                        && !is_stood_upon(widget)
                        && Guarded::of(widget) == guard
                };
                let act = body.make_use(&page, wanted, PRESSES)?;
                if act.intended.is_empty() {
                    break;
                }
                pressed += act.intended.len() as u64;
                stage.play(&act, std::slice::from_mut(&mut trial));
            }
            self.steps[guard as usize] += trial.steps;
            for (key, score) in trial.scores {
                self.scores.entry(key).or_default().add(&score);
            }
        }
        self.people += 1;
        Ok(())
    }

    /// Adds all people of another table.
    pub fn append(&mut self, other: Self) {
        for (key, score) in other.scores {
            self.scores.entry(key).or_default().add(&score);
        }
        for (steps, others) in self.steps.iter_mut().zip(other.steps) {
            *steps += others;
        }
        self.people += other.people;
    }

    /// Returns the number of steps on floors with this guard.
    #[must_use]
    pub fn steps(&self, guard: Guarded) -> u64 {
        self.steps[guard as usize]
    }

    /// Returns the sum over all kinds with one guard.
    #[must_use]
    pub fn whole(&self, guard: Guarded) -> IntentScore {
        let mut whole = IntentScore::default();
        self.scores.iter().filter(|((_, of), _)| *of == guard).for_each(|(_, score)| whole.add(score));
        whole
    }

    /// Returns all lines, for programs: each kind and guard, then all kinds of each guard.
    pub fn lines(&self) -> impl Iterator<Item = IntentLine> + '_ {
        let kinds = self.scores.iter().map(|((kind, guard), score)| (kind.clone(), *guard, *score));
        let wholes = Guarded::ALL.into_iter().map(|guard| ("all".to_owned(), guard, self.whole(guard)));
        kinds.chain(wholes).map(|(kind, guard, score)| IntentLine {
            steps: self.steps(guard),
            kind,
            guard,
            score,
        })
    }

    /// Returns all lines as CSV with a header line.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "kind,guard,steps,false_activations,taken_back,false_per_1000,false_low,false_high,\
             intended,missed,missed_per_1000,missed_low,missed_high,wrong,wrong_per_1000,wrong_low,wrong_high\n",
        );
        for line in self.lines() {
            let IntentLine { kind, guard, steps, score } = &line;
            let [falsely, missed, wrong] = [line.falsely(), line.missed(), line.wrong()].map(|counted| {
                let (low, high) = counted.wilson_95();
                format!("{:.3},{:.3},{:.3}", 1e3 * counted.share(), 1e3 * low, 1e3 * high)
            });
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "{kind},{},{steps},{},{},{falsely},{},{},{missed},{},{wrong}",
                guard.name(),
                score.false_activations,
                score.taken_back,
                score.intended,
                score.missed,
                score.wrong
            );
        }
        text
    }
}

/// One line of an [`IntentTable`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IntentLine {
    /// Name of the kind of control, or `all`.
    pub kind: String,
    /// Guard of the control.
    pub guard: Guarded,
    /// Number of steps on floors with this guard.
    pub steps: u64,
    /// Results of these steps and of the intended presses.
    #[serde(flatten)]
    pub score: IntentScore,
}

impl IntentLine {
    /// Returns the number of false activations out of all steps.
    #[must_use]
    pub fn falsely(&self) -> Counted {
        Counted { hits: self.score.false_activations, of: self.steps }
    }

    /// Returns the number of missed presses out of all intended ones.
    #[must_use]
    pub fn missed(&self) -> Counted {
        Counted { hits: self.score.missed, of: self.score.intended }
    }

    /// Returns the number of wrong presses out of all intended ones.
    #[must_use]
    pub fn wrong(&self) -> Counted {
        Counted { hits: self.score.wrong, of: self.score.intended }
    }
}

impl fmt::Display for IntentTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "shipped layouts on a floor of 6 x 6 tiles{}, {} people of 45 to 120 kg at three speeds;\n\
             per 1000, with the interval that holds the truth 95 times in 100 (Wilson)",
            quality_note(self.floor),
            self.people
        )?;
        writeln!(
            f,
            "                                   false activations                            missed               wrong"
        )?;
        writeln!(
            f,
            "guard       kind            steps         per 1000 steps  taken back  meant        per 1000            per 1000"
        )?;
        for line in self.lines() {
            let IntentLine { kind, guard, steps, score } = &line;
            writeln!(
                f,
                "{:12}{kind:14}{steps:7}   {}{:12}{:7}{}{}",
                guard.name(),
                line.falsely(),
                score.taken_back,
                score.intended,
                line.missed(),
                line.wrong()
            )?;
        }
        Ok(())
    }
}

/// An engine, and the scores of the people's actions on it.
#[derive(Debug)]
pub(super) struct IntentTrial {
    pub(super) engine: Engine,
    pub(super) scores: BTreeMap<(String, Guarded), IntentScore>,
    pub(super) steps: u64,
    /// Guard of the controls that count.
    guard: Guarded,
    /// Number of actions of each intended press in the current act.
    done: Vec<u32>,
    /// Unintended presses that have not ended, by control.
    unwanted: Vec<usize>,
}

impl IntentTrial {
    pub(super) fn new(engine: Engine, guard: Guarded) -> Self {
        Self { engine, scores: BTreeMap::new(), steps: 0, guard, done: Vec::new(), unwanted: Vec::new() }
    }

    /// Sum over all kinds.
    pub(super) fn whole(&self) -> IntentScore {
        let mut whole = IntentScore::default();
        self.scores.values().for_each(|score| whole.add(score));
        whole
    }

    fn take(&mut self, event: &WidgetEvent, since: Duration, act: &PlannedAct) {
        let Some(widget) = self.engine.layout().widget_index(event.id.as_str()) else { return };
        let spec = &self.engine.layout().widgets[widget];
        if Guarded::of(spec) != self.guard {
            return;
        }
        let key = (spec.kind.clone(), Guarded::of(spec));
        let acted = acts(event.kind, spec);
        let meant = act.intended.iter().position(|intended| (intended.from..intended.to).contains(&since));
        match meant {
            Some(meant) if act.intended[meant].widget == widget => self.done[meant] += u32::from(acted),
            Some(meant) if acted => {
                let meant = &self.engine.layout().widgets[act.intended[meant].widget];
                let key = (meant.kind.clone(), Guarded::of(meant));
                self.scores.entry(key).or_default().wrong += 1;
            }
            Some(_) => {}
            None => {
                let score = self.scores.entry(key).or_default();
                score.false_activations += u64::from(acted);
                match event.kind {
                    EventKind::Pressed if !acted => self.unwanted.push(widget),
                    EventKind::Cancelled if self.unwanted.contains(&widget) => score.taken_back += 1,
                    _ => {}
                }
                if !matches!(event.kind, EventKind::Pressed) {
                    self.unwanted.retain(|&other| other != widget);
                }
            }
        }
    }

    fn conclude(&mut self, act: &PlannedAct) {
        for (intended, &done) in act.intended.iter().zip(&self.done) {
            let spec = &self.engine.layout().widgets[intended.widget];
            let score = self.scores.entry((spec.kind.clone(), Guarded::of(spec))).or_default();
            score.intended += 1;
            score.missed += u64::from(done == 0);
            score.wrong += u64::from(done > 1);
        }
    }
}

/// True if people stand on the control instead of pressing it.
fn is_stood_upon(widget: &Widget) -> bool {
    matches!(widget.behaviour, Behaviour::Lean(_))
}

/// True if an event of this kind counts as an action of the control.
fn acts(kind: EventKind, widget: &Widget) -> bool {
    let held = matches!(widget.behaviour.thresholds().guard, Guard::HoldToRun { .. });
    match widget.behaviour {
        Behaviour::Button(_) if !held => kind == EventKind::Clicked,
        Behaviour::Switch(_) if !held => matches!(kind, EventKind::Changed(_)),
        Behaviour::Selector(_) if !held => kind == EventKind::Released,
        _ => kind == EventKind::Pressed,
    }
}

/// A floor and its sensing, shared by all trials on it.
#[derive(Debug)]
pub(super) struct IntentStage {
    rig: Rig,
    sensing: Sensing,
}

impl IntentStage {
    pub(super) fn new(floor: FloorQuality, seed: u64) -> Result<Self, ExperimentError> {
        let rig = Rig::of_quality(Geometry::default(), floor, seed)?;
        Ok(Self { sensing: rig.sensing(Method::Tracker), rig })
    }

    pub(super) fn engine(&self, layout: Layout) -> Engine {
        self.rig.engine(layout, Method::Tracker)
    }

    pub(super) fn geometry(&self) -> Geometry {
        *self.rig.geometry()
    }

    /// Plays an act to every trial at once, and returns the number of steps: touchdowns outside intended presses.
    pub(super) fn play(&mut self, act: &PlannedAct, trials: &mut [IntentTrial]) -> u64 {
        let bounds = self.geometry().bounds();
        for trial in trials.iter_mut() {
            trial.done.clear();
            trial.done.resize(act.intended.len(), 0);
        }
        let (mut loads, mut down, mut steps, mut empty_ms) = (Vec::<Load>::new(), 0, 0, 0);
        let length = act.script.duration().as_millis() as u32;
        for milli in 1..=length + PAUSE_MS {
            let since = Duration::from_millis(milli.into());
            loads.clear();
            if milli <= length {
                act.script.loads_at(Instant::START + since, &mut loads);
            }
            // A floor that stays empty produces no more events.
            empty_ms = if loads.is_empty() { empty_ms + 1 } else { 0 };
            if empty_ms > PAUSE_MS {
                continue;
            }
            let on_floor = |load: &&Load| load.force.0 > DOWN_N && bounds.contains(load.centre_of_pressure());
            let now_down = loads.iter().filter(on_floor).count();
            let meant = act.intended.iter().any(|intended| (intended.from..intended.to).contains(&since));
            steps += if meant { 0 } else { now_down.saturating_sub(down) as u64 };
            down = now_down;
            self.rig.step(loads.iter().copied(), |frame| {
                let contacts = self.sensing.update(frame);
                for trial in trials.iter_mut() {
                    let events = trial.engine.step_given(frame, contacts).events.to_vec();
                    events.iter().for_each(|event| trial.take(event, since, act));
                }
            });
        }
        for trial in trials.iter_mut() {
            trial.steps += steps;
            trial.conclude(act);
        }
        steps
    }
}

/// The shipped layouts with controls to press.
fn layouts_with_controls() -> impl Iterator<Item = &'static str> {
    let has_controls = |name: &&str| builtin_layout(name).is_some_and(|text| text.contains("widgets:"));
    builtin_layouts().filter(has_controls)
}

/// Returns one of them, in a cycle.
fn shipped(number: usize, geometry: &Geometry) -> Result<Layout, ExperimentError> {
    let count = layouts_with_controls().count().max(1);
    let name = layouts_with_controls().nth(number % count).unwrap_or_default();
    let text = builtin_layout(name).unwrap_or_default();
    let loaded = parse_layout(text, name, &Kinds::builtin(), geometry);
    loaded.map(|loaded| loaded.layout).map_err(|problems| ExperimentError::Layout(problems.to_string()))
}

fn joined(one: Rect, other: Rect) -> Rect {
    Rect::new(one.min.min(other.min), one.max.max(other.max))
}
