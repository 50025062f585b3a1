//! Records whose reading depends on values beside the file.

use underfoot_format::codec::{At, Beside, By, Distinct, Written};
use underfoot_format::describe::FieldType;
use underfoot_format::filed::read_record;
use underfoot_format::node::Within;
use underfoot_format::pairs::Limits;
use underfoot_format::problem::Problem;
use underfoot_format::reader::Reader;
use underfoot_format::source::Source;
use underfoot_format::text::RonText;
use underfoot_format::{Flat, Follow, Includes, Num, OneOf, Opt, Rec, choices, list, num, record};

/// The names of places on a floor.
struct PlaceNames(Vec<&'static str>);

/// A person on a floor.
struct Guest {
    names: PlaceNames,
}

impl Includes<Self> for PlaceNames {
    fn included(&self) -> &Self {
        self
    }
}

impl Includes<Self> for Guest {
    fn included(&self) -> &Self {
        self
    }
}

impl Includes<PlaceNames> for Guest {
    fn included(&self) -> &PlaceNames {
        &self.names
    }
}

/// A place by its name; the value is its index.
const PLACE: By<usize, PlaceNames> = By {
    shape: || FieldType::Words("the name of a place"),
    read: |node, PlaceNames(names)| {
        let name = node.text(20)?;
        let found = names.iter().position(|known| *known == name);
        if found.is_none() {
            node.report(Problem::error(node.span(), format!("no place is called {name}")));
        }
        found
    },
    write: |_| RonText::Nothing,
    stand_in: || 0,
};

const HEIGHT: Num = num(0.0..=9.0).bounded();

record! {
    /// A step.
    struct Step = "Step";
    /// Its height.
    height_m: f32 = "height_m", HEIGHT;
}

record! {
    /// A way from place to place.
    struct Way = "Way" with PlaceNames;
    /// Where it begins.
    from: Written<usize> = "from", At(PLACE);
    /// Where it ends.
    to: Option<usize> = "to", Opt(PLACE) => None;
    /// The places on the way.
    over: Vec<usize> = "over", list("place", 4, PLACE) => Vec::new();
    /// Where a person rests.
    rest: usize = "rest", Follow { explicit: PLACE, otherwise: "the first place" };
    /// The step at its end.
    step: Option<Step> = "step", Opt(Rec) => None;
}

choices! {
    /// A deed.
    enum Deed with PlaceNames;
    /// Stands still.
    Stand,
    /// Climbs a step.
    Climb(Step),
    /// Walks.
    Walk(Way),
}

const WAYS: Distinct<Way> = Distinct { entry: "way", most: 4, about: |_, _, _, _| {} };

record! {
    /// An outing.
    struct Outing = "Outing" with Guest;
    /// The first way.
    first: Way = "first", Rec;
    /// The other ways.
    ways: Vec<Way> = "ways", WAYS => Vec::new();
    /// The deeds.
    deeds: Vec<Deed> = "deeds", list("deed", 4, OneOf) => Vec::new();
    /// The last deed.
    last: Deed = "last", Beside => Deed::Stand;
    /// The highest step.
    step: Step = "", Flat;
}

fn guest() -> Guest {
    Guest { names: PlaceNames(vec!["door", "stairs"]) }
}

#[test]
fn a_place_is_found_from_every_depth_of_a_record() {
    let text = "(height_m: 2, first: (from: \"stairs\", to: \"stairs\", over: [\"door\", \"stairs\"], rest: \"stairs\"),
        ways: [(from: \"stairs\")], deeds: [Climb(height_m: 1), Walk(from: \"stairs\")],
        last: Walk, from: \"stairs\", step: (height_m: 3))";
    let outing: Outing = read_record(text, &guest()).unwrap();
    let way = |to, over, rest, step| Way { from: 1.into(), to, over, rest, step };
    assert_eq!(outing.first, way(Some(1), vec![0, 1], 1, None));
    assert_eq!(outing.ways, [way(None, vec![], 0, None)]);
    assert_eq!(outing.deeds, [Deed::Climb(Step { height_m: 1.0 }), Deed::Walk(way(None, vec![], 0, None))]);
    assert_eq!(outing.last, Deed::Walk(way(None, vec![], 0, Some(Step { height_m: 3.0 }))));
    assert_eq!(outing.step, Step { height_m: 2.0 });
}

#[test]
fn each_reading_has_a_context_of_its_own() {
    let text = "(from: \"attic\", over: [\"cellar\"])";
    let problems = read_record::<Way>(text, &guest().names).unwrap_err().to_string();
    for name in ["attic", "cellar"] {
        assert!(problems.contains(&format!("no place is called {name}")), "{problems}");
    }
    let house = PlaceNames(vec!["attic", "cellar"]);
    assert_eq!(read_record::<Way>(text, &house).map(|way| (way.from.value, way.over)), Ok((0, vec![1])));
}

#[test]
fn limits_hold_for_the_records_within_and_end_with_the_record() {
    let text = "(low: (step: (height_m: 5)), high: (step: (height_m: 5)))";
    let source = Source::new("steps", text).unwrap();
    let reader = Reader::new(&source, "Steps", Limits::LAYOUT);
    let mut all = reader.root("steps").and_then(|node| node.fields("Steps")).unwrap();
    let mut read = |name, within: Option<Within>| {
        let mut fields = all.take(name).and_then(|node| node.fields("One")).unwrap();
        if let Some(within) = within {
            fields.keep_within(within);
        }
        let step: Option<Step> = fields.read("step", None, |node| node.record(None, &()));
        fields.finish();
        step
    };
    let low = Within { low: 0.0, high: 1.0, noun: "the room", wider: "raise the ceiling: room_m" };
    assert_eq!(read("low", Some(low)), None);
    assert_eq!(read("high", None), Some(Step { height_m: 5.0 }));
    all.finish();
    let problems = reader.into_diagnostics();
    assert_eq!(problems.errors(), 1, "{problems}");
    assert!(problems.to_string().contains("`height_m` is outside of the room"), "{problems}");
}
