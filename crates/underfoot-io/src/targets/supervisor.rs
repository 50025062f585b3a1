//! The server's side: starts the guardian, passes orders and heartbeats on, and takes its place when it fails.

use std::io::{self, BufReader};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

use tracing::{info, warn};
use underfoot::messages::{Act, MessageOrder, MessagePlan};
use underfoot::sink::{Rank, claim_priority};

use super::link::{FromGuardian, ToGuardian, next, put};
use super::standby::Standby;
use super::{BEAT, POLLED};

/// Makes the command that starts a guardian: its standard input and output are the link.
pub type GuardianCommand = Box<dyn FnMut() -> io::Result<Command> + Send>;

/// Least time between two starts of a guardian that ends at once.
const AGAIN: Duration = Duration::from_millis(200);

/// Longest time for a guardian to acknowledge a heartbeat. Shorter than [`super::PATIENCE`], since the release takes longer
/// then: JACK needs some 40 ms from the guardian's end to the first message of the server's own port.
const ANSWERING: Duration = Duration::from_millis(60);

/// Longest time for a guardian to start, connect and release everything: a machine that boots is slow.
const STARTING: Duration = Duration::from_secs(10);

/// Time for the guardian to end after its input has ended.
const FAREWELL: Duration = Duration::from_secs(4);

/// Maximum number of the guardian's answers that wait: more than it gives in a second. It waits when they are full.
const MAX_ANSWERS: usize = 256;

/// A job for the supervisor.
pub(super) enum TargetJob {
    /// Other messages, of a layout that was loaded.
    Setup(MessagePlan),
    /// An order.
    Send(MessageOrder),
    /// Let everything come up.
    Release,
}

/// Numbers that the supervisor shares with the sink.
#[derive(Debug, Default)]
pub(super) struct TargetStatus {
    /// Milliseconds since [`GuardianSupervisor::begun`] at which the sensing thread last polled; 0 before the first time.
    pub(super) polled: AtomicU64,
    /// Orders that were not carried out.
    pub(super) undone: AtomicU64,
    /// Orders that were passed on, without those that only let something come up.
    pub(super) passed_on: AtomicU64,
    /// Orders that were lost before they were passed on, or left out because they came too fast.
    pub(super) left_out: AtomicU64,
}

/// The supervisor's state, on a thread of its own.
pub(super) struct GuardianSupervisor {
    pub(super) command: GuardianCommand,
    pub(super) shared: Arc<TargetStatus>,
    pub(super) begun: Instant,
    pub(super) plan: MessagePlan,
    /// Gets a word when the first guardian is ready.
    pub(super) ready: Option<SyncSender<()>>,
    pub(super) standby: Standby,
}

/// A guardian that runs.
struct RunningGuardian {
    child: Child,
    input: ChildStdin,
    answers: Receiver<FromGuardian>,
    beat: u64,
    /// The time at which the oldest heartbeat without an answer went out.
    waits: Option<Instant>,
    beaten: Instant,
    /// Whether it has answered: before that it may take its time, and gets no orders.
    is_ready: bool,
}

impl GuardianSupervisor {
    /// Runs until the sink ends.
    pub(super) fn run(mut self, jobs: &Receiver<TargetJob>) {
        // As the guardian's: without it a busy computer ends holds early.
        claim_priority(Rank::Telling);
        self.standby.prepare(&self.plan);
        let mut running: Option<RunningGuardian> = None;
        let mut started: Option<Instant> = None;
        loop {
            if running.is_none() && !self.plan.is_empty() && started.is_none_or(|at| at.elapsed() >= AGAIN) {
                started = Some(Instant::now());
                running = self.start();
            }
            let next_beat =
                running.as_ref().map_or(BEAT, |running| BEAT.saturating_sub(running.beaten.elapsed()));
            let job = jobs.recv_timeout(next_beat);
            if let Some(guardian) = &mut running {
                let fine = self.listen(guardian) && self.serve(guardian, &job);
                if !fine && let Some(failed) = running.take() {
                    self.take_over(failed);
                }
            } else if matches!(job, Ok(TargetJob::Send(_))) {
                self.shared.undone.fetch_add(1, Ordering::Relaxed);
            }
            match job {
                Ok(TargetJob::Setup(plan)) => {
                    self.standby.prepare(&plan);
                    self.plan = plan;
                }
                Err(RecvTimeoutError::Disconnected) => break,
                _ => {}
            }
        }
        if let Some(RunningGuardian { mut child, input, .. }) = running {
            // The end of its input lets everything come up.
            drop(input);
            let begun = Instant::now();
            while begun.elapsed() < FAREWELL && matches!(child.try_wait(), Ok(None)) {
                std::thread::sleep(Duration::from_millis(5));
            }
            let _ = child.kill();
            let _ = child.wait();
        }
    }

    fn start(&mut self) -> Option<RunningGuardian> {
        match self.try_start() {
            Ok(running) => Some(running),
            Err(error) => {
                warn!("no messages go out: the guardian can't be started: {error}");
                None
            }
        }
    }

