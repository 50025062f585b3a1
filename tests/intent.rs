//! Whether controls do what feet meant, in small: `underfoot experiment intent` counts twenty thousand.
#![allow(clippy::unwrap_used)]

use underfoot::experiment::{Guarded, IntentEffort, IntentSweep, IntentTable};

#[test]
fn a_few_people_cross_and_use_every_shipped_layout() {
    let mut table = IntentTable::default();
    for number in 0..6 {
        table.add_person(number + 1, number, IntentEffort { steps: 40, presses: 36 }).unwrap();
    }
    println!("{table}");
    let mut sweep = IntentSweep::default();
    sweep.add_person(5, 0, IntentEffort { steps: 20, presses: 50 }).unwrap();
    println!("{}", underfoot::experiment::Figure::summary(&sweep));
    assert!(Guarded::ALL.iter().all(|&guard| table.steps(guard) >= 240));
}
