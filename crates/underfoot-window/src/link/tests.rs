//! Links back and forth, damaged ones too.

use std::sync::LazyLock;

use proptest::prelude::*;

use super::*;
use underfoot::schema::{builtin_layout, builtin_layouts};
use underfoot_sim::{FloorQuality, RecordedFeet, Scenario};

fn shipped() -> impl Iterator<Item = SharedLayout> {
    builtin_layouts().map(|name| SharedLayout {
        name: format!("{name}.ron"),
        text: builtin_layout(name).unwrap().into(),
        ..SharedLayout::default()
    })
}

fn with_own() -> SharedLayout {
    SharedLayout {
        name: "süd.ron".into(),
        text: "Layout(\r\n  title: \"Süd\u{feff} 床\",\n)".into(),
        kinds: [("big.ron".to_owned(), "Kind(name: \"big\", from: \"button\")".to_owned())].into(),
        grid: Some((8, 4)),
        effects: [("thud.ron".to_owned(), "Effect(name: \"thud\")".to_owned())].into(),
        visit: None,
    }
}

/// The built-in session on the layout `map`.
fn with_visit() -> SharedLayout {
    let (geometry, text) = (Geometry::default(), builtin_layout("map").unwrap());
    let map = parse_layout(text, "map", &Kinds::builtin(), &geometry).unwrap().layout;
    let session = Scenario::parse("session", Scenario::SESSION).unwrap();
    let feet = RecordedFeet::of(&mut session.resolve(&map, &geometry).unwrap());
    let visit = SharedVisit::new(&feet, FloorQuality::Moderate, 7).unwrap();
    assert_eq!(visit.feet(), Ok(feet));
    SharedLayout { name: "map".into(), text: text.into(), visit: Some(visit), ..SharedLayout::default() }
}

#[test]
fn every_shipped_layout_comes_back_to_the_byte_from_the_whole_address_and_from_its_end() {
    for shared in shipped().chain([with_own(), with_visit(), SharedLayout::default()]) {
        let fragment = shared.fragment().unwrap();
        assert!(fragment.chars().all(|letter| letter.is_ascii_alphanumeric() || "#.-_".contains(letter)));
        // Short texts grow by their frame.
        assert!(
            shared.len() < 1000 || shared.visit.is_some() || fragment.len() < shared.len(),
            "{}: it is packed",
            shared.name
        );
        assert_eq!(SharedLayout::of_link(&fragment), Ok(shared.clone()));
        assert_eq!(SharedLayout::of_link(&format!("https://example.org/floor/{fragment}")), Ok(shared));
    }
}

#[test]
fn a_link_that_a_letter_has_broken_into_lines_is_read() {
    let fragment = with_own().fragment().unwrap();
    let (first, rest) = fragment.split_at(40);
    assert_eq!(SharedLayout::of_link(&format!(" {first}\r\n  {rest}\n")), Ok(with_own()));
}

#[test]
fn only_the_kinds_and_effects_that_change_the_layout_travel() {
    let text = r#"Layout(version: 1, title: "t", regions: [(id: "all", at: (0, 0), size: (6, 6))],
        widgets: [(id: "a", kind: "huge", at: (1, 1), size: (2, 2))])"#;
    let kind =
        |name: &str, from: &str| (format!("{name}.ron"), format!("Kind(name: \"{name}\", from: \"{from}\")"));
    let shared = SharedLayout {
        name: "t.ron".into(),
        text: text.into(),
        kinds: [kind("huge", "large"), kind("large", "button"), kind("unused", "button")].into(),
        ..SharedLayout::default()
    };
    let geometry = Geometry::default();
    let used = shared.clone().with_used_only(&geometry).unwrap();
    assert_eq!(used.kinds.keys().collect::<Vec<_>>(), ["huge.ron", "large.ron"]);
    assert_eq!((&used.text, &used.name), (&shared.text, &shared.name));
    let lacking = SharedLayout { kinds: BTreeMap::new(), ..shared };
    assert!(lacking.with_used_only(&geometry).is_err(), "its kind is missing");
}

#[test]
fn more_than_fits_is_refused_with_its_size() {
    let text = |length| SharedLayout { text: "x".repeat(length), ..SharedLayout::default() };
    assert!(text(MAX_TEXT).fragment().is_ok());
    assert_eq!(text(MAX_TEXT + 1).fragment(), Err(LinkError::TooLong { bytes: MAX_TEXT + 1 }));
    let message = text(40 * 1024).fragment().unwrap_err().to_string();
    assert!(message.contains("40 kB") && message.contains("32 kB"), "{message}");
}

/// A link whose few bytes would unpack to a gigabyte.
#[test]
fn a_bomb_is_refused_before_it_fills_the_memory() {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    let zeros = vec![b' '; 1 << 20];
    (0..64).for_each(|_| packer.write_all(&zeros).unwrap());
    let link = format!("#1.{}", URL_SAFE_NO_PAD.encode(packer.finish().unwrap()));
    assert_eq!(SharedLayout::of_link(&link), Err(LinkError::Damaged));
}

#[test]
fn a_visit_of_twenty_seconds_takes_some_kilobytes_and_names_its_floor() {
    let shared = with_visit();
    let alone = SharedLayout { visit: None, ..shared.clone() }.fragment().unwrap();
    let visit = shared.fragment().unwrap().len() - alone.len();
    assert!((500..6000).contains(&visit), "{visit} letters");
    let build = shared.visit.unwrap().build().unwrap();
    assert_eq!((build.quality, build.seed), (FloorQuality::Moderate, 7));
}

