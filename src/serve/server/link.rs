//! Reports of a floor's link: lost, found, tared, frozen, calibrated.

use std::time::Duration;

use tracing::{info, warn};

use super::limited::Limited;
use crate::floor::FloorFile;
use crate::sense::{Assembler, BoardTiming, TareOutcome, TimeBase};
use crate::units::Instant;
use crate::widget::OffReason;
use crate::wire::{LinkCause, LinkState};

/// Minimum time of a partial link before it is reported; controls on the silent boards are released long before.
const SETTLING: Duration = Duration::from_millis(100);

/// The link state as last reported.
#[derive(Debug)]
pub(super) struct LinkWatch {
    state: LinkState,
    /// Begin of the partial link: only some boards report.
    partial_since: Option<Instant>,
    tare: TareOutcome,
    /// Sensors without calibration.
    uncalibrated: usize,
    /// Counts of frozen boards, of tiles with repeating sensors, and of changes of swapped boards.
    frozen: u64,
    repeats: u64,
    swaps: u64,
    /// Rate and time base of each board as last logged.
    timings: Vec<BoardTiming>,
    notices: Limited,
}

impl Default for LinkWatch {
    fn default() -> Self {
        Self {
            state: LinkState::Waiting,
            partial_since: None,
            tare: TareOutcome::FromFloor,
            uncalibrated: 0,
            frozen: 0,
            repeats: 0,
            swaps: 0,
            timings: Vec::new(),
            notices: Limited::new(10, Duration::from_secs(10)),
        }
    }
}

impl LinkWatch {
    /// Returns the state that was last reported.
    pub(super) const fn state(&self) -> LinkState {
        self.state
    }

    /// Whether the link is lost.
    pub(super) fn is_lost(&self) -> bool {
        self.state == LinkState::Lost
    }

    /// Logs all changes; returns the state of the link if it has changed.
    pub(super) fn update(
        &mut self,
        assembler: &Assembler,
        file: &FloorFile,
        now: Instant,
    ) -> Option<LinkState> {
        self.note_frozen(assembler);
        self.note_repeats(assembler, now);
        self.note_swapped(assembler);
        self.note_tare(assembler);
        let state = self.settled(assembler.link_state(), now);
        if state == self.state {
            return None;
        }
        match state {
            LinkState::Lost => self
                .notices
                .warn(now, || "nothing usable from any board for 100 ms: what was held is cancelled".into()),
            LinkState::Partial => {
                self.notices.warn(now, || "nothing usable comes from some boards".into());
            }
            LinkState::Live => self.notices.info(now, || "packets arrive from every board".into()),
            LinkState::Waiting => {}
        }
        self.state = state;
        self.note_uncalibrated(assembler, file);
        Some(state)
    }

    /// Logs the cause of unusable frames, or its end.
    pub(super) fn note_cause(&mut self, cause: Option<&LinkCause>, now: Instant) {
        match cause {
            Some(cause) => self.notices.warn(now, || cause.to_string()),
            None => {
                self.notices.info(now, || "the fault of boards or link that was last named is gone".into());
            }
        }
    }

    /// Logs the rate and the time base of each board that does not send once a millisecond, when it is known and when
    /// it changes.
    pub(super) fn note_timings(&mut self, assembler: &Assembler, now: Instant) {
        let timings = (0_u16..).map_while(|board| Some(assembler.board(board)?.timing));
        for (board, timing) in timings.enumerate() {
            if board == self.timings.len() {
                self.timings.push(BoardTiming::MILLISECOND);
            }
            let Some(told) = self.timings.get_mut(board).filter(|told| timing.is_news_after(told)) else {
                continue;
            };
            *told = timing;
            self.notices.info(now, || {
                let times = match timing.base {
                    TimeBase::Packets => "its samples' times come from the number of each packet".to_owned(),
                    TimeBase::Milliseconds => "its samples' times are its stamps in milliseconds".to_owned(),
                    TimeBase::Arrival => format!(
                        "its samples' times are those of their arrival, to {:.1} ms",
                        1e3 * timing.jitter.as_secs_f32()
                    ),
                };
                format!("board {board} sends {:.1} packets a second; {times}", timing.hz)
            });
        }
    }

