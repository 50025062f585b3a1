//! A tare taken for a floor file.

use std::time::Duration;

use thiserror::Error;

use crate::floor::{Corner, Floor, SensorId, TileId};
use crate::sense::{Assembler, Quality, Tare, TareOutcome, TareRules};
use crate::source::{SensorSource, SourceError};
use crate::units::Newtons;

/// Why no tare was taken. The floor's own is still what it was.
#[derive(Debug, Error)]
pub enum TareFailure {
    /// The packets' source failed or ended.
    #[error("{0}")]
    Source(#[from] SourceError),
    /// Boards of the floor sent nothing.
    #[error("nothing came from {}: is the floor switched on, and does it send here?", boards.join(", "))]
    Silent {
        /// Their OSC addresses.
        boards: Vec<String>,
    },
    /// The stream kept breaking off.
    #[error("the packets keep breaking off, so nothing could be averaged for {:.1} s", span.as_secs_f32())]
    Broken {
        /// The time that was to be averaged.
        span: Duration,
    },
    /// Somebody or something is on the floor.
    #[error(
        "the floor is not empty and quiet: the sensor of {sensor} read {:.1} N and scattered by {:.2} N \
         (at most {:.0} N and {:.1} N on an empty floor); clear the floor and try again",
        mean.0, deviation.0, rules.most.0, rules.quiet.0
    )]
    NotQuiet {
        /// The worst sensor.
        sensor: SensorId,
        /// What it read on average.
        mean: Newtons,
        /// By how much its readings scattered.
        deviation: Newtons,
        /// What would have been quiet.
        rules: TareRules,
    },
    /// A sensor gave no number.
    #[error("the sensor of {sensor} gives no reading")]
    Unread {
        /// Which sensor.
        sensor: SensorId,
    },
    /// A tile weighs otherwise than when the floor was tared last.
    #[error(
        "tile {tile} carries {:+.1} N more than at the last tare: is something standing on it? \
         If the floor itself was changed, take the change as it is",
        change.0
    )]
    Changed {
        /// Which tile changed most.
        tile: TileId,
        /// By how much.
        change: Newtons,
    },
}

/// The change of a tile since the last tare from which on something stands on it: far more than
/// four sensors drift in a day, less than a bag (our choice).
const MOST_CHANGE: Newtons = Newtons(15.0);

/// How long after the patience is over packets may still be under way.
const GRACE: Duration = Duration::from_millis(200);

/// The tare of a floor that is provably empty and quiet: what each sensor reads, in newtons
/// ([`Floor::tare`]'s order). Sensors that no board reads keep what the floor has.
///
/// Takes packets from `source` for at most `patience`, and averages the first
/// quiet half second of each board. Where the floor was tared before, no tile may weigh
/// 15 N more or less than then, unless `accept_change`.
///
/// # Errors
/// [`TareFailure`] names the board, tile or sensor that caused it.
pub fn take_tare(
    source: &mut dyn SensorSource,
    floor: &Floor,
    patience: Duration,
    accept_change: bool,
) -> Result<Vec<[Newtons; 4]>, TareFailure> {
    let rules = TareRules { patience, ..TareRules::default() };
    let mut assembler = Assembler::with_tare(floor, Tare::AtStart(rules));
    let until = source.now() + patience + rules.span + GRACE;
    let mut faulty = None;
    let mut framed = false;
    loop {
        match source.next(Duration::from_millis(5))? {
            Some(packet) => assembler.take(&packet),
            None => assembler.poll(source.now()),
        }
        while let Some(frame) = assembler.ready() {
            framed = true;
            faulty = frame.quality.iter().enumerate().find_map(|(tile, quality)| {
                let corner = Corner::ALL.into_iter().find(|c| quality[c.index()] == Quality::Faulty)?;
                Some(SensorId { tile: floor.geometry.tile_at_index(tile), corner })
            });
        }
        let silent = || {
            let unheard =
                |number: &usize| assembler.board(*number as u16).is_none_or(|board| board.age.is_none());
            let numbers = (0..floor.boards.len()).filter(unheard);
            numbers.map(|number| floor.boards[number].address.clone()).collect::<Vec<_>>()
        };
        match assembler.tare_outcome() {
            TareOutcome::Taken if framed && silent().is_empty() => break,
            TareOutcome::Refused { sensor, mean, deviation } => {
                return Err(TareFailure::NotQuiet { sensor, mean, deviation, rules });
            }
            _ if source.now() < until => {}
            _ => {
                let boards = silent();
                return Err(if boards.is_empty() {
                    TareFailure::Broken { span: rules.span }
                } else {
                    TareFailure::Silent { boards }
                });
            }
        }
    }
    if let Some(sensor) = faulty {
        return Err(TareFailure::Unread { sensor });
    }
    let tare = merged(floor, &assembler.tare());
    match changed(floor, &tare) {
        Some((tile, change)) if !accept_change => Err(TareFailure::Changed { tile, change }),
        _ => Ok(tare),
    }
}

/// `measured` where boards read sensors, the floor's own elsewhere.
fn merged(floor: &Floor, measured: &[[Newtons; 4]]) -> Vec<[Newtons; 4]> {
    let mut tare = floor.tare.clone();
    for sensor in floor.boards.iter().flat_map(|board| board.channels.iter().flatten()) {
        let Some(tile) = floor.geometry.index(sensor.tile) else { continue };
        if let (Some(tare), Some(measured)) = (tare.get_mut(tile), measured.get(tile)) {
            tare[sensor.corner.index()] = measured[sensor.corner.index()];
        }
    }
    tare
}

/// The tile whose weight changed most since the floor was tared, if that is too much.
fn changed(floor: &Floor, tare: &[[Newtons; 4]]) -> Option<(TileId, Newtons)> {
    floor.tared?;
    let weight = |tare: &[Newtons; 4]| tare.iter().map(|tare| tare.0).sum::<f32>();
    let changes = floor.tare.iter().zip(tare).map(|(old, new)| weight(new) - weight(old)).enumerate();
    let (tile, change) = changes.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    (change.abs() > MOST_CHANGE.0).then(|| (floor.geometry.tile_at_index(tile), Newtons(change)))
}
