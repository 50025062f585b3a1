//! Influence of a heavy foot beside a region on the light foot that works in it.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::fmt;
use std::ops::Range;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;
use smallvec::SmallVec;

use super::METHODS;
use super::errors::{PositionErrors, Summary};
use super::follow::DOWN_N;
use super::people::quality_note;
use super::rig::{ExperimentError, FaultHook, Rig};
use underfoot::engine::{Engine, Snapshot};
use underfoot::feel::Cue;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::Layout;
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::{ContactId, ForceFrame};
use underfoot::units::Newtons;
use underfoot::widget::EventKind;
use underfoot_sim::{FloorQuality, Foot, shoe_size};

/// Stance of the heavy foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum HeavyFoot {
    /// The toes point at the region, as those of a person who looks at it.
    Facing,
    /// The foot stands alongside the region's edge.
    Beside,
}

impl HeavyFoot {
    /// Both stances, in the order of the table.
    pub const ALL: [Self; 2] = [Self::Facing, Self::Beside];

    const fn name(self) -> &'static str {
        match self {
            Self::Facing => "facing",
            Self::Beside => "beside",
        }
    }
}

/// One touch of the working foot in the region.
#[derive(Clone, Copy, Debug)]
struct Touch {
    from: Vec2,
    to: Vec2,
    start_ms: u32,
    end_ms: u32,
}

/// A person on one leg beside a region of 1.2 x 0.6 m, who taps and slides in it with the other foot.
#[derive(Clone, Debug)]
pub struct TapScene {
    layout: Layout,
    way: HeavyFoot,
    stance: Foot,
    touching: Foot,
    press: Newtons,
    touches: Vec<Touch>,
    sway: [f32; 2],
}

/// Position of the region in tiles: its south edge is in the middle of a row of tiles or on a seam.
const REGION_TILES: [(f32, f32); 2] = [(1.0, 3.0), (1.0, 2.5)];
const REGION_SIZE_TILES: (f32, f32) = (4.0, 2.0);

/// Press threshold of the region's control (N): below the force of every tap.
const PRESS_N: f32 = 24.0;

/// Time of the first touch (ms), long after the standing foot has landed; duration of a tap, a slide and a pause
/// (ms); number of touches.
const FIRST_MS: u32 = 1200;
const TAP_MS: u32 = 250;
const SLIDE_MS: u32 = 1000;
const PAUSE_MS: u32 = 700;
const TOUCHES: u32 = 6;

/// Time in which a foot puts its force on or off (ms).
const RAMP_MS: f32 = 50.0;

