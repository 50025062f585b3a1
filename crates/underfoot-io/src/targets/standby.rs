//! The server's own ways to the targets: they release everything when the guardian fails.
//!
//! Receivers of MIDI connect to a port, and lose it when its process ends. So the server has a port of its own from the
//! start, which connects as that of the guardian was once it is needed; all other ways open when they are needed.

use std::collections::{BTreeMap, BTreeSet};
use std::thread;
use std::time::{Duration, Instant};

use tracing::warn;
use underfoot::messages::{
    Act, Destination, Holdable, MessageOrder, MessagePlan, MidiTarget, SendTarget, StandingState,
};

use super::outlets::Outlets;

/// Longest time for which a release that failed is tried again.
const TRYING: Duration = Duration::from_millis(300);

/// The ways of the server to all targets.
pub(super) struct Standby {
    outlets: Outlets,
    /// Everything that the guardian holds down.
    down: BTreeSet<(usize, Holdable)>,
    /// The ports that receive from those of the guardian, by the index of their target.
    receivers: Vec<(usize, Vec<String>)>,
    lasting: LastingStates,
}

/// The states that last at the targets: a guardian that starts sets them again.
#[derive(Default)]
struct LastingStates {
    targets: Vec<SendTarget>,
    acts: BTreeMap<(usize, StandingState), Act>,
}

impl LastingStates {
    /// Returns the states of `plan`; those that it has as well are as they are now.
    fn changed(&self, plan: &MessagePlan) -> Self {
        let mut after = Self { targets: plan.targets.clone(), acts: BTreeMap::new() };
        for (index, act) in plan.standing() {
            let Some(state) = act.standing() else { continue };
            let was = self.targets.iter().position(|target| plan.targets.get(index) == Some(target));
            let stays = was.and_then(|was| self.acts.get(&(was, state.clone()))).cloned();
            after.acts.insert((index, state), stays.unwrap_or(act));
        }
        after
    }

    fn all(&self) -> Vec<(usize, Act)> {
        self.acts.iter().map(|((target, _), act)| (*target, act.clone())).collect()
    }

    fn note(&mut self, order: &MessageOrder) {
        if let Some(state) = order.act.standing() {
            self.acts.insert((order.target, state), order.act.clone());
        }
    }
}

impl Standby {
    /// No ways.
    pub(super) fn new() -> Self {
        Self {
            outlets: Outlets::new(Vec::new()),
            down: BTreeSet::new(),
            receivers: Vec::new(),
            lasting: LastingStates::default(),
        }
    }

    /// Prepares for the targets of `plan`; the guardian releases everything before that.
    pub(super) fn prepare(&mut self, plan: &MessagePlan) {
        self.outlets.change(plan.targets.iter().map(of_the_server).collect());
        self.receivers.clear();
        self.down.clear();
        self.lasting = self.lasting.changed(plan);
        for (index, target) in plan.targets.iter().enumerate() {
            // A port that connects by itself opens now, since the time is short later.
            if matches!(&target.to, Destination::Midi(MidiTarget { into: Some(_), .. })) {
                self.outlets.connect(index, Vec::new());
            }
        }
    }

    /// Notes that the server's port of the target with this index connects as that of the guardian is.
    pub(super) fn connect(&mut self, target: usize, receivers: Vec<String>) {
        self.receivers.retain(|(other, _)| *other != target);
        self.receivers.push((target, receivers.clone()));
        self.outlets.connect(target, receivers);
    }

    /// Makes connections whose two ports are there by now.
    pub(super) fn settle(&mut self) {
        self.outlets.settle();
    }

    /// The ports that receive from those of the guardian, by the index of their target.
    pub(super) fn receivers(&self) -> &[(usize, Vec<String>)] {
        &self.receivers
    }

    /// The states that last once the targets have changed to those of `plan`, with the indices of these.
    pub(super) fn states_for(&self, plan: &MessagePlan) -> Vec<(usize, Act)> {
        self.lasting.changed(plan).all()
    }

    /// Notes what `order` holds down or lets come up, and the state that it leaves.
    pub(super) fn note(&mut self, order: &MessageOrder) {
        self.lasting.note(order);
        match &order.act {
            Act::Down(what, _) => drop(self.down.insert((order.target, what.clone()))),
            Act::Up(what) => drop(self.down.remove(&(order.target, what.clone()))),
            _ => {}
        }
    }

    /// Releases everything that is down, and then all that `plan` can hold.
    pub(super) fn release(&mut self, plan: &MessagePlan) {
        let begun = Instant::now();
        let down = std::mem::take(&mut self.down);
        // A packet of DMX has all channels; a broker keeps its states by itself.
        for (target, act) in self.lasting.all() {
            if matches!(act, Act::Dmx(_)) {
                self.outlets.carry_out(target, &act, &mut |text| warn!("{text}"));
            }
        }
        let others = plan.holdables().into_iter().filter(|held| !down.contains(held));
        let mut held: Vec<(usize, Holdable)> = down.iter().cloned().chain(others).collect();
        loop {
            let Self { outlets, .. } = self;
            held.retain(|(target, what)| !outlets.release(*target, what, &mut |text| warn!("{text}")));
            outlets.work(&mut |text| warn!("{text}"));
            // A target that is gone holds nothing of ours; one that opens does so within this time.
            if held.is_empty() || !self.outlets.are_opening() || begun.elapsed() > TRYING {
                break;
            }
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Closes all ways but those that must be there before the next failure.
    pub(super) fn close(&mut self, plan: &MessagePlan) {
        let receivers = std::mem::take(&mut self.receivers);
        self.outlets = Outlets::new(Vec::new());
        self.prepare(plan);
        receivers.into_iter().for_each(|(target, names)| self.connect(target, names));
    }
}

/// The target as the server opens it: a port of MIDI has another name than that of the guardian.
fn of_the_server(target: &SendTarget) -> SendTarget {
    let mut own = target.clone();
    if let Destination::Midi(midi) = &mut own.to {
        midi.port.push_str(" standby");
    }
    own
}
