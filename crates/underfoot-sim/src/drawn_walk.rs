//! Walks drawn on a floor: a person enters, walks along the path, uses the control at its end, and leaves.

use std::fmt::Write as _;
use std::time::Duration;

use glam::Vec2;
use thiserror::Error;

use super::person::Person;
use super::scenario::Scenario;
use super::script::Script;
use super::visit::{AWAY_M, PAUSE, upper, working};
use super::way::{simplified, spaced};
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Layout, Widget};
use underfoot::widget::{Behaviour, WidgetId};

/// Maximum distance between the drawn line and its simplified path (m): half the width of a foot.
const LOOSE_M: f32 = 0.05;

/// Minimum distance between two points of a path (m): less than half a step. Nearer points merge.
const APART_M: f32 = 0.25;

/// Space that a standing person needs on each side (m).
const STANDING_M: f32 = 0.16;

/// Time that a person stands at the end of a path without a control.
const LOOKS_ROUND: Duration = Duration::from_secs(2);

/// Length of a detour that is worth avoiding a control (m).
const DETOUR_M: f32 = 2.0;

/// Reason why a path can't be walked.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WalkError {
    /// The path has no point.
    #[error("there is no way to walk")]
    Nowhere,
    /// The control is out of reach from every place on the path near its end.
    #[error("nobody who comes that way can use \"{0}\": end the walk on it from another side")]
    OutOfReach(WidgetId),
    /// The walk is impossible, for example on a floor too small to stand on.
    #[error("nobody can walk there")]
    Impossible,
}

/// The walk along a drawn path, as steps of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnWalk {
    steps: Vec<String>,
    uses: Option<WidgetId>,
}

impl DrawnWalk {
    /// Plans the walk along `way` (floor metres), and returns it with the script of its feet.
    ///
    /// A person of default measures enters over the best side and walks along the path. If the path ends on a control
    /// of `layout` that is on the page with number `page`, the person stops within reach of it and presses it, or
    /// drags it if it is a slider, dial or pad; otherwise the person stands at the end for a while. Then the person
    /// leaves. Points outside the floor are moved to its edge; points that are not finite are ignored.
    ///
    /// # Errors
    /// [`WalkError`] if the path is empty or can't be walked.
    pub fn new(
        way: &[Vec2],
        page: usize,
        layout: &Layout,
        geometry: &Geometry,
    ) -> Result<(Self, Script), WalkError> {
        let way: Vec<Vec2> = way.iter().copied().filter(|point| point.is_finite()).collect();
        let end = way.last().copied().ok_or(WalkError::Nowhere)?;
        let plan = Plan { layout, geometry, page };
        let used = layout.widget_at(page, end).and_then(|index| layout.widgets.get(index));
        let Some(widget) = used else {
            let mut steps = plan.steps_along(&way);
            steps.push(wait(LOOKS_ROUND));
            return plan.played(steps, end, None).ok_or(WalkError::Impossible);
        };
        let tries = AWAY_M.into_iter().find_map(|away_m| {
            let stretch = plan.up_to(&way, widget.area.centre(), away_m);
            let stands = stretch.last().copied()?;
            let mut steps = plan.steps_along(&stretch);
            steps.push(wait(PAUSE));
            steps.extend(plan.use_of(widget));
            steps.push(wait(PAUSE));
            plan.played(steps, stands, Some(widget.id.clone()))
        });
        tries.ok_or_else(|| WalkError::OutOfReach(widget.id.clone()))
    }

    /// Returns the control at the end of the path, if the walk uses one.
    #[must_use]
    pub fn uses(&self) -> Option<&WidgetId> {
        self.uses.as_ref()
    }

