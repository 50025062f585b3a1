//! Finds the cause if a floor whose boards send gives no usable frame, or never shows a load.

mod cadence;
mod range;
#[cfg(test)]
mod tests;

use std::time::Duration;

use self::cadence::{Cadence, Count, CountedRate};
use self::range::Range;
use crate::floor::Board;
use crate::sense::{Assembler, ForceFrame, Quality, TareOutcome, TimeBase};
use crate::units::Instant;
use crate::wire::{BOARD_RATES_HZ, LinkCause, LinkCounters, LinkState, SensorPacket};

/// Minimum duration of a cause before it is reported: boards need less to start or to be plugged in.
const HOLDS: Duration = Duration::from_secs(2);

/// Time without the cause after which its end is reported.
const GONE: Duration = Duration::from_secs(1);

/// Interval between two frames that are examined.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// Maximum age of the last datagram while the boards count as sending.
const SENT_LATELY: Duration = Duration::from_secs(1);

/// State of the floor apart from its packets.
pub(super) struct Facts<'a> {
    pub(super) assembler: &'a Assembler,
    pub(super) link: LinkState,
    /// Counters from the socket to the frames.
    pub(super) counters: &'a LinkCounters,
    /// The cause of the last rejected datagram or message.
    pub(super) refused: Option<LinkCause>,
}

/// Detects causes.
#[derive(Debug)]
pub(super) struct CauseWatch {
    /// OSC addresses of the boards.
    addresses: Vec<String>,
    /// Rates of the boards in the floor file, where they are written.
    written_hz: Vec<Option<f32>>,
    cadences: Vec<Cadence>,
    ranges: Vec<Range>,
    /// Whether the floor has shown a load since the start.
    has_load: bool,
    /// Time of the last frame with a usable sensor, and time of the last examination of a frame.
    usable: Instant,
    looked: Instant,
    /// Counters by kind, each with the time of its last growth.
    datagrams: Growth,
    packets: Growth,
    refused: Growth,
    limited: Growth,
    candidate: Option<(LinkCause, Instant)>,
    /// The reported cause, and the time at which it was last found.
    told: Option<(LinkCause, Instant)>,
}

/// A counter, and the time at which it last grew.
#[derive(Clone, Copy, Debug, Default)]
struct Growth {
    count: u64,
    at: Option<Instant>,
}

impl Growth {
    fn update(&mut self, count: u64, now: Instant) {
        if count > self.count {
            (self.count, self.at) = (count, Some(now));
        }
    }

    fn has_grown(&self, within: Duration, now: Instant) -> bool {
        self.at.is_some_and(|at| now.since(at) < within)
    }
}

impl CauseWatch {
    /// A watch for these boards.
    pub(super) fn new(boards: &[Board]) -> Self {
        Self {
            cadences: vec![Cadence::default(); boards.len()],
            ranges: boards.iter().map(|board| Range::new(board.range)).collect(),
            addresses: boards.iter().map(|board| board.address.clone()).collect(),
            written_hz: boards.iter().map(|board| board.rate_hz).collect(),
            has_load: false,
            usable: Instant::START,
            looked: Instant::START,
            datagrams: Growth::default(),
            packets: Growth::default(),
            refused: Growth::default(),
            limited: Growth::default(),
            candidate: None,
            told: None,
        }
    }

    /// Records a packet.
    pub(super) fn note(&mut self, packet: &SensorPacket) {
        let board = usize::from(packet.board);
        if let Some(cadence) = self.cadences.get_mut(board) {
            cadence.note(packet.sequence, packet.received);
        }
        if let Some(range) = self.ranges.get_mut(board) {
            range.note(&packet.readings, packet.received);
        }
    }

    /// Records a frame; `is_loaded`: something rests on the floor; `now`: time on the clock of the source.
    pub(super) fn note_frame(&mut self, frame: &ForceFrame, is_loaded: bool, now: Instant) {
        self.has_load |= is_loaded;
        if now.since(self.looked) >= LOOK_EVERY || self.looked == Instant::START {
            self.looked = now;
            if frame.quality.as_flattened().iter().any(|quality| *quality < Quality::Stale) {
                self.usable = now;
            }
        }
    }

    /// Returns the cause reported at present.
    pub(super) fn cause(&self) -> Option<&LinkCause> {
        self.told.as_ref().map(|(cause, _)| cause)
    }

    /// Looks for a cause; returns true when the reported cause changes or ends.
    pub(super) fn update(&mut self, facts: &Facts<'_>, now: Instant) -> bool {
        self.datagrams.update(facts.counters.datagrams + facts.counters.packets, now);
        self.packets.update(facts.counters.packets, now);
        self.refused.update(facts.counters.refused(), now);
        self.limited.update(facts.counters.limited, now);
        let found = self.find(facts, now);
        let Some(found) = found else {
            self.candidate = None;
            let is_gone = self.told.as_ref().is_some_and(|(_, at)| now.since(*at) >= GONE);
            return is_gone && self.told.take().is_some();
        };
        if let Some((told, at)) = &mut self.told
            && told.is_like(&found)
        {
            *at = now;
            self.candidate = None;
            return false;
        }
        let since = self.candidate.as_ref().filter(|(cause, _)| cause.is_like(&found));
        let since = since.map_or(now, |(_, since)| *since);
        // Causes about loads build on seconds of moving readings and need no further delay.
        if now.since(since) < HOLDS && !found.is_of_loads() {
            self.candidate = Some((found, since));
            return false;
        }
        self.candidate = None;
        self.told = Some((found, now));
        true
    }

