//! `underfoot-cluster gateway`: joins the reports of the nodes into those of one floor.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant as HostInstant};

use underfoot::floor::{Floor, Network, read_address};
use underfoot::outgoing::{TuioProfiles, write_control, write_error, write_mute, write_page};
use underfoot::schema;
#[cfg(unix)]
use underfoot::sink::Watchdog;
use underfoot::sink::{
    AreaNews, AreaState, EventSink, Fanout, JsonSink, OscSink, Rank, Report, TuioSink, TuioVersion,
    claim_priority,
};
use underfoot::source::{Port, UdpSource};
use underfoot::units::Instant;
use underfoot::wire::{Prefix, Request};
use underfoot_cluster::auth::{MessageKind, Opened, Role};
use underfoot_cluster::gateway::{Counters, Gateway, Output, RequestAnswer};
use underfoot_cluster::message::{NodeMessage, ToNodes, decode, encode};
use underfoot_cluster::transport::TransportEnd;

use super::key::{KeyArgs, session};
use super::notices::Notices;
use super::refused::{self, RefusalNotices};
use super::slowed::slow;
use super::{ClusterFailure, endpoints, layout, locked, stop_flag};

/// Options of the gateway.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Layout file, or the name of a built-in one, for all nodes; each change of the file goes to all of them or to
    /// none. Without it, nodes have their own and requests are refused.
    #[arg(value_name = "LAYOUT")]
    layout: Option<PathBuf>,
    /// Floor file with `areas`; the same on all nodes.
    #[arg(long, value_name = "FILE")]
    floor: PathBuf,
    /// Endpoint for nodes; may be given several times, for several network cards. Without it, that of the floor file,
    /// and else tcp/127.0.0.1:7447.
    #[arg(long, value_name = "ENDPOINT")]
    listen: Vec<String>,
    /// Address for apps' requests as OSC; without it, requests are refused.
    #[arg(long, value_name = "ADDR", requires = "layout", value_parser = read_address)]
    commands: Option<SocketAddr>,
    /// Accept requests from this address or range; several may be given. Without it, from this machine only.
    #[arg(long, value_name = "CIDR", requires = "commands")]
    allow_commands: Vec<Network>,
    /// Target for events and contacts as OSC; may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = read_address)]
    osc: Vec<SocketAddr>,
    /// Prefix of OSC addresses.
    #[arg(long, value_name = "PREFIX", default_value_t)]
    osc_prefix: Prefix,
    /// Send contacts as TUIO 1.1; may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = read_address)]
    tuio: Vec<SocketAddr>,
    /// Send contacts as TUIO 2.0 pointers with pressure; may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = read_address)]
    tuio2: Vec<SocketAddr>,
    /// Print every event as a line of JSON on standard output.
    #[arg(long)]
    json: bool,
    /// Print contacts among them as well, 100 times a second.
    #[arg(long, requires = "json")]
    json_contacts: bool,
    #[command(flatten)]
    key: KeyArgs,
    /// Stop after this many seconds.
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// For measurements: slow the gateway's clock down by this factor.
    #[arg(long, hide = true, default_value_t = 1)]
    slow: u32,
}

/// Greatest number of queued messages: half a second of sixteen nodes.
const WAITING: usize = 4096;

/// Number of remembered senders besides two nodes for each area: recordings of earlier starts.
const SPARE_NODES: usize = 64;

/// Noun of reports about rejected messages.
const MESSAGES: &str = "messages to the gateway";

/// Time without a message after which the gateway advances anyway.
const PATIENCE: Duration = Duration::from_millis(2);

/// Interval between two messages to all nodes.
const TELL_EVERY: Duration = Duration::from_millis(50);

