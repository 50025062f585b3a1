//! Options for events: OSC, TUIO, JSON lines.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, ToSocketAddrs};

use underfoot::floor::{Geometry, canonical};
use underfoot::outgoing::TuioProfiles;
use underfoot::sink::{Fanout, JsonSink, OscSink, TuioSink, TuioVersion};
use underfoot::wire::Prefix;

use super::failure::Failure;
use super::output::Results;

/// Options for the receivers of events.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct OutputArgs {
    /// Send events and contacts as OSC to this address; may be given several times, and be a broadcast or multicast
    /// address.
    #[arg(long, value_name = "HOST:PORT", default_values_t = [OSC_TARGET], value_parser = osc_target)]
    osc: Vec<SocketAddr>,
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
    /// Also print contacts, 100 times a second.
    #[arg(long, requires = "json")]
    json_contacts: bool,
}

/// Option for the prefix of OSC addresses.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct PrefixArg {
    /// Prefix of OSC addresses, in and out, except those of the boards, which the floor file names.
    #[arg(long, value_name = "PREFIX", default_value_t)]
    pub(crate) osc_prefix: Prefix,
}

/// Options for the receivers of TUIO.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct TuioArgs {
    /// Send contacts as TUIO 1.1 (port 3333 if none is given); may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = tuio_target)]
    tuio: Vec<SocketAddr>,
    /// Send contacts as TUIO 2.0 pointers with pressure; may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = tuio_target)]
    tuio2: Vec<SocketAddr>,
    /// Profiles of TUIO 1.1 for a foot; use `cursors` for a client that treats both as touches.
    #[arg(long, value_name = "WHICH", value_enum, default_value_t, requires = "tuio")]
    tuio_profiles: Profiles,
}

/// Profiles of TUIO 1.1 that contain a foot.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default)]
enum Profiles {
    /// `2Dcur`.
    Cursors,
    /// `2Dblb`.
    Blobs,
    /// Both: each foot is a cursor and a blob.
    #[default]
    Both,
}

impl From<Profiles> for TuioProfiles {
    fn from(profiles: Profiles) -> Self {
        match profiles {
            Profiles::Cursors => Self::Cursors,
            Profiles::Blobs => Self::Blobs,
            Profiles::Both => Self::Both,
        }
    }
}

/// Default address of an app on the same machine.
const OSC_TARGET: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 9001);

/// Default port of TUIO.
const TUIO_PORT: u16 = 3333;

impl Default for OutputArgs {
    fn default() -> Self {
        Self {
            osc: vec![OSC_TARGET],
            no_osc: false,
            prefix: PrefixArg::default(),
            tuio: TuioArgs::default(),
            json: false,
            json_contacts: false,
        }
    }
}

impl OutputArgs {
    /// Whether standard output has JSON lines.
    pub(crate) const fn is_json(&self) -> bool {
        self.json
    }

    /// Opens all outputs; a reader of JSON lines that is slow misses lines.
    pub(crate) fn open(&self, geometry: &Geometry) -> Result<Fanout, Failure> {
        self.open_with(geometry, |lines| lines)
    }

    /// Opens all outputs; waits for a reader of JSON lines that is slow.
    pub(crate) fn open_patiently(&self, geometry: &Geometry) -> Result<Fanout, Failure> {
        self.open_with(geometry, JsonSink::waiting)
    }

    fn open_with(
        &self,
        geometry: &Geometry,
        how: impl FnOnce(JsonSink) -> JsonSink,
    ) -> Result<Fanout, Failure> {
        let mut events = Fanout::new();
        if !self.no_osc {
            for &target in &self.osc {
                events.push(OscSink::under(target, self.prefix.osc_prefix.clone())?);
            }
        }
        self.tuio.open(geometry, &mut events)?;
        if self.json {
            let lines = how(JsonSink::new(Results(io::stdout()))?);
            events.push(if self.json_contacts { lines.with_contacts() } else { lines });
        }
        Ok(events)
    }
}

impl TuioArgs {
    /// Adds the receivers of TUIO to `events`.
    pub(crate) fn open(&self, geometry: &Geometry, events: &mut Fanout) -> Result<(), Failure> {
        let one = TuioVersion::One(self.tuio_profiles.into());
        for (targets, version) in [(&self.tuio, one), (&self.tuio2, TuioVersion::Two)] {
            for &target in targets {
                events.push(TuioSink::new(target, geometry, version)?);
            }
        }
        Ok(())
    }
}

/// Parses the address of a receiver of OSC.
pub(crate) fn osc_target(text: &str) -> Result<SocketAddr, String> {
    target(text, OSC_TARGET.port())
}

fn tuio_target(text: &str) -> Result<SocketAddr, String> {
    target(text, TUIO_PORT)
}

/// Resolves `HOST:PORT` or `HOST`; prefers IPv4 to IPv6.
fn target(text: &str, port: u16) -> Result<SocketAddr, String> {
    if let Ok(ip) = text.parse::<IpAddr>() {
        return Ok(canonical(SocketAddr::new(ip, port)));
    }
    let with_port = if text.contains(':') { text.to_owned() } else { format!("{text}:{port}") };
    let found: Vec<SocketAddr> = with_port
        .to_socket_addrs()
        .map_err(|error| format!("write it like 127.0.0.1:{port} or localhost:{port}: {error}"))?
        .collect();
    let first = found.iter().find(|address| address.is_ipv4()).or(found.first());
    first.copied().map(canonical).ok_or_else(|| format!("{text} has no address"))
}
