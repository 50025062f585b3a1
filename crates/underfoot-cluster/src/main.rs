//! The program `underfoot-cluster`: a node or the gateway of a floor that several computers serve.
//!
//! Exit status 0: done; 1: the work failed (the reason is on standard error); 2: wrong usage.

mod program;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use tracing_subscriber::EnvFilter;

use program::ClusterFailure;

/// One floor served by several computers.
///
/// Each computer runs a node, which serves one area of the floor file; one of them, or another one, runs the gateway,
/// to which apps listen as to `underfoot run`.
#[derive(Debug, Parser)]
#[command(name = "underfoot-cluster", version, propagate_version = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Say more on standard error (-v: events, -vv: everything).
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Serve one area: sensor packets in, actuator samples out, and reports to the gateway.
    Node(program::node::Args),
    /// Join the reports of the nodes into those of one floor.
    Gateway(program::gateway::Args),
    /// Make a key for a floor: a file that only its owner can read, the same for all computers of the floor.
    Key(program::key::Args),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let level = match cli.verbose {
        0 => "warn,zenoh=error,jack=off",
        1 => "info,underfoot=debug,zenoh=warn,jack=off",
        _ => "debug",
    };
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(level));
    tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).with_target(false).init();
    let done: Result<(), ClusterFailure> = match cli.command {
        Command::Node(args) => program::node::run(args),
        Command::Gateway(args) => program::gateway::run(&args),
        Command::Key(args) => program::key::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}
