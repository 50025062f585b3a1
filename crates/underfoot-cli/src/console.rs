//! The console of a running floor: a status line that is updated on a terminal, and advice when nothing arrives.

use std::io::{self, IsTerminal};
use std::net::SocketAddr;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tracing::warn;
use underfoot::engine::{FootRole, Snapshot};
use underfoot::feel::DeviceState;
use underfoot::runtime::Session;
use underfoot::wire::{LinkCounters, LinkState};

use super::output;

/// Interval of updates of the line: as short as a number can be read.
const EVERY: Duration = Duration::from_millis(250);

/// Silence after which the console logs advice.
const SILENCE: Duration = Duration::from_secs(2);

/// A running console; ends and removes its line when dropped.
pub(crate) struct Console {
    /// `None` only during the drop.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Console {
    /// Starts to show the state of `session`; `listen` is the address for packets.
    ///
    /// # Errors
    /// The error of the system if it provides no thread.
    pub(crate) fn start(listen: SocketAddr, session: Session) -> io::Result<Self> {
        let (end, ended) = channel();
        let thread = Builder::new().name("console".into()).spawn(move || keep(&session, &ended, listen))?;
        Ok(Self { end: Some(end), thread: Some(thread) })
    }
}

impl Drop for Console {
    fn drop(&mut self) {
        self.end = None;
        // The thread only draws, and a panic in it has been reported.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

fn keep(session: &Session, ended: &Receiver<()>, listen: SocketAddr) {
    let is_shown = io::stderr().is_terminal();
    let mut rate = Rate::new(Instant::now());
    let mut silence = Silence::new(Instant::now());
    while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(EVERY) {
        let (now, seen) = (Instant::now(), session.snapshot().floor);
        let arriving = rate.update(now, seen.counters.packets);
        let advice = silence.update(now, seen.link, &seen.counters, listen);
        // The cause has been logged, with more details.
        if let Some(advice) = advice.filter(|_| seen.link_cause.is_none()) {
            warn!("{advice}");
        }
        if is_shown {
            output::show_line(line(&seen, arriving, output::warnings()));
        }
    }
    if is_shown {
        output::show_line(String::new());
    }
}

/// Packets per second, over the last second or so.
struct Rate {
    since: Instant,
    packets: u64,
    per_second: u64,
}

impl Rate {
    const OVER: Duration = Duration::from_secs(1);

    const fn new(now: Instant) -> Self {
        Self { since: now, packets: 0, per_second: 0 }
    }

    fn update(&mut self, now: Instant, packets: u64) -> u64 {
        let passed = now.saturating_duration_since(self.since);
        if passed >= Self::OVER {
            let more = packets.saturating_sub(self.packets);
            self.per_second = (more as f64 / passed.as_secs_f64()).round() as u64;
            (self.since, self.packets) = (now, packets);
        }
        self.per_second
    }
}

/// Start of the time without usable packets, and whether the advice has been logged.
struct Silence {
    since: Instant,
    told: bool,
    before: LinkCounters,
}

impl Silence {
    fn new(now: Instant) -> Self {
        Self { since: now, told: false, before: LinkCounters::default() }
    }

    /// Advice, once for each silence.
    fn update(
        &mut self,
        now: Instant,
        link: LinkState,
        counters: &LinkCounters,
        listen: SocketAddr,
    ) -> Option<String> {
        let is_silent = matches!(link, LinkState::Waiting | LinkState::Lost);
        if !is_silent || counters.packets > self.before.packets {
            *self = Self { since: now, told: false, before: *counters };
            return None;
        }
        if self.told || now.saturating_duration_since(self.since) < SILENCE {
            return None;
        }
        self.told = true;
        Some(advice(&self.before, counters, listen))
    }
}

/// Advice for the case that nothing usable has arrived since `before`.
fn advice(before: &LinkCounters, now: &LinkCounters, listen: SocketAddr) -> String {
    let seconds = SILENCE.as_secs();
    let port = listen.port();
    let refused = now.refused() - before.refused();
    if refused == 0 {
        let own = if listen.ip().is_loopback() {
            format!(
                " {listen} takes packets of this machine only: boards on a network need --listen with the address of the card they are on."
            )
        } else {
            String::new()
        };
        return format!(
            "nothing has arrived on port {port} for {seconds} s: are the boards switched on and cabled, do they send to \
             this machine's address and this port, and does a firewall let UDP through?{own}"
        );
    }
    let reasons = [
        (now.foreign - before.foreign, "from senders that may not send: name the boards with --allow"),
        (
            now.wrong_shape - before.wrong_shape,
            "with other readings than the floor file says: is it this floor's?",
        ),
        (now.unknown_address - before.unknown_address, "for boards that the floor file does not name"),
        (now.malformed - before.malformed, "that are not OSC"),
        (now.limited - before.limited, "beyond what one sender may send"),
    ];
    let reasons: Vec<_> = reasons
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    format!("datagrams arrive on port {port} but for {seconds} s none could be used: {}", reasons.join("; "))
}

/// The state of the floor in one line.
fn line(seen: &Snapshot, arriving: u64, warnings: u64) -> String {
    let link = match seen.link {
        LinkState::Waiting => "waiting for boards",
        LinkState::Live => "live",
        LinkState::Partial => "some boards missing",
        LinkState::Lost => "FLOOR LOST",
    };
    let cause = seen.link_cause.as_ref();
    let link = cause.map_or(link.to_owned(), |cause| format!("{link}: {}", cause.name().replace('_', " ")));
    let arriving = if matches!(seen.link, LinkState::Waiting | LinkState::Lost) { 0 } else { arriving };
    let mut parts = vec![
        link,
        format!("boards {}/{}", seen.boards_live, seen.boards),
        format!("{arriving} packets/s"),
        format!("lost {}", seen.counters.lost),
    ];
    let refused = seen.counters.refused();
    if refused > 0 {
        parts.push(format!("refused {refused}"));
    }
    let feet = seen.feet.iter().filter(|foot| foot.role != FootRole::Object).count();
    parts.push(format!("feet {feet}"));
    let held: Vec<_> = seen.held.iter().map(ToString::to_string).collect();
    parts.push(if held.is_empty() { "nothing held".into() } else { format!("held {}", held.join(" ")) });
    let muted = &seen.muted;
    if muted.all {
        parts.push("all muted".into());
    } else if !muted.tiles.is_empty() {
        parts.push(format!("muted tiles {}", muted.tiles.len()));
    }
    match &seen.device {
        None => {}
        Some(device) if device.state == DeviceState::Playing => parts.push("actuators playing".into()),
        Some(device) => parts.push(format!("actuators {}", device.state.name())),
    }
    if !seen.health.troubles.is_empty() {
        parts.push(format!("sensors in trouble {}", seen.health.troubles.len()));
    }
    if warnings > 0 {
        parts.push(format!("warnings {warnings}"));
    }
    parts.join(" | ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::feel::{DeviceStatus, Muted};
    use underfoot::widget::WidgetId;
    use underfoot::wire::LinkCause;

    const LISTEN: &str = "127.0.0.1:9000";

    #[test]
    fn the_line_says_what_there_is_to_see() {
        let mut seen = Snapshot { boards: 6, ..Snapshot::default() };
        assert_eq!(
            line(&seen, 0, 0),
            "waiting for boards | boards 0/6 | 0 packets/s | lost 0 | feet 0 | nothing held"
        );
        seen.link = LinkState::Partial;
        seen.boards_live = 5;
        seen.counters = LinkCounters { lost: 7, malformed: 2, ..LinkCounters::default() };
        seen.held = vec![WidgetId::new("drive")];
        seen.muted = Muted { all: true, tiles: Vec::new() };
        seen.device = Some(DeviceStatus { state: DeviceState::Lost, ..DeviceStatus::default() });
        assert_eq!(
            line(&seen, 5000, 3),
            "some boards missing | boards 5/6 | 5000 packets/s | lost 7 | refused 2 | feet 0 | held drive | all muted \
             | actuators lost | warnings 3"
        );
        seen.link = LinkState::Lost;
        assert!(
            line(&seen, 5000, 3).contains("| 0 packets/s"),
            "the last rate of a floor that is lost is no rate"
        );
    }

    #[test]
    fn the_line_names_why_a_live_floor_gives_no_frame() {
        let cause = LinkCause::RateLow { board: 0, hz: 100.0 };
        let seen = Snapshot { link: LinkState::Live, link_cause: Some(cause), ..Snapshot::default() };
        assert!(line(&seen, 100, 0).starts_with("live: rate low | boards 0/0 | 100 packets/s"));
    }

    #[test]
    fn a_silence_is_told_once_with_what_to_look_at_and_again_after_packets_came() {
        let (begun, listen) = (Instant::now(), LISTEN.parse().unwrap());
        let at = |ms| begun + Duration::from_millis(ms);
        let mut silence = Silence::new(begun);
        let mut counters = LinkCounters::default();
        assert_eq!(silence.update(at(1900), LinkState::Waiting, &counters, listen), None);
        let said = silence.update(at(2000), LinkState::Waiting, &counters, listen).unwrap();
        assert!(
            said.starts_with("nothing has arrived on port 9000 for 2 s: ") && said.contains("--listen"),
            "{said}"
        );
        assert_eq!(silence.update(at(9000), LinkState::Waiting, &counters, listen), None);
        counters.packets = 10;
        assert_eq!(silence.update(at(9500), LinkState::Live, &counters, listen), None);
        assert_eq!(silence.update(at(9600), LinkState::Lost, &counters, listen), None);
        counters.foreign = 4;
        let said = silence.update(at(12_000), LinkState::Lost, &counters, listen).unwrap();
        assert!(said.contains("none could be used: 4 from senders that may not send"), "{said}");
    }

    #[test]
    fn the_rate_is_that_of_the_last_second() {
        let begun = Instant::now();
        let mut rate = Rate::new(begun);
        assert_eq!(rate.update(begun + Duration::from_millis(500), 3000), 0);
        assert_eq!(rate.update(begun + Duration::from_millis(1000), 6000), 6000);
        assert_eq!(rate.update(begun + Duration::from_millis(3000), 6000), 0);
    }
}