impl TapScene {
    /// Draws the scene from `seed`, on the paper's floor: 350 to 700 N on one foot at 0 to 15 cm from the region, and
    /// six touches of 30 to 150 N with the other foot.
    ///
    /// # Errors
    /// [`ExperimentError::Layout`], which no seed should cause.
    pub fn of(seed: u64, stance: HeavyFoot, geometry: &Geometry) -> Result<Self, ExperimentError> {
        let layout = layout(REGION_TILES[usize::from(seed % 2 == 1)], geometry)?;
        let region = layout.regions.first().map_or_else(Rect::default, |region| region.area);
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x7a95);
        let length_m = rng.random_range(0.22..0.30);
        let heavy = Newtons(rng.random_range(350.0..700.0));
        let press = Newtons(rng.random_range(30.0..150.0));
        let gap = rng.random_range(0.0..0.15);
        let along = region.min.x + region.size().x * rng.random_range(0.35..0.65);
        let shoe = shoe_size(length_m);
        let (heading, reach) = match stance {
            HeavyFoot::Facing => (rng.random_range(-0.2..0.2_f32), 0.5 * shoe.y),
            HeavyFoot::Beside => (FRAC_PI_2, 0.5 * shoe.x),
        };
        let position = Vec2::new(along, region.min.y - gap - reach);
        let standing = Foot { position, heading, length_m, force: heavy, roll: 0.4, left: false };
        // The other foot works to the right or left of the first one, not on top of it.
        let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let touching = Foot { roll: 0.6, force: Newtons::ZERO, heading: 0.15 * side, ..standing };
        let room = region.grown(-0.06);
        let mut place = || {
            let offset = Vec2::new(side * rng.random_range(0.05..0.40), rng.random_range(0.10..0.40));
            Vec2::new(along + offset.x, region.min.y + offset.y).clamp(room.min, room.max)
        };
        let mut touches = Vec::new();
        let mut start_ms = FIRST_MS;
        for touch in 0..TOUCHES {
            let from = clear_of(&standing, place());
            let slides = touch % 2 == 1;
            let to = if slides { clear_of(&standing, place()) } else { from };
            // A foot that operates a control slides at 0.3 m/s at most.
            let to = from + (to - from).clamp_length_max(0.25);
            let end_ms = start_ms + if slides { SLIDE_MS } else { TAP_MS };
            touches.push(Touch { from, to, start_ms, end_ms });
            start_ms = end_ms + PAUSE_MS;
        }
        let sway = [(); 2].map(|()| rng.random_range(0.0..TAU));
        Ok(Self { layout, way: stance, stance: standing, touching, press, touches, sway })
    }

    /// Returns the layout: one region with a single button over all of it.
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Returns the places and times (ms) at which the foot touches the region.
    pub fn touches(&self) -> impl ExactSizeIterator<Item = (Vec2, Range<u32>)> + '_ {
        self.touches.iter().map(|touch| (touch.from, touch.start_ms..touch.end_ms))
    }

    /// Returns the duration.
    #[must_use]
    pub fn length_ms(&self) -> u32 {
        self.touches.last().map_or(0, |last| last.end_ms) + 300
    }

    /// Returns the two feet at a moment, the standing one first; the working one has no force while it is in the air.
    #[must_use]
    pub fn feet(&self, milli: u32) -> [Foot; 2] {
        let time = milli as f32;
        let now = self.touches.iter().find(|touch| (touch.start_ms..touch.end_ms).contains(&milli));
        let mut working = self.touching;
        if let Some(touch) = now {
            let (start, end) = (touch.start_ms as f32, touch.end_ms as f32);
            let there = ease((time - start) / RAMP_MS) * ease((end - time) / RAMP_MS);
            working.force = self.press * there;
            // The foot slides at full force, and rests a little at both ends.
            let at = touch.from.lerp(touch.to, ease((time - start - 150.0) / (end - start - 300.0).max(1.0)));
            working.position = Vec2::ZERO;
            working.position = at - working.centre_of_pressure();
        }
        // The standing foot lands first, carries the rest of the weight, and sways a little.
        let sway = |hertz: f32, phase: usize| (TAU * hertz * time * 1e-3 + self.sway[phase]).sin();
        let mut stance = self.stance;
        stance.force = (self.stance.force + self.press) * ease(time / 200.0) - working.force;
        stance.force = stance.force * (1.0 + 0.01 * sway(1.1, 0));
        stance.roll += 0.03 * sway(0.4, 1);
        [stance, working]
    }
}

/// Moves `point` north until a foot that presses there does not overlap the other shoe.
fn clear_of(standing: &Foot, point: Vec2) -> Vec2 {
    let reach = shoe_size(standing.length_m).y * 0.5;
    let front = standing.position.y
        + if standing.heading.abs() > 1.0 { 0.5 * shoe_size(standing.length_m).x } else { reach };
    let beside = (point.x - standing.position.x).abs() > 0.15 && standing.heading.abs() < 1.0;
    // The ball is some 6 cm in front of the shoe's centre; the heel extends backwards.
    let lowest = if beside { point.y } else { front + reach + 0.07 };
    Vec2::new(point.x, point.y.max(lowest))
}

/// Smooth step from 0 to 1: `s² (3 - 2 s)`.
fn ease(share: f32) -> f32 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Result of one stance and method.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TapScore {
    /// Distance of the cursor from the centre of pressure of the foot that works in the region.
    pub cursor: PositionErrors,
    /// Number of samples in which the foot pressed with more than 10 N.
    pub samples: usize,
    /// Number of these samples without a cursor.
    pub without_cursor: usize,
    /// Number of touches of the region.
    pub touches: usize,
    /// Number of touches that pressed the control.
    pub pressed: usize,
    /// Number of further presses during a touch.
    pub repeated: usize,
    /// Number of presses without a touch of the region.
    pub out_of_nothing: usize,
    /// Number of changes of the cursor to another contact during a touch.
    pub flips: usize,
}

impl TapScore {
    /// Adds the counts of another score.
    pub fn append(&mut self, other: Self) {
        let Self { cursor, samples, without_cursor, touches, pressed, repeated, out_of_nothing, flips } =
            other;
        self.cursor.append(cursor);
        self.samples += samples;
        self.without_cursor += without_cursor;
        self.touches += touches;
        self.pressed += pressed;
        self.repeated += repeated;
        self.out_of_nothing += out_of_nothing;
        self.flips += flips;
    }
}

