//! How well one contact is found on floors of the paper's parts: tables as snapshots, held against the goals.

use underfoot::experiment::{SeamTable, SpotTable, Thing, Way};

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
        // 95 in 100 true places lie in the ellipse. Without a map a part's error is one for the whole tile, and a
        // point lies over few parts: 20 floors are few for so few parts.
        let inside = 100.0 * row.share_inside();
        let expected = match row.thing {
            Thing::Point => 90.0..=98.5,
            Thing::Foot => 93.0..=99.0,
        };
        assert!(expected.contains(&inside), "{inside} % in the ellipse, {what}");
        // The paper, without a position map: typically under 2 cm, under 5 cm at worst.
        assert!(found.median_cm < 2.0 && found.worst_cm < 5.0, "{what}");
        // Our goal with one is 0.4, 1 and 2 cm.
        if row.way.mapped {
            assert!(found.median_cm < 0.4 && found.p95_cm < 1.0 && found.worst_cm < 2.0, "{what}");
        }
    }
}

#[test]
fn a_foot_is_found_as_well_at_a_seam_as_in_the_middle_of_a_tile() {
    let mut table = SeamTable::default();
    (1..=20).for_each(|seed| table.add_floor(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    for (row, way) in table.rows(Thing::Foot).iter().zip(Way::ALL) {
        let ratio = row.ratio().unwrap();
        assert!(ratio <= 1.2, "{}: {ratio}", way.name);
    }
    // A point at a seam lies over two sensors instead of four: their errors do not cancel. But with a map it is
    // less than a millimetre.
    for row in &table.rows(Thing::Point)[..2] {
        assert!(row.ratio().unwrap() <= 1.2);
    }
    assert!(table.rows(Thing::Point)[2].seam.quantile(0.5).unwrap() < 0.001);
}
