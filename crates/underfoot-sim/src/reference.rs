//! The chapters of the reference about scenarios.

use super::Scenario;
use underfoot::schema::Chapter;

/// Returns the descriptions of scenarios and their steps.
#[must_use]
pub fn reference() -> Vec<Chapter> {
    let (scenario, steps) = Scenario::describe();
    let about =
        "What people do on a simulated floor: a file, such as one for `underfoot session --scenario`.";
    vec![
        Chapter::new("scenarios", about, vec![scenario]),
        Chapter::new("steps", "What a person does in a scenario, one step after the other.", steps),
    ]
}
