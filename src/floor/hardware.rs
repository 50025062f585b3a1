use super::{Corner, Geometry, SensorId, TileId};
use crate::units::Newtons;

/// Everything underfoot knows of one floor: geometry, boards, calibration, actuators.
///
/// The per-tile vectors are in tile-index order and as long as
/// [`Geometry::tile_count`]; [`Floor::of`] makes a consistent one to start from.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// Where tiles and sensors are.
    pub geometry: Geometry,
    /// The acquisition boards; a board's position in this list is its number.
    pub boards: Vec<Board>,
    /// Calibration of each tile's sensors, in [`Corner::ALL`] order.
    pub calibration: Vec<[Calibration; 4]>,
    /// Force each sensor reads on the empty floor, taken off every reading.
    pub tare: Vec<[Newtons; 4]>,
    /// The actuator under each tile; `None` where there is none.
    pub actuators: Vec<Option<Actuator>>,
}

impl Floor {
    /// A floor of this geometry wired like the paper's: each row of tiles on its
    /// own boards (up to eight tiles a board, four channels a tile, sw se nw ne),
    /// nominal calibration, no tare, actuator channel = tile index.
    #[must_use]
    pub fn of(geometry: Geometry) -> Self {
        let tiles = geometry.tile_count();
        Self {
            boards: boards_by_row(&geometry),
            calibration: vec![[Calibration::NOMINAL; 4]; tiles],
            tare: vec![[Newtons::ZERO; 4]; tiles],
            actuators: (0..tiles).map(|channel| Some(Actuator::nominal(channel as u16))).collect(),
            geometry,
        }
    }

    /// The sensors whose calibration is the nominal part's, to the digit: nobody has measured them.
    ///
    /// On a floor whose boards send newtons that is as it should be.
    pub fn uncalibrated(&self) -> impl Iterator<Item = SensorId> + '_ {
        self.geometry.tiles().zip(&self.calibration).flat_map(|(tile, laws)| {
            let nominal = |corner: &Corner| laws[corner.index()] == Calibration::NOMINAL;
            Corner::ALL.into_iter().filter(nominal).map(move |corner| SensorId { tile, corner })
        })
    }

    /// Number of actuator channels a device must have for this floor: the highest channel used plus one.
    #[must_use]
    pub fn channel_count(&self) -> usize {
        self.actuators.iter().flatten().map(|actuator| usize::from(actuator.channel) + 1).max().unwrap_or(0)
    }
}

impl Default for Floor {
    /// The paper's 6 x 6 floor: six boards, 144 sensors, 36 actuators.
    fn default() -> Self {
        Self::of(Geometry::default())
    }
}

/// One acquisition board: where its packets come from and what each argument measures.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// OSC address of its packets, `/underfoot/board/<number>` unless told otherwise.
    pub address: String,
    /// The sensor on each channel, in argument order; `None` for an unused channel.
    pub channels: Vec<Option<SensorId>>,
}

/// The exponential law of one force sensor.
///
/// # Source
/// `f = a exp(b v)` (paper, section 2.2), v in volts, f in newtons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// Factor a, in newtons; positive.
    pub a_n: f32,
    /// Exponent b, per volt; positive.
    pub b_per_volt: f32,
}

impl Calibration {
    /// The part underfoot assumes where nothing was measured: 0.5 N at 0 V, 406 N at 5 V (our choice).
    pub const NOMINAL: Self = Self { a_n: 0.5, b_per_volt: 1.34 };

    /// Voltage at the converter's full scale.
    pub const FULL_SCALE_VOLTS: f32 = 5.0;

    /// The voltage behind a raw 16-bit reading: 0 to 5 V.
    #[must_use]
    pub fn volts(counts: u16) -> f32 {
        f32::from(counts) * (Self::FULL_SCALE_VOLTS / f32::from(u16::MAX))
    }

    /// The force that a raw 16-bit reading stands for, tare not yet taken off.
    #[must_use]
    pub fn force(&self, counts: u16) -> Newtons {
        Newtons(self.a_n * (self.b_per_volt * Self::volts(counts)).exp())
    }
}

/// The vibrotactile actuator under one tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// Output channel of the audio device, from 0.
    pub channel: u16,
    /// Force at the plate for a full-scale sample, in newtons; positive.
    pub full_scale: Newtons,
}

impl Actuator {
    /// The actuator on `channel` with the paper's 40 N at full scale.
    #[must_use]
    pub const fn nominal(channel: u16) -> Self {
        Self { channel, full_scale: Newtons(40.0) }
    }
}

/// The most tiles one 32-channel board serves.
const TILES_PER_BOARD: u16 = 8;

fn boards_by_row(geometry: &Geometry) -> Vec<Board> {
    let mut boards = Vec::new();
    for row in 0..geometry.rows() {
        for west in (0..geometry.columns()).step_by(TILES_PER_BOARD.into()) {
            let east = (west + TILES_PER_BOARD).min(geometry.columns());
            let channels = (west..east)
                .flat_map(|column| {
                    let tile = TileId::new(column, row);
                    Corner::ALL.map(|corner| Some(SensorId { tile, corner }))
                })
                .collect();
            boards.push(Board { address: format!("/underfoot/board/{}", boards.len()), channels });
        }
    }
    boards
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_floor_has_one_board_of_24_channels_per_row() {
        let floor = Floor::default();
        assert_eq!(floor.boards.len(), 6);
        assert!(floor.boards.iter().all(|board| board.channels.len() == 24));
        assert_eq!(floor.boards[2].address, "/underfoot/board/2");
        let second_tile_nw = floor.boards[2].channels[6].unwrap();
        assert_eq!(second_tile_nw, SensorId { tile: TileId::new(1, 2), corner: Corner::NorthWest });
        assert_eq!(floor.channel_count(), 36);
    }

    #[test]
    fn wide_rows_are_shared_by_boards_of_at_most_32_channels() {
        let floor = Floor::of(Geometry::of_paper_tiles(24, 2).unwrap());
        assert_eq!(floor.boards.len(), 6);
        assert!(floor.boards.iter().all(|board| board.channels.len() == 32));
    }

    #[test]
    fn nominal_part_spans_half_a_newton_to_400() {
        let part = Calibration::NOMINAL;
        assert!((part.force(0).0 - 0.5).abs() < 1e-6);
        assert!((400.0..410.0).contains(&part.force(u16::MAX).0));
    }
}
