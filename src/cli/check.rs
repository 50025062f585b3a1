use std::path::PathBuf;

use underfoot::schema::{self, Diagnostics};

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::layout_args::LayoutArgs;

/// What `underfoot check` is asked to do.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Layout files.
    #[arg(required = true, value_name = "LAYOUT")]
    layouts: Vec<PathBuf>,
    #[command(flatten)]
    floor: FloorArgs,
    /// Folder of control kinds to add; without it, a `widgets` folder beside each layout or beside its folder.
    #[arg(long, value_name = "DIR")]
    widgets: Option<PathBuf>,
    /// Print the diagnostics as one JSON array on standard output.
    #[arg(long)]
    json: bool,
}

/// Reads every layout and says everything that is wrong with it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let floor = args.floor.load()?;
    let mut found = Diagnostics::default();
    let mut bad = 0;
    for path in &args.layouts {
        let files = LayoutArgs { layout: Some(path.clone()), widgets: args.widgets.clone() };
        let read = files.kinds().and_then(|kinds| schema::load_layout(path, &kinds, &floor.geometry));
        match read {
            Ok(loaded) => found.append(loaded.warnings),
            Err(diagnostics) => {
                bad += 1;
                found.append(diagnostics);
            }
        }
    }
    if args.json {
        let json = serde_json::to_string(&found).map_err(|error| Failure::Other(error.to_string()))?;
        anstream::println!("{json}");
    } else {
        anstream::eprint!("{found}");
    }
    match bad {
        0 => {
            if !args.json {
                anstream::println!("{} good", count(args.layouts.len()));
            }
            Ok(())
        }
        bad => Err(Failure::Other(format!("{} of {} bad", bad, count(args.layouts.len())))),
    }
}

fn count(layouts: usize) -> String {
    if layouts == 1 { "1 layout".into() } else { format!("{layouts} layouts") }
}
