//! Fingers and pens as feet: each presses one foot where it touches the floor.

use eframe::egui::{Event, TouchPhase};
use glam::Vec2;

use super::feed::{FootSink, PreviewFoot};
use underfoot::units::Newtons;

/// Maximum number of fingers that are feet at one time; further ones are ignored.
const MOST: usize = 8;

/// An action of a finger or a pen, in floor metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FloorTouch {
    /// The screen, and the finger on it.
    pub(super) finger: (u64, u64),
    /// The position.
    pub(super) at: Vec2,
    /// The pressure from 0 to 1, if the screen or the pen measures it.
    pub(super) pressure: Option<f32>,
    /// The phase of the touch.
    pub(super) phase: Phase,
}

/// The phase of a touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// It starts on the bare floor.
    Down,
    /// It continues.
    On,
    /// It ends.
    Up,
}

impl FloorTouch {
    /// The touch in `event`, if it is one. `floor` converts a point of the screen to floor metres; `is_floor` returns
    /// whether a point of the screen is the bare floor, where a foot may start.
    pub(super) fn of(
        event: &Event,
        floor: impl Fn(eframe::egui::Pos2) -> Vec2,
        is_floor: impl Fn(eframe::egui::Pos2) -> bool,
    ) -> Option<Self> {
        let Event::Touch { device_id, id, phase, pos, force } = event else { return None };
        let phase = match phase {
            TouchPhase::Start if is_floor(*pos) => Phase::Down,
            TouchPhase::Start => return None,
            TouchPhase::Move => Phase::On,
            TouchPhase::End | TouchPhase::Cancel => Phase::Up,
        };
        // Screens that do not measure pressure report 0.
        let pressure = force.filter(|force| *force > 0.0);
        Some(Self { finger: (device_id.0, id.0), at: floor(*pos), pressure, phase })
    }
}

/// The feet of fingers; each keeps its index in the list while it is down.
#[derive(Debug, Default)]
pub(super) struct Fingers(Vec<Option<Finger>>);

#[derive(Debug)]
struct Finger {
    finger: (u64, u64),
    at: Vec2,
    force: Newtons,
    /// Whether the screen measures its pressure: others report none, or always the maximum.
    is_measured: bool,
}

impl Fingers {
    /// Whether at least one finger is a foot.
    pub(super) fn are_down(&self) -> bool {
        self.0.iter().any(Option::is_some)
    }

    /// The path of each foot since the last call. `foot` has the usual force, which corresponds to half of a finger's
    /// maximum pressure.
    pub(super) fn step(
        &mut self,
        touches: &[FloorTouch],
        foot: PreviewFoot,
        sink: &dyn FootSink,
    ) -> Vec<Vec<PreviewFoot>> {
        let mut paths: Vec<Vec<PreviewFoot>> = self.0.iter().map(|_| Vec::new()).collect();
        for touch in touches {
            let known =
                self.0.iter().position(|known| known.as_ref().is_some_and(|one| one.finger == touch.finger));
            let place = match (touch.phase, known) {
                (Phase::Down, None) => self.free_place(),
                (_, known) => known,
            };
            let Some(place) = place else { continue };
            paths.resize_with(self.0.len(), Vec::new);
            let lands = known.is_none();
            let was_measured = self.0[place].as_ref().is_some_and(|finger| finger.is_measured);
            let is_measured = was_measured || touch.pressure.is_some_and(|share| share < 1.0);
            let force = match touch.pressure.filter(|_| is_measured) {
                Some(share) => Newtons(2.0 * share.min(1.0) * foot.force.0),
                None => foot.force,
            };
            let path = &mut paths[place];
            if lands {
                // Start above the floor: otherwise the foot would slide there.
                path.push(under(touch.at, Newtons::ZERO, foot, sink));
            }
            path.push(under(touch.at, force, foot, sink));
            self.0[place] = Some(Finger { finger: touch.finger, at: touch.at, force, is_measured });
            if touch.phase == Phase::Up {
                path.push(under(touch.at, Newtons::ZERO, foot, sink));
                self.0[place] = None;
            }
        }
        // The foot of a finger that keeps still stays in its place.
        for (path, finger) in paths.iter_mut().zip(&self.0) {
            if let (true, Some(finger)) = (path.is_empty(), finger) {
                path.push(under(finger.at, finger.force, foot, sink));
            }
        }
        while self.0.last().is_some_and(Option::is_none) {
            self.0.pop();
        }
        paths
    }

    /// Lifts all fingers, for example when the window loses the focus in mid-touch.
    pub(super) fn lift(&mut self) {
        self.0.clear();
    }

