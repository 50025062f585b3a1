//! Options for events: OSC, TUIO, JSON lines.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, ToSocketAddrs};

use underfoot::floor::Geometry;
use underfoot::outgoing::TuioProfiles;
use underfoot::sink::{Fanout, JsonSink, OscSink, TuioSink, TuioVersion};
use underfoot::wire::Prefix;

use super::failure::Failure;

/// Who is told what happens.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct OutputArgs {
    /// Where events and contacts are sent as OSC.
    #[arg(long, value_name = "HOST:PORT", default_value_t = OSC_TARGET, value_parser = osc_target)]
    osc: SocketAddr,
    /// Send no OSC.
    #[arg(long, conflicts_with = "osc")]
    no_osc: bool,
    #[command(flatten)]
    pub(crate) prefix: PrefixArg,
    #[command(flatten)]
    tuio: TuioArgs,
    /// Print every event as a line of JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// What addresses begin with.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct PrefixArg {
    /// What OSC addresses begin with, in and out: apart from those of the boards, which the floor file names.
    #[arg(long, value_name = "PREFIX", default_value_t)]
    pub(crate) osc_prefix: Prefix,
}

/// Who is told of contacts as TUIO.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct TuioArgs {
    /// Send contacts as TUIO 1.1 cursors and blobs (port 3333 if none is given).
    #[arg(long, value_name = "HOST:PORT", value_parser = tuio_target)]
    tuio: Option<SocketAddr>,
    /// Send contacts as TUIO 2.0 pointers with pressure.
    #[arg(long, value_name = "HOST:PORT", value_parser = tuio_target)]
    tuio2: Option<SocketAddr>,
}

/// Where an app on the same machine listens.
const OSC_TARGET: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 9001);

/// TUIO's own port.
const TUIO_PORT: u16 = 3333;

impl Default for OutputArgs {
    fn default() -> Self {
        Self {
            osc: OSC_TARGET,
            no_osc: false,
            prefix: PrefixArg::default(),
            tuio: TuioArgs::default(),
            json: false,
        }
    }
}

impl OutputArgs {
    /// Everybody who is told.
    pub(crate) fn open(&self, geometry: &Geometry) -> Result<Fanout, Failure> {
        let mut events = Fanout::new();
        if !self.no_osc {
            events.push(OscSink::under(self.osc, self.prefix.osc_prefix.clone())?);
        }
        self.tuio.open(geometry, &mut events)?;
        if self.json {
            events.push(JsonSink::new(io::stdout())?);
        }
        Ok(events)
    }
}

impl TuioArgs {
    /// Adds those who are told.
    pub(crate) fn open(&self, geometry: &Geometry, events: &mut Fanout) -> Result<(), Failure> {
        for (target, version) in
            [(self.tuio, TuioVersion::One(TuioProfiles::default())), (self.tuio2, TuioVersion::Two)]
        {
            if let Some(target) = target {
                events.push(TuioSink::new(target, geometry, version)?);
            }
        }
        Ok(())
    }
}

/// Where OSC goes.
pub(crate) fn osc_target(text: &str) -> Result<SocketAddr, String> {
    target(text, OSC_TARGET.port())
}

fn tuio_target(text: &str) -> Result<SocketAddr, String> {
    target(text, TUIO_PORT)
}

/// The address of `HOST:PORT` or `HOST`; one of IPv4 rather than one of IPv6.
fn target(text: &str, port: u16) -> Result<SocketAddr, String> {
    if let Ok(ip) = text.parse::<IpAddr>() {
        return Ok(SocketAddr::new(ip, port));
    }
    let with_port = if text.contains(':') { text.to_owned() } else { format!("{text}:{port}") };
    let found: Vec<SocketAddr> = with_port
        .to_socket_addrs()
        .map_err(|error| format!("write it like 127.0.0.1:{port} or localhost:{port}: {error}"))?
        .collect();
    let first = found.iter().find(|address| address.is_ipv4()).or(found.first());
    first.copied().ok_or_else(|| format!("{text} has no address"))
}
