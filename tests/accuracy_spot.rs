//! How well one contact is found on floors of the paper's parts: tables as snapshots, held against the goals.
#![allow(clippy::unwrap_used)]

use underfoot::experiment::{METHODS, SeamTable, SpotTable, Thing};

#[test]
fn one_contact_over_a_whole_tile() {
    let mut table = SpotTable::new(9);
    (1..=5).for_each(|seed| table.add_floor(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    for row in &table.rows {
        let found = row.errors.summary().unwrap();
        assert_eq!(row.missed, 0, "{row:?}");
        // The paper, without a position map: typically under 2 cm, under 5 cm at worst.
        assert!(
            found.median_cm < 2.0 && found.worst_cm < 5.0,
            "{:?} at {:?}: {found:?}",
            row.thing,
            row.force
        );
    }
}

#[test]
fn a_foot_is_found_as_well_at_a_seam_as_in_the_middle_of_a_tile() {
    let mut table = SeamTable::default();
    (1..=20).for_each(|seed| table.add_floor(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    for (method, name) in METHODS {
        for thing in Thing::ALL {
            let ratio = table.row(thing, method).ratio().unwrap();
            assert!(ratio <= 1.2, "{name}, {thing:?}: {ratio}");
        }
    }
}
