//! The sensing thread: creates the server, runs it, and reports its end in every case.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;

use super::app_sink::Waker;
use super::builder::StartError;
use super::event::{EndReason, Event};
use super::held::HeldWatch;
use super::queue::EventQueue;
use crate::engine;
use crate::feel::CueSender;
use crate::floor::Floor;
use crate::layout::Layout;
#[cfg(feature = "threads")]
use crate::parallel::ThreadPool;
use crate::sense::Method;
use crate::serve::{FloorCommand, Neighbours, Server};
use crate::sink::{ActuatorSink, Fanout, LatencyStages, Rank, RealTime, SinkError, WaitFreeReceiver};
use crate::source::FloorInput;
use crate::units::{HostClock, Instant};
use crate::wire::Prefix;

/// Haptic output of a session: cues in, samples out.
pub struct Actuators {
    /// Sends cues to the renderer.
    pub feel: CueSender,
    /// Plays the samples of the renderer.
    pub sink: Box<dyn ActuatorSink>,
}

/// Opens the actuators on the sensing thread, where they stay: not every system can move a stream to another thread.
/// Gets the floor, the present, and the clock that stamps packets.
pub(super) type OpenActuators =
    Box<dyn FnOnce(&Floor, Instant, &HostClock) -> Result<Actuators, SinkError> + Send>;

/// Everything that the sensing thread owns.
pub(super) struct SensingThread {
    pub(super) floor: Floor,
    pub(super) layout: Layout,
    pub(super) method: Method,
    pub(super) input: FloorInput,
    pub(super) clock: HostClock,
    pub(super) prefix: Prefix,
    pub(super) sinks: Fanout,
    pub(super) actuators: Option<OpenActuators>,
    pub(super) neighbours: Option<Box<dyn Neighbours>>,
    pub(super) latency: Option<LatencyStages>,
    pub(super) realtime: bool,
    /// Distributes the feet of a crowd; `None` if the sensing thread works alone.
    #[cfg(feature = "threads")]
    pub(super) pool: Option<ThreadPool>,
    pub(super) commands: WaitFreeReceiver<FloorCommand>,
    pub(super) snapshots: triple_buffer::Input<engine::Snapshot>,
    pub(super) stop: Arc<AtomicBool>,
}

/// Receivers of the end of a session.
pub(super) struct EndWatchers {
    pub(super) queue: Arc<EventQueue>,
    pub(super) held: Arc<HeldWatch>,
    pub(super) waker: Option<Arc<Waker>>,
}

/// Serves until the end, on this thread or on one of the pool; sends to `ready` once the first snapshot exists, or
/// the error that prevents the start.
#[cfg_attr(not(feature = "threads"), expect(unused_mut, reason = "no pool to take from it"))]
pub(super) fn run(
    mut plan: SensingThread,
    watchers: &EndWatchers,
    ready: &SyncSender<Result<(), StartError>>,
) {
    #[cfg(feature = "threads")]
    if let Some(pool) = plan.pool.take() {
        return pool.run(|| run_here(plan, watchers, ready));
    }
    run_here(plan, watchers, ready);
}

fn run_here(plan: SensingThread, watchers: &EndWatchers, ready: &SyncSender<Result<(), StartError>>) {
    let clock = Arc::clone(&plan.clock);
    // After a panic, inconsistent state is only read to cancel presses.
    let served = catch_unwind(AssertUnwindSafe(|| serve(plan, watchers, ready)));
    watchers.held.end();
    let (reason, message) = served.unwrap_or_else(|panic| (EndReason::Panicked, text(panic.as_ref())));
    watchers.queue.end(Event::ended(clock(), reason, message));
    if let Some(waker) = &watchers.waker {
        waker.wake();
    }
}

fn serve(
    plan: SensingThread,
    watchers: &EndWatchers,
    ready: &SyncSender<Result<(), StartError>>,
) -> (EndReason, String) {
    let stop = Arc::clone(&plan.stop);
    let realtime = plan.realtime;
    let mut server = match server(plan) {
        Ok(server) => server,
        Err(error) => {
            // The thread that called `start` waits for the answer.
            let _ = ready.send(Err(error.into()));
            return (EndReason::Stopped, String::new());
        }
    };
    server.show_now();
    let _ = ready.send(Ok(()));
    if realtime {
        // Last, since new threads inherit the priority.
        let mut priority = RealTime::claim(Rank::Sensing);
        server.watch_load(move || {
            priority.look();
            priority.given_up()
        });
    }
    let served = catch_unwind(AssertUnwindSafe(|| server.run(&stop)));
    // Before the outputs close, which may take a while.
    watchers.held.end();
    drop(server);
    match served {
        Ok(Ok(())) if stop.load(Ordering::Relaxed) => (EndReason::Stopped, String::new()),
        Ok(Ok(())) => (EndReason::SourceEnded, String::new()),
        Ok(Err(error)) => (EndReason::Failed, error.to_string()),
        Err(panic) => (EndReason::Panicked, text(panic.as_ref())),
    }
}

fn server(plan: SensingThread) -> Result<Server, SinkError> {
    let SensingThread {
        floor,
        layout,
        method,
        input,
        clock,
        prefix,
        sinks,
        actuators,
        neighbours,
        latency,
        ..
    } = plan;
    let actuators = actuators.map(|open| open(&floor, input.source.now(), &clock)).transpose()?;
    let mut server = Server::new(&floor, layout, method, input)
        .with_events(Box::new(sinks))
        .with_prefix(prefix)
        .with_snapshots(plan.snapshots)
        .with_commands(plan.commands);
    if let Some(Actuators { feel, sink }) = actuators {
        server = server.with_feel(feel, sink);
    }
    if let Some(neighbours) = neighbours {
        server = server.with_neighbours(neighbours);
    }
    if let Some(latency) = latency {
        server = server.with_latency(latency);
    }
    Ok(server)
}

/// The message of a panic.
fn text(panic: &(dyn Any + Send)) -> String {
    let words = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    words.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a word".into())
}