/// The letters of a link with this text in the place of the JSON.
fn link_of(json: &str) -> String {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    packer.write_all(json.as_bytes()).unwrap();
    format!("#1.{}", URL_SAFE_NO_PAD.encode(packer.finish().unwrap()))
}

#[test]
fn a_visit_that_cannot_be_played_says_why() {
    let with = |visit: &str| link_of(&format!(r#"{{"name":"a","text":"b","visit":{visit}}}"#));
    let says = |visit: &str| SharedLayout::of_link(&with(visit)).unwrap_err().to_string();
    let empty = "eJxjZGAAAAAGAAI";
    assert!(says(r#"{"quality":"slight","seed":1,"feet":"?"}"#).contains("feet are damaged"));
    assert!(says(r#"{"quality":"slight","seed":1,"feet":""}"#).contains("feet are damaged"));
    assert_eq!(SharedLayout::of_link(&with(r#"{"quality":7}"#)), Err(LinkError::Damaged));
    let bad = format!(r#"{{"quality":"golden","seed":1,"feet":"{empty}"}}"#);
    assert!(says(&bad).contains("golden"), "{}", says(&bad));
    let long = format!(r#"{{"quality":"slight","seed":1,"feet":"{}"}}"#, "A".repeat(MAX_VISIT + 1));
    assert!(says(&long).contains("a shorter one"), "{}", says(&long));
}

/// Feet whose few bytes would unpack to megabytes.
#[test]
fn a_bomb_in_the_place_of_feet_is_refused() {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    packer.write_all(&vec![0; 8 << 20]).unwrap();
    let feet = URL_SAFE_NO_PAD.encode(packer.finish().unwrap());
    let link = link_of(&format!(
        r#"{{"name":"a","text":"b","visit":{{"quality":"slight","seed":1,"feet":"{feet}"}}}}"#
    ));
    assert_eq!(SharedLayout::of_link(&link), Err(LinkError::Feet(BadFeet::Damaged)));
}

#[test]
fn what_is_no_link_of_ours_says_what_one_looks_like() {
    for no_layout in
        ["", "https://example.org/", "https://example.org/#top", "#", "#x.y", "#0.abc", "map.ron"]
    {
        assert_eq!(SharedLayout::of_link(no_layout), Err(LinkError::NoLayout), "{no_layout}");
    }
    assert_eq!(SharedLayout::of_link("#2.abc"), Err(LinkError::Newer("2".into())));
    assert_eq!(SharedLayout::of_link("#1."), Err(LinkError::Damaged));
    let cut = with_own().fragment().unwrap();
    assert_eq!(SharedLayout::of_link(&cut[..cut.len() - 9]), Err(LinkError::Damaged));
}

/// Cases of each property: `PROPTEST_CASES=10000` in the environment runs more of them.
fn cases() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(500))
}

/// The link with the built-in session.
static VISIT: LazyLock<String> = LazyLock::new(|| with_visit().fragment().unwrap());

proptest! {
    #![proptest_config(cases())]

    /// A visit whose letters are changed inside the link, with sums that fit again.
    #[test]
    fn visits_with_damaged_feet_are_refused_or_played(at in 0..6000_usize, with in "[A-Za-z0-9_-]{0,4}", cut in 0..6_usize) {
        let good = SharedLayout::of_link(&VISIT).unwrap();
        let mut json = serde_json::to_value(&good).unwrap();
        let feet = json["visit"]["feet"].as_str().unwrap().to_owned();
        let (begin, end) = (at.min(feet.len()), (at + cut).min(feet.len()));
        json["visit"]["feet"] = format!("{}{with}{}", &feet[..begin], &feet[end..]).into();
        match SharedLayout::of_link(&link_of(&json.to_string())) {
            Ok(shared) => prop_assert!(shared.visit.unwrap().feet().is_ok()),
            Err(error) => prop_assert!(error.to_string().contains("visit")),
        }
    }

    /// Links with a visit, changed, cut or longer anywhere.
    #[test]
    fn damaged_links_with_a_visit_are_refused_or_read(at in 0..9000_usize, with in "[ -~]{0,4}", cut in 0..6_usize) {
        let (begin, end) = (at.min(VISIT.len()), (at + cut).min(VISIT.len()));
        let bad = format!("{}{with}{}", &VISIT[..begin], &VISIT[end..]);
        match SharedLayout::of_link(&bad) {
            Ok(shared) => prop_assert!(Ok(shared) == SharedLayout::of_link(&VISIT)),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    /// Letters changed, cut or inserted anywhere give an error or a layout of no more than the allowed size.
    #[test]
    fn damaged_links_are_refused_or_read(at in 0..400_usize, with in "[ -~]{0,4}", cut in 0..6_usize) {
        let good = with_own().fragment().unwrap();
        let (begin, end) = (at.min(good.len()), (at + cut).min(good.len()));
        let bad = format!("{}{with}{}", &good[..begin], &good[end..]);
        if let Ok(shared) = SharedLayout::of_link(&bad) {
            prop_assert!(shared.len() <= MAX_TEXT);
            // Zlib's sum finds all other changes.
            prop_assert_eq!(shared, with_own());
        }
    }

    #[test]
    fn any_text_is_refused_or_read(text in "(#1\\.)?.{0,200}") {
        if let Ok(shared) = SharedLayout::of_link(&text) {
            prop_assert!(shared.len() <= MAX_TEXT);
        }
    }
}