/// Cursor and events of a region, while a foot of 350 to 700 N stands at 0 to 15 cm from it and the other one taps
/// and slides in it with 30 to 150 N.
///
/// The whole region is one button, so that a press anywhere in it counts.
#[derive(Clone, Debug, PartialEq)]
pub struct TapTable {
    /// One entry per method ([`METHODS`]) and stance ([`HeavyFoot::ALL`]).
    pub scores: [[TapScore; 2]; 2],
    floor: FloorQuality,
    people: usize,
}

/// A table for the paper's floor.
impl Default for TapTable {
    fn default() -> Self {
        Self::on(FloorQuality::Paper)
    }
}

/// Time after a touch in which a press still belongs to it (ms).
const AFTER_MS: u32 = 60;

impl TapTable {
    /// Creates an empty table for floors of this quality.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        Self { scores: Default::default(), floor, people: 0 }
    }

    /// Simulates the person drawn from `seed` using a region in both stances, on a floor with parts drawn from `seed`
    /// too.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`].
    pub fn add_person(&mut self, seed: u64) -> Result<(), ExperimentError> {
        for stance in HeavyFoot::ALL {
            let geometry = Geometry::default();
            let scene = TapScene::of(seed, stance, &geometry)?;
            self.add_scene(&mut Rig::of_quality(geometry, self.floor, seed)?, &scene, &mut ());
        }
        self.people += 1;
        Ok(())
    }

    /// Simulates `scene` on the floor of `rig`, with the faults of `fault`.
    pub fn add_scene(&mut self, rig: &mut Rig, scene: &TapScene, fault: &mut impl FaultHook) {
        let which = scene.way as usize;
        let scores = &mut self.scores;
        let mut engines = METHODS.map(|(method, _)| Watched {
            engine: rig.engine(scene.layout.clone(), method),
            snapshot: Snapshot::default(),
            presses: vec![0; scene.touches.len()],
            cursor: None,
        });
        for milli in 1..=scene.length_ms() {
            let (feet, time) = (scene.feet(milli), u64::from(milli));
            let mut cues: SmallVec<[Cue; 4]> = SmallVec::new();
            let loads = feet.iter().map(Foot::as_load);
            rig.step_with(fault, time, loads, |frame| {
                for (watched, scores) in engines.iter_mut().zip(scores.iter_mut()) {
                    cues = watched.step(frame, scene, milli, &feet[1], &mut scores[which]);
                }
            });
            fault.felt(time, &cues);
        }
        for (watched, scores) in engines.iter().zip(scores.iter_mut()) {
            let score = &mut scores[which];
            score.touches += watched.presses.len();
            score.pressed += watched.presses.iter().filter(|&&presses| presses > 0).count();
            score.repeated += watched.presses.iter().map(|presses| presses.saturating_sub(1)).sum::<usize>();
        }
    }

    /// Adds all people of another table.
    pub fn append(&mut self, other: Self) {
        for (score, others) in self.scores.iter_mut().flatten().zip(other.scores.into_iter().flatten()) {
            score.append(others);
        }
        self.people += other.people;
    }

    fn named(&self) -> impl Iterator<Item = (&'static str, &'static str, &TapScore)> + '_ {
        METHODS.into_iter().zip(&self.scores).flat_map(|((_, method), scores)| {
            HeavyFoot::ALL.into_iter().zip(scores).map(move |(stance, score)| (method, stance.name(), score))
        })
    }

    /// Returns all lines, for programs.
    pub fn lines(&self) -> impl Iterator<Item = TapLine> + '_ {
        self.named().map(|(method, stance, score)| TapLine {
            method,
            stance,
            cursor: score.cursor.summary(),
            without_cursor: score.without_cursor as f32 / score.samples.max(1) as f32,
            touches: score.touches,
            pressed: score.pressed,
            repeated: score.repeated,
            out_of_nothing: score.out_of_nothing,
        })
    }
}

/// An engine, and its presses during each touch.
struct Watched {
    engine: Engine,
    snapshot: Snapshot,
    presses: Vec<usize>,
    /// The contact that was the cursor at the last sample with a pressing foot.
    cursor: Option<ContactId>,
}

