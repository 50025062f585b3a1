use std::io;
use std::net::SocketAddr;

use underfoot::sink::{Fanout, JsonSink, OscSink};

use super::failure::Failure;

/// Who is told what happens.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct OutputArgs {
    /// Where events and contacts are sent as OSC.
    #[arg(long, value_name = "ADDR", default_value_t = OSC_TARGET)]
    osc: SocketAddr,
    /// Send no OSC.
    #[arg(long, conflicts_with = "osc")]
    no_osc: bool,
    /// Print every event as a line of JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Where an app on the same machine listens.
const OSC_TARGET: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(std::net::Ipv4Addr::LOCALHOST), 9001);

impl Default for OutputArgs {
    fn default() -> Self {
        Self { osc: OSC_TARGET, no_osc: false, json: false }
    }
}

impl OutputArgs {
    /// Everybody who is told.
    pub(crate) fn open(&self) -> Result<Fanout, Failure> {
        let mut events = Fanout::new();
        if !self.no_osc {
            events.push(OscSink::new(self.osc)?);
        }
        if self.json {
            events.push(JsonSink::new(io::stdout())?);
        }
        Ok(events)
    }
}
