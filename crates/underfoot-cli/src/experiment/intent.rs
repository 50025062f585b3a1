//! Unintended actions and missed presses.

use serde::Serialize;
use underfoot_lab::experiment::{IntentEffort, IntentSweep, IntentTable};

use super::options::{FigureArgs, IntentArgs};
use super::parallel::gathered;
use crate::failure::Failure;
use crate::output::print_json;
use crate::progress::ProgressLine;

/// Plays all people, and writes tables and plot.
pub(super) fn intent(args: &IntentArgs) -> Result<(), Failure> {
    let IntentArgs { people, steps, presses, seed, .. } = *args;
    let quality = args.quality.quality;
    let progress = ProgressLine::of("person", people);
    // Every fourth person also uses the rows of buttons, with as many presses and fewer steps: each crosses all rows.
    let sweepers = people.div_ceil(4);
    let on_rows = IntentEffort { steps: (2 * steps).div_ceil(5), presses };
    let empty = || (IntentTable::on(quality), IntentSweep::on(quality));
    let add = |(table, sweep): &mut (IntentTable, IntentSweep), number| {
        let seed = seed.wrapping_add(number);
        table.add_person(seed, number, IntentEffort { steps, presses })?;
        if number < sweepers {
            sweep.add_person(seed.wrapping_add(people), number, on_rows)?;
        }
        Ok(())
    };
    let append = |all: &mut (IntentTable, IntentSweep), person: (IntentTable, IntentSweep)| {
        all.0.append(person.0);
        all.1.append(&person.1);
    };
    let (table, sweep) = gathered(&progress, people, empty, add, append)?;
    drop(progress);
    if args.json {
        #[derive(Serialize)]
        struct Tables<L, C> {
            lines: Vec<L>,
            cells: C,
        }
        return print_json(&Tables { lines: table.lines().collect(), cells: sweep.cells() });
    }
    outln!("{table}");
    FigureArgs { out: args.out.clone(), seed: args.seed, width: args.width }.make("intent_sweep", &sweep)?;
    let path = args.out.join("intent.csv");
    std::fs::write(&path, table.csv()).map_err(|error| Failure::File(path.clone(), error))?;
    outln!("{}", path.display());
    Ok(())
}
