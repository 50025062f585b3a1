//! How well one contact is found on floors of the paper's parts: tables as snapshots, held against the goals.
#![allow(clippy::unwrap_used)]

use underfoot::experiment::{SeamTable, SpotTable, Thing};

#[test]
fn one_contact_over_a_whole_tile() {
    let mut table = SpotTable::new(5);
    (1..=20).for_each(|seed| table.add_floor(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    for row in &table.rows {
        let found = row.errors.summary().unwrap();
        let what = format!("{:?}, {:?}, {}: {found:?}", row.thing, row.force, row.way.name);
        assert_eq!(row.missed, 0, "{what}");
        // The paper, without a position map: typically under 2 cm, under 5 cm at worst.
        assert!(found.median_cm < 2.0 && found.worst_cm < 5.0, "{what}");
        // Our goal with one; at 50 N a sensor's zero, half a newton off, alone is worth 0.3 cm.
        if row.way.mapped && row.force.0 >= 100.0 {
            assert!(found.median_cm < 0.5 && found.p95_cm < 1.2, "{what}");
        }
    }
}

#[test]
fn a_foot_is_found_as_well_at_a_seam_as_in_the_middle_of_a_tile() {
    let mut table = SeamTable::default();
    (1..=20).for_each(|seed| table.add_floor(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    let [plain, mapped] = [1, 2];
    for thing in Thing::ALL {
        let ratio = table.rows(thing)[plain].ratio().unwrap();
        assert!(ratio <= 1.2, "{thing:?}: {ratio}");
    }
    // With maps what is left comes from the sensors' zeros, of which a foot on two tiles meets twice as
    // many, with longer levers: more than in mid-tile, but less than half of what it is without maps.
    let seam = |way: usize| table.rows(Thing::Foot)[way].seam.quantile(0.5).unwrap();
    assert!(seam(mapped) < 0.5 * seam(plain), "{} and {} m", seam(mapped), seam(plain));
}
