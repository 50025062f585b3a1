//! One control on a simulated floor, with a foot that operates it.

use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::widget::{EventKind, Value};

pub use EventKind::{Cancelled, Changed, Clicked, Pressed, Released};

use crate::support::{Walker, page};

/// Force of a deliberate foot, enough for any shipped kind.
pub const FIRM: Newtons = Newtons(150.0);

/// Default speed of a sliding foot, in metres per second.
const SPEED: f32 = 0.3;

/// Load on the standing foot of a person of 70 kg.
const WEIGHT: Newtons = Newtons(690.0);

/// One control named `it`, alone on the floor, and a person before it with one free foot.
pub struct Bench {
    pub walker: Walker,
    middle: Vec2,
    size: Vec2,
}

impl Bench {
    /// The control with these `fields`, 1.2 tiles (36 cm) wide and one (30 cm) deep.
    pub fn with(fields: &str) -> Self {
        let text = format!(
            "Layout(version: 1, regions: [(id: \"all\", at: (0, 2), size: (6, 4))],
                stances: [(at: (2.1, 0), size: (1.2, 1))],
                widgets: [(id: \"it\", at: (2.1, 2.6), size: (1.2, 1), {fields})])"
        );
        let layout = page(&text);
        let area = layout.widgets[0].area;
        let mut walker = Walker::on(layout);
        // A person who has arrived and is no longer expected to step on.
        walker.stand(WEIGHT);
        walker.wait(3000);
        Self { walker, middle: area.centre(), size: area.size() }
    }

    /// A place on the control: 0 to 1 from west to east and from south to north.
    pub fn at(&self, east: f32, north: f32) -> Vec2 {
        self.middle + (Vec2::new(east, north) - 0.5) * self.size
    }

    /// Puts the foot there with [`FIRM`], and waits for the dwell.
    pub fn press_at(&mut self, east: f32, north: f32) {
        self.press_with(east, north, FIRM);
    }

    pub fn press_with(&mut self, east: f32, north: f32, force: Newtons) {
        let at = self.at(east, north);
        self.walker.step_at(at, force);
        self.walker.wait(60);
    }

    pub fn press(&mut self) {
        self.press_at(0.5, 0.5);
    }

    /// Slides the foot there.
    pub fn slide_to(&mut self, east: f32, north: f32) {
        let to = self.at(east, north);
        self.walker.slide_to(to, SPEED);
    }

    pub fn lift(&mut self) {
        self.walker.lift();
        self.walker.wait(60);
    }

    /// Presses in the middle and lifts.
    pub fn tap(&mut self) {
        self.press();
        self.lift();
    }

    pub fn wait(&mut self, millis: u64) {
        self.walker.wait(millis);
    }

    /// Slides the foot 30 cm off the control to the north, and takes it away.
    pub fn slide_off(&mut self) {
        self.slide_to(0.5, 2.0);
        self.lift();
    }

    /// Stops all boards under the foot.
    pub fn lose_the_floor(&mut self) {
        self.walker.connected = false;
        self.walker.wait(150);
    }

    /// The events since the last call.
    pub fn events(&mut self) -> Vec<EventKind> {
        self.walker.take_events().into_iter().map(|(_, kind)| kind).collect()
    }

    /// The same without changes of value.
    pub fn outline(&mut self) -> Vec<EventKind> {
        let mut events = self.events();
        events.retain(|event| !matches!(event, Changed(_)));
        events
    }

    pub fn value(&self) -> Option<Value> {
        self.walker.engine.value("it")
    }

    pub fn number(&self) -> f32 {
        let Some(Value::Number(number)) = self.value() else { panic!("{:?} is no number", self.value()) };
        number
    }

    pub fn pair(&self) -> Vec2 {
        let Some(Value::Pair(pair)) = self.value() else { panic!("{:?} is no pair", self.value()) };
        pair
    }

    #[track_caller]
    pub fn is_about(&self, wanted: f32, tolerance: f32) {
        let number = self.number();
        assert!((number - wanted).abs() <= tolerance, "{number}, not {wanted}");
    }
}

/// Number of clicks since the last call.
pub fn clicks(bench: &mut Bench) -> usize {
    bench.walker.take_cues().len()
}
