//! `underfoot run`: serves a floor.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::Duration;

use tracing::info;
use underfoot::feel::FeelCounters;
use underfoot::floor::read_address;
use underfoot::ground::{GroundCounters, GroundMaterial, GroundState};
use underfoot::layout::Layout;
use underfoot::recording::{Recorded, Recorder, WhenBehind};
use underfoot::runtime::{EndReason, Event, Kind, Session, SessionSnapshot};
use underfoot::sense::Method;
use underfoot::sink::LatencyStages;
#[cfg(unix)]
use underfoot::sink::Watchdog;
use underfoot::source::LinkFaults;
use underfoot::wire::LinkCounters;

use super::actuate::ActuateArgs;
use super::area_args::AreaArgs;
use super::console::Console;
use super::failure::Failure;
use super::fault_args::FaultArgs;
use super::floor_args::FloorArgs;
use super::latency::LatencyArgs;
use super::layout_args::LayoutArgs;
use super::number::{lifetime, threads};
use super::outputs::OutputArgs;
use super::send_args::SendArgs;
use super::senders::{BoardArgs, CommandArgs};
use super::stop::{panic_flag, stop_flag};
use super::watch::FileWatch;
use super::web::{QueryArgs, WebArgs};

/// Default address for packets.
pub(crate) const LISTEN: SocketAddr = SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 9000));

/// Options of `underfoot run`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    area: AreaArgs,
    /// Where the boards' packets arrive: an address of this machine and a port. Boards in a network need the address
    /// of the network card that they are on. Without it, the floor file's address for --area, or else 127.0.0.1:9000.
    #[arg(long, value_name = "ADDR", value_parser = read_address)]
    listen: Option<SocketAddr>,
    /// Wait for that address if this machine does not have it yet, as when it starts before its network does.
    #[arg(long)]
    await_address: bool,
    #[command(flatten)]
    boards: BoardArgs,
    #[command(flatten)]
    commands: CommandArgs,
    #[command(flatten)]
    outputs: OutputArgs,
    #[command(flatten)]
    send: SendArgs,
    #[command(flatten)]
    web: WebArgs,
    #[command(flatten)]
    query: QueryArgs,
    #[command(flatten)]
    actuate: ActuateArgs,
    #[command(flatten)]
    latency: LatencyArgs,
    #[command(flatten)]
    faults: FaultArgs,
    /// The paper's plain sensing: one contact per group of connected tiles.
    #[arg(long)]
    eq4: bool,
    /// Number of threads that sense the feet of a crowd; `all` for as many as there are cores. Those beyond the first
    /// sleep while fewer than a hundred feet are on the floor, and keep a core busy each while there are more.
    #[arg(long, value_name = "N|all", default_value = "1", value_parser = threads)]
    sensing_threads: NonZeroUsize,
    /// Record everything that determines the events into this file, for `underfoot replay`; an existing file is
    /// replaced. Latencies are not measured meanwhile.
    #[arg(long, value_name = "FILE", conflicts_with = "latency")]
    record: Option<PathBuf>,
    /// Stop after this many seconds.
    #[arg(long, value_name = "S", value_parser = lifetime)]
    seconds: Option<Duration>,
}

/// Serves a floor until it is stopped.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (served, floor) = args.area.of(args.boards.load(&args.floor)?)?;
    let layout = served.layout(args.layout.load(&served.geometry)?);
    let prefix = args.outputs.prefix.osc_prefix.clone();
    let stop = stop_flag()?;
    let panicked = panic_flag(&stop);
    let listen = args.listen.or(served.listen()).unwrap_or(LISTEN);
    let source = if args.await_address {
        args.boards.bind_once_there(listen, &floor, &stop)?
    } else {
        args.boards.bind(listen, &floor)?
    };
    let source = served.among_neighbours(source)?;
    let source = source.with_prefix(prefix.clone());
    let source = args.commands.open(source)?;
    let (address, granted, clock) = (source.local_addr(), source.granted_buffer(), source.clock());
    let input = args.boards.beside(source, &floor, clock.clone())?;
    let input = args.faults.wrap(input, LinkFaults::default());
    let method = if args.eq4 { Method::Eq4 } else { Method::default() };
    let path = args.record.as_deref();
    let Recorded { recorder, input, floor, layout } =
        Recorder::around(path, input, floor, layout, method, WhenBehind::LeaveOut)?;
    let web = args.web.open()?;
    let input = match &web {
        Some(web) => web.wrap(input, floor.geometry),
        None => input,
    };
    let query = args.query.open()?;
    let latency = LatencyStages::default();
    let lost = Arc::<AtomicU64>::default();
    let (notice, noticed) = mpsc::channel();
    // The receiver may be gone.
    let notice = move |text| drop(notice.send(text));
    let actuators = args.actuate.opener(latency.clone(), Arc::clone(&lost), |_| {}, notice);
    let mut outputs = args.outputs.open(&served.geometry)?;
    if let Some(web) = &web {
        web.listen(&mut outputs)?;
    }
    if let Some(query) = &query {
        query.listen(&prefix, &mut outputs)?;
    }
    let (sender, messages) = args.send.open(&layout)?;
    outputs.push(sender);
    if let Some(recorder) = &recorder {
        outputs.push(recorder.events()?);
    }
    let unrecorded = recorder.map(|recorder| recorder.lost());
    #[cfg(unix)]
    if let Some(watchdog) = Watchdog::of_environment() {
        outputs.push(watchdog);
    }
    let session = Session::source(input, clock)
        .floor(floor.clone())
        .layout(layout)
        .method(method)
        .prefix(prefix.clone())
        .sink(served.outputs(outputs))
        .actuators(actuators)
        .latency(latency.clone())
        .realtime()
        .sensing_threads(args.sensing_threads)
        .stop_flag(Arc::clone(&stop))
        .start()?;
    let told = session.clone();
    let (geometry, here) = (served.geometry, served);
    let (reloaded, send) = (messages.clone(), args.send.clone());
    let watch = FileWatch::start(&args.layout, geometry, move |read| match read {
        Ok(layout) => {
            info!("the changed layout is on the floor");
            let layout = here.layout(layout);
            send.reload(&reloaded, &layout);
            told.set_layout(layout);
        }
        Err(diagnostics) => {
            errln!("{diagnostics}The last good layout stays on the floor.");
        }
    })?;
    if let Ok(address) = &address {
        errln!(
            "Listening on {address} with a receive buffer of {} KiB. {} Ctrl-C ends it.",
            granted / 1024,
            noticed.recv().unwrap_or_default()
        );
    }
    let apps = args.commands.apps().to_vec();
    let sensors = address.as_ref().copied().unwrap_or(listen);
    let requests = args.commands.port(sensors);
    let query =
        query.map(|query| query.serve(session.clone(), floor.clone(), prefix, requests)).transpose()?;
    let web = web.map(|web| web.serve(session.clone(), floor, method, apps, messages)).transpose()?;
    if let Some(seconds) = args.seconds {
        stop_after(seconds, stop);
    }
    let console = Console::start(sensors, session.clone())
        .map_err(|error| Failure::Other(format!("the console can't be started: {error}")))?;
    let end = end(&session);
    drop((watch, console, web, query));
    let SessionSnapshot { layout, floor, .. } = session.snapshot();
    report(&floor.counters, floor.unsent_events);
    report_felt(&floor.feel);
    grounds(&layout, &floor.grounds).iter().for_each(|ground| errln!("{ground}"));
    args.latency.tell(&latency, args.outputs.is_json())?;
    if panicked.load(Ordering::Relaxed) {
        return Err(Failure::Other("a part of the program failed; please report it".into()));
    }
    if let Kind::Ended(EndReason::Failed) = end.kind {
        return Err(Failure::Other(end.message().into()));
    }
    // The last handle ends the recording.
    drop(session);
    whole(&lost, "frames")?;
    unrecorded.map_or(Ok(()), |lost| whole(&lost, "entries"))
}

