//! Scenarios: files that say what people do on a floor, tied to a layout and played.

use std::fmt;
use std::time::Duration;

use glam::Vec2;

use super::definition::{PersonFields, Places, ScenarioDefinition, ScenarioProblem, Side, Step, read};
use super::performance::Performance;
use super::person::{MoveError, Person};
use super::script::Script;
use crate::floor::{Geometry, Rect};
use crate::layout::{Layout, Widget};
use crate::units::Newtons;
use crate::widget::Behaviour;

/// A scenario file, read and its numbers checked, not yet tied to a layout.
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
///         // Along the slider's axis, in shares of its travel. 0.3 m/s and 80 N may be left out.
///         Drag(widget: "zoom", from: 0.2, to: 0.8, speed_m_s: 0.3, force_n: 80),
///         // As Press, on a bare place.
///         Point(at: (2.0, 3.0), force_n: 120, hold_ms: 300),
///         // By small steps, looking where one looked before.
///         Sidestep(at: (3.5, 0.6)),
///         Turn(to: East),
///         Leave(to: East),
///     ],
///     // More people at the same time; each has a person and steps of its own.
///     // What goes wrong on the way of the packets, as the option `--fault` has it.
///     faults: ["loss=1%", "board=2:10s..12s"],
///     others: [(person: (mass_kg: 55), steps: [Stand(at: (5, 5), facing: South), Wait(ms: 9000)])],
/// )
/// ```
///
/// Places are in tiles (1.0 = one tile pitch) from the south-west corner.
/// `Stand` is for somebody who is on the floor from the first moment, so it comes first or not at all.
///
/// Who presses stands on the other foot, which stays where it is, so a control
/// must lie within reach (about 0.85 m) and not under the feet. The foot comes
/// back after each press; a press with nothing to wait for takes about two seconds.
#[derive(Clone, Debug)]
pub struct Scenario {
    title: String,
    file: String,
    cast: Vec<Performer>,
    faults: Vec<String>,
}

#[derive(Clone, Debug)]
struct Performer {
    body: PersonFields,
    steps: Vec<(Step, Places)>,
}

/// Everything wrong with a scenario: a line for each problem, as `file:line:column: message`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenarioError {
    /// The file, as it was named when it was read.
    pub file: String,
    /// At least one problem.
    pub problems: Vec<ScenarioProblem>,
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, ScenarioProblem { line, column, message }) in self.problems.iter().enumerate() {
            let end = if index + 1 < self.problems.len() { "\n" } else { "" };
            write!(f, "{}:{line}:{column}: {message}{end}", self.file)?;
        }
        Ok(())
    }
}

impl std::error::Error for ScenarioError {}

/// How far beside the floor people come from and go to, in metres: one and a half steps.
const BESIDE_M: f32 = 1.0;

/// How long a tap stays on its place.
const TAP: Duration = Duration::from_millis(60);

impl Scenario {
    /// The built-in scenario of somebody who crosses the floor and touches no control; fits floors of 4 x 3 tiles and more.
    pub const CROSSING: &str = include_str!("scenarios/crossing.ron");

    /// The built-in session on the shipped layout `map`: walk on, press a button, drag a slider, flip a switch, walk off.
    pub const SESSION: &str = include_str!("scenarios/session.ron");

    /// The built-in scenario for layouts without controls: a stroll over the floor and back; fits floors of 6 x 5 tiles and more.
    pub const STROLL: &str = include_str!("scenarios/stroll.ron");

    /// The scenario written in `text`; `file` is what messages call it.
    ///
    /// # Errors
    /// [`ScenarioError`] with the place of what is not RON, not a field, or out of range.
    pub fn parse(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let (definition, places) =
            read(text).map_err(|problems| ScenarioError { file: file.into(), problems })?;
        let ScenarioDefinition { title, person, steps, others, faults } = definition;
        let cast = std::iter::once((person, steps))
            .chain(others.into_iter().map(|other| (other.person, other.steps)));
        let cast = cast
            .zip(places)
            .map(|((body, steps), places)| Performer { body, steps: steps.into_iter().zip(places).collect() })
            .collect();
        Ok(Self { title, file: file.into(), cast, faults })
    }

    /// What people call it.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// What goes wrong with the packets meanwhile, as `--fault` has it.
    #[must_use]
    pub fn faults(&self) -> &[String] {
        &self.faults
    }

