//! Acts of people in front of a layout: crossing it, and using it.

use std::f32::consts::{PI, TAU};
use std::time::Duration;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::rig::ExperimentError;
use underfoot::floor::Rect;
use underfoot::layout::{Layout, Widget};
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, Guard};
use underfoot_sim::{MoveError, Performance, Person, Script};

/// Walking speeds, in metres per second: slow, usual, brisk.
///
/// # Source
/// Adults' slow, comfortable and fast walking (Bohannon 1997: 0.8 at the slow end of the old, 1.3, 1.7 and more).
pub(super) const SPEEDS_M_S: [f32; 3] = [0.8, 1.2, 1.6];

/// Standard deviation of the pressed point about the aimed one, in metres along each axis (our assumption: feet hit
/// targets of 10 to 12 cm nearly always and often miss targets of 5 cm, Saunders and Vogel 2015).
const AIM_M: f32 = 0.02;

/// Mean press force as a multiple of the control's threshold, and standard deviation of its logarithm (our
/// assumption). The force is limited to half of the weight: beyond that the other foot no longer carries the person.
const FORCE_OVER_PRESS: f32 = 2.0;
const FORCE_SCATTER: f32 = 0.3;

/// Minimum press force as a multiple of the threshold: a person who feels no click presses harder.
const FORCE_AT_LEAST: f32 = 1.2;

const MOST_OF_WEIGHT: f32 = 0.5;

/// Distance from the centre of a shoe to its side, plus a margin (m).
const HALF_SHOE_M: f32 = 0.07;

/// Distance at which people stand from a control after they could not reach it (m).
const NEAR_M: f32 = 0.60;

/// Distance beyond the floor at which people start (m): no part of a foot is on the floor there.
const BEYOND_M: f32 = 0.45;

/// An intended press of a control, with its time span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Intended {
    /// Index of the control.
    pub(super) widget: usize,
    /// Start of the first move towards the control.
    pub(super) from: Duration,
    /// A moment after the last foot has left the control.
    pub(super) to: Duration,
}

/// One act of a person: a script, and the intended presses in it.
#[derive(Clone, Debug)]
pub(super) struct PlannedAct {
    pub(super) script: Script,
    pub(super) intended: Vec<Intended>,
}

/// Time after a press in which its events still count, in addition to the time in which a tap may become a double
/// tap.
const AFTER: Duration = Duration::from_millis(120);

/// A person drawn from a seed.
#[derive(Debug)]
pub(super) struct Somebody {
    person: Person,
    rng: Pcg64Mcg,
    bounds: Rect,
    /// Seed of the rolling pattern of recorded people; `None` for the even roll.
    rolling: Option<u64>,
    seed: u64,
}

