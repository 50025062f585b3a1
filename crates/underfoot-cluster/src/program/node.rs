//! `underfoot-cluster node`: serves one area and reports to the gateway.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use underfoot::floor::{Area, Floor, read_address};
use underfoot::runtime::{EndReason, Kind, Session};
use underfoot::schema;
#[cfg(unix)]
use underfoot::sink::Watchdog;
use underfoot::sink::{Fanout, Rank, claim_priority, wait_free};
use underfoot::source::{FloorInput, UdpSource};
use underfoot_cluster::auth::{Opened, Role};
use underfoot_cluster::message::{LayoutName, NodeMessage, ToNodes, VERSION, decode, fingerprint};
use underfoot_cluster::node::{GatewayGuard, NodeSink};
use underfoot_cluster::transport::TransportEnd;

use super::key::{KeyArgs, session as session_of};
use super::neighbourhood::Neighbourhood;
use super::notices::Notices;
use super::refused;
use super::slowed::{SlowedSource, slowed};
use super::sound::SoundArgs;
use super::stepped::{SteppedSource, Steps};
use super::teller::{Commander, DATAGRAMS, MESSAGES, Teller};
use super::worker::NodeWorker;
use super::{ClusterFailure, endpoints, layout, locked, stop_flag};

/// Options of a node.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Layout file, or the name of a built-in one; the same on all nodes. Without it the node has no controls until
    /// the gateway sends a layout; a gateway with a layout sends it in any case.
    #[arg(value_name = "LAYOUT")]
    layout: Option<PathBuf>,
    /// Floor file with `areas`; the same on all nodes and the gateway, but for calibration.
    #[arg(long, value_name = "FILE")]
    floor: PathBuf,
    /// The area that this node serves.
    #[arg(long, value_name = "NAME")]
    area: String,
    /// Address for the boards' packets: one of this machine, with a port. Without it, that of the floor file, and
    /// else 127.0.0.1:9000.
    #[arg(long, value_name = "ADDR", value_parser = read_address)]
    listen: Option<SocketAddr>,
    /// Endpoint of the gateway; may be given several times, for a second gateway beside the first. Without it, that
    /// of the floor file, and else tcp/127.0.0.1:7447.
    #[arg(long, value_name = "ENDPOINT")]
    gateway: Vec<String>,
    #[command(flatten)]
    key: KeyArgs,
    #[command(flatten)]
    sound: SoundArgs,
    /// Number of threads that sense the feet of a crowd. Those beyond the first sleep while fewer than a hundred feet
    /// are in the area, and keep a core busy each while there are more.
    #[arg(long, value_name = "N", default_value_t = NonZeroUsize::MIN)]
    sensing_threads: NonZeroUsize,
    /// Stop after this many seconds.
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// For tests: SIGUSR1 sets this node's clock forward by a second.
    #[arg(long, hide = true)]
    step_clock: bool,
    /// For measurements: slow this node's clock down by this factor.
    #[arg(long, hide = true, default_value_t = 1)]
    slow: u32,
}

/// Default address for packets.
const LISTEN: SocketAddr = SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 9000));

/// Number of remembered senders besides the gateways: recordings of earlier starts.
const SPARE_GATEWAYS: usize = 8;

/// Greatest number of messages that wait for the sending thread: a fifth of a second.
const WAITING: usize = 100;

/// The packets and requests of `source` on a clock with these steps that runs `times` slower.
fn on_clock(source: UdpSource, steps: Option<Steps>, times: u32) -> FloorInput {
    let mut input = FloorInput::from(source);
    if let Some(steps) = steps {
        input.source = Box::new(SteppedSource::new(input.source, steps));
    }
    if times > 1 {
        input.source = Box::new(SlowedSource::new(input.source, times));
    }
    input
}

