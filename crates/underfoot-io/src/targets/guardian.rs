//! The guardian: a process that sends, notes everything that is down, and releases it when the server fails.
//!
//! ```text
//! plan               -> everything that the layout can hold is released; states that last are set
//! act                -> carried out; each down is noted
//! heartbeat          -> acknowledged
//! none for 80 ms     -> everything comes up; nothing is pressed again by itself
//! end of the input   -> everything comes up, and the process ends
//! ```

use std::collections::BTreeSet;
use std::io::{BufRead, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

use underfoot::messages::{Act, Holdable};
use underfoot::sink::{Rank, claim_priority};

use super::PATIENCE;
use super::link::{FromGuardian, ToGuardian, next, put};
use super::outlets::Outlets;

/// Longest time between two attempts to release a key.
const AGAIN: Duration = Duration::from_millis(20);

/// Longest wait for targets to open, before the guardian answers.
const OPENING: Duration = Duration::from_millis(500);

/// Time between two looks at the connections of ports.
const LOOK: Duration = Duration::from_millis(200);

/// Time for which the guardian tries to release keys after its server has ended.
const LAST: Duration = Duration::from_secs(3);

/// Maximum number of messages that wait: a second of the fastest orders.
const QUEUE: usize = 4096;

/// Guards everything that the server at the other end of `from` and `to` holds down, until that end closes.
///
/// # Errors
/// The system gives no thread.
pub fn guard(mut from: impl BufRead + Send + 'static, to: impl Write) -> std::io::Result<()> {
    // A computer that is busy otherwise lets holds end early; the thread that reads inherits it.
    claim_priority(Rank::Telling);
    let (queue, messages) = sync_channel(QUEUE);
    let read = move || {
        while let Some(message) = next::<ToGuardian>(&mut from) {
            if queue.send(message).is_err() {
                break;
            }
        }
    };
    Builder::new().name("guardian in".into()).spawn(read)?;
    let (outlets, down, starting) = (Outlets::new(Vec::new()), BTreeSet::new(), BTreeSet::new());
    let connections = Connections { told: Vec::new(), looked: Instant::now() };
    Guardian { outlets, down, starting, begun: Instant::now(), to, undone: 0, connections }.run(&messages);
    Ok(())
}

/// The state of the guardian.
struct Guardian<W> {
    outlets: Outlets,
    /// Keys, buttons and addresses that are down, or may be.
    down: BTreeSet<(usize, Holdable)>,
    /// Those that may be down from before, and could not be released so far.
    starting: BTreeSet<(usize, Holdable)>,
    /// The time at which the plan came.
    begun: Instant,
    to: W,
    undone: u64,
    connections: Connections,
}

/// The connections of ports, which the server keeps in case this process ends.
struct Connections {
    told: Vec<(usize, Vec<String>)>,
    looked: Instant,
}

impl<W: Write> Guardian<W> {
    fn run(mut self, messages: &Receiver<ToGuardian>) {
        let mut heard = Instant::now();
        loop {
            let wait = PATIENCE.saturating_sub(heard.elapsed());
            // Without patience left, it only tries to release the rest.
            let wait = if wait.is_zero() { AGAIN } else { wait };
            let wait = self.work().map_or(wait, |due| wait.min(due));
            match messages.recv_timeout(wait) {
                Ok(message) => {
                    let is_late = heard.elapsed() > PATIENCE;
                    if is_late {
                        self.release_all();
                    }
                    match message {
                        // A press of a server that was silent is old.
                        ToGuardian::Act(_, act) if is_late && !matches!(act, Act::Up(_)) => self.undone += 1,
                        ToGuardian::Act(target, act) => self.act(target, &act),
                        message => {
                            heard = Instant::now();
                            self.process(message);
                        }
                    }
                }
                Err(RecvTimeoutError::Timeout) => {
                    if heard.elapsed() >= PATIENCE {
                        self.release_all();
                    }
                }
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        let ended = Instant::now();
        self.release_all();
        while !self.down.is_empty() && ended.elapsed() < LAST {
            std::thread::sleep(AGAIN);
            self.release_all();
        }
        self.outlets.end();
    }

    /// Does what is due at the targets by itself; returns the time until more is due.
    fn work(&mut self) -> Option<Duration> {
        let mut notices = Vec::new();
        let due = self.outlets.work(&mut |text| notices.push(text));
        self.tell(notices);
        due
    }

    fn process(&mut self, message: ToGuardian) {
        match message {
            ToGuardian::Setup(targets, holdables, states) => {
                self.release_all();
                self.outlets.change(targets);
                self.outlets.forget();
                self.connections.told.clear();
                self.open_all();
                self.starting = holdables.into_iter().collect();
                self.begun = Instant::now();
                self.release_old();
                states.into_iter().for_each(|(target, act)| self.act(target, &act));
            }
            ToGuardian::Act(target, act) => self.act(target, &act),
            ToGuardian::Beat(number) => {
                self.say(&FromGuardian::Beat(number));
                self.release_old();
                let undone = std::mem::take(&mut self.undone);
                if undone > 0 {
                    self.say(&FromGuardian::Undone(undone));
                }
                self.look_at_connections();
            }
            ToGuardian::Release => self.release_all(),
            ToGuardian::Connect(target, receivers) => self.outlets.connect(target, receivers),
        }
    }

    /// Opens all targets, so that the first message goes out.
    fn open_all(&mut self) {
        let begun = Instant::now();
        self.outlets.open();
        while self.outlets.are_opening() && begun.elapsed() < OPENING {
            std::thread::sleep(Duration::from_millis(2));
        }
        // From now on, others find the ports and connect to them.
        self.outlets.receivers();
    }

    fn act(&mut self, target: usize, act: &Act) {
        let mut notices = Vec::new();
        match act {
            Act::Down(what, _) => {
                let key = (target, what.clone());
                // Noted first: an act that fails half-way may have pressed a part.
                self.down.insert(key.clone());
                self.starting.remove(&key);
                if !self.outlets.carry_out(target, act, &mut |text| notices.push(text)) {
                    self.undone += 1;
                    self.outlets.release(target, what, &mut |_| {});
                    self.down.remove(&key);
                }
            }
            // It may have come up already, after a silence.
            Act::Up(what) => {
                let key = (target, what.clone());
                if self.down.contains(&key)
                    && self.outlets.carry_out(target, act, &mut |text| notices.push(text))
                {
                    self.down.remove(&key);
                }
            }
            _ => {
                if !self.outlets.carry_out(target, act, &mut |text| notices.push(text)) {
                    self.undone += 1;
                }
            }
        }
        self.tell(notices);
    }

    /// Lets everything come up; a key that could not be released stays noted.
    fn release_all(&mut self) {
        let mut notices = Vec::new();
        let Self { outlets, down, .. } = self;
        down.retain(|(target, what)| !outlets.release(*target, what, &mut |text| notices.push(text)));
        self.tell(notices);
    }

    /// Releases keys from before the start; a target that stays absent holds nothing of ours.
    fn release_old(&mut self) {
        if self.begun.elapsed() > LAST {
            self.starting.clear();
        }
        if self.starting.is_empty() {
            return;
        }
        let mut notices = Vec::new();
        let Self { outlets, starting, .. } = self;
        starting.retain(|(target, what)| !outlets.release(*target, what, &mut |text| notices.push(text)));
        self.tell(notices);
    }

    /// Reports connections that have changed.
    fn look_at_connections(&mut self) {
        if self.connections.looked.elapsed() < LOOK {
            return;
        }
        self.connections.looked = Instant::now();
        self.outlets.settle();
        let now = self.outlets.receivers();
        // A new guardian has none, until the server names those of the one before it.
        let is_new =
            |it: &&(usize, Vec<String>)| match self.connections.told.iter().find(|told| told.0 == it.0) {
                Some(told) => told.1 != it.1,
                None => !it.1.is_empty(),
            };
        let news: Vec<_> = now.iter().filter(is_new).cloned().collect();
        news.into_iter().for_each(|(target, names)| self.say(&FromGuardian::Receivers(target, names)));
        self.connections.told = now;
    }

    fn tell(&mut self, notices: Vec<String>) {
        notices.into_iter().for_each(|text| self.say(&FromGuardian::Notice(text)));
    }

    /// A server that has ended reads nothing; the end of the input shows that.
    fn say(&mut self, message: &FromGuardian) {
        let _ = put(&mut self.to, message);
    }
}
