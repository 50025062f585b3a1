//! Reports on boards, tare and sensors, as of the last packet, poll or frame.

use std::time::Duration;

use super::board::BoardTrack;
use super::numbering::TimeBase;
use super::presence::Presence;
use super::{Assembler, TareOutcome};
use crate::floor::{NoSuchSensor, SensorChoice, SensorId, TileId};
use crate::sense::{Quality, SensorHealth, Trouble};
use crate::units::Newtons;
use crate::wire::{LinkCounters, LinkState};

/// Numbers of packets of one board since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoardCounts {
    /// Packets accepted.
    pub packets: u64,
    /// Packets that did not arrive, by gaps in the sequence numbers.
    pub lost: u64,
    /// Duplicate packets that were dropped.
    pub duplicate: u64,
}

/// State of one board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardStatus {
    /// Quality of all its sensors; a single sensor may be worse.
    pub quality: Quality,
    /// Time since its last usable packet; `None` if none has come.
    pub age: Option<Duration>,
    /// Share of its packets that were lost or too late over the last second, 0 to 1.
    pub loss: f32,
    /// Whether it is stale because all its readings have been constant for 100 ms under a load.
    pub frozen: bool,
    /// Samples by which its crystal has run slower (positive) or faster than the common clock; 0 with a rate of its
    /// own.
    pub slips: i64,
    /// Numbers of its packets.
    pub counts: BoardCounts,
    /// The time of its samples.
    pub timing: BoardTiming,
}

/// The rate of a board, and the time of its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardTiming {
    /// Packets a second, measured or as written in the floor file; 1000 as long as neither is known.
    pub hz: f32,
    /// The source of its samples' times.
    pub base: TimeBase,
    /// Mean error of these times by the way of the packets; zero for a board that sends once a millisecond, whose
    /// samples are a millisecond apart.
    pub jitter: Duration,
}

impl BoardTiming {
    /// A board that sends once a millisecond.
    pub(crate) const MILLISECOND: Self = Self { hz: 1000.0, base: TimeBase::Packets, jitter: Duration::ZERO };

    /// Whether it is worth a report after `told`: another time base, or a rate that differs by more than a percent.
    pub(crate) fn is_news_after(&self, told: &Self) -> bool {
        const MOST: f32 = 0.01;
        self.base != told.base || (self.hz / told.hz - 1.0).abs() > MOST
    }
}

impl BoardTrack {
    fn timing(&self) -> BoardTiming {
        self.own_rate.as_ref().map_or(BoardTiming::MILLISECOND, |own| BoardTiming {
            hz: own.hz(),
            base: own.stream.base(),
            jitter: Duration::from_nanos(own.stream.jitter_ns().max(0).cast_unsigned()),
        })
    }
}

impl Assembler {
    /// State of the link as of the last packet or poll.
    ///
    /// While the boards report for the first time, one after the other, the link is still waiting.
    #[must_use]
    pub fn link_state(&self) -> LinkState {
        let presences = || self.boards.iter().map(|board| &board.stream.presence);
        if self.times.is_gathering() && presences().any(|presence| !presence.has_reported()) {
            LinkState::Waiting
        } else if presences().all(Presence::is_live) {
            LinkState::Live
        } else if presences().any(Presence::is_live) {
            LinkState::Partial
        } else {
            LinkState::Lost
        }
    }

    /// Number of boards with usable packets, as of the last packet or poll, and number of boards of the floor.
    #[must_use]
    pub fn boards_live(&self) -> (u32, u32) {
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let live = self.boards.iter().filter(|board| board.stream.presence.is_live());
        (count(live.count()), count(self.boards.len()))
    }

    /// State of board `number`, as of the last packet or poll; `None` if the floor has no such board.
    #[must_use]
    pub fn board(&self, number: u16) -> Option<BoardStatus> {
        let board = self.boards.get(usize::from(number))?;
        let age = |used: i64| Duration::from_nanos((self.times.now_ns() - used).max(0).cast_unsigned());
        Some(BoardStatus {
            quality: board.quality(),
            age: board.stream.presence.used_ns().map(age),
            loss: board.stream.loss.share(),
            frozen: board.repeats() && !board.stream.presence.is_live(),
            slips: board.stream.slips(),
            counts: board.stream.counts,
            timing: board.timing(),
        })
    }

    /// Result of the tare; if boards differ, the most urgent one.
    #[must_use]
    pub fn tare_outcome(&self) -> TareOutcome {
        let urgency = |outcome: &TareOutcome| match outcome {
            TareOutcome::Measuring => 3,
            TareOutcome::Refused { .. } => 2,
            TareOutcome::Taken => 1,
            TareOutcome::FromFloor => 0,
        };
        let reporting = self.boards.iter().filter(|board| board.stream.presence.has_reported());
        let outcomes = reporting.map(BoardTrack::tare_outcome);
        let unheard = self.boards.first().map_or(TareOutcome::FromFloor, BoardTrack::tare_outcome);
        outcomes.max_by_key(urgency).unwrap_or(unheard)
    }

