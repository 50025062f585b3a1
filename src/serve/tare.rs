//! A tare taken for a floor file.

use std::time::Duration;

use thiserror::Error;

use crate::floor::{Corner, Floor, SensorId, TileId};
use crate::sense::{Assembler, Quality, Tare, TareOutcome, TareRules};
use crate::source::{SensorSource, SourceError};
use crate::units::Newtons;

/// Reasons why taking a tare failed. The floor's own tare is unchanged.
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
    /// The packet stream was interrupted repeatedly.
    #[error("the packets keep breaking off, so nothing could be averaged for {:.1} s", span.as_secs_f32())]
    Broken {
        /// The time over which readings are averaged.
        span: Duration,
    },
    /// The floor is not empty.
    #[error(
        "the floor is not empty and quiet: the sensor of {sensor} read {:.1} N and scattered by {:.2} N \
         (at most {:.0} N and {:.1} N on an empty floor); clear the floor and try again",
        mean.0, deviation.0, rules.most.0, rules.quiet.0
    )]
    NotQuiet {
        /// The worst sensor.
        sensor: SensorId,
        /// The mean of its readings.
        mean: Newtons,
        /// The standard deviation of its readings.
        deviation: Newtons,
        /// Limits for a quiet floor.
        rules: TareRules,
    },
    /// A sensor gave no reading.
    #[error("the sensor of {sensor} gives no reading")]
    Unread {
        /// The sensor.
        sensor: SensorId,
    },
    /// The weight of a tile differs from that at the last tare.
    #[error(
        "tile {tile} carries {:+.1} N more than at the last tare: is something standing on it? \
         If the floor itself was changed, take the change as it is",
        change.0
    )]
    Changed {
        /// The tile with the greatest change.
        tile: TileId,
        /// The change in newtons.
        change: Newtons,
    },
}

/// Change of a tile since the last tare above which a load rests on it: far more than four sensors drift in a day,
/// less than a bag (our choice).
const MOST_CHANGE: Newtons = Newtons(15.0);

/// Time after the end of the patience during which packets may still arrive.
const GRACE: Duration = Duration::from_millis(200);

/// Measures the tare of a floor that is provably empty and quiet: the reading of each sensor, in newtons
/// ([`Floor::tare`]'s order). Sensors that no board reads keep the value of the floor.
///
/// Takes packets from `source` for at most `patience`, and averages the first quiet half second of each board. If the
/// floor has a tare, no tile may differ by more than 15 N from it, unless `accept_change`.
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

/// Returns `measured` where boards read sensors, the floor's own tare elsewhere.
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

/// Returns the tile with the greatest change since the floor was tared, if the change is too large.
fn changed(floor: &Floor, tare: &[[Newtons; 4]]) -> Option<(TileId, Newtons)> {
    floor.tared?;
    let weight = |tare: &[Newtons; 4]| tare.iter().map(|tare| tare.0).sum::<f32>();
    let changes = floor.tare.iter().zip(tare).map(|(old, new)| weight(new) - weight(old)).enumerate();
    let (tile, change) = changes.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    (change.abs() > MOST_CHANGE.0).then(|| (floor.geometry.tile_at_index(tile), Newtons(change)))
}