    fn free_place(&mut self) -> Option<usize> {
        if let Some(free) = self.0.iter().position(Option::is_none) {
            return Some(free);
        }
        (self.0.len() < MOST).then(|| {
            self.0.push(None);
            self.0.len() - 1
        })
    }
}

/// `foot` with its centre of pressure at `at`.
fn under(at: Vec2, force: Newtons, foot: PreviewFoot, sink: &dyn FootSink) -> PreviewFoot {
    let foot = PreviewFoot { force, position: Vec2::ZERO, ..foot };
    PreviewFoot { position: at - sink.centre_of_pressure(&foot), ..foot }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Floor;

    impl FootSink for Floor {
        fn lead(&mut self, _over_s: f32, _paths: &[Vec<PreviewFoot>]) {}
    }

    fn usual() -> PreviewFoot {
        PreviewFoot {
            position: Vec2::ZERO,
            heading_rad: 0.0,
            length_m: 0.28,
            force: Newtons(150.0),
            roll: 0.75,
            left: false,
        }
    }

    fn touch(finger: u64, x: f32, pressure: Option<f32>, phase: Phase) -> FloorTouch {
        FloorTouch { finger: (0, finger), at: Vec2::new(x, 0.6), pressure, phase }
    }

    /// The last position and force of each foot; `None` for an index without a foot.
    fn ends(paths: &[Vec<PreviewFoot>]) -> Vec<Option<(f32, f32)>> {
        let end = |path: &Vec<PreviewFoot>| {
            path.last().map(|foot| (Floor.centre_of_pressure(foot).x, foot.force.0.round()))
        };
        paths.iter().map(end).collect()
    }

    #[test]
    fn two_fingers_are_two_feet_and_one_may_go_without_the_other() {
        let mut fingers = Fingers::default();
        let down = [touch(7, 0.4, None, Phase::Down), touch(9, 0.9, None, Phase::Down)];
        let paths = fingers.step(&down, usual(), &Floor);
        assert_eq!(paths[0][0].force, Newtons::ZERO, "it comes from above");
        assert_eq!(ends(&paths), [Some((0.4, 150.0)), Some((0.9, 150.0))]);
        let paths = fingers.step(&[touch(9, 1.0, None, Phase::On)], usual(), &Floor);
        assert_eq!(ends(&paths), [Some((0.4, 150.0)), Some((1.0, 150.0))], "the still one stays");
        let paths = fingers.step(&[touch(7, 0.4, None, Phase::Up)], usual(), &Floor);
        assert_eq!(ends(&paths), [Some((0.4, 0.0)), Some((1.0, 150.0))]);
        let paths = fingers.step(&[], usual(), &Floor);
        assert_eq!(ends(&paths), [None, Some((1.0, 150.0))], "each keeps its place in the list");
        fingers.step(&[touch(9, 1.0, None, Phase::Up)], usual(), &Floor);
        assert!(!fingers.are_down());
    }

    #[test]
    fn a_pen_presses_as_hard_as_it_is_pressed() {
        let mut fingers = Fingers::default();
        let paths = fingers.step(&[touch(1, 0.5, Some(0.5), Phase::Down)], usual(), &Floor);
        assert_eq!(ends(&paths), [Some((0.5, 150.0))], "half is the usual force");
        let paths = fingers.step(&[touch(1, 0.5, Some(1.0), Phase::On)], usual(), &Floor);
        assert_eq!(ends(&paths), [Some((0.5, 300.0))]);
    }

    #[test]
    fn a_screen_that_always_reports_the_maximum_measures_nothing() {
        let mut fingers = Fingers::default();
        for phase in [Phase::Down, Phase::On] {
            let paths = fingers.step(&[touch(1, 0.5, Some(1.0), phase)], usual(), &Floor);
            assert_eq!(ends(&paths), [Some((0.5, 150.0))]);
        }
        let paths = fingers.step(&[touch(1, 0.5, Some(0.8), Phase::On)], usual(), &Floor);
        assert_eq!(ends(&paths), [Some((0.5, 240.0))], "it measures after all");
    }

    #[test]
    fn fingers_that_came_down_elsewhere_or_are_too_many_put_no_foot_down() {
        let mut fingers = Fingers::default();
        assert!(fingers.step(&[touch(3, 0.5, None, Phase::On)], usual(), &Floor).is_empty());
        let many: Vec<FloorTouch> = (0..20).map(|finger| touch(finger, 0.5, None, Phase::Down)).collect();
        assert_eq!(fingers.step(&many, usual(), &Floor).len(), MOST);
        fingers.lift();
        assert!(!fingers.are_down());
    }
}
