//! The effect of a heavy foot beside a region on the foot that works in it: a small table as a snapshot.
//!
//! `underfoot experiment feet --people 100 --quality paper` makes the same table of more people.

use underfoot_lab::experiment::TapTable;

#[test]
fn a_heavy_foot_beside_a_region_leaves_its_cursor_alone() {
    let mut table = TapTable::default();
    (1..=8).for_each(|seed| table.add_person(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    let tracker = &table.scores[1];
    for score in tracker {
        assert_eq!((score.pressed, score.repeated), (score.touches, 0), "each touch is one press");
        assert!(score.cursor.quantile(0.5).unwrap() < 0.012, "{}", score.cursor);
    }
    assert!(tracker.iter().all(|score| score.out_of_nothing == 0), "a press that nobody made");
}
