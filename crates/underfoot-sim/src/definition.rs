//! Format of scenario files; each record is described once.

use std::f32::consts::FRAC_PI_2;
use std::time::Duration;

use glam::Vec2;

use super::Person;
use underfoot::floor::Rect;
use underfoot::units::Newtons;
use underfoot_format::codec::By;
use underfoot_format::describe::FieldType;
use underfoot_format::{Codec, Name, Named, Num, OneOf, Opt, Pair, Rec, Text, choices, list, num, record};

record! {
    /// Actions of people on a floor; playing it needs a layout.
    pub(super) struct ScenarioRecord = "Scenario";
    /// Title to display.
    pub(super) title: String = "title", Text(200);
    /// The person's measures.
    pub(super) person: PersonRecord = "person", Rec => PersonRecord::of(&Person::default());
    /// The person's actions, one after the other.
    pub(super) steps: Vec<Step> = "steps", list("step", MOST_STEPS, OneOf);
    /// Others on the floor at the same time.
    pub(super) others: Vec<Other> = "others", list("other", MOST_OTHERS, Rec) => Vec::new();
    /// Faults of the packets on the network, each in the format of the option `--fault`, such as "loss=1%".
    pub(super) faults: Vec<String> = "faults", list("fault", MOST_FAULTS, Text(200)) => Vec::new();
}

record! {
    /// Another person on the same floor.
    pub(super) struct Other = "Other";
    /// The person's measures.
    pub(super) person: PersonRecord = "person", Rec => PersonRecord::of(&Person::default());
    /// The person's actions, one after the other.
    pub(super) steps: Vec<Step> = "steps", list("step", MOST_STEPS, OneOf);
}

record! {
    /// A person's measures.
    pub(super) struct PersonRecord = "Person", Copy;
    /// Body mass.
    pub(super) mass_kg: f32 = "mass_kg", num(10.0..=300.0) => Person::default().mass_kg;
    /// Length of the bare foot.
    pub(super) foot_m: f32 = "foot_m", num(0.1..=0.4) => Person::default().foot_length_m;
    /// Walking speed.
    pub(super) speed_m_s: f32 = "speed_m_s", num(0.4..=2.0) => Person::default().speed_m_s;
    /// Distance between the middles of the feet while standing.
    pub(super) stand_m: f32 = "stand_m", num(0.08..=0.6) => Person::default().stand_width_m;
}

choices! {
    /// One step of a performance; each begins when the one before has ended.
    pub(super) enum Step;
    /// Waits.
    Wait(Wait),
    /// Stands on the floor from the first moment; only as the first step.
    Stand(Stand),
    /// Walks onto the floor from beside it.
    Enter(Enter),
    /// Walks, and stops with the feet left and right of the place.
    WalkTo(WalkTo),
    /// Steps aside by small steps, with the same facing.
    Sidestep(Sidestep),
    /// Turns on the spot.
    Turn(Turn),
    /// Puts the ball of the nearer foot on the middle of a control.
    Press(Press),
    /// Presses as Press does, but only briefly.
    Tap(Tap),
    /// Presses a slider, dial or pad, or the free floor, and slides along it.
    Drag(Drag),
    /// Presses as Press does, at a place instead of a control.
    Point(Point),
    /// Walks off the floor.
    Leave(Leave),
}

record! {
    /// Waits.
    pub(super) struct Wait = "Wait", Copy;
    /// Duration, in milliseconds.
    pub(super) time: Duration = "ms", MILLIS;
}

record! {
    /// Stands on the floor from the first moment.
    pub(super) struct Stand = "Stand", Copy;
    /// Place, in tiles.
    pub(super) at: Vec2 = "at", PLACE;
    /// Facing direction.
    pub(super) facing: Side = "facing", Name => Side::North;
}

record! {
    /// Walks onto the floor from beside it.
    pub(super) struct Enter = "Enter", Copy;
    /// Side of the floor that the person comes from.
    pub(super) from: Side = "from", Name;
    /// Place to stop at, in tiles.
    pub(super) at: Vec2 = "at", PLACE;
    /// Facing direction at the end; the walking direction by default.
    pub(super) facing: Option<Side> = "facing", Opt(Name) => None;
}

record! {
    /// Walks to a place.
    pub(super) struct WalkTo = "WalkTo";
    /// Place to stop at, in tiles.
    pub(super) at: Vec2 = "at", PLACE;
    /// Places to pass on the way, in tiles.
    pub(super) via: Vec<Vec2> = "via", list("via", MOST_STEPS, PLACE) => Vec::new();
    /// Facing direction at the end; the walking direction by default.
    pub(super) facing: Option<Side> = "facing", Opt(Name) => None;
}

record! {
    /// Steps aside.
    pub(super) struct Sidestep = "Sidestep", Copy;
    /// Place to step to, in tiles.
    pub(super) at: Vec2 = "at", PLACE;
}

record! {
    /// Turns on the spot.
    pub(super) struct Turn = "Turn", Copy;
    /// Facing direction at the end.
    pub(super) to: Side = "to", Name;
}