impl Watched {
    fn step(
        &mut self,
        frame: &ForceFrame,
        scene: &TapScene,
        milli: u32,
        working: &Foot,
        score: &mut TapScore,
    ) -> SmallVec<[Cue; 4]> {
        let step = self.engine.step(frame);
        let pressed = step.events.iter().filter(|event| event.kind == EventKind::Pressed).count();
        let cues = step.cues.iter().cloned().collect();
        let touched = |touch: &Touch| (touch.start_ms..touch.end_ms + AFTER_MS).contains(&milli);
        match scene.touches.iter().position(touched) {
            Some(touch) => self.presses[touch] += pressed,
            None => score.out_of_nothing += pressed,
        }
        if working.force.0 <= DOWN_N {
            self.cursor = None;
            return cues;
        }
        self.engine.snapshot(&mut self.snapshot);
        score.samples += 1;
        let Some(cursor) = self.snapshot.cursors.first().copied().flatten() else {
            score.without_cursor += 1;
            return cues;
        };
        score.cursor.push(cursor.position.distance(working.centre_of_pressure()));
        score.flips +=
            usize::from(self.cursor.replace(cursor.contact).is_some_and(|old| old != cursor.contact));
        cues
    }
}

/// One region with a single button over all of it.
fn layout(at: (f32, f32), geometry: &Geometry) -> Result<Layout, ExperimentError> {
    let (size, release) = (REGION_SIZE_TILES, 0.6 * PRESS_N);
    let text = format!(
        "Layout(version: 1, title: \"Taps\", regions: [(id: \"all\", at: {at:?}, size: {size:?})],
         widgets: [(id: \"all\", kind: \"button\", at: {at:?}, size: {size:?},
                    press_n: {PRESS_N:?}, release_n: {release:?})])"
    );
    let loaded = parse_layout(&text, "taps", &Kinds::builtin(), geometry);
    loaded.map(|loaded| loaded.layout).map_err(|problems| ExperimentError::Layout(problems.to_string()))
}

/// One line of a [`TapTable`], for programs.
#[derive(Debug, Serialize)]
pub struct TapLine {
    method: &'static str,
    stance: &'static str,
    cursor: Option<Summary>,
    without_cursor: f32,
    touches: usize,
    pressed: usize,
    repeated: usize,
    out_of_nothing: usize,
}

impl fmt::Display for TapTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "error of the cursor{}, {} people standing 0 to 15 cm from its region with 350 to 700 N,\n\
             tapping and sliding in it with 30 to 150 N, cm",
            quality_note(self.floor),
            self.people
        )?;
        writeln!(
            f,
            "                                          no cursor  touches           again in  presses out"
        )?;
        writeln!(
            f,
            "method  stance    median     p95   worst          %           pressed  a touch   of nothing"
        )?;
        for (method, stance, score) in self.named() {
            let TapScore { cursor, touches, pressed, repeated, out_of_nothing, .. } = score;
            let without = 100.0 * score.without_cursor as f32 / score.samples.max(1) as f32;
            writeln!(
                f,
                "{method:8}{stance:8}{cursor}{without:11.2}{touches:9}{pressed:9}{repeated:9}{out_of_nothing:13}"
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scenes() -> impl Iterator<Item = (Rect, TapScene)> {
        let geometry = Geometry::default();
        (0..60_u64).flat_map(move |seed| {
            HeavyFoot::ALL.map(|stance| {
                let scene = TapScene::of(seed, stance, &geometry).unwrap();
                (scene.layout.regions[0].area, scene)
            })
        })
    }

    #[test]
    fn one_foot_stands_beside_the_region_and_the_other_one_works_in_it() {
        for (region, scene) in scenes() {
            let half = shoe_size(scene.stance.length_m) * 0.5;
            let reach = if scene.stance.heading > 1.0 { half.x } else { half.y };
            let gap = region.min.y - scene.stance.position.y - reach;
            assert!((-1e-4..0.1501).contains(&gap), "{gap} m between shoe and region");
            let mut greatest = 0.0_f32;
            for milli in 1..=scene.length_ms() {
                let [stance, working] = scene.feet(milli);
                if milli > 200 {
                    assert!((340.0..870.0).contains(&stance.force.0), "{:?}", stance.force);
                }
                greatest = greatest.max(working.force.0);
                if working.force.0 > 0.0 {
                    assert!(region.contains(working.centre_of_pressure()), "{working:?}");
                    let apart = working.position.distance(stance.position);
                    assert!(apart > 0.095, "{apart} m between two shoes");
                }
            }
            assert!((29.0..151.0).contains(&greatest), "{greatest} N");
        }
    }

    #[test]
    fn feet_never_jump_while_they_press() {
        for (_, scene) in scenes().take(20) {
            for milli in 201..scene.length_ms() {
                let ([stance, working], [next, later]) = (scene.feet(milli), scene.feet(milli + 1));
                assert!((stance.force - next.force).0.abs() < 15.0);
                if working.force.0 > 0.0 && later.force.0 > 0.0 {
                    assert!(working.position.distance(later.position) < 0.002);
                }
            }
        }
    }
}