    /// Logs which boards are swapped.
    fn note_swapped(&mut self, assembler: &Assembler) {
        let (changes, places) = assembler.swapped();
        if std::mem::replace(&mut self.swaps, changes) == changes {
            return;
        }
        let mut places: Vec<(u16, u16)> = places.collect();
        if places.is_empty() {
            warn!("the boards fit the floor file again");
        }
        while let Some((first, mut next)) = places.pop() {
            let mut ring = vec![first];
            while let Some(found) = places.iter().position(|(board, _)| *board == next) {
                ring.push(next);
                next = places.swap_remove(found).1;
            }
            ring.sort_unstable();
            let named: Vec<String> = ring.iter().map(u16::to_string).collect();
            let (last, others) =
                named.split_last().map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
            warn!(
                "boards {} and {last} are swapped: each reads what the floor file says of another one's empty tiles. Nothing on \
                 their tiles works until that is mended, nor do controls with the guard HoldToRun: exchange their \
                 cables or addresses, or let `underfoot wiring` find which board is where",
                others.join(", ")
            );
        }
    }

    /// Returns the state of the link; delays a partial link while boards come back one after the other.
    fn settled(&mut self, state: LinkState, now: Instant) -> LinkState {
        if state != LinkState::Partial {
            self.partial_since = None;
            return state;
        }
        let since = *self.partial_since.get_or_insert(now);
        if now.since(since) < SETTLING { self.state } else { state }
    }

    fn note_tare(&mut self, assembler: &Assembler) {
        let tare = assembler.tare_outcome();
        if tare == self.tare {
            return;
        }
        match tare {
            TareOutcome::Measuring => info!("measuring the tare: keep off the floor"),
            TareOutcome::Taken => info!("tare measured"),
            TareOutcome::Refused { sensor, mean, deviation } => warn!(
                "the floor was never empty and quiet enough to tare: {sensor} read {:.1} N, scattered by {:.1} N; \
                 going on with the floor file's tare",
                mean.0, deviation.0
            ),
            TareOutcome::FromFloor => {}
        }
        self.tare = tare;
    }

    /// Logs which boards repeat the same readings under a load.
    fn note_frozen(&mut self, assembler: &Assembler) {
        let frozen = assembler.counters().frozen;
        if std::mem::replace(&mut self.frozen, frozen) == frozen {
            return;
        }
        let boards = (0_u16..).map_while(|board| Some((board, assembler.board(board)?)));
        for (board, _) in boards.filter(|(_, status)| status.frozen) {
            warn!(
                "board {board}: all its readings have stood still for 100 ms under a load, which no converter does \
                 that works; what was held on its tiles is cancelled. Look at its converters and their clock"
            );
        }
    }

    /// Logs which tiles have sensors that repeat the same readings under a load.
    fn note_repeats(&mut self, assembler: &Assembler, now: Instant) {
        let (count, tiles) = assembler.repeating();
        if std::mem::replace(&mut self.repeats, count) == count {
            return;
        }
        let tiles: Vec<String> = tiles.map(|tile| tile.to_string()).collect();
        if tiles.is_empty() {
            return;
        }
        self.notices.warn(now, || {
            format!(
                "tile {}: two or more sensors have repeated for 100 ms, under a load, what they had read before, which no \
                 converter does that works; what was held there is cancelled. Look at the converter that they share. \
                 Readings without noise of their own need `noiseless: true` in the floor file",
                tiles.join(", ")
            )
        });
    }

    /// Logs once how many sensors count as nominal parts, and which file could calibrate them.
    fn note_uncalibrated(&mut self, assembler: &Assembler, file: &FloorFile) {
        let uncalibrated = assembler.uncalibrated();
        if uncalibrated > self.uncalibrated {
            self.uncalibrated = uncalibrated;
            warn!(
                "{uncalibrated} sensors were never calibrated and count as nominal parts: their forces may be off by \
                 a third. Controls with the guard HoldToRun are off: {}",
                OffReason::NotCalibrated.explain(file)
            );
        }
    }
}
