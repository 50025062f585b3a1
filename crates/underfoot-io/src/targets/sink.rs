//! The sink of a session that sends the messages of its layout.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant as HostInstant};

use tracing::warn;
use underfoot::layout::Layout;
use underfoot::messages::{Act, MessageNews, MessagePlan};
use underfoot::sink::{EventSink, Report};
use underfoot::units::Instant;

use super::standby::Standby;
use super::supervisor::{GuardianCommand, GuardianSupervisor, TargetJob, TargetStatus};

/// Maximum number of orders that wait: a second of the fastest ones.
const QUEUE: usize = 1024;

/// Maximum number of loaded plans that wait for the sensing thread, which takes them every 5 ms and uses the latest.
const MAX_PLANS: usize = 4;

/// Longest wait for the first guardian: a foot that presses before it is ready presses nothing.
const READY: Duration = Duration::from_secs(3);

/// The messages that may be sent, and where to.
#[derive(Clone, Debug, Default)]
struct AllowedPlan {
    /// The plan of the layout that the operator has named.
    written: Arc<MessagePlan>,
    /// The same with the targets where the command line puts them.
    moved: MessagePlan,
}

/// Sends the messages of one layout, through a guardian.
pub struct TargetSink {
    allowed: AllowedPlan,
    plans: Receiver<AllowedPlan>,
    /// `None` only while being dropped.
    jobs: Option<SyncSender<TargetJob>>,
    shared: Arc<TargetStatus>,
    begun: HostInstant,
    /// Whether the queue was full: everything must come up.
    overflowed: bool,
    lost: u64,
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
    plans: SyncSender<AllowedPlan>,
    shared: Arc<TargetStatus>,
}

impl LoadedPlan {
    /// Sends the messages of `layout`, which the operator has named, to its targets as `moved` has them; everything
    /// comes up first. Waits while four earlier plans wait for the sensing thread.
    pub fn load(&self, layout: &Layout, moved: MessagePlan) {
        // The session may have ended.
        let _ = self.plans.send(AllowedPlan { written: Arc::new(layout.plan()), moved });
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
        if layout.sends() {
            warn!("the messages of this layout are off: {reason}");
        }
        let _ = self.plans.send(AllowedPlan::default());
    }
}

impl TargetSink {
    /// Sends the messages of `layout` to its targets as `moved` has them; `command` starts the guardian. Waits until the
    /// guardian is ready, for three seconds at most.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(
        layout: &Layout,
        moved: MessagePlan,
        command: GuardianCommand,
    ) -> std::io::Result<(Self, LoadedPlan)> {
        let (jobs, queue) = sync_channel(QUEUE);
        let (load, plans) = sync_channel(MAX_PLANS);
        let (ready, is_ready) = sync_channel(1);
        let (shared, begun) = (Arc::new(TargetStatus::default()), HostInstant::now());
        let supervisor = GuardianSupervisor {
            command,
            shared: Arc::clone(&shared),
            begun,
            plan: moved.clone(),
            ready: Some(ready),
            standby: Standby::new(),
        };
        let thread = Builder::new().name("targets".into()).spawn(move || supervisor.run(&queue))?;
        if !moved.is_empty() && is_ready.recv_timeout(READY).is_err() {
            warn!("the guardian of held keys is slow to start: messages are lost until it is ready");
        }
        let sink = Self {
            allowed: AllowedPlan { written: Arc::new(layout.plan()), moved },
            plans,
            jobs: Some(jobs),
            shared: Arc::clone(&shared),
            begun,
            overflowed: false,
            lost: 0,
            thread: Some(thread),
        };
        Ok((sink, LoadedPlan { plans: load, shared }))
    }

    /// Passes a message on, if it is one of the layout that may send; a queue that is full loses it and lets everything
    /// come up.
    fn pass_on(&mut self, news: &MessageNews) {
        if self.allowed.moved.is_empty() || !self.is_allowed(&news.plan) {
            return;
        }
        if !self.offer(TargetJob::Send(news.order.clone())) {
            self.overflowed = true;
        }
        self.recover();
    }

    /// Whether the floor has the layout that may send.
    fn is_allowed(&mut self, plan: &Arc<MessagePlan>) -> bool {
        if Arc::ptr_eq(plan, &self.allowed.written) {
            return true;
        }
        let same = **plan == *self.allowed.written;
        if same {
            // The next comparison is one of pointers.
            self.allowed.written = Arc::clone(plan);
        }
        same
    }

    /// Lets everything come up after messages were lost.
    fn recover(&mut self) {
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
                self.shared.left_out.store(self.lost, Ordering::Relaxed);
                false
            }
        }
    }

    /// Uses the messages of a layout that was loaded.
    fn reload(&mut self) {
        let Some(plan) = self.plans.try_iter().last() else { return };
        let is_same = plan.moved == self.allowed.moved;
        if is_same || self.offer(TargetJob::Setup(plan.moved.clone())) {
            self.allowed = plan;
        } else {
            warn!("the messages of the new layout are not used: too much waits");
            self.allowed = AllowedPlan::default();
            self.overflowed = true;
        }
    }
}

impl EventSink for TargetSink {
    fn report(&mut self, report: &Report<'_>) {
        if let Report::Message(news) = report {
            self.pass_on(news);
        }
    }

    fn poll(&mut self, _: Instant) {
        let millis = u64::try_from(self.begun.elapsed().as_millis()).unwrap_or(u64::MAX);
        self.shared.polled.store(millis.max(1), Ordering::Relaxed);
        self.reload();
        self.recover();
    }

    fn dropped(&self) -> u64 {
        self.lost + self.shared.undone.load(Ordering::Relaxed)
    }
}

impl Drop for TargetSink {
    /// Lets everything come up and ends the guardian.
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            warn!("the thread that sends messages has panicked");
        }
    }
}
