//! A visitor who uses every control of any layout.

use std::collections::VecDeque;
use std::f32::consts::{FRAC_PI_2, PI};
use std::time::Duration;

use glam::Vec2;

use super::performance::Performance;
use super::person::{MoveError, Person};
use super::script::Script;
use super::slide::Slide;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Layout, Widget};
use underfoot::units::Newtons;
use underfoot::widget::{Axis, Behaviour, Guard, WidgetId};

/// Time that the floor stays empty at first: enough for a tare.
const EMPTY: Duration = Duration::from_millis(1200);

/// Force of a press as a multiple of the control's threshold, its minimum, and its maximum as a share of the weight:
/// some weight stays on the other foot.
const FIRMLY: f32 = 1.6;
const LEAST: Newtons = Newtons(90.0);
const MOST_SHARE: f32 = 0.8;

/// Time that a foot stays on a control in addition to its dwell time.
const HOLD: Duration = Duration::from_millis(350);

/// Time that a person stands before using a control, until the weight settles.
pub(super) const PAUSE: Duration = Duration::from_millis(500);

/// Speed of a slide along a slider, in metres per second.
const SLIDE_M_S: f32 = 0.3;

/// Distances from a control at which a person stands to use it, in metres; the foot reaches 0.85 m.
pub(super) const AWAY_M: [f32; 5] = [0.45, 0.55, 0.65, 0.36, 0.75];

/// Directions from a control in which the person stands, as turns clockwise from south; a person south of the control
/// faces north.
const ASIDE_RAD: [f32; 8] = [0.0, 0.5, -0.5, 1.0, -1.0, FRAC_PI_2, -FRAC_PI_2, PI];

/// Maximum distance of a sidestep (m); the person walks longer distances.
const SIDESTEP_M: f32 = 1.5;

/// Half of the space that a standing person needs (m).
const STANDING_M: Vec2 = Vec2::new(0.15, 0.16);

/// A visit of one person to the controls of a layout.
#[derive(Clone, Debug)]
pub struct Visit {
    /// Script of the visitor.
    pub script: Script,
    /// Controls that the visitor does not reach: on pages without a control that leads to them, or too far from any
    /// place to stand.
    pub missed: Vec<WidgetId>,
}

/// Simulates one person of 70 kg who comes from the south, uses the controls of `layout` in their order, page by
/// page, and leaves.
///
/// The visitor presses buttons, drags sliders, flips switches, and presses controls with confirmation twice. The
/// visitor stands beside controls and outside the regions where there is room. The same layout always gives the same
/// visit.
#[must_use]
pub fn visit(layout: &Layout, geometry: &Geometry) -> Visit {
    let mut visitor = Visitor {
        layout,
        bounds: geometry.bounds(),
        person: Person::default(),
        performance: Performance::new(Person::default(), 0),
        page: 0,
        used: vec![false; layout.widgets.len()],
        out_of_reach: vec![false; layout.widgets.len()],
    };
    visitor.performance.wait(EMPTY);
    loop {
        visitor.use_page();
        if !visitor.turn_page() {
            break;
        }
    }
    visitor.leave();
    let missed = layout.widgets.iter().zip(&visitor.used).filter(|(_, used)| !**used);
    let missed = missed.map(|(widget, _)| widget.id.clone()).collect();
    Visit { script: Script::new(vec![visitor.performance], geometry.bounds()), missed }
}

struct Visitor<'a> {
    layout: &'a Layout,
    bounds: Rect,
    person: Person,
    performance: Performance,
    page: usize,
    used: Vec<bool>,
    /// Whether the last attempt to use each control failed.
    out_of_reach: Vec<bool>,
}