    fn find(&self, facts: &Facts<'_>, now: Instant) -> Option<LinkCause> {
        let loads = || {
            let unseen = |(board, range): (u16, &Range)| range.unseen(board);
            (0..).zip(&self.ranges).find_map(unseen).filter(|_| !self.has_load)
        };
        let swapped = || {
            let (_, mut places) = facts.assembler.swapped();
            places.next().map(|(board, reads)| LinkCause::BoardsSwapped { board, reads })
        };
        self.fault_of_a_board(facts.assembler, now)
            .or_else(swapped)
            .or_else(|| self.missing(facts, now))
            .or_else(loads)
    }

    /// Returns the fault of the first board with wrong numbering, a wrong rate or unusable readings.
    fn fault_of_a_board(&self, assembler: &Assembler, now: Instant) -> Option<LinkCause> {
        let is_limited = self.limited.has_grown(HOLDS, now);
        let counted =
            (0..).zip(&self.cadences).zip(&self.written_hz).find_map(|((board, cadence), written)| {
                let CountedRate { count, hz, numbers_hz } = cadence.judged(now)?;
                let timing = assembler.board(board)?.timing;
                match count {
                    // The gateway rejected some packets because there were too many.
                    Count::Steps(_) | Count::Jumps if is_limited => {
                        Some(LinkCause::RateHigh { board, hz: numbers_hz })
                    }
                    // Its numbers need not count packets.
                    _ if timing.base != TimeBase::Packets => rate(board, timing.hz, *written),
                    Count::Steady => rate(board, hz, *written),
                    count => count.fault(board),
                }
            });
        counted.or_else(|| (0..).zip(&self.ranges).find_map(|(board, range)| range.fault(board)))
    }

    /// Returns the cause for missing usable frames, or frames that lack boards.
    fn missing(&self, facts: &Facts<'_>, now: Instant) -> Option<LinkCause> {
        let Facts { assembler, link, refused, .. } = facts;
        let is_usable = now.since(self.usable) < HOLDS && self.usable != Instant::START;
        let is_sent = self.datagrams.has_grown(SENT_LATELY, now);
        let is_taring = assembler.tare_outcome() == TareOutcome::Measuring && *link == LinkState::Live;
        if !is_sent || is_taring || self.addresses.is_empty() || (is_usable && *link == LinkState::Live) {
            return None;
        }
        if self.refused.has_grown(SENT_LATELY, now)
            && let Some(refused) =
                refused.as_ref().filter(|refused| !matches!(refused, LinkCause::Unknown { .. }))
        {
            return Some(refused.clone());
        }
        let statuses = || (0..).map_while(|board| Some((board, assembler.board(board)?)));
        if let Some((board, _)) = statuses().find(|(_, status)| status.frozen) {
            return Some(LinkCause::ReadingsStand { board });
        }
        let (live, boards) = assembler.boards_live();
        if (1..boards).contains(&live) {
            let (board, _) = statuses().find(|(_, status)| status.age.is_none_or(|age| age > LOOK_EVERY))?;
            let address = self.addresses.get(usize::from(board)).cloned().unwrap_or_default();
            return Some(LinkCause::BoardsMissing { board, address, missing: boards - live, boards });
        }
        if is_usable {
            return None;
        }
        // Requests of apps alone are no sign of boards.
        if ![&self.packets, &self.refused].iter().any(|count| count.has_grown(SENT_LATELY, now)) {
            return None;
        }
        let last_refused = match refused {
            Some(LinkCause::Unknown { last_refused }) => last_refused.clone(),
            Some(other) => other.to_string(),
            None => String::new(),
        };
        Some(LinkCause::Unknown { last_refused })
    }
}

impl LinkCause {
    /// Whether the cause is that no load was ever seen.
    const fn is_of_loads(&self) -> bool {
        matches!(
            self,
            Self::CountsNarrow { .. }
                | Self::NewtonsSmall { .. }
                | Self::ReadingsFall { .. }
                | Self::NoLoad { .. }
        )
    }
}

/// Returns the fault of a board that sends `hz` packets a second, if that rate is one: beyond the supported range, or not
/// the one that the floor file says.
fn rate(board: u16, hz: f32, written: Option<f32>) -> Option<LinkCause> {
    /// Relative error of a rate measured over half a second.
    const ERROR: f32 = 0.05;
    /// Relative difference from the floor file's rate beyond which boards differ from it.
    const OTHER: f32 = 0.2;
    let [lowest, highest] = BOARD_RATES_HZ;
    match written {
        _ if hz < lowest * (1.0 - ERROR) => Some(LinkCause::RateLow { board, hz }),
        _ if hz > highest * (1.0 + ERROR) => Some(LinkCause::RateHigh { board, hz }),
        Some(written) if (hz / written - 1.0).abs() > OTHER => {
            Some(LinkCause::RateOther { board, hz, written })
        }
        _ => None,
    }
}
