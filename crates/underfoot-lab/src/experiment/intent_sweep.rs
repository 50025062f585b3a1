//! False activations and missed presses over the size and the threshold of a button.

use std::fmt::Write;

use glam::Vec2;
use serde::Serialize;

use super::chart::{ChartAxis, ChartPage, LINE_M, LegendSymbol, MARGIN_M, Plot, THEME};
use super::figure::Figure;
use super::intent::{Guarded, IntentEffort, IntentScore, IntentStage, IntentTrial};
use super::intent_act::Somebody;
use super::rig::ExperimentError;
use super::wilson::Counted;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Colour, Layout};
use underfoot::schema::{Kinds, parse_layout};
use underfoot_scene::scene::{Ink, Scene, Stroke};
use underfoot_sim::FloorQuality;

/// Sides of the buttons in centimetres, and their press thresholds in newtons.
const SIZES_CM: [f32; 5] = [8.0, 12.0, 16.0, 20.0, 24.0];
const PRESS_N: [f32; 5] = [25.0, 40.0, 60.0, 90.0, 120.0];

/// Release thresholds as a share of the press thresholds.
const RELEASE: f32 = 0.67;

/// Number of presses in a row, and of crossings.
const PRESSES: usize = 10;
const CROSSINGS: usize = 6;

/// Results of the buttons of one size and threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SweepCell {
    /// Side of the buttons, in centimetres.
    pub size_cm: f32,
    /// Their press threshold, in newtons.
    pub press_n: f32,
    /// Number of false activations out of all steps over the row.
    pub falsely: Counted,
    /// Number of missed presses out of all intended ones.
    pub missed: Counted,
}

/// Rows of four unguarded buttons in 25 combinations of size and threshold, crossed and used by the same people.
#[derive(Clone, Debug, PartialEq)]
pub struct IntentSweep {
    floor: FloorQuality,
    cells: Vec<SweepCell>,
}

/// A sweep on the paper's floor.
impl Default for IntentSweep {
    fn default() -> Self {
        Self::on(FloorQuality::Paper)
    }
}

impl IntentSweep {
    /// Creates an empty sweep for floors of this quality. On floors with real errors ([`FloorQuality::REAL`]), feet
    /// roll like those of recorded people.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        let each = |size_cm| {
            PRESS_N.map(|press_n| SweepCell {
                size_cm,
                press_n,
                falsely: Counted::default(),
                missed: Counted::default(),
            })
        };
        Self { floor, cells: SIZES_CM.into_iter().flat_map(each).collect() }
    }
}

impl IntentSweep {
    /// Simulates the person drawn from `seed` crossing every row with the steps of `effort`, and sharing its presses
    /// among every fifth combination of size and threshold; `number` selects them.
    ///
    /// # Errors
    /// The same as [`super::IntentTable::add_person`].
    pub fn add_person(
        &mut self,
        seed: u64,
        number: u64,
        effort: IntentEffort,
    ) -> Result<(), ExperimentError> {
        let geometry = Geometry::default();
        let mut stage = IntentStage::new(self.floor, seed)?;
        let mut body = Somebody::of(seed, number as usize, geometry.bounds()).rolling(self.floor.is_real());
        let pitch = geometry.pitch_m();
        let row = Rect::new(Vec2::new(1.0, 2.1), Vec2::new(5.0, 3.1));
        let area = Rect::new(row.min * pitch, row.max * pitch);
        let mut trials = Vec::with_capacity(self.cells.len());
        for cell in &self.cells {
            trials.push(IntentTrial::new(stage.engine(layout(cell, &geometry)?), Guarded::Free));
        }
        let mut walked = 0;
        while walked < effort.steps {
            for _ in 0..CROSSINGS {
                walked += stage.play(&body.cross(area)?, &mut trials);
            }
        }
        for (which, trial) in trials.iter_mut().enumerate() {
            let mut pressed = 0;
            while which as u64 % 5 == number % 5 && pressed < effort.presses.div_ceil(5) {
                let page = trial.engine.layout().clone();
                let act = body.make_use(&page, |_| true, PRESSES)?;
                pressed += act.intended.len() as u64;
                stage.play(&act, std::slice::from_mut(trial));
            }
        }
        for (cell, trial) in self.cells.iter_mut().zip(&trials) {
            let IntentScore { intended, missed, false_activations, .. } = trial.whole();
            cell.falsely += Counted { hits: false_activations, of: trial.steps };
            cell.missed += Counted { hits: missed, of: intended };
        }
        Ok(())
    }

    /// Adds all people of another sweep.
    pub fn append(&mut self, other: &Self) {
        for (cell, more) in self.cells.iter_mut().zip(&other.cells) {
            cell.falsely += more.falsely;
            cell.missed += more.missed;
        }
    }

    /// Returns all combinations, the smallest size and lightest threshold first.
    #[must_use]
    pub fn cells(&self) -> &[SweepCell] {
        &self.cells
    }
}