/// Serves an area until a stop.
pub(crate) fn run(args: Args) -> Result<(), ClusterFailure> {
    let floor = schema::load_floor(&args.floor)?;
    let area = area(&floor, &args.area)?;
    let part = floor.part(area);
    let part = part
        .ok_or_else(|| ClusterFailure::Other(format!("the area \"{}\" has no tile on the floor", area.id)))?;
    let layout = args.layout.map(|path| layout::load(&path, &floor.geometry)).transpose()?;
    let own = layout.as_ref().map(|layout| LayoutName::of(0, &schema::write_layout(layout)));
    let layout = layout.unwrap_or_default().part(area, &floor.geometry);
    let stop = stop_flag(args.seconds)?;
    let listen = args.listen.or(area.listen).unwrap_or(LISTEN);
    let gateways = endpoints(args.gateway, &floor);
    let (key, made) = args.key.find((&floor, &args.floor), &gateways, [listen])?;
    let source = UdpSource::bind(listen, &part)?;
    let steps = args.step_clock.then(Steps::by_signal).transpose()?;
    let set = steps.as_ref().map_or_else(|| source.clock(), |steps| steps.clock(source.clock()));
    let clock = if args.slow > 1 { slowed(set, args.slow) } else { set };
    let Neighbourhood { seal, computers, border, session: neighbours, unheard } =
        Neighbourhood::of((&floor, area), listen, &key, &clock)?;
    let crossed = border.counters();
    let source = source.sealed_by(Box::new(seal), computers);
    let (source, forwarded) = source.forwarding(&floor.forwardings(area))?;
    let input = on_clock(source, steps, args.slow);
    let (drafts, drafted) = wait_free(WAITING);
    let sink = NodeSink::new(drafts);
    let held_up = sink.held_up();
    #[cfg_attr(not(unix), expect(unused_mut, reason = "other systems have no watchdog"))]
    let mut sinks = Fanout::new().with(sink);
    #[cfg(unix)]
    if let Some(watchdog) = Watchdog::of_environment() {
        sinks.push(watchdog);
    }
    let sound = args.sound;
    let session = Session::source(input, Arc::clone(&clock))
        .floor(part)
        .layout(layout)
        .sink(sinks)
        .neighbours(border)
        .actuators(move |floor, start, _| sound.open(floor, start))
        .realtime()
        .sensing_threads(args.sensing_threads)
        .stop_flag(stop)
        .start()?;
    let notices = Notices::start();
    made.into_iter().for_each(|made| notices.say(made));
    // The priority of the sending thread and of Zenoh's threads, which inherit it.
    claim_priority(Rank::Telling);
    let guard = Arc::new(Mutex::new(GatewayGuard::new(&args.area)));
    let refused = Arc::<AtomicU64>::default();
    let answering = session_of(Role::Node, &key, gateways.len() + SPARE_GATEWAYS)?;
    let answering = Arc::new(Mutex::new(answering));
    let worker = NodeWorker::start(session.clone(), area.clone(), floor.geometry, own, notices.clone());
    let transport = {
        let worker = worker.clone();
        let commander = Commander { session: session.clone(), notices: notices.clone() };
        let (guard, clock, refused) = (Arc::clone(&guard), Arc::clone(&clock), Arc::clone(&refused));
        let answering = Arc::clone(&answering);
        TransportEnd::node(&gateways, &args.area, &key, move |bytes| {
            let now = clock();
            let Ok(Opened { head, body, .. }) = locked(&answering).open(bytes, now) else { return };
            let message = match decode(bytes.get(body).unwrap_or_default())
                .map(|told: ToNodes| told.in_envelope(&head))
            {
                Ok(ToNodes::Beat(message)) => message,
                Ok(ToNodes::Layout(layout)) => return worker.check(layout, now),
                Err(_) => {
                    refused.fetch_add(1, Ordering::Relaxed);
                    return;
                }
            };
            worker.hear(&message, now);
            let actions = locked(&guard).hear(&message, now);
            actions.into_iter().for_each(|action| commander.apply(action));
        })?
    };
    notices.say(format!(
        "Serving area \"{}\" on {}, for the gateway at {}. Ctrl-C ends it.",
        args.area,
        listen,
        gateways.join(", ")
    ));
    let teller = Teller {
        head: NodeMessage {
            version: VERSION,
            floor: fingerprint(&floor),
            area: args.area,
            name: format!("{listen} (process {})", std::process::id()),
            ..NodeMessage::default()
        },
        transport,
        session: Arc::clone(&answering),
        neighbours: neighbours.clone(),
        refused: Default::default(),
        guard,
        clock,
        commander: Commander { session: session.clone(), notices: notices.clone() },
        worker,
        unsent: 0,
    };
    let unsent = teller.run(drafted);
    if forwarded.sent() > 0 {
        eprintln!("{} packets forwarded to neighbours.", forwarded.sent());
    }
    if crossed.given() + crossed.felt() > 0 {
        eprintln!("{} cues handed to neighbours, {} of theirs felt here.", crossed.given(), crossed.felt());
    }
    let counters = session.snapshot().floor.counters;
    let lost = [
        (counters.lost, "packets of boards that never came"),
        (counters.late, "packets of boards that came too late for their frame"),
        (counters.overflowed, "packets that the system dropped, since its buffer was full"),
        (counters.refused(), "datagrams refused"),
        (counters.jumps, "loads that changed faster than a body changes them, not believed for 100 ms"),
        (
            counters.overruns,
            "times that sensing gave up its real-time priority, since the machine is too slow",
        ),
        (crossed.late(), "cues of neighbours older than 50 ms, not played"),
        (crossed.lost(), "cues of neighbours that never came"),
        (crossed.untimed(), "cues of neighbours whose clock was not known yet, not played"),
        (crossed.unsent(), "cues that could not be handed to a neighbour"),
        (crossed.refused(), "notes of neighbours not understood"),
        (unheard.load(Ordering::Relaxed), "notes of neighbours dropped, since they came faster than frames"),
        (forwarded.late(), "packets too old to be forwarded"),
        (forwarded.unsent(), "packets not forwarded, since the system did not take them"),
        (held_up.load(Ordering::Relaxed), "messages held up"),
        (unsent, "messages not sent"),
        (refused.load(Ordering::Relaxed), "messages not understood"),
    ];
    lost.iter().filter(|(count, _)| *count > 0).for_each(|(count, what)| eprintln!("{count} {what}."));
    refused::report(locked(&answering).refusals(), MESSAGES);
    refused::report(neighbours.refusals(), DATAGRAMS);
    ended(&session)
}

