//! Plots of figures over time: the selection of lines, and their history.
//!
//! [`super::scopes`] shows the actuators over a tenth of a second; this module shows sensors, tiles, feet and
//! controls over the last half minute, 60 times a second. Only `chart` depends on egui_plot.

mod chart;
mod history;
mod panel;
mod series;

pub(in crate::preview) use series::Series;

use std::sync::Arc;

use history::{ControlIndex, PlotHistory};
use series::Unit;

use super::design::Threshold;
use underfoot::engine::Snapshot;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::units::Newtons;
use underfoot::widget::WidgetId;

/// Maximum number of lines: the number of distinct colours.
const MOST: usize = 6;

/// The time spans to choose from, in seconds.
const SPANS: [f64; 3] = [5.0, 10.0, history::LONGEST_S];

/// Minimum pause between two moments for which the line stays flat until shortly before the later one: the window
/// records nothing without a change.
const PAUSE_S: f64 = 0.1;

/// Pause after which the plots count as at rest: the floor sends nothing new, as a paused recording.
const SILENCE_S: f64 = 0.5;

/// The state of the plots.
pub(in crate::preview) struct Plots {
    pub(in crate::preview) is_open: bool,
    chosen: Vec<Series>,
    span_s: f64,
    /// Whether the display is frozen.
    is_held: bool,
    history: PlotHistory,
    /// Time of the last new moment, on the window's clock.
    fed_s: f64,
    /// The search text of the list of everything.
    wanted: String,
    /// The threshold that is being dragged, and its force.
    dragged: Option<(Threshold, Newtons)>,
    /// The message about the last threshold that was set.
    told: Option<String>,
}

impl Default for Plots {
    fn default() -> Self {
        Self {
            is_open: false,
            chosen: vec![Series::Selected],
            span_s: 10.0,
            is_held: false,
            history: PlotHistory::default(),
            fed_s: f64::NEG_INFINITY,
            wanted: String::new(),
            dragged: None,
            told: None,
        }
    }
}

impl Plots {
    /// Records a frame's state at `now_s`.
    pub(in crate::preview) fn note(&mut self, now_s: f64, snapshot: &Snapshot, layout: &Arc<Layout>) {
        let before = self.history.end();
        if !self.is_held {
            self.history.note(snapshot, layout);
        }
        if self.history.end() != before {
            self.fed_s = now_s;
        }
    }

    #[cfg(test)]
    pub(in crate::preview) fn seen_until(&self) -> Option<underfoot::units::Instant> {
        self.history.end()
    }

    /// Adds these lines, in place of the oldest ones above the maximum.
    pub(in crate::preview) fn add(&mut self, series: impl IntoIterator<Item = Series>) {
        self.is_open = true;
        for one in series {
            if !self.chosen.contains(&one) {
                self.chosen.push(one);
            }
        }
        let extra = self.chosen.len().saturating_sub(MOST);
        self.chosen.drain(..extra);
    }

    fn turn(&mut self, series: Series) {
        match self.chosen.iter().position(|one| *one == series) {
            Some(at) => drop(self.chosen.remove(at)),
            None => self.add([series]),
        }
    }

    /// The points of a line, in seconds relative to the latest moment; gaps are `NaN`.
    fn points(&self, series: &Series, geometry: &Geometry, selected: Option<&WidgetId>) -> Vec<[f64; 2]> {
        let Some(end) = self.history.end() else { return Vec::new() };
        let (mut points, mut place) = (Vec::<[f64; 2]>::new(), ControlIndex::default());
        for moment in self.history.last(self.span_s) {
            let at_s = -end.since(moment.at).as_secs_f64();
            let figure = series.at(moment, geometry, selected, &mut place).unwrap_or(f64::NAN);
            if let Some([before_s, before]) = points.last().copied()
                && at_s - before_s > PAUSE_S
            {
                points.push([at_s - 0.5 * PAUSE_S, before]);
            }
            points.push([at_s, figure]);
        }
        points
    }

    /// Whether lines move through the plot: it contains a change above noise that will leave it as time passes.
    pub(in crate::preview) fn are_moving(
        &self,
        now_s: f64,
        geometry: &Geometry,
        selected: Option<&WidgetId>,
    ) -> bool {
        self.is_open
            && now_s - self.fed_s < SILENCE_S
            && !self.is_held
            && self.chosen.iter().any(|series| {
                let mut place = ControlIndex::default();
                let moments = self.history.last(self.span_s);
                let figures = moments.map(|moment| series.at(moment, geometry, selected, &mut place));
                differ(figures, series.unit())
            })
    }
}