    fn try_start(&mut self) -> io::Result<RunningGuardian> {
        let mut command = (self.command)()?;
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        // Ctrl-C is for the server alone.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let missing = || io::Error::other("it has no pipe");
        let mut input = child.stdin.take().ok_or_else(missing)?;
        let output = child.stdout.take().ok_or_else(missing)?;
        let (tell, answers) = sync_channel(MAX_ANSWERS);
        Builder::new().name("guardian out".into()).spawn(move || read(output, &tell))?;
        put(&mut input, &plan_for(&self.plan, self.standby.states_for(&self.plan)))?;
        for (target, receivers) in self.standby.receivers() {
            put(&mut input, &ToGuardian::Connect(*target, receivers.clone()))?;
        }
        let (beaten, waits) = (Instant::now(), None);
        Ok(RunningGuardian { child, input, answers, beat: 0, waits, beaten, is_ready: false })
    }

    /// Processes the guardian's answers; false if it has failed.
    fn listen(&mut self, guardian: &mut RunningGuardian) -> bool {
        loop {
            match guardian.answers.try_recv() {
                Ok(FromGuardian::Beat(number)) => {
                    guardian.is_ready = true;
                    if let Some(ready) = self.ready.take() {
                        // Nobody may wait for it.
                        let _ = ready.try_send(());
                    }
                    guardian.waits = (number != guardian.beat).then(Instant::now);
                }
                Ok(FromGuardian::Notice(text)) => warn!("{text}"),
                Ok(FromGuardian::Receivers(target, receivers)) => self.standby.connect(target, receivers),
                Ok(FromGuardian::Undone(count)) => {
                    self.shared.undone.fetch_add(count, Ordering::Relaxed);
                }
                Err(std::sync::mpsc::TryRecvError::Empty) => break,
                Err(std::sync::mpsc::TryRecvError::Disconnected) => return false,
            }
        }
        let patience = if guardian.is_ready { ANSWERING } else { STARTING };
        guardian.waits.is_none_or(|since| since.elapsed() < patience)
    }

    /// Passes on `job` and the heartbeat, if it is due; false if the guardian has failed.
    fn serve(&mut self, guardian: &mut RunningGuardian, job: &Result<TargetJob, RecvTimeoutError>) -> bool {
        let sent = match job {
            Ok(TargetJob::Setup(plan)) => {
                // It opens targets, which takes as long as at a start.
                guardian.is_ready = false;
                put(&mut guardian.input, &plan_for(plan, self.standby.states_for(plan)))
            }
            Ok(TargetJob::Send(_)) if !guardian.is_ready => {
                self.shared.undone.fetch_add(1, Ordering::Relaxed);
                Ok(())
            }
            Ok(TargetJob::Send(order)) => {
                let name = self.plan.targets.get(order.target).map_or("", |target| &target.name);
                info!("{name}: {} ({})", order.act, order.control);
                self.standby.note(order);
                put(&mut guardian.input, &ToGuardian::Act(order.target, order.act.clone()))
            }
            Ok(TargetJob::Release) => put(&mut guardian.input, &ToGuardian::Release),
            Err(_) => Ok(()),
        };
        sent.is_ok() && (guardian.beaten.elapsed() < BEAT || self.beat(guardian).is_ok())
    }

    fn beat(&mut self, guardian: &mut RunningGuardian) -> io::Result<()> {
        guardian.beaten = Instant::now();
        self.standby.settle();
        let now = self.begun.elapsed().as_millis();
        let polled = self.shared.polled.load(Ordering::Relaxed);
        // Without the sensing thread there is no heartbeat: the guardian releases everything. Before that thread starts
        // nothing is down.
        if polled > 0 && now.saturating_sub(polled.into()) > POLLED.as_millis() {
            return Ok(());
        }
        guardian.beat += 1;
        guardian.waits.get_or_insert(guardian.beaten);
        put(&mut guardian.input, &ToGuardian::Beat(guardian.beat))
    }

    /// Ends a guardian that has failed and releases everything in its place.
    fn take_over(&mut self, mut failed: RunningGuardian) {
        // It ends first, so that it presses nothing afterwards.
        let _ = failed.child.kill();
        self.standby.release(&self.plan);
        let _ = failed.child.wait();
        self.standby.close(&self.plan);
        warn!("the guardian of held keys has failed; everything was released, and another one starts");
    }
}

fn plan_for(plan: &MessagePlan, states: Vec<(usize, Act)>) -> ToGuardian {
    ToGuardian::Setup(plan.targets.clone(), plan.holdables().into_iter().collect(), states)
}

/// Reads the guardian's answers until it ends.
fn read(output: ChildStdout, tell: &SyncSender<FromGuardian>) {
    let mut output = BufReader::new(output);
    while let Some(answer) = next(&mut output) {
        if tell.send(answer).is_err() {
            break;
        }
    }
}