    /// Writes a scenario of these walks, each starting after its delay, as text that [`Scenario::parse`] reads, so
    /// that a drawn walk can be edited and played again. Includes at most 65 walks, and limits each delay to ten
    /// minutes.
    #[must_use]
    pub fn scenario(title: &str, walks: &[(Duration, Self)]) -> String {
        let mut text = format!("Scenario(\n    title: {title:?},\n");
        let mut walks = walks.iter().take(65);
        let first = walks.next().map(|(after, walk)| walk.after(*after, "        ")).unwrap_or_default();
        text += &format!("    steps: [\n{first}    ],\n");
        let others: Vec<String> = walks
            .map(|(after, walk)| {
                format!("        (steps: [\n{}        ]),\n", walk.after(*after, "            "))
            })
            .collect();
        if !others.is_empty() {
            text += &format!("    others: [\n{}    ],\n", others.concat());
        }
        text + ")\n"
    }

    /// The steps after an initial wait, one on each line.
    fn after(&self, after: Duration, indent: &str) -> String {
        let after = after.min(Duration::from_secs(600));
        let mut text = String::new();
        for step in std::iter::once(&wait(after)).chain(&self.steps) {
            // Writing to a string never fails.
            let _ = writeln!(text, "{indent}{step},");
        }
        text
    }
}

/// Layout, floor and page that a walk is planned on.
struct Plan<'a> {
    layout: &'a Layout,
    geometry: &'a Geometry,
    page: usize,
}

impl Plan<'_> {
    /// Completes the walk and resolves its script; `None` if the walk is impossible.
    fn played(
        &self,
        mut steps: Vec<String>,
        end: Vec2,
        uses: Option<WidgetId>,
    ) -> Option<(DrawnWalk, Script)> {
        steps.push(format!("Leave(to: {})", self.side_for(end)));
        let walk = DrawnWalk { steps, uses };
        let text = DrawnWalk::scenario("A walk", &[(Duration::ZERO, walk.clone())]);
        let scenario = Scenario::parse("drawn.ron", &text).ok()?;
        Some((walk, scenario.resolve(self.layout, self.geometry).ok()?))
    }

    /// Steps that enter the floor and walk along `way`.
    fn steps_along(&self, way: &[Vec2]) -> Vec<String> {
        let points = spaced(&simplified(&self.on_floor(way), LOOSE_M), APART_M);
        let Some((first, rest)) = points.split_first() else { return Vec::new() };
        let mut steps = vec![format!("Enter(from: {}, at: {})", self.side_for(*first), self.tiles(*first))];
        if let Some((last, between)) = rest.split_last() {
            let via: Vec<String> = between.iter().map(|point| self.tiles(*point)).collect();
            let via = if via.is_empty() { String::new() } else { format!(", via: [{}]", via.join(", ")) };
            steps.push(format!("WalkTo(at: {}{via})", self.tiles(*last)));
        }
        steps
    }

    /// Moves the points to where a person can stand.
    fn on_floor(&self, way: &[Vec2]) -> Vec<Vec2> {
        let bounds = self.geometry.bounds();
        let room = bounds.grown(-STANDING_M.min(0.4 * bounds.size().min_element()));
        way.iter().map(|point| point.clamp(room.min, room.max)).collect()
    }

    /// Cuts the path where it comes within `away_m` of `target`. A path entirely within that distance is replaced by
    /// one place at that distance south of the target, or north if there is no room.
    fn up_to(&self, way: &[Vec2], target: Vec2, away_m: f32) -> Vec<Vec2> {
        let way = self.on_floor(way);
        let Some(last) = way.iter().rposition(|point| point.distance(target) >= away_m) else {
            let south = target - Vec2::Y * away_m;
            let is_there = self.geometry.bounds().contains(south - Vec2::Y * STANDING_M);
            return vec![if is_there { south } else { target + Vec2::Y * away_m }];
        };
        let (mut stretch, from) = (way[..=last].to_vec(), way[last]);
        if let Some(next) = way.get(last + 1) {
            // The line crosses the circle once, from outside, so bisection finds the crossing.
            let (mut outer, mut inner) = (0.0, 1.0);
            for _ in 0..20 {
                let middle = 0.5 * (outer + inner);
                let is_outside = from.lerp(*next, middle).distance(target) >= away_m;
                if is_outside { outer = middle } else { inner = middle }
            }
            stretch.push(from.lerp(*next, outer));
        }
        stretch
    }

    /// Steps that operate `widget`.
    fn use_of(&self, widget: &Widget) -> Vec<String> {
        let how = working(widget, &Person::default());
        let (id, force, hold) = (widget.id.as_str(), how.force.0.round(), how.hold.as_millis());
        let dragged =
            |from: &str, to: &str| format!("Drag(widget: {id:?}, from: {from}, to: {to}, force_n: {force})");
        let point = |share: Vec2| {
            let at = self.tiles(widget.area.min + share * widget.area.size());
            format!("Point(at: {at}, force_n: {force}, hold_ms: {hold})")
        };
        let step = match &widget.behaviour {
            Behaviour::Slider(_) => dragged("0.25", "0.75"),
            Behaviour::Dial(_) => dragged("0.4", "0.6"),
            Behaviour::Pad(_) => dragged("(0.35, 0.35)", "(0.65, 0.65)"),
            Behaviour::Stepper(spec) => point(upper(spec.axis)),
            Behaviour::Selector(spec) => point(upper(spec.axis)),
            Behaviour::Lean(_)
            | Behaviour::Button(_)
            | Behaviour::Hold(_)
            | Behaviour::Switch(_)
            | Behaviour::Pedal(_) => {
                format!("Press(widget: {id:?}, force_n: {force}, hold_ms: {hold})")
            }
        };
        vec![step; how.times]
    }

    /// The best side of the floor for reaching `place`: near, and with few controls in between.
    fn side_for(&self, place: Vec2) -> &'static str {
        let bounds = self.geometry.bounds();
        let Vec2 { x, y } = place;
        let sides = [
            ("South", Vec2::new(x, bounds.min.y)),
            ("North", Vec2::new(x, bounds.max.y)),
            ("West", Vec2::new(bounds.min.x, y)),
            ("East", Vec2::new(bounds.max.x, y)),
        ];
        let cost = |edge: Vec2| {
            let ground = Rect::new(edge.min(place), edge.max(place)).grown(STANDING_M);
            let controls = self.layout.widgets.iter();
            let in_the_way =
                controls.filter(|widget| widget.is_on(self.page) && widget.area.overlaps(ground)).count();
            edge.distance(place) + DETOUR_M * in_the_way as f32
        };
        let best = sides.into_iter().min_by(|one, other| cost(one.1).total_cmp(&cost(other.1)));
        best.map_or("South", |(side, _)| side)
    }

    /// Formats `place` in tiles, with two decimals.
    fn tiles(&self, place: Vec2) -> String {
        let one = self.geometry.metres_from_tiles(Vec2::ONE);
        let tiles = place / one;
        format!("({:.2}, {:.2})", tiles.x, tiles.y)
    }
}