fn layout(cell: &SweepCell, geometry: &Geometry) -> Result<Layout, ExperimentError> {
    let (side, press, release) = (cell.size_cm / 30.4, cell.press_n, cell.press_n * RELEASE);
    let mut text = String::from(
        "Layout(version: 1, title: \"Row\", regions: [(id: \"row\", at: (0.5, 2), size: (5, 2))],
         stances: [(at: (2, 0), size: (2, 1))], widgets: [",
    );
    for (number, x) in (1..).zip([1.5, 2.5, 3.5, 4.5]) {
        let (x, y) = (x - 0.5 * side, 2.6 - 0.5 * side);
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "(id: \"b{number}\", kind: \"button\", at: ({x:.4}, {y:.4}), size: ({side:.4}, {side:.4}),
              press_n: {press:.1}, release_n: {release:.1}),"
        );
    }
    text.push_str("])");
    let loaded = parse_layout(&text, "row of buttons", &Kinds::builtin(), geometry);
    loaded.map(|loaded| loaded.layout).map_err(|problems| ExperimentError::Layout(problems.to_string()))
}

/// The quantity in one of the two plots.
type Measure = fn(&SweepCell) -> Counted;

const SIDE_M: Vec2 = Vec2::new(0.082, 0.075);
const GAP_M: f32 = 0.024;

impl Figure for IntentSweep {
    fn draw(&self) -> Scene {
        let left = MARGIN_M + 0.011;
        let mut page = ChartPage::new(
            Vec2::new(left + 2.0 * SIDE_M.x + GAP_M + MARGIN_M, SIDE_M.y + 0.050),
            "What a button's size and threshold do",
            "Unguarded buttons; walkers of 45 to 120 kg crossing them, and presses of twice the threshold",
        );
        let plots: [(&str, &'static str, Measure); 2] = [
            ("False activations", "per 1000 steps", |cell| cell.falsely),
            ("Missed presses", "per 1000 meant", |cell| cell.missed),
        ];
        for (number, (title, label, measure)) in plots.into_iter().enumerate() {
            let corner = Vec2::new(left + number as f32 * (SIDE_M.x + GAP_M), 0.022);
            self.plot(&mut page, Rect::from_min_size(corner, SIDE_M), title, label, measure);
        }
        let names = SIZES_CM.map(|size| format!("{size:.0} cm"));
        let entries: Vec<_> = names
            .iter()
            .enumerate()
            .map(|(which, name)| (LegendSymbol::Line, shade(which), name.as_str()))
            .collect();
        page.legend(Vec2::new(MARGIN_M, 0.0055), &entries);
        page.scene
    }

    fn csv(&self) -> String {
        let mut csv = String::from(
            "size_cm,press_n,steps,false_activations,false_per_1000,false_low,false_high,\
             intended,missed,missed_per_1000,missed_low,missed_high\n",
        );
        for SweepCell { size_cm, press_n, falsely, missed } in &self.cells {
            let [falsely, missed] = [falsely, missed].map(|counted| {
                let (low, high) = counted.wilson_95();
                let Counted { hits, of } = counted;
                format!("{of},{hits},{:.3},{:.3},{:.3}", 1e3 * counted.share(), 1e3 * low, 1e3 * high)
            });
            // Writing to a string does not fail.
            let _ = writeln!(csv, "{size_cm},{press_n},{falsely},{missed}");
        }
        csv
    }

    fn summary(&self) -> String {
        let mut text = String::from("false activations per 1000 steps / missed of 1000 presses\n   side");
        PRESS_N.iter().for_each(|press| {
            let _ = write!(text, "{:>16}", format!("{press:.0} N"));
        });
        text.push('\n');
        for (size, row) in SIZES_CM.iter().zip(self.cells.chunks(PRESS_N.len())) {
            let _ = write!(text, "{size:4.0} cm");
            for cell in row {
                let _ = write!(text, "{:9.2} /{:5.1}", 1e3 * cell.falsely.share(), 1e3 * cell.missed.share());
            }
            text.push('\n');
        }
        text
    }
}

impl IntentSweep {
    fn plot(&self, page: &mut ChartPage, area: Rect, title: &str, label: &'static str, measure: Measure) {
        let per_1000 = |cell: &SweepCell| 1e3 * measure(cell).share() as f32;
        let most = self.cells.iter().map(per_1000).fold(0.0, f32::max);
        // Five steps of 1, 2, 5, 10, 20 ..., so that the axis reaches the highest line.
        let tick =
            [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0].into_iter().find(|tick| 5.0 * tick >= most);
        let tick = tick.unwrap_or(200.0);
        let x = ChartAxis { from: 0.0, to: 140.0, tick: 20.0, label: "press threshold, N" };
        let plot = Plot::draw(page, area, title, x, ChartAxis { from: 0.0, to: 5.0 * tick, tick, label });
        for (which, row) in self.cells.chunks(PRESS_N.len()).enumerate() {
            let values = || row.iter().map(|cell| Vec2::new(cell.press_n, per_1000(cell)));
            plot.curve(page, values(), Stroke::new(LINE_M, Ink::solid(shade(which))));
            for value in values() {
                page.dot(plot.at(value), shade(which));
            }
        }
    }
}

/// Larger buttons are darker.
fn shade(which: usize) -> Colour {
    THEME.haptic.mix(THEME.ink, which as f32 / (SIZES_CM.len() - 1) as f32)
}
