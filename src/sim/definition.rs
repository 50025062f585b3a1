//! Scenario files as people write them, and where each step stands in the file.

use std::f32::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use glam::Vec2;
use ron::Options;
use ron::extensions::Extensions;
use ron2::ast::{Expr, StructBody, StructField, parse_document};
use serde::Deserialize;

use crate::floor::Rect;

/// A whole file.
#[derive(Debug, Deserialize)]
#[serde(rename = "Scenario", deny_unknown_fields)]
pub(super) struct ScenarioDefinition {
    pub(super) title: String,
    #[serde(default)]
    pub(super) person: PersonFields,
    pub(super) steps: Vec<Step>,
    #[serde(default)]
    pub(super) others: Vec<Other>,
    #[serde(default)]
    pub(super) faults: Vec<String>,
}

/// Somebody else on the same floor.
#[derive(Debug, Deserialize)]
#[serde(rename = "Other", deny_unknown_fields)]
pub(super) struct Other {
    #[serde(default)]
    pub(super) person: PersonFields,
    pub(super) steps: Vec<Step>,
}

/// One problem and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenarioProblem {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// What is wrong and what to do about it.
    pub message: String,
}

/// A person's measures.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename = "person", deny_unknown_fields, default)]
pub(super) struct PersonFields {
    pub(super) mass_kg: f32,
    pub(super) foot_m: f32,
    pub(super) speed_m_s: f32,
}

impl Default for PersonFields {
    fn default() -> Self {
        let person = super::Person::default();
        Self { mass_kg: person.mass_kg, foot_m: person.foot_length_m, speed_m_s: person.speed_m_s }
    }
}

/// A side of the floor, or the way somebody looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename = "side")]
pub(super) enum Side {
    North,
    East,
    South,
    West,
}

/// One step of a performance; each begins when the one before has ended.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename = "step", deny_unknown_fields)]
pub(super) enum Step {
    Wait {
        ms: u32,
    },
    Stand {
        at: (f32, f32),
        #[serde(default = "north")]
        facing: Side,
    },
    Enter {
        from: Side,
        at: (f32, f32),
        #[serde(default)]
        facing: Option<Side>,
    },
    WalkTo {
        at: (f32, f32),
        #[serde(default)]
        via: Vec<(f32, f32)>,
        #[serde(default)]
        facing: Option<Side>,
    },
    Sidestep {
        at: (f32, f32),
    },
    Turn {
        to: Side,
    },
    Press {
        widget: String,
        #[serde(default = "pressing")]
        force_n: f32,
        #[serde(default = "holding")]
        hold_ms: u32,
    },
    Tap {
        widget: String,
        #[serde(default = "pressing")]
        force_n: f32,
    },
    Drag {
        widget: String,
        from: f32,
        to: f32,
        #[serde(default = "sliding")]
        speed_m_s: f32,
        #[serde(default = "dragging")]
        force_n: f32,
    },
    Point {
        at: (f32, f32),
        #[serde(default = "pressing")]
        force_n: f32,
        #[serde(default = "holding")]
        hold_ms: u32,
    },
    Leave {
        to: Side,
    },
}

fn north() -> Side {
    Side::North
}

fn pressing() -> f32 {
    120.0
}

fn holding() -> u32 {
    300
}

fn sliding() -> f32 {
    0.3
}

fn dragging() -> f32 {
    80.0
}

/// Longest wait or hold, in milliseconds: ten minutes.
const LONGEST_MS: u32 = 600_000;

/// Files larger than this are not scenarios, in bytes.
const LARGEST_FILE: usize = 1 << 20;

/// A number in a file, and what it may be.
type Number = (&'static str, f32, RangeInclusive<f32>);

impl PersonFields {
    fn numbers(&self) -> [Number; 3] {
        [
            ("mass_kg", self.mass_kg, 10.0..=300.0),
            ("foot_m", self.foot_m, 0.1..=0.4),
            ("speed_m_s", self.speed_m_s, 0.4..=2.0),
        ]
    }
}

impl Step {
    fn numbers(&self) -> Vec<Number> {
        let force = |force_n: f32| ("force_n", force_n, 0.0..=3000.0);
        let millis = |name, ms: u32| (name, ms as f32, 0.0..=LONGEST_MS as f32);
        // That places are on the floor is checked where the floor is known.
        let place = |name, (x, y): (f32, f32)| [(name, x, -1e4..=1e4), (name, y, -1e4..=1e4)];
        match *self {
            Self::Wait { ms } => vec![millis("ms", ms)],
            Self::Stand { at, .. } | Self::Enter { at, .. } | Self::Sidestep { at } => place("at", at).into(),
            Self::WalkTo { at, ref via, .. } => {
                let mut numbers: Vec<Number> = via.iter().flat_map(|&point| place("via", point)).collect();
                numbers.extend(place("at", at));
                numbers
            }
            Self::Turn { .. } | Self::Leave { .. } => Vec::new(),
            Self::Press { force_n, hold_ms, .. } => vec![force(force_n), millis("hold_ms", hold_ms)],
            Self::Tap { force_n, .. } => vec![force(force_n)],
            Self::Drag { from, to, speed_m_s, force_n, .. } => vec![
                ("from", from, 0.0..=1.0),
                ("to", to, 0.0..=1.0),
                ("speed_m_s", speed_m_s, 0.01..=2.0),
                force(force_n),
            ],
            Self::Point { at, force_n, hold_ms } => {
                let mut numbers = vec![force(force_n), millis("hold_ms", hold_ms)];
                numbers.extend(place("at", at));
                numbers
            }
        }
    }
}

impl Side {
    /// The heading of somebody who looks that way, in radians counter-clockwise from north.
    pub(super) fn heading(self) -> f32 {
        match self {
            Self::North => 0.0,
            Self::East => -FRAC_PI_2,
            Self::South => 2.0 * FRAC_PI_2,
            Self::West => FRAC_PI_2,
        }
    }

    /// The place `distance` metres off this side of the floor, straight out from `point`.
    pub(super) fn outside(self, bounds: Rect, point: Vec2, distance: f32) -> Vec2 {
        match self {
            Self::North => Vec2::new(point.x, bounds.max.y + distance),
            Self::East => Vec2::new(bounds.max.x + distance, point.y),
            Self::South => Vec2::new(point.x, bounds.min.y - distance),
            Self::West => Vec2::new(bounds.min.x - distance, point.y),
        }
    }

    pub(super) fn opposite(self) -> Self {
        match self {
            Self::North => Self::South,
            Self::East => Self::West,
            Self::South => Self::North,
            Self::West => Self::East,
        }
    }
}

/// Line and column, from 1; columns count bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) line: usize,
    pub(super) column: usize,
}