    /// The scenario played on this layout and floor.
    ///
    /// # Errors
    /// [`ScenarioError`] with every control that the layout doesn't have and every
    /// place that is not on the floor, and for each person the first move that nobody could make.
    pub fn resolve(&self, layout: &Layout, geometry: &Geometry) -> Result<Script, ScenarioError> {
        let stage = Stage { layout, geometry, bounds: geometry.bounds() };
        let mut problems = Vec::new();
        let mut performances = Vec::new();
        for (number, performer) in self.cast.iter().enumerate() {
            match stage.perform(performer, number as u64) {
                Ok(performance) => performances.push(performance),
                Err(found) => problems.extend(found),
            }
        }
        if problems.is_empty() {
            Ok(Script::new(performances, stage.bounds))
        } else {
            Err(ScenarioError { file: self.file.clone(), problems })
        }
    }
}

/// What a scenario is played on.
struct Stage<'a> {
    layout: &'a Layout,
    geometry: &'a Geometry,
    bounds: Rect,
}

impl Stage<'_> {
    fn perform(&self, performer: &Performer, number: u64) -> Result<Performance, Vec<ScenarioProblem>> {
        let PersonFields { mass_kg, foot_m, speed_m_s } = performer.body;
        let person = Person { mass_kg, foot_length_m: foot_m, speed_m_s, ..Person::default() };
        let mut performance = Performance::new(person, number);
        let mut problems = Vec::new();
        // After a move that cannot be made the later ones start from the wrong place: names are still checked.
        let mut lost = false;
        for (index, (step, places)) in performer.steps.iter().enumerate() {
            if index > 0 && matches!(step, Step::Stand { .. }) {
                problems.push(places.of("").problem("Stand must be the first step; later on, Enter".into()));
                lost = true;
            }
            match self.ready(step, places) {
                Err(problem) => {
                    problems.push(problem);
                    lost = true;
                }
                Ok(ready) if !lost => {
                    if let Err(error) = self.act(&mut performance, &ready) {
                        problems.push(places.of("").problem(error.to_string()));
                        lost = true;
                    }
                }
                Ok(_) => {}
            }
        }
        if problems.is_empty() { Ok(performance) } else { Err(problems) }
    }

    /// The step with its names and places looked up.
    fn ready(&self, step: &Step, places: &Places) -> Result<Ready, ScenarioProblem> {
        let widget = |id: &str| self.widget(id).map_err(|message| places.of("widget").problem(message));
        let place = |at: (f32, f32)| self.place(at).map_err(|message| places.of("at").problem(message));
        let hold = |ms: u32| Duration::from_millis(ms.into());
        Ok(match step {
            Step::Wait { ms } => Ready::Wait(hold(*ms)),
            Step::Stand { at, facing } => Ready::Stand(place(*at)?, facing.heading()),
            Step::Enter { from, at, facing } => Ready::Enter(*from, place(*at)?, facing.map(Side::heading)),
            Step::WalkTo { at, via, facing } => {
                let mut way = via
                    .iter()
                    .map(|point| self.place(*point).map_err(|message| places.of("via").problem(message)))
                    .collect::<Result<Vec<Vec2>, _>>()?;
                way.push(place(*at)?);
                Ready::Walk(way, facing.map(Side::heading))
            }
            Step::Sidestep { at } => Ready::Sidestep(place(*at)?),
            Step::Turn { to } => Ready::Turn(to.heading()),
            Step::Press { widget: id, force_n, hold_ms } => {
                Ready::Press(widget(id)?.area.centre(), Newtons(*force_n), hold(*hold_ms))
            }
            Step::Tap { widget: id, force_n } => {
                Ready::Press(widget(id)?.area.centre(), Newtons(*force_n), TAP)
            }
            Step::Point { at, force_n, hold_ms } => {
                Ready::Press(place(*at)?, Newtons(*force_n), hold(*hold_ms))
            }
            Step::Drag { widget: id, from, to, speed_m_s, force_n } => {
                let [from, to] = [*from, *to].map(|share| {
                    along(widget(id)?, share).map_err(|message| places.of("widget").problem(message))
                });
                Ready::Drag { from: from?, to: to?, speed_m_s: *speed_m_s, force: Newtons(*force_n) }
            }
            Step::Leave { to } => Ready::Leave(*to),
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
            Ready::Drag { from, to, speed_m_s, force } => performance.drag(from, to, speed_m_s, force),
            Ready::Leave(to) => {
                let from = performance.place().ok_or(MoveError::NotThere)?;
                performance.walk(&[to.outside(self.bounds, from, BESIDE_M)])?;
                performance.disappear()
            }
        }
    }

    fn place(&self, (x, y): (f32, f32)) -> Result<Vec2, String> {
        let at = self.geometry.metres_from_tiles(Vec2::new(x, y));
        if self.bounds.contains(at) {
            Ok(at)
        } else {
            let (columns, rows) = (self.geometry.columns(), self.geometry.rows());
            Err(format!("({x}, {y}) is not on this floor of {columns} x {rows} tiles"))
        }
    }

    fn widget(&self, id: &str) -> Result<&Widget, String> {
        let widgets = &self.layout.widgets;
        widgets.iter().find(|widget| widget.id == id).ok_or_else(|| {
            let likeness = |widget: &&Widget| strsim::jaro_winkler(widget.id.as_str(), id);
            let nearest = widgets.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
            let hint = match nearest {
                Some(nearest) if likeness(&nearest) > 0.7 => format!("; did you mean \"{}\"?", nearest.id),
                Some(nearest) => format!("; it has \"{}\", for one", nearest.id),
                None => "; it has no controls at all".into(),
            };
            format!("the layout has no control \"{id}\"{hint}")
        })
    }
}

