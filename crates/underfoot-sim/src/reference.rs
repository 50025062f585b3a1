//! The chapters of the reference about scenarios.

use super::Scenario;
use underfoot::schema::Chapter;

/// Returns the descriptions of scenarios and their steps.
#[must_use]
pub fn reference() -> Vec<Chapter> {
    let (scenario, steps) = Scenario::describe();
    let about =
        "Actions of people on a simulated floor: a file, such as one for `underfoot session --scenario`.";
    vec![
        Chapter::new("scenarios", about, vec![scenario]),
        Chapter::new("steps", "Actions of one person in a scenario, one after the other.", steps),
    ]
}