impl Place {
    pub(super) fn problem(self, message: String) -> ScenarioProblem {
        ScenarioProblem { line: self.line, column: self.column, message }
    }
}

/// Where one step stands: itself, and its fields' values.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    step: Place,
    fields: Vec<(String, Place)>,
}

impl Places {
    /// The place of a field's value, or of the step if it doesn't have that field.
    pub(super) fn of(&self, field: &str) -> Place {
        self.fields.iter().find(|(name, _)| name == field).map_or(self.step, |(_, place)| *place)
    }
}

/// A file read and each number in it checked, with the places of all steps: the first person's, then the others'.
pub(super) fn read(text: &str) -> Result<(ScenarioDefinition, Vec<Vec<Places>>), Vec<ScenarioProblem>> {
    if text.len() > LARGEST_FILE {
        return Err(vec![Place { line: 1, column: 1 }.problem("the file is larger than 1 MB".into())]);
    }
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let options = Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    let definition: ScenarioDefinition = options.from_str(text).map_err(|error| {
        let start = error.span.start;
        vec![Place { line: start.line, column: start.col }.problem(error.code.to_string())]
    })?;
    let document = parse_document(text).map_err(|error| {
        let start = error.span().start;
        vec![Place { line: start.line, column: start.col }.problem(error.to_string())]
    })?;
    let root = document.value.as_ref().map(fields).unwrap_or_default();
    let mut casts = vec![places_of_steps(root)];
    let mut bodies = vec![(definition.person, places_of(field(root, "person")))];
    let others = field(root, "others").map(items).unwrap_or_default();
    for (other, expr) in definition.others.iter().zip(others) {
        casts.push(places_of_steps(fields(expr)));
        bodies.push((other.person, places_of(field(fields(expr), "person"))));
    }
    let mut problems = Vec::new();
    for (body, places) in &bodies {
        problems.extend(body.numbers().into_iter().filter_map(|number| out_of_range(number, places)));
    }
    let scripts =
        std::iter::once(&definition.steps).chain(definition.others.iter().map(|other| &other.steps));
    for (steps, places) in scripts.zip(&casts) {
        for (step, places) in steps.iter().zip(places) {
            problems.extend(step.numbers().into_iter().filter_map(|number| out_of_range(number, places)));
        }
    }
    if problems.is_empty() { Ok((definition, casts)) } else { Err(problems) }
}

fn out_of_range((name, value, range): Number, places: &Places) -> Option<ScenarioProblem> {
    let (low, high) = (range.start(), range.end());
    (!range.contains(&value))
        .then(|| places.of(name).problem(format!("{name} must be between {low} and {high}, not {value}")))
}

fn places_of_steps(performer: &[StructField<'_>]) -> Vec<Places> {
    let steps = field(performer, "steps").map(items).unwrap_or_default();
    steps.into_iter().map(|step| places_of(Some(step))).collect()
}

fn places_of(expr: Option<&Expr<'_>>) -> Places {
    let Some(expr) = expr else { return Places::default() };
    let named = |field: &StructField<'_>| (field.name.name.to_string(), place(&field.value));
    Places { step: place(expr), fields: fields(expr).iter().map(named).collect() }
}

fn place(expr: &Expr<'_>) -> Place {
    let start = expr.span().start;
    Place { line: start.line, column: start.col }
}

fn fields<'a>(expr: &'a Expr<'a>) -> &'a [StructField<'a>] {
    match expr {
        Expr::AnonStruct(written) => &written.fields,
        Expr::Struct(written) => match &written.body {
            Some(StructBody::Fields(body)) => &body.fields,
            _ => &[],
        },
        _ => &[],
    }
}

fn field<'a>(fields: &'a [StructField<'a>], name: &str) -> Option<&'a Expr<'a>> {
    fields.iter().find(|field| field.name.name == name).map(|field| &field.value)
}

fn items<'a>(expr: &'a Expr<'a>) -> Vec<&'a Expr<'a>> {
    match expr {
        Expr::Seq(written) => written.items.iter().map(|item| &item.expr).collect(),
        _ => Vec::new(),
    }
}
