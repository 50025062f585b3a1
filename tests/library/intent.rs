//! Whether controls follow the intent of feet, on a small scale: `underfoot experiment intent` counts twenty
//! thousand.

use underfoot_lab::experiment::{Figure, Guarded, IntentEffort, IntentSweep, IntentTable};

#[test]
fn people_who_cross_and_use_every_shipped_layout_get_what_they_mean() {
    let run = || {
        let mut table = IntentTable::default();
        for number in 0..3 {
            table.add_person(number + 1, number, IntentEffort { steps: 20, presses: 18 }).unwrap();
        }
        table
    };
    let table = run();
    println!("{table}");
    for guard in Guarded::ALL {
        let score = table.whole(guard);
        assert!(table.steps(guard) >= 60 && score.intended >= 18, "{guard:?}");
        assert_eq!((score.false_activations, score.wrong), (0, 0), "{guard:?}");
        // One of thirty-six is below any measurable rate here; the full run counts thousands.
        assert!(score.missed <= 1, "{guard:?}: {score:?}");
    }
    assert_eq!(table.csv().lines().count(), 1 + table.lines().count());
}

#[test]
fn the_sweep_has_a_curve_for_every_size() {
    let mut sweep = IntentSweep::default();
    sweep.add_person(5, 0, IntentEffort { steps: 1, presses: 0 }).unwrap();
    assert_eq!(sweep.cells().len(), 25);
    assert!(sweep.cells().iter().all(|cell| cell.falsely.of > 0));
    let page = sweep.draw();
    let said: Vec<String> = page.texts().map(|(text, _)| text.to_string()).collect();
    assert!(said.iter().any(|text| text == "24 cm") && said.iter().any(|text| text == "False activations"));
    assert_eq!(sweep.csv().lines().count(), 26);
}
