//! Options for events: OSC, TUIO, JSON lines.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, ToSocketAddrs};

use underfoot::floor::{Geometry, canonical};
use underfoot::outgoing::TuioProfiles;
use underfoot::sink::{Fanout, JsonSink, OscSink, TuioSink, TuioVersion};
use underfoot::wire::Prefix;

use super::failure::Failure;
use super::output::Results;

/// Who is told what happens.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct OutputArgs {
    /// Where events and contacts are sent as OSC; may be given several times, and be a broadcast or multicast address.
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
    /// Print contacts among them as well, 100 times a second.
    #[arg(long, requires = "json")]
    json_contacts: bool,
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
    /// Send contacts as TUIO 1.1 (port 3333 if none is given); may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = tuio_target)]
    tuio: Vec<SocketAddr>,
    /// Send contacts as TUIO 2.0 pointers with pressure; may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = tuio_target)]
    tuio2: Vec<SocketAddr>,
    /// What a foot is in TUIO 1.1; where a client takes both for touches, `cursors`.
    #[arg(long, value_name = "WHICH", value_enum, default_value_t, requires = "tuio")]
    tuio_profiles: Profiles,
}

/// Which profiles of TUIO 1.1 tell of a foot.
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

/// Where an app on the same machine listens.
const OSC_TARGET: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 9001);

/// TUIO's own port.
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

    /// Everybody who is told; those who read JSON lines slowly are left lines out.
    pub(crate) fn open(&self, geometry: &Geometry) -> Result<Fanout, Failure> {
        self.open_with(geometry, |lines| lines)
    }

    /// Everybody who is told; those who read JSON lines slowly are waited for.
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
    /// Adds those who are told.
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