/// The area called `id`.
fn area<'f>(floor: &'f Floor, id: &str) -> Result<&'f Area, ClusterFailure> {
    floor.area(id).ok_or_else(|| {
        let ids: Vec<&str> = floor.areas.iter().map(|area| area.id.as_str()).collect();
        ClusterFailure::Other(format!("the floor has no area \"{id}\": there are {}", ids.join(", ")))
    })
}

/// The reason for the end of the floor's session.
fn ended(session: &Session) -> Result<(), ClusterFailure> {
    while let Some(event) = session.next_event_timeout(Duration::from_secs(2)) {
        match event.kind {
            Kind::Ended(EndReason::Stopped | EndReason::SourceEnded) => return Ok(()),
            Kind::Ended(reason) => {
                return Err(ClusterFailure::Other(format!("{reason}: {}", event.message())));
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::net::UdpSocket;

    use super::*;

    #[test]
    fn requests_get_through_a_clock_of_another_kind() {
        let here = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let source = UdpSource::bind(here, &Floor::default()).unwrap();
        let app = UdpSocket::bind(here).unwrap();
        app.connect(source.local_addr().unwrap()).unwrap();
        let message = rosc::OscMessage { addr: "/underfoot/page/get".into(), args: vec![] };
        app.send(&rosc::encoder::encode(&rosc::OscPacket::Message(message)).unwrap()).unwrap();
        let mut input = on_clock(source, Some(Steps::default()), 4);
        while input.source.counters().datagrams == 0 {
            input.source.next(Duration::from_millis(5)).unwrap();
        }
        let mut port = input.port.unwrap();
        let sender = port.take_request().unwrap().sender.unwrap();
        port.answer(sender, b"here");
        assert_eq!(app.recv(&mut [0; 16]).unwrap(), 4);
    }
}
