//! The sink of a session that sends the messages of its controls.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::Instant as HostInstant;

use tracing::warn;
use underfoot::layout::Layout;
use underfoot::messages::{Act, MessageOrder, MessagePlan, Messenger, Unsent};
use underfoot::sink::{EventSink, Report};
use underfoot::units::Instant;
use underfoot::wire::LinkState;

use super::supervisor::{GuardianCommand, GuardianSupervisor, TargetJob, TargetStatus};

/// Maximum number of orders that wait: a second of the fastest ones.
const QUEUE: usize = 1024;

/// Maximum number of loaded plans that wait for the sensing thread, which takes them every 5 ms and uses the latest.
const MAX_PLANS: usize = 4;

/// Sends the messages of the controls of one layout, through a guardian.
pub struct TargetSink {
    messenger: Messenger,
    plans: Receiver<MessagePlan>,
    /// `None` only while being dropped.
    jobs: Option<SyncSender<TargetJob>>,
    shared: Arc<TargetStatus>,
    begun: HostInstant,
    orders: Vec<MessageOrder>,
    /// Whether the queue was full: everything must come up.
    overflowed: bool,
    lost: u64,
    told: Unsent,
    thread: Option<JoinHandle<()>>,
}

/// Numbers of messages since the start; releases do not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TargetCounts {
    /// Messages that went on their way to their targets.
    pub sent: u64,
    /// Messages that did not reach them: the target refused or was gone, or they came too fast.
    pub unsent: u64,
}

/// Changes the messages of a running [`TargetSink`], and counts them.
#[derive(Clone, Debug)]
pub struct LoadedPlan {
    plans: SyncSender<MessagePlan>,
    shared: Arc<TargetStatus>,
}

impl LoadedPlan {
    /// Uses these targets and messages, of a layout that the operator has named; everything comes up first. Waits while
    /// four earlier plans wait for the sensing thread.
    pub fn load(&self, plan: MessagePlan) {
        // The session may have ended.
        let _ = self.plans.send(plan);
    }

    /// Returns the numbers of messages so far.
    #[must_use]
    pub fn counts(&self) -> TargetCounts {
        let count = |number: &AtomicU64| number.load(Ordering::Relaxed);
        let TargetStatus { undone, passed_on, left_out, .. } = &*self.shared;
        let undone = count(undone);
        TargetCounts { sent: count(passed_on).saturating_sub(undone), unsent: count(left_out) + undone }
    }

    /// Sends nothing any more: the layout on the floor is not the operator's. Waits as [`Self::load`] does.
    pub fn stop(&self, layout: &Layout, reason: &str) {
        if !layout.plan().is_empty() {
            warn!("the messages of this layout are off: {reason}");
        }
        let _ = self.plans.send(MessagePlan::default());
    }
}

impl TargetSink {
    /// Sends the messages of `plan`; `command` starts the guardian.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(plan: MessagePlan, command: GuardianCommand) -> std::io::Result<(Self, LoadedPlan)> {
        let (jobs, queue) = sync_channel(QUEUE);
        let (load, plans) = sync_channel(MAX_PLANS);
        let (shared, begun) = (Arc::new(TargetStatus::default()), HostInstant::now());
        let supervisor =
            GuardianSupervisor { command, shared: Arc::clone(&shared), begun, plan: plan.clone() };
        let thread = Builder::new().name("targets".into()).spawn(move || supervisor.run(&queue))?;
        let sink = Self {
            messenger: Messenger::new(plan),
            plans,
            jobs: Some(jobs),
            shared: Arc::clone(&shared),
            begun,
            orders: Vec::new(),
            overflowed: false,
            lost: 0,
            told: Unsent::default(),
            thread: Some(thread),
        };
        Ok((sink, LoadedPlan { plans: load, shared }))
    }

    /// Passes the orders on; a queue that is full loses them and lets everything come up.
    fn pass_on(&mut self) {
        let orders = std::mem::take(&mut self.orders);
        for order in orders {
            if !self.offer(TargetJob::Send(order)) {
                self.overflowed = true;
            }
        }
        if self.overflowed && self.offer(TargetJob::Release) {
            self.overflowed = false;
        }
    }

    fn offer(&mut self, job: TargetJob) -> bool {
        let counts = matches!(&job, TargetJob::Send(order) if !matches!(order.act, Act::Up(_)));
        match self.jobs.as_ref().map(|jobs| jobs.try_send(job)) {
            Some(Ok(())) => {
                self.shared.passed_on.fetch_add(u64::from(counts), Ordering::Relaxed);
                true
            }
            Some(Err(TrySendError::Full(_) | TrySendError::Disconnected(_))) | None => {
                self.lost += u64::from(counts);
                false
            }
        }
    }

    /// Uses the messages of a layout that was loaded.
    fn reload(&mut self) {
        let Some(plan) = self.plans.try_iter().last() else { return };
        if plan == *self.messenger.plan() {
            return;
        }
        self.messenger.release_all(&mut self.orders);
        self.pass_on();
        if self.offer(TargetJob::Setup(plan.clone())) {
            self.messenger = Messenger::new(plan);
            self.told = Unsent::default();
        } else {
            warn!("the messages of the new layout are not used: too much waits");
        }
    }

    fn tell_unsent(&mut self) {
        let unsent = self.messenger.unsent();
        if unsent.limited > 0 && self.told.limited == 0 {
            warn!("messages come faster than their target may get them; the rest is left out and counted");
        }
        self.told = unsent;
        self.shared.left_out.store(self.lost + unsent.limited, Ordering::Relaxed);
    }
}

impl EventSink for TargetSink {
    fn report(&mut self, report: &Report<'_>) {
        let orders = &mut self.orders;
        match report {
            Report::Event(event) => self.messenger.event(event, orders),
            Report::Held(report) => self.messenger.held(report.at, &report.held, orders),
            Report::Link(_, LinkState::Lost | LinkState::Waiting) => self.messenger.lost(orders),
            _ => return,
        }
        self.pass_on();
    }

    fn poll(&mut self, now: Instant) {
        let millis = u64::try_from(self.begun.elapsed().as_millis()).unwrap_or(u64::MAX);
        self.shared.polled.store(millis, Ordering::Relaxed);
        self.reload();
        self.messenger.advance(now, &mut self.orders);
        self.pass_on();
        self.tell_unsent();
    }

    fn dropped(&self) -> u64 {
        let unsent = self.messenger.unsent();
        self.lost + unsent.limited + self.shared.undone.load(Ordering::Relaxed)
    }
}

impl Drop for TargetSink {
    /// Lets everything come up and ends the guardian.
    fn drop(&mut self) {
        self.messenger.release_all(&mut self.orders);
        self.pass_on();
        self.jobs = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            warn!("the thread that sends messages has panicked");
        }
    }
}