    /// The tare in use, per tile and corner as in [`crate::floor::Floor::tare`]; zero for sensors without a board.
    #[must_use]
    pub fn tare(&self) -> Vec<[Newtons; 4]> {
        let mut tare = vec![[Newtons::ZERO; 4]; self.floor_tiles];
        for (tile, corner, force) in self.boards.iter().flat_map(BoardTrack::tares) {
            tare[tile][corner.index()] = force;
        }
        tare
    }

    /// Number of sensors whose counts are converted by the nominal part's law, because the floor has no calibration
    /// for them; [`crate::floor::Floor::uncalibrated`] names them. Their forces may be off by a quarter and more, and
    /// are [`Quality::Degraded`].
    #[must_use]
    pub fn uncalibrated(&self) -> usize {
        self.boards.iter().map(BoardTrack::uncalibrated).sum()
    }

    /// Whether, at the start, the empty floor differed from the floor's tare on most of its tiles: the file belongs
    /// to another floor or is outdated. All sensors are [`Quality::Degraded`] then.
    #[must_use]
    pub fn is_foreign(&self) -> bool {
        self.health.is_foreign()
    }

    /// Number of changes of board places, and the boards that have changed places: each misplaced board comes with
    /// the board whose empty tiles it reads, which is misplaced too. Two boards have been swapped, more form a ring.
    /// Their sensors are [`Quality::Faulty`] until they are back in their places. Requires a tare from the floor
    /// file.
    pub fn swapped(&self) -> (u64, impl Iterator<Item = (u16, u16)> + '_) {
        self.swaps.places()
    }

    /// Writes the health of the sensors, as of the last frame, into `health`.
    pub fn health(&self, health: &mut SensorHealth) {
        health.recount(self.frame.quality.iter());
        health.uncalibrated = u32::try_from(self.uncalibrated()).unwrap_or(u32::MAX);
        health.foreign = self.is_foreign();
        health.timings.clear();
        let own = (0..).zip(&self.boards).filter(|(_, board)| board.own_rate.is_some());
        health.timings.extend(own.map(|(number, board)| (number, board.timing())));
        health.troubles.clear();
        health.troubles.extend(self.troubles());
        health
            .troubles
            .sort_by_key(|(sensor, _)| (sensor.tile.row, sensor.tile.column, sensor.corner.index()));
    }

    /// The sensors with faults, as of the last frame.
    pub fn troubles(&self) -> impl Iterator<Item = (SensorId, Trouble)> + '_ {
        self.health.troubles()
    }

    /// Switches sensors off, or on again, from the next frame on: the readings of an off sensor never count, and it is
    /// [`Quality::Faulty`] with [`Trouble::Off`].
    ///
    /// # Errors
    /// [`NoSuchSensor`] if the floor has none of them.
    pub fn switch(&mut self, choice: SensorChoice, on: bool) -> Result<(), NoSuchSensor> {
        let boards = &self.boards;
        let wired = |board: u16, channel: u16| boards.get(usize::from(board))?.sensor(channel.into());
        for sensor in choice.wired(self.health.geometry(), wired)? {
            self.health.switch(sensor, on);
        }
        Ok(())
    }

    /// Number of times that a sensor fault began or ended; constant as long as [`Assembler::troubles`] is.
    #[must_use]
    pub const fn trouble_changes(&self) -> u64 {
        self.health.changes()
    }

    /// Drift of each sensor's zero from its tare, as tracked, per tile and corner as in [`crate::floor::Floor::tare`];
    /// at most 20 % of the sensor's range.
    #[must_use]
    pub fn drift(&self) -> impl ExactSizeIterator<Item = [Newtons; 4]> + '_ {
        self.health.drift()
    }

    /// Estimated creep of the floor's sensors, as a share of their load for each decade of time: 0 to 0.1. The creep
    /// correction is proportional to it; below 0.02 there is none.
    #[must_use]
    pub const fn creep(&self) -> f32 {
        self.health.creep()
    }

    /// Counters of received and dropped packets; the source counts datagrams and refusals.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        LinkCounters {
            sensor_troubles: self.health.found(),
            jumps: self.jumps().0,
            repeats: self.repeating().0,
            ..self.counters
        }
    }

    /// Number of changes of a tile's load that are faster than those by a body (300 N in a millisecond), and the last
    /// such tile with its change in newtons. Such a tile is [`Quality::Faulty`] for 100 ms.
    #[must_use]
    pub fn jumps(&self) -> (u64, Option<(TileId, f32)>) {
        self.health.jumps()
    }

    /// Number of times that two or more sensors of a tile have repeated their readings for 100 ms under a load
    /// although their noise makes that improbable, and the tiles with such sensors now or in the last 100 ms. These
    /// are [`Quality::Stale`].
    pub fn repeating(&self) -> (u64, impl Iterator<Item = TileId> + '_) {
        self.health.repeating()
    }
}