/// Joins the nodes' reports until a stop.
pub(crate) fn run(args: &Args) -> Result<(), ClusterFailure> {
    let floor = schema::load_floor(&args.floor)?;
    let listen = endpoints(args.listen.clone(), &floor);
    let (key, made) = args.key.find((&floor, &args.floor), &listen, [])?;
    let session = session(Role::Gateway, &key, 2 * floor.areas.len() + SPARE_NODES)?;
    let mut gateway = Gateway::new(&floor, session.nonce())?;
    let session = Arc::new(Mutex::new(session));
    let stop = stop_flag(args.seconds)?;
    let mut sinks = outputs(args, &floor)?;
    let mut requests = args.commands.map(|address| RequestSocket::open(address, args)).transpose()?;
    let changes = match &args.layout {
        Some(path) => {
            gateway.propose(layout::load(path, &floor.geometry)?, Instant::START);
            // A built-in layout has no file.
            path.exists().then(|| layout::watch(path.clone(), floor.geometry))
        }
        None => None,
    };
    let notices = Notices::start();
    made.into_iter().for_each(|made| notices.say(made));
    // The priority of this thread and of Zenoh's threads, which inherit it.
    claim_priority(Rank::Telling);
    let started = HostInstant::now();
    let times = args.slow;
    let now = move || slow(Instant::START + started.elapsed(), times);
    let (messages, received) = sync_channel(WAITING);
    let dropped = Arc::<AtomicU64>::default();
    let areas: Vec<String> = floor.areas.iter().map(|area| area.id.clone()).collect();
    let transport = {
        let (dropped, session) = (Arc::clone(&dropped), Arc::clone(&session));
        TransportEnd::gateway(&listen, &areas, &key, move |bytes| {
            let at = now();
            let Ok(Opened { head, echo, body, .. }) = locked(&session).open(bytes, at) else { return };
            let message = bytes.get(body).and_then(|body| decode::<NodeMessage>(body).ok());
            let message = message.map(|message| message.in_envelope(&head, echo));
            if messages.try_send((at, message)).is_err() {
                dropped.fetch_add(1, Ordering::Relaxed);
            }
        })?
    };
    let send = |message: &ToNodes| {
        let mut sealed = Vec::new();
        locked(&session).seal(MessageKind::Gateway, &encode(message), now(), &mut sealed);
        transport.send(sealed);
    };
    let areas = areas.len();
    notices.say(format!("Waiting for the nodes of {areas} areas on {}. Ctrl-C ends it.", listen.join(", ")));
    let mut latest = Instant::START;
    let mut due = Instant::START;
    let mut garbled = 0;
    let mut refused = RefusalNotices::default();
    while !stop.load(Ordering::Relaxed) {
        let arrived = wait(&received);
        for (at, message) in arrived {
            // Messages come on several threads.
            latest = latest.max(at);
            match message {
                Some(message) => gateway.take(message, latest),
                None => garbled += 1,
            }
        }
        latest = latest.max(now());
        if let Some(requests) = &mut requests {
            requests.take()?.into_iter().for_each(|request| gateway.ask(request, latest));
        }
        match changes.as_ref().and_then(|changes| changes.try_recv().ok()) {
            Some(Ok(layout)) => gateway.propose(layout, latest),
            Some(Err(failure)) => notices.say(format!("{failure}The last good layout stays on the floor.")),
            None => {}
        }
        let told = gateway.advance(latest);
        tell(&told, &mut sinks, &notices);
        if let Some(requests) = &mut requests {
            told.iter().for_each(|told| requests.answer(told));
        }
        sinks.poll(latest);
        if let Some(layout) = gateway.layout_message(latest) {
            send(&ToNodes::Layout(layout));
        }
        if gateway.take_news() || latest >= due {
            due = latest + TELL_EVERY;
            send(&ToNodes::Beat(gateway.message(now())));
        }
        let refusals = locked(&session).refusals();
        refused.look(refusals, MESSAGES, latest).into_iter().for_each(|notice| notices.say(notice));
    }
    tell(&gateway.end(latest), &mut sinks, &notices);
    let dropped = dropped.load(Ordering::Relaxed);
    report(gateway.counters(), garbled, dropped, sinks.dropped());
    refused::report(locked(&session).refusals(), MESSAGES);
    Ok(())
}

/// The outputs in `args`.
fn outputs(args: &Args, floor: &Floor) -> Result<Fanout, ClusterFailure> {
    let mut sinks = Fanout::new();
    for &target in &args.osc {
        sinks.push(OscSink::under(target, args.osc_prefix.clone())?);
    }
    for (targets, version) in
        [(&args.tuio, TuioVersion::One(TuioProfiles::default())), (&args.tuio2, TuioVersion::Two)]
    {
        for &target in targets {
            sinks.push(TuioSink::new(target, &floor.geometry, version)?);
        }
    }
    if args.json {
        let lines = JsonSink::new(io::stdout())?;
        sinks.push(if args.json_contacts { lines.with_contacts() } else { lines });
    }
    #[cfg(unix)]
    if let Some(watchdog) = Watchdog::of_environment() {
        sinks.push(watchdog);
    }
    Ok(sinks)
}

