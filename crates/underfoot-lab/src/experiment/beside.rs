//! Buttons pressed while the other foot stands in their region, by the region's cursor rule.

use std::fmt;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::intent::shipped_layouts;
use super::rig::{ExperimentError, Rig};
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{CursorRule, Layout, Widget};
use underfoot::sense::Method;
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, EventKind, Guard};
use underfoot_sim::{FloorQuality, Foot, shoe_size};

/// The compared rules, with their names in the table.
const RULES: [(CursorRule, &str); 2] = [(CursorRule::Largest, "Largest"), (CursorRule::Working, "Working")];

/// Unguarded buttons of the shipped layouts, tapped by people whose other foot stands on the free floor of the same
/// region, with each cursor rule in turn.
#[derive(Clone, Debug, PartialEq)]
pub struct BesideTable {
    floor: FloorQuality,
    scores: [BesideScore; 2],
}

/// Number of taps, of those that clicked, and of clicks of another control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct BesideScore {
    taps: u64,
    clicked: u64,
    wrong: u64,
}

/// Time of the standing foot alone before the first tap and between two taps (ms).
const BEFORE_MS: u64 = 2500;
const PAUSE_MS: u64 = 600;

/// Times of a tap: rise, rest and fall of the force (ms).
const TAP_MS: [u64; 3] = [80, 150, 60];

/// Number of taps on each button.
const TAPS: u64 = 3;

/// Weight of the person (N), and range of the force of a tap above the button's threshold.
const WEIGHT_N: f32 = 700.0;
const ABOVE: std::ops::Range<f32> = 1.3..1.8;

/// Distances of a standing foot from the button's middle (m).
const AWAY_M: [f32; 3] = [0.40, 0.50, 0.60];

impl BesideTable {
    /// Creates an empty table for floors of this quality.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        Self { floor, scores: Default::default() }
    }

    /// Simulates the person drawn from `seed` at each button of each shipped layout that has room for a standing foot in
    /// its region.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`]; [`ExperimentError::Layout`], which no layout should cause.
    pub fn add_person(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let geometry = Geometry::default();
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0xbe51_de00);
        for layout in shipped_layouts(&geometry)? {
            for widget in layout.widgets.iter().filter(|widget| is_tapped(widget)) {
                let length_m = rng.random_range(0.23..0.29);
                let Some(standing) = standing(&layout, widget, length_m, &mut rng) else { continue };
                let press = widget.behaviour.thresholds().press * rng.random_range(ABOVE);
                let working = Foot { position: widget.area.centre(), force: press, ..standing };
                let working =
                    Foot { position: 2.0 * working.position - working.centre_of_pressure(), ..working };
                for ((rule, _), score) in RULES.into_iter().zip(&mut self.scores) {
                    let mut layout = layout.clone();
                    layout.regions.iter_mut().for_each(|region| region.cursor = rule);
                    let mut rig = Rig::of_quality(geometry, self.floor, seed)?;
                    score.play(&mut rig, layout, widget, [standing, working]);
                }
            }
        }
        Ok(())
    }

    /// Adds all people of another table.
    pub fn append(&mut self, other: &Self) {
        for (score, other) in self.scores.iter_mut().zip(&other.scores) {
            score.taps += other.taps;
            score.clicked += other.clicked;
            score.wrong += other.wrong;
        }
    }

    /// Returns all lines, for programs: one per rule.
    pub fn lines(&self) -> impl Iterator<Item = BesideLine> + '_ {
        RULES.into_iter().zip(&self.scores).map(|((_, rule), score)| BesideLine {
            rule,
            taps: score.taps,
            missed: score.taps - score.clicked,
            wrong: score.wrong,
        })
    }
}

impl BesideScore {
    fn play(&mut self, rig: &mut Rig, layout: Layout, widget: &Widget, [standing, working]: [Foot; 2]) {
        let mut engine = rig.engine(layout, Method::Tracker);
        let [rise, rest, fall] = TAP_MS;
        let tap = rise + rest + fall + PAUSE_MS;
        let mut clicks = [false; TAPS as usize];
        for milli in 1..=BEFORE_MS + TAPS * tap {
            let since = milli.checked_sub(BEFORE_MS);
            let share = since.map_or(0.0, |since| {
                let since = since % tap;
                let falling = (rise + rest + fall).saturating_sub(since) as f32 / fall as f32;
                (since as f32 / rise as f32).min(falling).clamp(0.0, 1.0)
            });
            let force = working.force * share;
            let feet = [
                Foot { force: Newtons(WEIGHT_N) - force, ..standing }.as_load(),
                Foot { force, ..working }.as_load(),
            ];
            rig.step(feet.into_iter().filter(|load| load.force.0 > 0.0), |frame| {
                for event in engine.step(frame).events.iter().filter(|event| event.kind == EventKind::Clicked)
                {
                    let tapped = since.and_then(|since| clicks.get_mut((since / tap) as usize));
                    match tapped.filter(|_| event.id == widget.id) {
                        Some(clicked) => *clicked = true,
                        None => self.wrong += 1,
                    }
                }
            });
        }
        self.taps += TAPS;
        self.clicked += clicks.into_iter().filter(|clicked| *clicked).count() as u64;
    }
}

/// Whether a tap on this control is a click.
fn is_tapped(widget: &Widget) -> bool {
    matches!(widget.behaviour, Behaviour::Button(_))
        && widget.behaviour.thresholds().guard == Guard::Free
        && widget.goto.is_none()
        && widget.is_on(0)
}

/// A foot that stands on the free floor of the control's region, as near as the other foot reaches; `None` without
/// room.
fn standing(layout: &Layout, widget: &Widget, length_m: f32, rng: &mut Pcg64Mcg) -> Option<Foot> {
    let region = layout.regions.get(widget.region)?.area;
    let shoe = shoe_size(length_m);
    let first = rng.random_range(0..8_u32);
    let places = AWAY_M.into_iter().flat_map(|away| {
        (0..8).map(move |step| Vec2::from_angle(std::f32::consts::FRAC_PI_4 * (first + step) as f32) * away)
    });
    let is_free = |place: &Vec2| {
        let area = Rect::from_centre_size(*place, shoe);
        let is_inside = region.contains(area.min) && region.contains(area.max);
        is_inside
            && layout.widgets.iter().all(|other| !other.area.overlaps(area))
            && layout.stances.iter().all(|stance| !stance.area.overlaps(area))
    };
    let position = places.map(|offset| widget.area.centre() + offset).find(is_free)?;
    Some(Foot { position, heading: 0.0, length_m, force: Newtons(WEIGHT_N), roll: 0.45, left: false })
}

/// One line of a [`BesideTable`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BesideLine {
    /// The cursor rule of all regions.
    pub rule: &'static str,
    /// Number of taps.
    pub taps: u64,
    /// Number of taps without a click.
    pub missed: u64,
    /// Number of clicks of another control, or between taps.
    pub wrong: u64,
}

impl fmt::Display for BesideTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "buttons of the shipped layouts tapped while the other foot stands in their region ({})",
            self.floor
        )?;
        writeln!(f, "cursor      taps  missed   wrong")?;
        for line in self.lines() {
            let missed = 100.0 * line.missed as f64 / line.taps.max(1) as f64;
            writeln!(f, "{:10}{:6}{missed:7.1}%{:8}", line.rule, line.taps, line.wrong)?;
        }
        Ok(())
    }
}