/// Waits for the last event; the sinks report all others.
pub(crate) fn end(session: &Session) -> Event {
    loop {
        let event = session.next_event_timeout(Duration::from_secs(3600));
        if let Some(event) = event.filter(|event| matches!(event.kind, Kind::Ended(_))) {
            return event;
        }
    }
}

fn stop_after(span: Duration, stop: Arc<AtomicBool>) {
    thread::spawn(move || {
        thread::sleep(span);
        stop.store(true, Ordering::Relaxed);
    });
}

/// Fails if a recording lacks some of `what`, such as frames, because the disk was too slow.
pub(crate) fn whole(lost: &AtomicU64, what: &str) -> Result<(), Failure> {
    match lost.load(Ordering::Relaxed) {
        0 => Ok(()),
        lost => {
            Err(Failure::Other(format!("the recording is not whole: {lost} {what} could not be written")))
        }
    }
}

/// Reports cues that were not played as intended; prints nothing if there are none.
fn report_felt(felt: &FeelCounters) {
    let FeelCounters { dropped, muted, late, unfelt, refused, stolen, .. } = *felt;
    let FeelCounters { not_finite, overloaded, silenced, heated, .. } = *felt;
    let counts = [
        (dropped, "dropped"),
        (muted, "muted"),
        (late, "late"),
        (unfelt, "spots without actuator"),
        (refused, "modes refused"),
        (stolen, "voices that made room"),
        (not_finite, "samples not finite"),
        (overloaded, "samples overloaded"),
        (silenced, "channels silenced"),
        (heated, "times too hot"),
    ];
    let said: Vec<String> = counts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{what} {count}"))
        .collect();
    if !said.is_empty() {
        errln!("Cues: {}.", said.join(", "));
    }
}

/// The counts of each ground of the layout at the end, a line each.
fn grounds(layout: &Layout, states: &[GroundState]) -> Vec<String> {
    let grounds = layout.grounds.iter().zip(states);
    grounds
        .map(|(ground, state)| {
            let GroundCounters { events, unfelt, evicted } = state.counters;
            let cracks = match ground.spec.material {
                GroundMaterial::Ice(_) => format!(
                    "; pieces of crack {}, seeds {}, evicted {evicted}",
                    state.cracks.len(),
                    state.seeds.len()
                ),
                GroundMaterial::Grain(_) | GroundMaterial::Wood(_) => String::new(),
            };
            format!(
                "{}: events {events}, too thick to be felt {unfelt}{cracks}.",
                ground.spec.material.name()
            )
        })
        .collect()
}

/// Reports the counts of received packets and of unused ones.
fn report(counters: &LinkCounters, dropped: u64) {
    errln!(
        "{} packets, {} frames; lost {}, late {}, repeated {}, refused {} (may not send {}, sent too much {}), skipped {}, bad readings {}; requests not met {}, labels cleaned {}; events not sent {dropped}.",
        counters.packets,
        counters.frames,
        counters.lost,
        counters.late,
        counters.duplicate,
        counters.refused(),
        counters.foreign,
        counters.limited,
        counters.skipped,
        counters.bad_readings,
        counters.denied,
        counters.cleaned,
    );
    if counters.overflowed > 0 {
        errln!(
            "{} datagrams were dropped by the system, since nobody read them in time.",
            counters.overflowed
        );
    }
    if counters.overruns > 0 {
        errln!(
            "Since the machine is too slow, the sensing thread gave up its real-time priority (times: {}).",
            counters.overruns
        );
    }
}
