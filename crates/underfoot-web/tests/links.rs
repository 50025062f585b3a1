//! Links and files that are damaged in any place: the page opens them, or says why.
//!
//! `PROPTEST_CASES=10000` in the environment runs more of them.
#![allow(clippy::unwrap_used)]

use std::cell::RefCell;
use std::io::Write;
use std::time::Duration;

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use proptest::prelude::*;
use proptest::sample::Index;
use underfoot::schema::{builtin_layout, builtin_layouts};
use underfoot_sim::{FloorQuality, RecordedFeet};
use underfoot_web::floor::PageFloor;
use underfoot_web::played::Played;
use underfoot_web::visit::VisitReel;
use underfoot_window::link::{SharedLayout, SharedVisit};

fn cases() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(150))
}

/// A change of a text: where, how much is cut, and the text in its place.
type Change = (Index, usize, String);

fn change() -> impl Strategy<Value = Change> {
    (any::<Index>(), 0..20_usize, "[ -~äß\u{0}\u{202e}]{0,8}")
}

fn changed(text: &str, changes: &[Change]) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for (at, cut, with) in changes {
        let at = at.index(letters.len() + 1);
        let end = (at + cut).min(letters.len());
        letters.splice(at..end, with.chars());
    }
    letters.into_iter().collect()
}

/// A link with this JSON, whatever that is.
fn link_of(json: &str) -> String {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    packer.write_all(json.as_bytes()).unwrap();
    format!("#1.{}", URL_SAFE_NO_PAD.encode(packer.finish().unwrap()))
}

/// Opens a link as a page does, and runs its floor for a moment; otherwise returns the message.
fn opened(link: &str) -> Result<(), String> {
    let shared = SharedLayout::of_link(link).map_err(|error| error.to_string())?;
    let now = Duration::from_millis(20);
    if shared.visit.is_some() {
        let reel = VisitReel::new(&shared, |_| {}, Box::new(|_, _| {})).map_err(|error| error.to_string())?;
        let (mut played, _input) =
            Played::new(Box::new(reel), "a visit").map_err(|error| error.to_string())?;
        played.run_until(Duration::ZERO, &|| Duration::ZERO);
        played.run_until(now, &|| Duration::ZERO);
    } else {
        let (mut floor, _input) = PageFloor::new(&shared, |_| {}).map_err(|error| error.to_string())?;
        floor.run_until(now);
    }
    Ok(())
}

fn assert_said(opened: Result<(), String>) -> Result<(), TestCaseError> {
    if let Err(message) = opened {
        prop_assert!(message.chars().count() > 10, "{message:?}");
        prop_assert!(message.len() < 1 << 20, "{} bytes", message.len());
    }
    Ok(())
}

thread_local! {
    /// The feet of a short visit, and the JSON of a link with it.
    static VISIT: RefCell<Option<String>> = const { RefCell::new(None) };
}

fn with_visit() -> String {
    VISIT.with_borrow_mut(|json| {
        json.get_or_insert_with(|| {
            let text = builtin_layout("first_steps").unwrap();
            let geometry = underfoot::floor::Geometry::default();
            let kinds = underfoot::schema::Kinds::builtin();
            let layout =
                underfoot::schema::parse_layout(text, "first_steps", &kinds, &geometry).unwrap().layout;
            let feet = RecordedFeet::of(&mut underfoot_sim::visit(&layout, &geometry).script);
            let visit = SharedVisit::new(&feet, FloorQuality::Ideal, 1).unwrap();
            let shared = SharedLayout {
                name: "first_steps".into(),
                text: text.into(),
                visit: Some(visit),
                ..SharedLayout::default()
            };
            serde_json::to_string(&shared).unwrap()
        })
        .clone()
    })
}

proptest! {
    #![proptest_config(cases())]

    /// A layout with a text that is changed in some places, in a link that is sound.
    #[test]
    fn layouts_that_are_damaged_open_or_say_why(which in any::<Index>(), changes in proptest::collection::vec(change(), 1..4)) {
        let names: Vec<&str> = builtin_layouts().collect();
        let text = changed(builtin_layout(names[which.index(names.len())]).unwrap(), &changes);
        let shared = SharedLayout { name: "a.ron".into(), text, ..SharedLayout::default() };
        if let Ok(link) = shared.fragment() {
            assert_said(opened(&link))?;
        }
    }

    /// The content of a link with a visit, changed in some places before it is packed.
    #[test]
    fn contents_that_are_damaged_open_or_say_why(changes in proptest::collection::vec(change(), 1..3)) {
        assert_said(opened(&link_of(&changed(&with_visit(), &changes))))?;
    }

    /// A link of any letters.
    #[test]
    fn letters_at_random_say_why(letters in "(#1\\.|#2\\.|#)?[A-Za-z0-9_-]{0,300}") {
        let said = opened(&letters);
        prop_assert!(said.is_err());
        assert_said(said)?;
    }
}