/// A step whose names and places are known.
enum Ready {
    Wait(Duration),
    Stand(Vec2, f32),
    Enter(Side, Vec2, Option<f32>),
    Walk(Vec<Vec2>, Option<f32>),
    Sidestep(Vec2),
    Turn(f32),
    Press(Vec2, Newtons, Duration),
    Drag { from: Vec2, to: Vec2, speed_m_s: f32, force: Newtons },
    Leave(Side),
}

/// The place a share of the way along a slider's track.
fn along(widget: &Widget, share: f32) -> Result<Vec2, String> {
    let Behaviour::Slider(slider) = widget.behaviour else {
        return Err(format!("Drag needs a slider, and \"{}\" is a {}", widget.id, widget.kind));
    };
    let size = widget.area.size();
    Ok(widget.area.min + slider.track.place_at(share, size) * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::Feel;
    use crate::layout::{Colour, CursorRule, Look, Region, Shape};
    use crate::sim::{Foot, FootDriver};
    use crate::units::Instant;
    use crate::widget::{ButtonSpec, Scale, SliderSpec, Thresholds, WidgetId};

    fn layout() -> Layout {
        let thresholds = Thresholds::new(Newtons(40.0), Newtons(30.0));
        let slider = SliderSpec::new(thresholds, Scale::UNIT);
        let widget = |id, kind: &str, area, behaviour| Widget {
            id: WidgetId::new(id),
            kind: kind.into(),
            region: 0,
            page: None,
            goto: None,
            area,
            label: String::new(),
            behaviour,
            feel: Feel::default(),
            look: Look {
                shape: Shape::Box,
                face: Colour::default(),
                lit: Colour::default(),
                ink: Colour::default(),
                icon: None,
            },
        };
        let tiles = |x: f32, y: f32, w: f32, h: f32| {
            Rect::from_min_size(Vec2::new(x, y) * 0.304, Vec2::new(w, h) * 0.304)
        };
        let button = Behaviour::Button(ButtonSpec::new(thresholds));
        Layout {
            title: "Test".into(),
            regions: vec![Region {
                id: "all".into(),
                area: Geometry::default().bounds(),
                cursor: CursorRule::Largest,
            }],
            stances: Vec::new(),
            pages: Vec::new(),
            grounds: Vec::new(),
            widgets: vec![
                widget("zoom_in", "button", tiles(2.6, 1.6, 0.6, 0.6), button.clone()),
                widget("layers", "button", tiles(3.4, 1.6, 0.6, 0.6), button),
                widget("zoom", "slider", tiles(2.2, 2.4, 1.8, 0.5), Behaviour::Slider(slider)),
            ],
        }
    }

    fn parse(steps: &str) -> Result<Scenario, ScenarioError> {
        Scenario::parse("test.ron", &format!("Scenario(title: \"Test\", steps: [\n{steps}\n])"))
    }

    fn play(script: &mut Script) -> Vec<Vec<Foot>> {
        let mut feet = Vec::new();
        (0..).map_while(|ms| script.feet(Instant::from_millis(ms), &mut feet).then(|| feet.clone())).collect()
    }

    /// The block that the documentation shows.
    fn documented() -> String {
        let lines = include_str!("scenario.rs").lines();
        let block =
            lines.skip_while(|line| *line != "/// ```ron").skip(1).take_while(|line| *line != "/// ```");
        block.map(|line| format!("{}\n", line.trim_start_matches("///"))).collect()
    }

    #[test]
    fn the_documented_scenario_plays() {
        let scenario = Scenario::parse("documentation", &documented()).unwrap();
        assert_eq!(scenario.title(), "Zoom in, then wander off");
        let mut script = scenario.resolve(&layout(), &Geometry::default()).unwrap();
        let seconds = script.duration().as_secs_f32();
        assert!((20.0..40.0).contains(&seconds), "{seconds}");
        let frames = play(&mut script);
        assert_eq!(frames[0].len(), 2, "only the one who stands there from the start");
        assert!(frames.iter().any(|feet| feet.len() == 4));
    }

    #[test]
    fn somebody_crosses_the_floor() {
        let scenario = Scenario::parse("crossing.ron", Scenario::CROSSING).unwrap();
        let mut script = scenario.resolve(&layout(), &Geometry::default()).unwrap();
        let frames = play(&mut script);
        assert!(frames[0].is_empty() && frames.last().unwrap().is_empty());
        let columns: std::collections::BTreeSet<u16> = frames
            .iter()
            .flatten()
            .flat_map(|foot| foot.on_tiles(&Geometry::default()))
            .map(|load| load.tile.column)
            .collect();
        assert_eq!(columns.len(), 6, "{columns:?}");
    }

    #[test]
    fn presses_and_drags_meet_their_controls() {
        let layout = layout();
        let scenario = parse(
            "Stand(at: (3.0, 0.6)), Press(widget: \"zoom_in\", force_n: 120, hold_ms: 300),\
             Tap(widget: \"layers\", force_n: 90), Drag(widget: \"zoom\", from: 0.2, to: 0.8, force_n: 80),\
             Point(at: (2.0, 2.0), force_n: 70, hold_ms: 100)",
        );
        let mut script = scenario.unwrap().resolve(&layout, &Geometry::default()).unwrap();
        let frames = play(&mut script);
        let held = |force: f32| -> Vec<Foot> {
            // Held is what is pressed for longer than a moment.
            let steady = |pair: &[Vec<Foot>]| {
                pair[0]
                    .iter()
                    .zip(&pair[1])
                    .find(|(a, b)| a.force == b.force && (a.force.0 - force).abs() < 0.01)
                    .map(|(a, _)| *a)
            };
            frames.windows(2).filter_map(steady).collect()
        };
        let on = |id: &str| layout.widgets[layout.widget_index(id).unwrap()].area;
        for (id, force, millis) in [("zoom_in", 120.0, 300), ("layers", 90.0, 60)] {
            let feet = held(force);
            assert!((millis - 2..millis + 4).contains(&feet.len()), "{id} is held for {} ms", feet.len());
            assert!(
                feet.iter().all(|foot| foot.centre_of_pressure().distance(on(id).centre()) < 1e-4),
                "{id}"
            );
        }
        let drag = held(80.0);
        let share = |foot: &Foot| (foot.centre_of_pressure().x - on("zoom").min.x) / on("zoom").size().x;
        assert!((share(&drag[0]) - 0.2).abs() < 1e-3 && (share(drag.last().unwrap()) - 0.8).abs() < 1e-3);
        assert!(drag.iter().all(|foot| on("zoom").contains(foot.centre_of_pressure())));
        assert!(held(70.0)[0].centre_of_pressure().distance(Vec2::splat(2.0 * 0.304)) < 1e-4);
    }

    fn messages(steps: &str) -> String {
        match parse(steps).and_then(|scenario| scenario.resolve(&layout(), &Geometry::default())) {
            Err(error) => error.to_string(),
            Ok(_) => "no error".into(),
        }
    }

    #[test]
    fn mistakes_are_told_with_their_places_and_all_at_once() {
        let told = messages(
            "Stand(at: (3.0, 0.6)),\n  Press(widget: \"zom_in\"),\nDrag(widget: \"layers\", from: 0.1, to: 0.9),\n\
             WalkTo(at: (7, 2)),\nWalkTo(at: (1, 2), via: [(1, 1), (1, 9)]),",
        );
        insta::assert_snapshot!(told, @r#"
        test.ron:3:17: the layout has no control "zom_in"; did you mean "zoom_in"?
        test.ron:4:14: Drag needs a slider, and "layers" is a button
        test.ron:5:12: (7, 2) is not on this floor of 6 x 6 tiles
        test.ron:6:25: (1, 9) is not on this floor of 6 x 6 tiles
        "#);
    }

    #[test]
    fn typing_errors_speak_of_what_is_written() {
        let told = [
            messages("Pres(widget: \"zoom_in\")"),
            messages("Press(wiget: \"zoom_in\")"),
            messages("Press(widget: \"zoom_in\", force_n: -5)"),
            messages("Press(widget: \"zoom_in\", force_n: NaN)"),
            messages("Wait(ms: 700000)"),
            messages("Wait(ms: 5"),
            messages("Stand(at: (3, 1)), Stand(at: (3, 1))"),
            Scenario::parse("test.ron", "Scenario(title: \"Two\", person: (mass_kg: 900), steps: [])")
                .unwrap_err()
                .to_string(),
        ];
        insta::assert_snapshot!(told.join("\n"), @r#"
        test.ron:2:1: Unexpected variant named `Pres` in enum `step`, expected one of `Wait`, `Stand`, `Enter`, `WalkTo`, `Sidestep`, `Turn`, `Press`, `Tap`, `Drag`, `Point`, or `Leave` instead
        test.ron:2:7: Unexpected field named `wiget` in `Press`, expected one of `widget`, `force_n`, or `hold_ms` instead
        test.ron:2:35: force_n must be between 0 and 3000, not -5
        test.ron:2:35: force_n must be between 0 and 3000, not NaN
        test.ron:2:10: ms must be between 0 and 600000, not 700000
        test.ron:3:1: Expected comma
        test.ron:2:20: Stand must be the first step; later on, Enter
        test.ron:1:42: mass_kg must be between 10 and 300, not 900
        "#);
    }

    #[test]
    fn impossible_moves_are_told_at_their_step() {
        let told = [
            messages("Press(widget: \"zoom_in\")"),
            messages("Stand(at: (1.0, 5.0)),\nPress(widget: \"zoom_in\")"),
            messages("Stand(at: (3.0, 1.5)),\nPoint(at: (3.02, 1.5))"),
            messages("Stand(at: (3.0, 0.6)),\nPress(widget: \"zoom_in\", force_n: 1000)"),
        ];
        insta::assert_snapshot!(told.join("\n"), @r#"
        test.ron:2:1: the person is not on the floor: let it Enter first
        test.ron:3:1: the foot would have to reach 1.18 m from the one that stands, further than 0.85 m: WalkTo somewhere nearer first
        test.ron:3:1: the other foot stands there, 0.09 m away: WalkTo beside the place first
        test.ron:3:1: a person of 687 N cannot press with 1000 N
        "#);
    }

    #[test]
    fn every_beginning_of_a_scenario_is_an_error_and_never_a_panic() {
        let text = documented();
        for end in (0..text.trim_end().len()).filter(|&end| text.is_char_boundary(end)) {
            assert!(Scenario::parse("cut", &text[..end]).is_err(), "{end}");
        }
    }

    proptest::proptest! {
        #[test]
        fn a_slip_of_the_pen_never_panics(at in 0usize..1500, slip in "[(){}\\[\\],:.\"0-9a-z/*-]{0,3}") {
            let mut text: Vec<char> = documented().chars().collect();
            let at = at.min(text.len() - 1);
            text.splice(at..=at, slip.chars());
            let text: String = text.into_iter().collect();
            if let Ok(scenario) = Scenario::parse("slip", &text) {
                let _ = scenario.resolve(&layout(), &Geometry::default());
            }
        }
    }

    #[test]
    fn deep_nesting_and_huge_files_are_refused() {
        let deep = "(".repeat(100_000);
        assert!(parse(&deep).is_err());
        let huge = format!("{}\n{}", Scenario::CROSSING, " ".repeat(1 << 20));
        assert!(Scenario::parse("huge", &huge).is_err());
    }

    #[test]
    fn files_with_a_byte_order_mark_are_read() {
        assert!(Scenario::parse("bom", &format!("\u{feff}{}", Scenario::CROSSING)).is_ok());
    }
}