/// The socket for apps' requests and their answers.
struct RequestSocket {
    source: UdpSource,
    prefix: Prefix,
    bytes: Vec<u8>,
}

impl RequestSocket {
    fn open(address: SocketAddr, args: &Args) -> Result<Self, ClusterFailure> {
        let apps = if args.allow_commands.is_empty() { &Network::LOOPBACK[..] } else { &args.allow_commands };
        let prefix = args.osc_prefix.clone();
        let source = UdpSource::requests(address, apps.iter().copied())?.with_prefix(prefix.clone());
        Ok(Self { source, prefix, bytes: Vec::new() })
    }

    /// The requests of apps that have arrived.
    fn take(&mut self) -> Result<Vec<Request>, ClusterFailure> {
        // No boards send to this socket; the loop only reads packets so that requests are received.
        while self.source.next(Duration::ZERO)?.is_some() {}
        Ok(std::iter::from_fn(|| self.source.take_request()).collect())
    }

    /// Sends an answer to the app that asked.
    fn answer(&mut self, told: &Output) {
        let Output::Answer(to, answer) = told else { return };
        match answer {
            RequestAnswer::Control(state) => write_control(&self.prefix, state, &mut self.bytes),
            RequestAnswer::Page(page) => write_page(&self.prefix, page, &mut self.bytes),
            RequestAnswer::Muted(muted) => write_mute(&self.prefix, muted, &mut self.bytes),
            RequestAnswer::Refused(path, why) => {
                write_error(&self.prefix, &self.prefix.address(path), why, &mut self.bytes);
            }
        }
        self.source.answer(*to, &self.bytes);
    }
}

/// All messages that have arrived, once one has or [`PATIENCE`] is over. It takes all of them at once, so that the
/// backlog does not count as later than it is.
fn wait<T>(received: &Receiver<T>) -> Vec<T> {
    match received.recv_timeout(PATIENCE) {
        Ok(first) => std::iter::once(first).chain(received.try_iter().take(WAITING)).collect(),
        Err(RecvTimeoutError::Timeout) => Vec::new(),
        Err(RecvTimeoutError::Disconnected) => {
            std::thread::sleep(PATIENCE);
            Vec::new()
        }
    }
}

fn tell(told: &[Output], sinks: &mut Fanout, notices: &Notices) {
    for told in told {
        match told {
            Output::Report(report) => {
                sinks.report(report);
                if let Report::Area(news) = report {
                    notices.say(sentence(news));
                }
            }
            Output::Notice(notice) => notices.say(notice.clone()),
            Output::Answer(..) => {}
        }
    }
}

/// Returns the state of an area as a sentence for the operator.
fn sentence(AreaNews { area, state, why, uncertainty, .. }: &AreaNews) -> String {
    if *state == AreaState::Live {
        format!("Area \"{area}\" is live; its times are sure to {} us.", uncertainty.as_micros())
    } else {
        format!("Area \"{area}\" is {}: {why}.", state.name())
    }
}

fn report(counters: Counters, garbled: u64, dropped: u64, unsent: u64) {
    let Counters { messages, refused, stale, withheld, late, lost, denied, unpressed } = counters;
    let all = [
        (refused + garbled, "messages refused"),
        (dropped, "messages dropped, since they came faster than they could be joined"),
        (stale, "messages older than 100 ms, or of a clock that was set"),
        (withheld, "events of areas or presses that had been given up"),
        (unpressed, "holds refused, since their controls were not pressed"),
        (late, "events told out of order"),
        (lost, "events that never came"),
        (denied, "requests not met"),
        (unsent, "reports that nobody took"),
    ];
    let told: Vec<String> =
        all.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    let told = if told.is_empty() { "nothing lost".to_owned() } else { told.join(", ") };
    eprintln!("{messages} messages of nodes; {told}.");
}
