use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::mpsc;

use underfoot::sense::Method;
use underfoot::serve::{Command, Server};
use underfoot::sink::{EventSink, Fanout, JsonSink, OscSink};
use underfoot::source::UdpSource;

use super::actuate::{self, ActuateArgs};
use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::layout_args::LayoutArgs;
use super::stop::stop_flag;
use super::summary;
use super::watch::Watch;

/// What `underfoot run` is asked to do.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    /// Where the boards' packets arrive.
    #[arg(long, value_name = "ADDR", default_value = "0.0.0.0:9000")]
    listen: SocketAddr,
    #[command(flatten)]
    outputs: OutputArgs,
    #[command(flatten)]
    actuate: ActuateArgs,
    /// The paper's plain sensing: one contact per group of connected tiles.
    #[arg(long)]
    eq4: bool,
}