fn wait(time: Duration) -> String {
    format!("Wait(ms: {})", time.as_millis())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Foot;
    use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};
    use underfoot::units::Instant;

    fn shipped(name: &str) -> Layout {
        let text = builtin_layout(name).unwrap();
        parse_layout(text, name, &Kinds::builtin(), &Geometry::default()).unwrap().layout
    }

    fn middle_of(layout: &Layout, id: &str) -> Vec2 {
        layout.widgets.iter().find(|widget| widget.id == id).unwrap().area.centre()
    }

    /// All feet of the script with more than 1 N, at each millisecond.
    fn pressing(script: &Script) -> Vec<Vec<Foot>> {
        let at = |ms| {
            let mut feet = Vec::new();
            script.feet_at(Instant::from_millis(ms), &mut feet);
            feet.retain(|foot| foot.force.0 > 1.0);
            feet
        };
        (0..script.duration().as_millis() as u64).map(at).collect()
    }

    #[test]
    fn somebody_who_is_drawn_a_bow_walks_the_bow_and_leaves() {
        let geometry = Geometry::default();
        // A quarter of a circle around the south-east corner, as if drawn with a mouse.
        let bow: Vec<Vec2> = (0..=90)
            .map(|degrees| {
                let (sin, cos) = (degrees as f32).to_radians().sin_cos();
                Vec2::new(1.8 - 1.2 * cos, 1.2 * sin)
            })
            .collect();
        let pond = shipped("pond");
        let (walk, script) = DrawnWalk::new(&bow, 0, &pond, &geometry).unwrap();
        assert_eq!(walk.uses(), None);
        let frames = pressing(&script);
        let on_floor: Vec<&Foot> =
            frames.iter().flatten().filter(|foot| geometry.bounds().contains(foot.position)).collect();
        assert!(on_floor.len() > 2000, "{}", on_floor.len());
        // Feet are 8 cm beside the path, simplification shortens the path by up to 5 cm, and steps cut bends.
        let near = |foot: &&&Foot| bow.iter().any(|point| point.distance(foot.position) < 0.30);
        let share = on_floor.iter().filter(near).count() as f32 / on_floor.len() as f32;
        assert!(share > 0.8, "{share}");
        assert!(frames.last().unwrap().iter().all(|foot| !geometry.bounds().contains(foot.position)));
    }

    #[test]
    fn who_ends_on_a_control_uses_it_from_whichever_side_they_come() {
        let geometry = Geometry::default();
        for name in builtin_layouts() {
            let layout = shipped(name);
            for widget in layout.widgets.iter().filter(|widget| widget.is_on(0)) {
                let target = widget.area.centre();
                let from_south = [Vec2::new(target.x, 0.0), target];
                let done = DrawnWalk::new(&from_south, 0, &layout, &geometry);
                let (walk, script) = done.unwrap_or_else(|error| panic!("{name}: {error}"));
                let used = layout.widget_at(0, target).map(|index| &layout.widgets[index].id);
                assert_eq!(walk.uses(), used, "{name}");
                let touched = |foot: &Foot| widget.area.grown(0.01).contains(foot.centre_of_pressure());
                assert!(pressing(&script).iter().flatten().any(touched), "{name}: {}", widget.id);
            }
        }
        let map = shipped("map");
        let home = middle_of(&map, "home");
        for from in [Vec2::new(-0.2, home.y), Vec2::new(1.7, 1.7), home] {
            let (walk, _) = DrawnWalk::new(&[from, home], 0, &map, &geometry).unwrap();
            assert_eq!(walk.uses(), Some(&WidgetId::new("home")), "from {from}");
        }
    }

    #[test]
    fn what_was_drawn_is_a_scenario_that_plays_the_same_again() {
        let (geometry, map) = (Geometry::default(), shipped("map"));
        let way = |id: &str| [Vec2::new(0.3, 0.1), middle_of(&map, id)];
        let (home, script) = DrawnWalk::new(&way("home"), 0, &map, &geometry).unwrap();
        let (zoom, _) = DrawnWalk::new(&way("zoom"), 0, &map, &geometry).unwrap();
        let alone = DrawnWalk::scenario("One \"visit\"", &[(Duration::ZERO, home.clone())]);
        let again = Scenario::parse("drawn.ron", &alone).unwrap();
        assert_eq!(again.title(), "One \"visit\"");
        assert_eq!(pressing(&again.resolve(&map, &geometry).unwrap()), pressing(&script));
        let later = Duration::from_millis(2500);
        let both = DrawnWalk::scenario("Two", &[(Duration::ZERO, home), (later, zoom)]);
        let both = Scenario::parse("drawn.ron", &both).unwrap().resolve(&map, &geometry).unwrap();
        assert!(pressing(&both).iter().any(|feet| feet.len() > 2), "both are there at once");
    }

    #[test]
    fn a_way_that_is_none_is_refused_and_one_beyond_the_floor_is_walked_at_its_edge() {
        let (geometry, pond) = (Geometry::default(), shipped("pond"));
        let nowhere = DrawnWalk::new(&[Vec2::NAN], 0, &pond, &geometry);
        assert_eq!(nowhere.unwrap_err(), WalkError::Nowhere);
        let beyond = [Vec2::new(-9.0, 0.9), Vec2::new(99.0, 0.9)];
        assert!(DrawnWalk::new(&beyond, 0, &pond, &geometry).is_ok());
        assert!(DrawnWalk::new(&[Vec2::new(0.9, 0.9)], 0, &pond, &geometry).is_ok(), "a click");
    }
}
