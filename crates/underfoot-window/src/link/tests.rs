//! Links back and forth, damaged ones too.

use proptest::prelude::*;

use super::*;
use underfoot::schema::{builtin_layout, builtin_layouts};

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
    }
}

#[test]
fn every_shipped_layout_comes_back_to_the_byte_from_the_whole_address_and_from_its_end() {
    for shared in shipped().chain([with_own(), SharedLayout::default()]) {
        let fragment = shared.fragment().unwrap();
        assert!(fragment.chars().all(|letter| letter.is_ascii_alphanumeric() || "#.-_".contains(letter)));
        // Short texts grow by their frame.
        assert!(shared.len() < 1000 || fragment.len() < shared.len(), "{}: it is packed", shared.name);
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

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
