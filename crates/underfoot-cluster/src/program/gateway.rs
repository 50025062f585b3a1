//! `underfoot-cluster gateway`: what nodes tell, told as one floor.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant as HostInstant};

use underfoot::outgoing::TuioProfiles;
use underfoot::schema;
use underfoot::sink::{
    AreaNews, AreaState, EventSink, Fanout, JsonSink, OscSink, Rank, TuioSink, TuioVersion, claim_priority,
};
use underfoot::units::Instant;
use underfoot::wire::Prefix;
use underfoot_cluster::gateway::{Counters, Gateway, Told};
use underfoot_cluster::message::{NodeMessage, decode, encode};
use underfoot_cluster::transport::{ENDPOINT, Transport};

use super::notices::Notices;
use super::{Failure, drawn, stop_flag};

/// What the gateway is asked to do.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Floor file with `areas`; the same on all nodes.
    #[arg(long, value_name = "FILE")]
    floor: PathBuf,
    /// Where nodes connect; may be given several times, for several network cards.
    #[arg(long, value_name = "ENDPOINT", default_value = ENDPOINT)]
    listen: Vec<String>,
    /// Where events and contacts are sent as OSC; may be given several times.
    #[arg(long, value_name = "HOST:PORT")]
    osc: Vec<SocketAddr>,
    /// What OSC addresses begin with.
    #[arg(long, value_name = "PREFIX", default_value_t)]
    osc_prefix: Prefix,
    /// Send contacts as TUIO 1.1; may be given several times.
    #[arg(long, value_name = "HOST:PORT")]
    tuio: Vec<SocketAddr>,
    /// Send contacts as TUIO 2.0 pointers with pressure; may be given several times.
    #[arg(long, value_name = "HOST:PORT")]
    tuio2: Vec<SocketAddr>,
    /// Print every event as a line of JSON on standard output.
    #[arg(long)]
    json: bool,
    /// Print contacts among them as well, 100 times a second.
    #[arg(long, requires = "json")]
    json_contacts: bool,
    /// Stop after so many seconds.
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
}

/// Messages that may wait: half a second of sixteen nodes.
const WAITING: usize = 4096;

/// How long nothing may come before it is looked at what that means.
const PATIENCE: Duration = Duration::from_millis(2);

/// Time between two messages to all nodes.
const TELL_EVERY: Duration = Duration::from_millis(50);

/// Joins what nodes tell until told to stop.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let floor = schema::load_floor(&args.floor)?;
    let mut gateway = Gateway::new(&floor, drawn())?;
    let stop = stop_flag(args.seconds)?;
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
    let notices = Notices::start();
    // What joins, and Zenoh's threads, which inherit it.
    claim_priority(Rank::Telling);
    let started = HostInstant::now();
    let now = move || Instant::START + started.elapsed();
    let (messages, received) = sync_channel(WAITING);
    let dropped = Arc::<AtomicU64>::default();
    let transport = {
        let dropped = Arc::clone(&dropped);
        Transport::gateway(&args.listen, move |bytes| {
            if messages.try_send((now(), decode::<NodeMessage>(bytes).ok())).is_err() {
                dropped.fetch_add(1, Ordering::Relaxed);
            }
        })?
    };
    let areas = floor.areas.len();
    notices.say(format!(
        "Waiting for the nodes of {areas} areas on {}. Ctrl-C ends it.",
        args.listen.join(", ")
    ));
    let mut latest = Instant::START;
    let mut due = Instant::START;
    let mut garbled = 0;
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
        tell(&gateway.advance(latest), &mut sinks, &notices);
        sinks.poll(latest);
        if latest >= due {
            due = latest + TELL_EVERY;
            transport.send(encode(&gateway.message(now())));
        }
    }
    tell(&gateway.end(latest), &mut sinks, &notices);
    let dropped = dropped.load(Ordering::Relaxed);
    report(gateway.counters(), garbled, dropped, sinks.dropped());
    Ok(())
}

/// What has arrived, once something has or patience is over: all of it, so that what is late already is not taken for
/// later than it is.
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

fn tell(told: &[Told], sinks: &mut Fanout, notices: &Notices) {
    for told in told {
        if let Some(report) = told.report() {
            sinks.report(report);
        }
        match told {
            Told::Area(AreaNews { area, state: AreaState::Live, doubt, .. }) => {
                notices
                    .say(format!("Area \"{area}\" is live; its times are sure to {} us.", doubt.as_micros()));
            }
            Told::Area(AreaNews { area, state, why, .. }) => {
                notices.say(format!("Area \"{area}\" is {}: {why}.", state.name()));
            }
            Told::Notice(notice) => notices.say(notice.clone()),
            _ => {}
        }
    }
}

fn report(counters: Counters, garbled: u64, dropped: u64, unsent: u64) {
    let Counters { messages, refused, stale, withheld, late, lost } = counters;
    let all = [
        (refused + garbled, "messages refused"),
        (dropped, "messages dropped, since they came faster than they could be joined"),
        (stale, "messages older than 100 ms, or of a clock that was set"),
        (withheld, "events of areas or presses that had been given up"),
        (late, "events told out of order"),
        (lost, "events that never came"),
        (unsent, "reports that nobody took"),
    ];
    let told: Vec<String> =
        all.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    let told = if told.is_empty() { "nothing lost".to_owned() } else { told.join(", ") };
    eprintln!("{messages} messages of nodes; {told}.");
}
