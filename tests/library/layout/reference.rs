//! The reference of the format agrees with its reader.

use underfoot::schema::{self, Chapter};
use underfoot_sim as sim;

const HEAD: &str = "# What files may say\n\n\
    Every field of layouts, kinds, controls, effects, grounds, floors and scenarios, made by `underfoot reference` from the descriptions that the \
    reader goes by. Units are the ends of names: `press_n` is in newtons, `dwell_ms` in milliseconds. A kind made \
    `from` another, a widget of a kind and an effect made `from` another take from it what they don't write.\n\n";

/// The chapters that `underfoot reference` prints.
fn reference() -> Vec<Chapter> {
    schema::reference().into_iter().chain(sim::reference()).collect()
}

fn write_reference(name: Option<&str>) -> Result<String, String> {
    schema::write_reference(&reference(), name)
}

/// After a change of a record run this with `UPDATE_EXPECTED=1` and check the differences.
#[test]
fn the_page_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/reference.md");
    let page = format!("{HEAD}{}\n", write_reference(None).unwrap().trim_end());
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(path, &page).unwrap();
    }
    assert!(std::fs::read_to_string(path).unwrap_or_default() == page, "docs/reference.md is out of date");
}

#[test]
fn every_field_says_what_it_is() {
    for chapter in reference() {
        let records = chapter.records.iter().flat_map(|record| &record.fields);
        for field in chapter.common.iter().chain(records) {
            assert!(!field.about.is_empty() && !field.name.is_empty(), "{}: {field:?}", chapter.name);
            assert!(!field.shape.told(field.name).is_empty(), "{}: {field:?}", chapter.name);
        }
    }
}

#[test]
fn one_record_can_be_asked_for() {
    let slider = write_reference(Some("slider")).unwrap();
    assert!(slider.starts_with("### Slider\n"), "{slider}");
    assert!(slider.contains("- `gain`: a number from 0.01 to 10; 1 where nothing is written. "), "{slider}");
    let unknown = write_reference(Some("Slidr")).unwrap_err();
    assert_eq!(unknown, "nothing is called `Slidr`; did you mean `Slider`?");
}