record! {
    /// Presses a control.
    pub(super) struct Press = "Press";
    /// Id of the control.
    pub(super) widget: String = "widget", Text(64);
    /// Force of the press.
    pub(super) force: Newtons = "force_n", FORCE => PRESSING;
    /// Duration of the press.
    pub(super) hold: Duration = "hold_ms", MILLIS => HOLDING;
}

record! {
    /// Presses a control briefly.
    pub(super) struct Tap = "Tap";
    /// Id of the control.
    pub(super) widget: String = "widget", Text(64);
    /// Force of the press.
    pub(super) force: Newtons = "force_n", FORCE => PRESSING;
}

record! {
    /// Moves a slider, dial or pad, or slides over free floor.
    pub(super) struct Drag = "Drag";
    /// Id of the control; leave it out to slide over free floor.
    pub(super) widget: Option<String> = "widget", Opt(Text(64)) => None;
    /// Place of the touchdown: as a share of a slider's track or of a dial's range, as shares of a pad's width and
    /// depth, on free floor in tiles.
    pub(super) from: DragEnd = "from", END;
    /// Place of the lift-off, in the same form as `from`.
    pub(super) to: DragEnd = "to", END;
    /// Speed of the slide.
    pub(super) speed_m_s: f32 = "speed_m_s", num(0.01..=2.0) => 0.3;
    /// Force of the press.
    pub(super) force: Newtons = "force_n", FORCE => Newtons(80.0);
}

record! {
    /// Presses at a place.
    pub(super) struct Point = "Point", Copy;
    /// Place, in tiles.
    pub(super) at: Vec2 = "at", PLACE;
    /// Force of the press.
    pub(super) force: Newtons = "force_n", FORCE => PRESSING;
    /// Duration of the press.
    pub(super) hold: Duration = "hold_ms", MILLIS => HOLDING;
}

record! {
    /// Walks off the floor.
    pub(super) struct Leave = "Leave", Copy;
    /// Side of the floor that the person leaves over.
    pub(super) to: Side = "to", Name;
}

/// Maximum number of steps of one person, and of places on one walk.
pub(super) const MOST_STEPS: usize = 4096;

/// Maximum number of people besides the first.
pub(super) const MOST_OTHERS: usize = 64;

/// Maximum number of faults in one scenario.
const MOST_FAULTS: usize = 32;

/// The check that a place is on the floor follows when the floor is known.
const PLACE: Pair = Pair { each: num(-1e4..=1e4), pattern: "(east, north)", parts: ["east", "north"] };

/// One end of a drag: the touchdown or the lift-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DragEnd {
    /// Along a track or a range.
    Share(f32),
    /// Eastwards and northwards: shares of a pad, tiles of the floor.
    Place(Vec2),
}

/// The check of the range of a share follows when the control is known.
const END: By<DragEnd> = By {
    shape: || FieldType::Words("a number from 0 to 1, or (east, north)"),
    read: |node, context| match node.peek_number() {
        Some(_) => SHARE.read(node, None, context).map(DragEnd::Share),
        None => PLACE.read(node, None, context).map(DragEnd::Place),
    },
    write: |end: &DragEnd| match end {
        DragEnd::Share(share) => SHARE.write(share),
        DragEnd::Place(place) => PLACE.write(place),
    },
    stand_in: || DragEnd::Share(0.0),
};

const SHARE: Num = num(0.0..=1.0);

const FORCE: Num = num(0.0..=3000.0);

/// Durations are at most ten minutes.
const MILLIS: Num = num(0.0..=600_000.0).milli();

const PRESSING: Newtons = Newtons(120.0);

const HOLDING: Duration = Duration::from_millis(300);

/// A side of the floor, or a facing direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    North,
    East,
    South,
    West,
}

impl Named for Side {
    const ALL: &'static [(&'static str, Self)] =
        &[("North", Self::North), ("East", Self::East), ("South", Self::South), ("West", Self::West)];
}

impl PersonRecord {
    fn of(person: &Person) -> Self {
        Self {
            mass_kg: person.mass_kg,
            foot_m: person.foot_length_m,
            speed_m_s: person.speed_m_s,
            stand_m: person.stand_width_m,
        }
    }

    /// Returns the person with these measures and the default values for the rest.
    pub(super) fn person(&self) -> Person {
        let Self { mass_kg, foot_m, speed_m_s, stand_m } = *self;
        Person { mass_kg, foot_length_m: foot_m, speed_m_s, stand_width_m: stand_m, ..Person::default() }
    }
}

impl Side {
    /// Returns the heading of a person facing this side, in radians counter-clockwise from north.
    pub(super) fn heading(self) -> f32 {
        match self {
            Self::North => 0.0,
            Self::East => -FRAC_PI_2,
            Self::South => 2.0 * FRAC_PI_2,
            Self::West => FRAC_PI_2,
        }
    }

    /// Returns the place `distance` metres outside this side of the floor, straight out from `point`.
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