/// Whether figures differ by more than noise, or are present only in part.
fn differ(figures: impl Iterator<Item = Option<f64>>, unit: Unit) -> bool {
    let (mut low, mut high, mut gaps) = (f64::INFINITY, f64::NEG_INFINITY, false);
    for figure in figures {
        match figure {
            Some(figure) => (low, high) = (low.min(figure), high.max(figure)),
            None => gaps = true,
        }
    }
    high - low > unit.noise() || (gaps && high >= low)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::preview::sample::{at_rest, map, step_on};
    use underfoot::floor::{Corner, TileId};
    use underfoot::units::Instant;

    fn fed(forces: &[(u64, f32)]) -> Plots {
        let (mut plots, layout) = (Plots { is_open: true, ..Plots::default() }, Arc::new(map()));
        let home = layout.widgets[layout.widget_index("home").unwrap()].area.centre();
        for (at_ms, force) in forces {
            let mut snapshot = at_rest(&layout);
            snapshot.at = Instant::from_millis(*at_ms);
            if *force > 0.0 {
                step_on(&mut snapshot, 3, home, *force, Vec2::ZERO);
            }
            plots.note(*at_ms as f64 * 1e-3, &snapshot, &layout);
        }
        plots
    }

    fn home() -> WidgetId {
        WidgetId::new("home")
    }

    #[test]
    fn a_press_is_drawn_where_it_was_and_a_pause_of_the_window_is_level() {
        let geometry = Geometry::default();
        let plots = fed(&[(1000, 0.0), (1016, 90.0), (1032, 0.0), (3032, 50.0)]);
        let points = plots.points(&Series::Force(home()), &geometry, None);
        let rounded: Vec<_> = points.iter().map(|[at, y]| ((at * 1e3).round(), y.round())).collect();
        assert_eq!(rounded, [(-2032.0, 0.0), (-2016.0, 90.0), (-2000.0, 0.0), (-50.0, 0.0), (0.0, 50.0)]);
        assert_eq!(plots.points(&Series::Selected, &geometry, Some(&home())), points);
        let foot = plots.points(&Series::Foot(None, series::FootQuantity::East), &geometry, None);
        assert!(foot[0][1].is_nan() && foot[1][1].is_finite(), "{foot:?}");
        assert_eq!(
            plots
                .points(&Series::Value(home()), &geometry, None)
                .iter()
                .filter(|it| it[1].is_finite())
                .count(),
            0
        );
    }

    #[test]
    fn the_plot_moves_until_the_press_has_left_it_and_stands_still_then() {
        let geometry = Geometry::default();
        let now_s = |forces: &[(u64, f32)]| forces.last().map_or(0.0, |(at_ms, _)| *at_ms as f64 * 1e-3);
        let moves = |forces: &[(u64, f32)]| fed(forces).are_moving(now_s(forces), &geometry, Some(&home()));
        assert!(!moves(&[(1000, 0.0), (1016, 1.0), (1032, 0.5)]), "noise");
        assert!(moves(&[(1000, 0.0), (1016, 90.0), (1032, 0.0)]));
        // The plot spans ten seconds.
        let gone = [(1000, 90.0), (1016, 0.0), (6000, 0.0), (11_100, 0.0), (11_116, 0.0)];
        assert!(moves(&gone[..3]) && !moves(&gone));
        let mut closed = fed(&gone[..3]);
        closed.is_open = false;
        assert!(!closed.are_moving(6.0, &geometry, Some(&home())));
        // A floor at rest moves nothing; a frame or two without news do not count as rest.
        let mut paused = fed(&gone[..3]);
        let snapshot = Snapshot { at: Instant::from_millis(6000), ..at_rest(&map()) };
        for (now_s, moves) in [(6.05, true), (6.4, true), (6.6, false)] {
            paused.note(now_s, &snapshot, &Arc::new(map()));
            assert_eq!(paused.are_moving(now_s, &geometry, Some(&home())), moves, "{now_s}");
        }
    }

    #[test]
    fn a_recording_that_is_played_again_begins_anew_and_old_moments_go() {
        let plots = fed(&[(1000, 10.0), (2000, 20.0), (1500, 30.0)]);
        assert_eq!(plots.history.last(30.0).count(), 1);
        let long: Vec<_> = (0..4000).map(|frame| (frame * 16, 20.0)).collect();
        let plots = fed(&long);
        let count = plots.history.last(60.0).count();
        assert!((1800..=1900).contains(&count), "{count} in half a minute");
    }

    #[test]
    fn no_more_lines_than_colours_and_one_is_taken_out_as_it_was_put_in() {
        let mut plots = Plots::default();
        let tile = TileId::new(2, 1);
        plots.add(Corner::ALL.map(|corner| Series::Sensor(tile, corner)));
        plots.add([Series::Tile(tile), Series::Force(home()), Series::Value(home())]);
        assert_eq!(plots.chosen.len(), MOST);
        assert!(plots.is_open && !plots.chosen.contains(&Series::Selected), "the oldest goes");
        plots.turn(Series::Tile(tile));
        assert!(!plots.chosen.contains(&Series::Tile(tile)));
    }
}
