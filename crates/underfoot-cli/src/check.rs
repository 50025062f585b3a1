//! `underfoot check`: reports all problems of layouts.

use std::path::PathBuf;

use underfoot::floor::Floor;
use underfoot::schema::{self, Diagnostics};
use underfoot_scene::ergonomics::{self, RULES};

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::fonts::fonts;
use super::layout_args::{LayoutArgs, MisplacedLayout, builtin_names};
use super::output::{colours, print_json};

/// Options of `underfoot check`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[arg(
        required_unless_present_any = ["explain", "rules"],
        value_name = "LAYOUT",
        help = format!("Layout files, or names of built-in layouts ({})", builtin_names()),
    )]
    layouts: Vec<PathBuf>,
    #[command(flatten)]
    misplaced: MisplacedLayout,
    #[command(flatten)]
    floor: FloorArgs,
    /// Folder of control kinds to add; without it, a `widgets` folder beside each layout or beside its folder.
    #[arg(long, value_name = "DIR")]
    widgets: Option<PathBuf>,
    /// Folder of effects to add; without it, an `effects` folder beside each layout or beside its folder.
    #[arg(long, value_name = "DIR")]
    effects: Option<PathBuf>,
    /// Print each layout in its resolved form on standard output: every value of every control, written or from its
    /// kind.
    #[arg(long, conflicts_with = "json")]
    resolved: bool,
    /// Print the diagnostics as one JSON array on standard output.
    #[arg(long)]
    json: bool,
    /// Fail on warnings too.
    #[arg(long)]
    strict: bool,
    /// Explain an ergonomic rule, such as U101: its requirement, its reason and its source.
    #[arg(long, value_name = "CODE", conflicts_with = "layouts")]
    explain: Option<String>,
    /// List all ergonomic rules.
    #[arg(long, conflicts_with_all = ["layouts", "explain"])]
    rules: bool,
}

/// Reads every layout and reports all its problems, for the program and for feet.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(code) = &args.explain {
        return explain(code, args.json);
    }
    if args.rules {
        return list_rules(args.json);
    }
    let floor = args.floor.load()?;
    let mut found = Diagnostics::default();
    let mut bad = 0;
    for path in &args.layouts {
        let problems = check(path, args, &floor);
        bad += usize::from(problems.errors() > 0 || (args.strict && problems.warnings() > 0));
        found.append(problems);
    }
    if args.json {
        print_json(&found)?;
    } else if !found.is_empty() {
        errln!("{}", if colours() { format!("{found:#}") } else { found.to_string() });
    }
    match bad {
        0 => {
            if !args.json && !args.resolved {
                outln!("{} good", count(args.layouts.len()));
            }
            Ok(())
        }
        bad => Err(Failure::Other(format!("{} of {} bad", bad, count(args.layouts.len())))),
    }
}

/// All diagnostics of the layout at `path`.
fn check(path: &std::path::Path, args: &Args, floor: &Floor) -> Diagnostics {
    let files = LayoutArgs {
        layout: Some(path.to_path_buf()),
        widgets: args.widgets.clone(),
        effects: args.effects.clone(),
        ..LayoutArgs::default()
    };
    match files.read(&floor.geometry) {
        Ok(loaded) => {
            if args.resolved {
                outln!("{}", schema::write_layout(&loaded.layout));
            }
            let mut problems = loaded.warnings;
            problems.merge(ergonomics::locate(&loaded.places, &ergonomics::review(&loaded.layout, floor)));
            problems.merge(loaded.places.undrawn(|text| fonts().missing(text)));
            problems
        }
        Err(problems) => problems,
    }
}

fn explain(code: &str, json: bool) -> Result<(), Failure> {
    let rule = ergonomics::rule(code).ok_or_else(|| {
        let codes: Vec<&str> = RULES.iter().map(|rule| rule.code).collect();
        Failure::Other(format!("there is no rule {code}; there are {}", codes.join(", ")))
    })?;
    if json {
        return print_json(rule);
    }
    outln!(
        "{}: {}\n\n{}\n\nWhy: {}\nTo do: {}",
        rule.code,
        rule.title,
        rule.limits,
        rule.source,
        rule.remedy
    );
    Ok(())
}

fn list_rules(json: bool) -> Result<(), Failure> {
    if json {
        return print_json(&RULES);
    }
    for rule in RULES {
        outln!("{}  {}: {}", rule.code, rule.title, rule.limits);
    }
    Ok(())
}

fn count(layouts: usize) -> String {
    if layouts == 1 { "1 layout".into() } else { format!("{layouts} layouts") }
}