impl Somebody {
    /// Draws a person of 45 to 120 kg in shoes on feet of 22 to 30 cm, on a floor with these bounds; `number` selects
    /// one of three walking speeds.
    pub(super) fn of(seed: u64, number: usize, bounds: Rect) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x1274_e475);
        let person = Person {
            mass_kg: rng.random_range(45.0..120.0),
            foot_length_m: rng.random_range(0.22..0.30),
            speed_m_s: SPEEDS_M_S[number % 3] * rng.random_range(0.92..1.08),
            step_width_m: rng.random_range(0.08..0.16),
            stand_width_m: rng.random_range(0.15..0.32),
            toe_out: rng.random_range(0.0..0.2),
            ..Person::default()
        };
        Self { person, rng, bounds, rolling: None, seed }
    }

    /// The same person, with feet that roll like those of recorded people, or evenly.
    pub(super) fn rolling(mut self, as_people_do: bool) -> Self {
        self.rolling = as_people_do.then_some(self.seed);
        self
    }

    /// A performance of the person, before the person appears.
    fn performance(&mut self) -> Performance {
        let performance = Performance::new(self.person, self.rng.random());
        match self.rolling {
            Some(seed) => performance.rolling_as_people_do(seed),
            None => performance,
        }
    }

    /// Crosses the floor over a point of `area`: straight on, or with a stop, perhaps with a turn or a sidestep
    /// there.
    pub(super) fn cross(&mut self, area: Rect) -> Result<PlannedAct, ExperimentError> {
        let through = area.min + area.size() * self.pair(0.0, 1.0);
        let way = self.rng.random_range(0.0..TAU);
        let from = self.beyond(through, way + PI);
        let mut to = self.beyond(through, way);
        let mut walker = self.performance();
        walker.appear(from, way - 0.5 * PI)?;
        let manner = self.rng.random_range(0.0..1.0);
        if manner > 0.6 {
            walker.walk(&[through])?;
            walker.wait(self.millis(500, 2000));
            if manner > 0.85 {
                let aside = self.rng.random_range(0.1..0.5) * self.sign();
                walker.sidestep(through + Vec2::from_angle(way).perp() * aside)?;
                walker.wait(self.millis(300, 1500));
            } else if manner > 0.7 {
                let turn = self.rng.random_range(0.5..2.8) * self.sign();
                walker.turn(way - 0.5 * PI + turn)?;
                walker.wait(self.millis(300, 1500));
                to = self.beyond(through, way + turn);
            }
        }
        walker.walk(&[to])?;
        Ok(PlannedAct { script: Script::new(vec![walker], self.bounds), intended: Vec::new() })
    }

    /// Comes to the layout's stance zone, uses controls `times` times, and leaves.
    ///
    /// Uses only controls for which `wanted` is true.
    pub(super) fn make_use(
        &mut self,
        layout: &Layout,
        wanted: impl Fn(&Widget) -> bool,
        times: usize,
    ) -> Result<PlannedAct, ExperimentError> {
        let choice: Vec<usize> =
            (0..layout.widgets.len()).filter(|&index| wanted(&layout.widgets[index])).collect();
        let mut user = self.performance();
        let stance = stance(layout, self.bounds) + self.pair(-0.04, 0.04);
        let way = self.rng.random_range(0.0..PI);
        user.appear(self.beyond(stance, way + PI), way - 0.5 * PI)?;
        user.walk(&[stance])?;
        user.turn(0.0)?;
        user.wait(self.millis(1000, 2500));
        let mut intended = Vec::new();
        if !choice.is_empty() {
            for _ in 0..times {
                let widget = choice[self.rng.random_range(0..choice.len())];
                let from = user.duration();
                let after = AFTER + double_tap(&layout.widgets[widget]);
                self.operate(&mut user, &layout.widgets[widget])?;
                intended.push(Intended { widget, from, to: user.duration() + after });
                user.wait(after + self.millis(150, 700));
            }
        }
        let away = self.rng.random_range(PI..TAU);
        let away = self.beyond(stance, away);
        user.walk(&[away])?;
        Ok(PlannedAct { script: Script::new(vec![user], self.bounds), intended })
    }

    /// Does the presses that the control's guard needs to act once.
    fn operate(&mut self, user: &mut Performance, widget: &Widget) -> Result<(), ExperimentError> {
        match widget.behaviour.thresholds().guard {
            Guard::Free => self.press(user, widget, (80, 350), None)?,
            Guard::Confirm { .. } => {
                let first = self.press(user, widget, (80, 350), None)?;
                self.press(user, widget, (80, 350), Some(first))?
            }
            Guard::HoldToRun { .. } => self.press(user, widget, (800, 2000), None)?,
        };
        Ok(())
    }

    /// Presses once for some milliseconds and returns the pressed point. If the point is out of reach or under the
    /// other foot, presses the point `before`, or, without one, moves first.
    fn press(
        &mut self,
        user: &mut Performance,
        widget: &Widget,
        hold_ms: (u64, u64),
        before: Option<Vec2>,
    ) -> Result<Vec2, ExperimentError> {
        let hold = self.millis(hold_ms.0, hold_ms.1);
        let scatter = Vec2::new(self.normal(), self.normal()) * AIM_M;
        let aim = widget.area.centre() + scatter;
        let press = widget.behaviour.thresholds().for_weight(Some(self.person.weight())).press;
        let meant = press * (FORCE_OVER_PRESS * (FORCE_SCATTER * self.normal()).exp()).max(FORCE_AT_LEAST);
        let most = self.person.weight() * MOST_OF_WEIGHT;
        let force = Newtons(meant.0.min(most.0));
        let failed = match user.press(aim, force, hold) {
            Ok(()) => return Ok(aim),
            Err(failed) => failed,
        };
        let (MoveError::OutOfReach { .. } | MoveError::Occupied { .. }) = failed else {
            return Err(failed.into());
        };
        let again = match before {
            Some(before) => before,
            None => {
                // Stand in front of the control then, and near enough to it.
                let place = user.place().unwrap_or_default();
                let nearer = place.y.max(aim.y - NEAR_M);
                // Keep both feet on the floor: people do not stand over its edge.
                let edge = 0.5 * self.person.stand_width_m + HALF_SHOE_M;
                let beside =
                    (aim.x + 0.05 * self.sign()).clamp(self.bounds.min.x + edge, self.bounds.max.x - edge);
                user.sidestep(Vec2::new(beside, nearer))?;
                user.wait(self.millis(800, 1500));
                aim
            }
        };
        user.press(again, force, hold)?;
        Ok(again)
    }

    /// Place outside the floor on the line from `point` in the direction `way`.
    fn beyond(&self, point: Vec2, way: f32) -> Vec2 {
        let outer = self.bounds.grown(BEYOND_M);
        let direction = Vec2::from_angle(way);
        let to_edge = |from: f32, along: f32, low: f32, high: f32| {
            if along.abs() < 1e-6 {
                f32::INFINITY
            } else {
                ((if along > 0.0 { high } else { low }) - from) / along
            }
        };
        let distance = to_edge(point.x, direction.x, outer.min.x, outer.max.x).min(to_edge(
            point.y,
            direction.y,
            outer.min.y,
            outer.max.y,
        ));
        point + direction * distance
    }

    fn pair(&mut self, low: f32, high: f32) -> Vec2 {
        Vec2::new(self.rng.random_range(low..high), self.rng.random_range(low..high))
    }

    fn normal(&mut self) -> f32 {
        StandardNormal.sample(&mut self.rng)
    }

    fn sign(&mut self) -> f32 {
        if self.rng.random_bool(0.5) { 1.0 } else { -1.0 }
    }

    fn millis(&mut self, least: u64, most: u64) -> Duration {
        Duration::from_millis(self.rng.random_range(least..most))
    }
}

/// Place where people stand to use `layout`; at the middle of the south side if it has no stance zone.
fn stance(layout: &Layout, bounds: Rect) -> Vec2 {
    layout
        .stances
        .first()
        .map_or(Vec2::new(bounds.centre().x, bounds.min.y + 0.15), |stance| stance.area.centre())
}

/// Time in which a click waits for a second tap.
fn double_tap(widget: &Widget) -> Duration {
    match &widget.behaviour {
        Behaviour::Button(button) => button.gestures.double_tap.unwrap_or_default(),
        _ => Duration::ZERO,
    }
}
