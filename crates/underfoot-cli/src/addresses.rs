//! `underfoot addresses`: every OSC address of a layout.

use underfoot::serve::{AddressEntry, MessageDirection, Reference};

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::layout_args::LayoutArgs;
use super::output::print_json;
use super::outputs::PrefixArg;

/// Options of `underfoot addresses`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    prefix: PrefixArg,
    /// Print one JSON array on standard output.
    #[arg(long)]
    json: bool,
}

/// Lists every OSC address that the floor receives or sends, with its arguments.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let floor = args.floor.load()?;
    let layout = args.layout.load(&floor.geometry)?;
    let reference = Reference::of(&layout, &floor, &args.prefix.osc_prefix);
    if args.json {
        return print_json(&reference);
    }
    for entry in &reference.entries {
        outln!("{}", line(entry));
    }
    Ok(())
}

/// One address on a line: direction, address, arguments, meaning.
fn line(entry: &AddressEntry) -> String {
    let way = match entry.direction {
        MessageDirection::In => "in",
        MessageDirection::Out => "out",
        MessageDirection::Answer => "answer",
        MessageDirection::Target => "target",
    };
    let arguments: Vec<String> = entry
        .arguments
        .iter()
        .map(|argument| {
            let range =
                if argument.range.is_empty() { String::new() } else { format!(" ({})", argument.range) };
            format!("{} {}{range}", argument.tag, argument.name)
        })
        .collect();
    let arguments = if arguments.is_empty() { "-".to_owned() } else { arguments.join(", ") };
    format!("{way:6} {}  {arguments}\n         {}", entry.address, entry.says)
}