impl Visitor<'_> {
    /// Uses the controls of the current page, except those that lead to another page.
    fn use_page(&mut self) {
        for (index, widget) in self.layout.widgets.iter().enumerate() {
            let stays = widget.goto.is_none_or(|page| page == self.page);
            if widget.is_on(self.page) && stays && !self.used[index] {
                self.use_control(index);
            }
        }
    }

    /// Uses the control with this index; false if it is out of reach.
    fn use_control(&mut self, index: usize) -> bool {
        let is_done = self.layout.widgets.get(index).is_some_and(|widget| self.work(widget));
        self.used[index] |= is_done;
        self.out_of_reach[index] = !is_done;
        is_done
    }

    /// Goes one page nearer to a page with an unused control that may be in reach; false if no control in reach leads
    /// to one.
    fn turn_page(&mut self) -> bool {
        while let Some(first) = self.way_on() {
            if self.use_control(first) {
                let shown = self.layout.widgets.get(first).and_then(|widget| widget.goto);
                self.page = shown.unwrap_or(self.page);
                return true;
            }
        }
        false
    }

    /// Breadth-first search: the control that is the first step to a page with an unused control, or is itself an
    /// unused page control. Controls that were out of reach count as if they did not exist.
    fn way_on(&self) -> Option<usize> {
        let mut seen = vec![self.page];
        let mut ahead: VecDeque<(usize, Option<usize>)> = VecDeque::from([(self.page, None)]);
        while let Some((page, first)) = ahead.pop_front() {
            for (index, widget) in self.layout.widgets.iter().enumerate() {
                if !widget.is_on(page) || self.out_of_reach[index] {
                    continue;
                }
                let first = first.or(Some(index));
                if !self.used[index] && (widget.goto.is_some() || page != self.page) {
                    return first;
                }
                if let Some(next) = widget.goto.filter(|next| !seen.contains(next)) {
                    seen.push(next);
                    ahead.push_back((next, first));
                }
            }
        }
        None
    }

    /// Goes to a place within reach of the control and uses it; false if there is no such place.
    fn work(&mut self, widget: &Widget) -> bool {
        for place in self.places(widget) {
            let mut tried = self.performance.clone();
            let there = go(&mut tried, place, self.bounds);
            tried.wait(PAUSE);
            if there.and_then(|()| self.act(&mut tried, widget)).is_ok() {
                self.performance = tried;
                return true;
            }
        }
        false
    }

    /// Possible places to stand, the best first.
    fn places(&self, widget: &Widget) -> Vec<Vec2> {
        let target = widget.area.centre();
        let here = self.performance.place();
        let mut places: Vec<(f32, Vec2)> = Vec::new();
        for (rank, away) in AWAY_M.into_iter().enumerate() {
            for aside in ASIDE_RAD {
                let place = target - Vec2::from_angle(-aside).rotate(Vec2::Y) * away;
                let ground = Rect::from_centre_size(place, 2.0 * STANDING_M);
                let way_m = here.map_or(0.0, |here| here.distance(place));
                let mut cost = 0.1 * rank as f32 + 0.3 * way_m + 0.1 * aside.abs();
                let others = self.layout.widgets.iter().filter(|other| other.is_on(self.page));
                cost += 5.0 * others.filter(|other| overlap(other.area, ground)).count() as f32;
                let regions = self.layout.regions.iter();
                cost += regions.filter(|region| overlap(region.area, ground)).count() as f32;
                places.push((cost, place));
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        places.into_iter().map(|(_, place)| place).collect()
    }

    fn act(&self, performance: &mut Performance, widget: &Widget) -> Result<(), MoveError> {
        let Working { force, hold, times } = working(widget, &self.person);
        let size = widget.area.size();
        let at = |share: Vec2| widget.area.min + share * size;
        for _ in 0..times {
            match &widget.behaviour {
                Behaviour::Slider(slider) => {
                    let way = |from, to| Slide::along(slider.track, widget.area, from, to);
                    // A track too long for one reach is dragged around its middle.
                    performance
                        .drag(way(0.25, 0.75), SLIDE_M_S, force)
                        .or_else(|_| performance.drag(way(0.4, 0.6), SLIDE_M_S, force))?;
                }
                Behaviour::Pad(_) => {
                    let [from, to] = [0.35, 0.65].map(|share| at(Vec2::splat(share)));
                    performance.drag(Slide::Line { from, to }, SLIDE_M_S, force)?;
                }
                Behaviour::Dial(dial) => {
                    performance.drag(Slide::round(dial, widget.area, 0.4, 0.6), SLIDE_M_S, force)?;
                }
                // The centre of a control with several parts may be between them.
                Behaviour::Stepper(spec) => performance.press(at(upper(spec.axis)), force, hold)?,
                Behaviour::Selector(spec) => performance.press(at(upper(spec.axis)), force, hold)?,
                Behaviour::Lean(_)
                | Behaviour::Button(_)
                | Behaviour::Hold(_)
                | Behaviour::Switch(_)
                | Behaviour::Pedal(_) => performance.press(widget.area.centre(), force, hold)?,
            }
        }
        Ok(())
    }

    fn leave(&mut self) {
        let Some(here) = self.performance.place() else {
            self.performance.wait(HOLD);
            return;
        };
        let outside = Vec2::new(here.x, self.bounds.min.y - 1.0);
        // The person is on the floor and the place is finite, so both moves succeed.
        let left = self.performance.walk(&[outside]).and_then(|()| self.performance.disappear());
        debug_assert!(left.is_ok(), "{left:?}");
    }
}

/// The way to use a control.
pub(super) struct Working {
    pub(super) force: Newtons,
    pub(super) hold: Duration,
    /// Number of presses: two for a control with confirmation.
    pub(super) times: usize,
}

/// Returns how `person` uses `widget` with a firm press.
pub(super) fn working(widget: &Widget, person: &Person) -> Working {
    let thresholds = widget.behaviour.thresholds().for_weight(Some(person.weight()));
    let force = (thresholds.press * FIRMLY).max(LEAST).0.min((person.weight() * MOST_SHARE).0);
    let times = if matches!(thresholds.guard, Guard::Confirm(_)) { 2 } else { 1 };
    Working { force: Newtons(force), hold: thresholds.dwell + HOLD, times }
}

/// Goes to stand at `place`, facing north: from beside the floor, by sidesteps, or by walking.
fn go(performance: &mut Performance, place: Vec2, bounds: Rect) -> Result<(), MoveError> {
    match performance.place() {
        None => {
            performance.appear(Vec2::new(place.x, bounds.min.y - 1.0), 0.0)?;
            performance.walk(&[place])?;
            performance.turn(0.0)
        }
        Some(here) if here.distance(place) <= SIDESTEP_M => performance.sidestep(place),
        Some(_) => {
            performance.walk(&[place])?;
            performance.turn(0.0)
        }
    }
}

/// A place in the upper half of a control along its axis, in shares of its size.
pub(super) fn upper(axis: Axis) -> Vec2 {
    match axis {
        Axis::East => Vec2::new(0.8, 0.5),
        Axis::North => Vec2::new(0.5, 0.8),
    }
}

fn overlap(one: Rect, other: Rect) -> bool {
    one.min.cmplt(other.max).all() && other.min.cmplt(one.max).all()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::{FootDriver, SimConfig, SimFloor};
    use underfoot::engine::Engine;
    use underfoot::floor::Floor;
    use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};
    use underfoot::sense::{Assembler, Method};
    use underfoot::units::Instant;
    use underfoot::widget::EventKind;
    use underfoot::wire::SensorPacket;

    /// The controls that the visit affects, on a floor with ideal sensors.
    fn used(layout: &Layout, visit: &Visit) -> BTreeSet<WidgetId> {
        let floor = Floor { noiseless: true, ..Floor::default() };
        let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
        let mut assembler = Assembler::new(&floor);
        let mut engine = Engine::new(floor.geometry, layout.clone(), Method::default());
        let (mut script, mut feet, mut used) = (visit.script.clone(), Vec::new(), BTreeSet::new());
        for ms in 0.. {
            let at = Instant::from_millis(ms);
            if !script.feet(at, &mut feet) {
                break;
            }
            sim.step(&feet);
            for (board, readings) in (0..).zip(sim.readings()) {
                let readings = readings.clone();
                assembler.take(&SensorPacket { board, sequence: ms as u32, received: at, readings });
            }
            while let Some(frame) = assembler.ready() {
                let step = engine.step(frame);
                step.ignored.iter().for_each(|press| println!("{press}"));
                for event in step.events {
                    if !matches!(event.kind, EventKind::Pressed | EventKind::Armed | EventKind::Cancelled) {
                        used.insert(event.id.clone());
                    }
                }
            }
        }
        used
    }

    #[test]
    fn every_control_of_every_shipped_layout_is_used() {
        for name in builtin_layouts() {
            let text = builtin_layout(name).unwrap();
            let layout =
                parse_layout(text, name, &Kinds::builtin(), &Floor::default().geometry).unwrap().layout;
            let visit = visit(&layout, &Floor::default().geometry);
            assert_eq!(visit.missed, Vec::<WidgetId>::new(), "{name}");
            let used = used(&layout, &visit);
            let unused: Vec<_> =
                layout.widgets.iter().map(|widget| &widget.id).filter(|id| !used.contains(*id)).collect();
            assert_eq!(unused, Vec::<&WidgetId>::new(), "{name}");
        }
    }

    #[test]
    fn a_control_on_a_page_without_a_way_to_it_is_told() {
        let text = r#"Layout(version: 1, title: "Pages", regions: [(id: "all", at: (0, 0), size: (6, 6))], pages: [
            (id: "one", widgets: [(id: "on", kind: "button", at: (1, 2), size: (0.6, 0.6), goto: "two")]),
            (id: "two", widgets: [(id: "there", kind: "button", at: (3, 2), size: (0.6, 0.6))]),
            (id: "lost", widgets: [(id: "nowhere", kind: "button", at: (3, 2), size: (0.6, 0.6))]),
        ])"#;
        let geometry = Geometry::default();
        let layout = parse_layout(text, "pages.ron", &Kinds::builtin(), &geometry).unwrap().layout;
        assert_eq!(visit(&layout, &geometry).missed, [WidgetId::new("nowhere")]);
    }

    #[test]
    fn controls_out_of_reach_neither_end_a_visit_nor_prolong_it() {
        // No foot reaches along pads of six metres.
        let text = r#"Layout(version: 1, title: "Hall", regions: [(id: "all", at: (0, 0), size: (24, 24))], pages: [
            (id: "one", widgets: [
                (id: "wide", kind: "pad", at: (0, 3), size: (24, 20)),
                (id: "on", kind: "button", at: (1, 1), size: (0.6, 0.6), goto: "two"),
            ]),
            (id: "two", widgets: [
                (id: "wider", kind: "pad", at: (0, 3), size: (24, 21)),
                (id: "back", kind: "button", at: (3, 1), size: (0.6, 0.6), goto: "one"),
            ]),
        ])"#;
        let geometry = Geometry::of_paper_tiles(24, 24).unwrap();
        let mut layout = parse_layout(text, "hall.ron", &Kinds::builtin(), &geometry).unwrap().layout;
        for goto in [None, Some(1)] {
            layout.widgets[0].goto = goto;
            let missed = visit(&layout, &geometry).missed;
            assert_eq!(missed, ["wide", "wider"].map(WidgetId::new), "a pad that leads to {goto:?}");
        }
    }
}
