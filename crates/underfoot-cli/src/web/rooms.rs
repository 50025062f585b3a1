//! Limits on clients: in all, per address, and one place for this machine.

use std::collections::VecDeque;
use std::net::{IpAddr, Ipv6Addr, TcpStream};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tracing::warn;

use super::MOST;
use super::http::{turn_away, wait_for};

/// Maximum number of clients of one other machine: a wall of screens, each with a page.
const MOST_OF_ONE: usize = 6;

/// Number of places reserved for this machine, so that an operator here can always connect.
const KEPT_FOR_THIS_MACHINE: usize = 1;

/// Maximum number of clients that wait for a refusal; further connections are closed without a message.
const WAITING: usize = 16;

/// Maximum time for a refused client to read the reason.
const PATIENCE: Duration = Duration::from_millis(100);

/// Maximum number of new clients per second, of one address and in all: each first gets the whole floor, which takes
/// some milliseconds.
const MOST_A_SECOND: usize = 32;
const MOST_OF_ALL_A_SECOND: usize = 64;
const SECOND: Duration = Duration::from_secs(1);

/// The connected clients.
#[derive(Default)]
pub(super) struct Rooms {
    taken: Vec<(IpAddr, JoinHandle<()>)>,
    /// Addresses and times of the clients accepted within the last second.
    came: VecDeque<(IpAddr, Instant)>,
}

impl Rooms {
    /// The reason to refuse a client from `ip` at `now`, if any.
    pub(super) fn why_not(&mut self, ip: IpAddr, now: Instant) -> Option<&'static str> {
        self.taken.retain(|(_, room)| !room.is_finished());
        while self.came.pop_front_if(|(_, came)| now.duration_since(*came) >= SECOND).is_some() {}
        let of_this = self.came.iter().filter(|(other, _)| network(*other) == network(ip)).count();
        // Clients of other machines do not count against this machine.
        let is_crowd = self.came.len() >= MOST_OF_ALL_A_SECOND && !ip.to_canonical().is_loopback();
        if of_this >= MOST_A_SECOND || is_crowd {
            return Some("too many clients at once: come again in a second");
        }
        let taken: Vec<IpAddr> = self.taken.iter().map(|(ip, _)| *ip).collect();
        why_not(ip, &taken)
    }

    /// Registers a client that arrived at `now` and is served by the thread `room`.
    pub(super) fn take(&mut self, ip: IpAddr, room: JoinHandle<()>, now: Instant) {
        self.taken.push((ip, room));
        self.came.push_back((ip, now));
    }

    /// Waits until all clients have left.
    pub(super) fn wait(self) {
        // A panic of the thread has been reported.
        self.taken.into_iter().for_each(|(_, room)| drop(room.join()));
    }
}

/// The reason to refuse a client from `ip` beside those from `taken`, if any.
fn why_not(ip: IpAddr, taken: &[IpAddr]) -> Option<&'static str> {
    let is_here = ip.to_canonical().is_loopback();
    let of_this = taken.iter().filter(|other| network(**other) == network(ip)).count();
    let room = if is_here { MOST } else { MOST - KEPT_FOR_THIS_MACHINE };
    if taken.len() >= room {
        Some("too many clients")
    } else if !is_here && of_this >= MOST_OF_ONE {
        Some("too many clients from this address")
    } else {
        None
    }
}

/// The part of an address that one machine can't easily change: for IPv6, the network of 64 bits.
fn network(ip: IpAddr) -> IpAddr {
    match ip.to_canonical() {
        IpAddr::V6(ip) if !ip.is_loopback() => {
            let [a, b, c, d, ..] = ip.segments();
            Ipv6Addr::new(a, b, c, d, 0, 0, 0, 0).into()
        }
        ip => ip,
    }
}

/// Refuses clients on a thread of its own: one that reads slowly delays no other.
pub(super) struct Refusals(Option<SyncSender<(TcpStream, &'static str)>>);

impl Refusals {
    pub(super) fn start() -> Self {
        let (refuse, refused) = sync_channel::<(TcpStream, &'static str)>(WAITING);
        let work = move || {
            for (stream, why) in refused {
                if wait_for(&stream, PATIENCE).is_ok() {
                    turn_away(stream, "503 Service Unavailable", why);
                }
            }
        };
        let started = Builder::new().name("web refusals".into()).spawn(work);
        let failed =
            started.inspect_err(|error| warn!("web clients are turned away without a word: {error}"));
        Self(failed.is_ok().then_some(refuse))
    }

    /// Sends the reason to the client, or closes the connection if too many wait.
    pub(super) fn refuse(&self, stream: TcpStream, why: &'static str) {
        if let Some(refuse) = &self.0 {
            let _ = refuse.try_send((stream, why));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: IpAddr = IpAddr::V4(std::net::Ipv4Addr::LOCALHOST);

    fn elsewhere(number: u8) -> IpAddr {
        [192, 168, 1, number].into()
    }

    #[test]
    fn a_page_that_connects_again_and_again_is_let_in_so_often() {
        let (mut rooms, begun) = (Rooms::default(), Instant::now());
        let mut let_in = 0;
        for ms in 0..5000 {
            let now = begun + Duration::from_millis(ms);
            if rooms.why_not(HERE, now).is_none() {
                let room = std::thread::spawn(|| {});
                while !room.is_finished() {
                    std::thread::yield_now();
                }
                rooms.take(HERE, room, now);
                let_in += 1;
            }
        }
        assert_eq!(let_in, 5 * MOST_A_SECOND);
    }

    #[test]
    fn one_other_machine_has_six_places() {
        let taken = [elsewhere(7); 6];
        assert_eq!(why_not(elsewhere(7), &taken[..5]), None);
        assert_eq!(why_not(elsewhere(7), &taken), Some("too many clients from this address"));
        assert_eq!(why_not(elsewhere(8), &taken), None);
    }

    #[test]
    fn a_place_is_kept_for_this_machine() {
        let taken: Vec<IpAddr> = (0..15).map(elsewhere).collect();
        assert_eq!(why_not(elsewhere(99), &taken), Some("too many clients"));
        assert_eq!(why_not(HERE, &taken), None);
        // Also if this machine's own clients have taken the other places.
        assert_eq!(why_not(elsewhere(99), &[HERE; 15]), Some("too many clients"));
        assert_eq!(why_not(HERE, &[HERE; 16]), Some("too many clients"));
    }

    #[test]
    fn a_machine_is_one_address_however_it_writes_itself() {
        let mapped: IpAddr = "::ffff:192.168.1.7".parse().unwrap_or(HERE);
        assert_eq!(why_not(mapped, &[elsewhere(7); 6]), Some("too many clients from this address"));
        let [one, other]: [IpAddr; 2] =
            ["2001:db8:1:2::1", "2001:db8:1:2:ffff::9"].map(|text| text.parse().unwrap_or(HERE));
        assert!(one.is_ipv6() && why_not(other, &[one; 6]).is_some());
    }
}
