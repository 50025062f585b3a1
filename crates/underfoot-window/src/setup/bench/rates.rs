//! The boards that send now: rates of the last second, and troubles.

use std::collections::HashMap;
use std::time::Duration;

use underfoot::floor::PortName;
use underfoot::serve::{FoundBoard, SentNumbers};
use underfoot::units::Instant;

use crate::setup::heard::{HeardBoards, board_kind, board_name};
use crate::setup::view::BoardView;

/// Time over which packets are counted.
const SPAN: Duration = Duration::from_secs(1);

/// Time without a packet after which a board counts as silent.
const SILENT: Duration = Duration::from_secs(1);

/// Rates with which boards may send (1/s).
const RATES_HZ: [f64; 2] = [20.0, 4000.0];

/// Number of readings that are shown.
const SHOWN: usize = 64;

/// Counts the packets of each board.
#[derive(Clone, Debug, Default)]
pub(super) struct LiveRates {
    boards: HashMap<(String, Option<PortName>), LiveRate>,
}

#[derive(Clone, Copy, Debug, Default)]
struct LiveRate {
    /// Number of packets at the beginning of the present span, and when that was.
    begun: Option<(u64, Instant)>,
    hz: Option<f64>,
}

impl LiveRate {
    fn count(&mut self, packets: u64, now: Instant) {
        match self.begun {
            None => self.begun = Some((packets, now)),
            Some((before, begun)) if now.since(begun) >= SPAN => {
                self.hz = Some(packets.saturating_sub(before) as f64 / now.since(begun).as_secs_f64());
                self.begun = Some((packets, now));
            }
            Some(_) => {}
        }
    }
}

impl LiveRates {
    /// The boards at `now`.
    pub(super) fn boards(&mut self, heard: &HeardBoards, now: Instant) -> Vec<BoardView> {
        let live = |board: &FoundBoard| {
            let key = (board.address.clone(), board.port.clone());
            let rate = self.boards.entry(key).or_default();
            rate.count(board.packets(), now);
            // Within the first second, the rate since the first packet.
            let rate_hz = rate.hz.or_else(|| board.rate_hz());
            BoardView {
                name: board_name(board),
                rate_hz,
                channels: board.channels(),
                kind: board_kind(board),
                is_numbered: board.is_numbered(),
                full_scale: board.full_scale(),
                greatest: board.greatest(),
                readings: board.readings().iter().take(SHOWN).copied().collect(),
                troubles: troubles(board, rate.hz, now),
            }
        };
        heard.boards().into_iter().map(live).collect()
    }
}

/// The troubles of a board.
fn troubles(board: &FoundBoard, rate_hz: Option<f64>, now: Instant) -> Vec<String> {
    let silence = now.since(board.last());
    if silence >= SILENT {
        return vec![format!("Nothing has come for {} s: is it still on?", silence.as_secs())];
    }
    let mut troubles = Vec::new();
    let [least, most] = RATES_HZ;
    match rate_hz {
        Some(hz) if hz < least => {
            troubles.push(format!("{hz:.0} packets a second are too few: at least {least:.0}."));
        }
        Some(hz) if hz > most => {
            troubles.push(format!("{hz:.0} packets a second are too many: at most {most:.0}."));
        }
        _ => {}
    }
    if board.channels() < 3 {
        troubles.push(format!("{} channels are too few: a plate has 3 or 4 sensors.", board.channels()));
    }
    if board.numbers != SentNumbers::Newtons && board.readings().iter().any(|reading| *reading < 0.0) {
        troubles.push(
            "Some counts are negative: counts with a sign, or a converter that does not answer. The floor file says \
             which, with `counts` and `full_scale`."
                .to_owned(),
        );
    }
    troubles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_last_second_and_silence_is_named() {
        let (mut heard, mut rates) = (HeardBoards::default(), LiveRates::default());
        let mut boards = Vec::new();
        for ms in 0..4000_u32 {
            // 100 packets a second, then 10, then none.
            if (ms < 1500 && ms % 10 == 0) || (ms < 2500 && ms % 100 == 0) {
                let mut datagram = b"/b\0\0,iiii\0\0\0".to_vec();
                [ms / 10, 5, 6, 7].iter().for_each(|number| datagram.extend(number.to_be_bytes()));
                heard.take_datagram(&datagram, "127.0.0.1".parse().unwrap(), Instant::from_millis(ms.into()));
            }
            boards = rates.boards(&heard, Instant::from_millis(ms.into()));
            if ms == 1400 {
                let [board] = &boards[..] else { panic!("{boards:?}") };
                assert!(
                    (board.rate_hz.unwrap() - 100.0).abs() < 2.0 && board.troubles.is_empty(),
                    "{board:?}"
                );
                assert_eq!((board.channels, board.is_numbered, board.greatest), (3, true, 7.0));
            }
            if ms == 3100 {
                assert!(boards[0].troubles[0].contains("too few"), "{boards:?}");
            }
        }
        assert!(boards[0].troubles[0].contains("Nothing has come for 1 s"), "{boards:?}");
    }
}
