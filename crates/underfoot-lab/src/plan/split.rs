//! How a floor is cut into areas of nearly equal size.

use serde::Serialize;

use super::area_demand::Extent;
use super::datagram::{on_wire, sensor_packet};
use super::limit::{first, limits};
use super::{AreaDemand, Crowd, FloorSize, Machine, PlanError};
use underfoot::floor::SENSED_BEYOND_M;
use underfoot::wire::SensorFormat;

/// Pitch of the paper's tiles (m).
const PITCH_M: f32 = 0.304;

/// Number of adjacent tiles that one board of 32 channels reads.
const BOARD_TILES: u32 = 8;

/// A floor cut into `across` x `up` areas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Split {
    /// Areas from west to east.
    pub across: u32,
    /// Areas from south to north.
    pub up: u32,
}

impl Split {
    /// One area: the whole floor.
    pub(super) const WHOLE: Self = Self { across: 1, up: 1 };

    /// Returns the number of areas.
    #[must_use]
    pub const fn areas_count(&self) -> u32 {
        self.across * self.up
    }

    /// Returns the demand of each area, row by row from the south-west.
    pub(super) fn areas(&self, size: FloorSize, crowd: &Crowd) -> Vec<AreaDemand> {
        let boards = Boards::of(size, crowd.format);
        let columns = boards.along(size.columns, self.across);
        let rows = rows(size.rows, self.up);
        rows.iter().flat_map(|row| columns.iter().map(|column| demand(column, row, size, crowd))).collect()
    }
}

/// Tiles from `first` up to but excluding `end` on one axis, and the sensed range around them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    first: u32,
    end: u32,
    sensed: (u32, u32),
}

/// Returns the number of boards of a floor of this size.
pub(super) fn boards(size: FloorSize) -> u32 {
    size.columns.div_ceil(BOARD_TILES).saturating_mul(size.rows)
}

/// Range of the boards in a row with sensors in the sensed part of a span: first, and end (exclusive).
fn sensing(span: Span) -> (u32, u32) {
    (span.sensed.0 / BOARD_TILES, span.sensed.1.div_ceil(BOARD_TILES))
}

/// Load of a span along its axis.
#[derive(Clone, Copy, Debug, Default)]
struct Along {
    own: u32,
    sensed: u32,
    /// Boards of each row with sensors in the sensed part of the span; bytes of their packets.
    boards: u32,
    bytes: f64,
    /// Boards of each row that send to this span's computer (their home), or rows of its own; bytes of their packets.
    home: u32,
    home_bytes: f64,
    /// The same boards or rows, each counted once for every span that senses it; bytes of their packets.
    copies: u32,
    copied_bytes: f64,
    /// Number of spans, including itself, that are homes of boards or rows sensed by this span.
    homes: u32,
}

/// Divides `length` tiles into `parts` spans of nearly equal length.
fn spans(length: u32, parts: u32) -> impl DoubleEndedIterator<Item = Span> + ExactSizeIterator {
    let beyond = (SENSED_BEYOND_M / PITCH_M).ceil() as u32;
    let cut = move |part: u32| (u64::from(part) * u64::from(length) / u64::from(parts.max(1))) as u32;
    (0..parts).map(move |part| {
        let (first, end) = (cut(part), cut(part + 1));
        Span { first, end, sensed: (first.saturating_sub(beyond), (end + beyond).min(length)) }
    })
}

fn along(span: Span) -> Along {
    Along { own: span.end - span.first, sensed: span.sensed.1 - span.sensed.0, ..Along::default() }
}

/// For each of `count` positions, the number of spans that cover it.
fn covers(count: u32, spans: impl Iterator<Item = (u32, u32)>) -> Vec<u32> {
    let mut changes = vec![0_i64; count as usize + 1];
    for (from, to) in spans {
        changes[from as usize] += 1;
        changes[to as usize] -= 1;
    }
    let mut sum = 0;
    let sums = changes.iter().take(count as usize).map(|change| {
        sum += change;
        sum as u32
    });
    sums.collect()
}

/// Load of each of `up` spans over `length` rows.
fn rows(length: u32, up: u32) -> Vec<Along> {
    let all: Vec<Span> = spans(length, up).collect();
    let sensed = covers(length, all.iter().map(|span| span.sensed));
    let row = |span: &Span| {
        let copies = sensed[span.first as usize..span.end as usize].iter().sum();
        let before = all.partition_point(|other| other.end <= span.sensed.0);
        let homes = all.partition_point(|other| other.first < span.sensed.1) - before;
        Along { home: span.end - span.first, copies, homes: homes as u32, ..along(*span) }
    };
    all.iter().map(row).collect()
}

/// Boards of a floor: each row has its own, with eight tiles each.
struct Boards {
    columns: u32,
    /// Bytes on the wire of a full board's packet, and of the packet of the last board in a row.
    full: f64,
    last: f64,
}

impl Boards {
    fn of(size: FloorSize, format: SensorFormat) -> Self {
        let number = boards(size);
        let letters =
            "/underfoot/board/".len() as u32 + number.saturating_sub(1).checked_ilog10().unwrap_or(0) + 1;
        let bytes = |tiles: u32| f64::from(on_wire(sensor_packet(letters, 4 * tiles, format)));
        let rest = size.columns % BOARD_TILES;
        Self {
            columns: size.columns,
            full: bytes(BOARD_TILES),
            last: bytes(if rest == 0 { BOARD_TILES } else { rest }),
        }
    }

    /// Load of the boards of one row with sensors in the sensed part of a span.
    fn span(&self, span: Span) -> Along {
        let (from, to) = sensing(span);
        let bytes = (from..to).map(|board| self.bytes(board)).sum();
        Along { boards: to - from, bytes, ..along(span) }
    }

    /// Bytes on the wire of the packet of one board in a row.
    fn bytes(&self, board: u32) -> f64 {
        if board + 1 == self.columns.div_ceil(BOARD_TILES) { self.last } else { self.full }
    }

    /// Load of each of `across` spans in a row.
    fn along(&self, length: u32, across: u32) -> Vec<Along> {
        let mut all: Vec<Along> = spans(length, across).map(|span| self.span(span)).collect();
        let sensed = covers(length.div_ceil(BOARD_TILES), spans(length, across).map(sensing));
        let home = |board: u32| {
            let (west, east) = (board * BOARD_TILES, (board + 1) * BOARD_TILES);
            let tiles = |span: Span| span.end.min(east).saturating_sub(span.first.max(west));
            // If several spans have equally many of its tiles, the first is its home; `max_by_key` returns the last
            // of equals, hence `rev`.
            let number = spans(length, across).enumerate().rev().max_by_key(|(_, span)| tiles(*span));
            number.map(|(number, _)| number)
        };
        let homes: Vec<Option<usize>> = (0..).zip(&sensed).map(|(board, _)| home(board)).collect();
        for (span, along) in spans(length, across).zip(&mut all) {
            let (from, to) = sensing(span);
            // Homes are in the order of the boards, so equal homes are adjacent.
            let of_boards = homes[from as usize..to as usize].chunk_by(|one, next| one == next);
            along.homes = of_boards.count() as u32;
        }
        for ((board, copies), home) in (0..).zip(sensed).zip(&homes) {
            let Some(home) = home.and_then(|home| all.get_mut(home)) else { continue };
            let bytes = self.bytes(board);
            home.home += 1;
            home.home_bytes += bytes;
            home.copies += copies;
            home.copied_bytes += f64::from(copies) * bytes;
        }
        all
    }
}

fn demand(column: &Along, row: &Along, size: FloorSize, crowd: &Crowd) -> AreaDemand {
    let extent = Extent {
        columns: column.own,
        rows: row.own,
        sensed_columns: column.sensed,
        sensed_rows: row.sensed,
        boards: column.boards * row.sensed,
        bytes: column.bytes * f64::from(row.sensed),
        // The home receives the packet directly from the board.
        forwards: (column.copies * row.copies).saturating_sub(column.home * row.home),
        forwarded_bytes: (column.copied_bytes * f64::from(row.copies)
            - column.home_bytes * f64::from(row.home))
        .max(0.0),
        // An area narrower than a board may be the home of no board.
        forwarders: (column.homes * row.homes).saturating_sub(u32::from(column.home * row.home > 0)),
        channels: if size.actuators { column.own * row.own } else { 0 },
    };
    AreaDemand::new("", &extent, f64::from(size.columns) * f64::from(size.rows), crowd)
}

/// The maximum of each number over all spans. The home numbers are subtracted later, so they are the minimum.
fn most(all: &[Along]) -> Along {
    let all = all.iter().copied().reduce(|most, one| Along {
        own: most.own.max(one.own),
        sensed: most.sensed.max(one.sensed),
        boards: most.boards.max(one.boards),
        bytes: most.bytes.max(one.bytes),
        home: most.home.min(one.home),
        home_bytes: most.home_bytes.min(one.home_bytes),
        copies: most.copies.max(one.copies),
        copied_bytes: most.copied_bytes.max(one.copied_bytes),
        homes: most.homes.max(one.homes),
    });
    all.unwrap_or_default()
}

/// Returns the fewest areas that fit; among equal counts, the areas nearest to squares.
///
/// # Errors
/// [`PlanError::TooMuch`] if single tiles do not fit.
pub(super) fn fewest(size: FloorSize, crowd: &Crowd, machine: &Machine) -> Result<Split, PlanError> {
    let boards = Boards::of(size, crowd.format);
    let rows: Vec<Along> = (1..=size.rows).map(|up| most(&rows(size.rows, up))).collect();
    let mut best: Option<(u32, u32, Split)> = None;
    let mut runs_out = "sensing";
    for across in 1..=size.columns {
        if best.is_some_and(|(count, ..)| across > count) {
            break;
        }
        let column = most(&boards.along(size.columns, across));
        let fits = |row: &Along| first(&limits(&demand(&column, row, size, crowd), machine, crowd.usable));
        // More areas are smaller, but each has more neighbours: a number of areas may fit while a larger number does
        // not.
        let no_more_than_best =
            best.map_or(rows.len(), |(count, ..)| rows.len().min((count / across) as usize));
        let Some(up) = rows[..no_more_than_best].iter().position(|row| fits(row).share <= 1.0) else {
            if let Some(row) = rows.last() {
                runs_out = fits(row).resource.name();
            }
            continue;
        };
        let row = &rows[up];
        let split = Split { across, up: up as u32 + 1 };
        let key = (split.across.saturating_mul(split.up), column.own.abs_diff(row.own), split);
        if best.is_none_or(|(count, oblong, _)| (key.0, key.1) < (count, oblong)) {
            best = Some(key);
        }
    }
    best.map(|(.., split)| split).ok_or(PlanError::TooMuch { what: runs_out })
}

#[cfg(test)]
mod tests {
    use super::super::machine::tests::ROUND;
    use super::*;
    use underfoot::floor::{Area, Floor, Geometry, TileBlock, TileId};

    const HALL: FloorSize = FloorSize { columns: 24, rows: 12, actuators: true };

    #[test]
    fn areas_by_size_ask_as_much_as_areas_by_a_file() {
        // Includes sides that the number of areas or boards does not divide evenly.
        for (columns, rows, across, up) in [(24, 12, 2, 2), (24, 12, 3, 1), (23, 13, 3, 2), (9, 5, 9, 1)] {
            let size = FloorSize { columns, rows, actuators: true };
            let crowd = Crowd::of(40);
            let split = Split { across, up };
            let cut = |parts, length, part| part * length / parts;
            let areas: Vec<Area> = (0..up)
                .flat_map(|row| (0..across).map(move |column| (column, row)))
                .map(|(column, row)| {
                    let (west, south) = (cut(across, columns, column), cut(up, rows, row));
                    let (east, north) = (cut(across, columns, column + 1), cut(up, rows, row + 1));
                    let tiles = TileBlock {
                        first: TileId::new(west as u16, south as u16),
                        columns: (east - west) as u16,
                        rows: (north - south) as u16,
                    };
                    let listen = Some(([127, 0, 0, 1], (row * across + column) as u16 + 9000).into());
                    Area { listen, ..Area::new(&format!("{column} {row}"), tiles) }
                })
                .collect();
            let geometry = Geometry::of_paper_tiles(columns as u16, rows as u16).unwrap();
            let floor = Floor::of(geometry).with_areas(areas);
            let by_file: Vec<_> =
                floor.areas.iter().map(|area| AreaDemand::of(&floor, area, &crowd)).collect();
            let name = |area: AreaDemand| AreaDemand { id: String::new(), ..area };
            let by_file: Vec<_> = by_file.into_iter().map(name).collect();
            let by_size = split.areas(size, &crowd);
            // The file's addresses have one or two digits, and the size-based plan uses the longest. Both strings
            // have the same length after padding to four bytes.
            assert_eq!(by_size, by_file, "{size:?} {split:?}");
        }
    }

    #[test]
    fn a_floor_that_fits_is_not_cut() {
        assert_eq!(
            fewest(FloorSize { columns: 6, rows: 6, actuators: true }, &Crowd::of(2), &ROUND),
            Ok(Split::WHOLE)
        );
    }

    #[test]
    fn channels_decide_where_there_are_few() {
        // 288 actuators on cards of 64 channels: at least five areas, of 24 / 5 x 12 tiles; six of 8 x 6 fit.
        let split = fewest(HALL, &Crowd::of(2), &ROUND).unwrap();
        assert_eq!(split.areas_count(), 5);
        assert_eq!(split, Split { across: 5, up: 1 }, "five columns of 12 tiles are 60 channels");
        let silent = FloorSize { actuators: false, ..HALL };
        assert_eq!(fewest(silent, &Crowd::of(2), &ROUND), Ok(Split::WHOLE));
    }

    #[test]
    fn people_decide_where_there_are_many() {
        // 500 us less the fixed 20 + 36 x 1 + 288 x 0.2 us leave room for 38 people on the whole floor.
        let silent = FloorSize { actuators: false, ..HALL };
        let even = |people| Crowd { crowding: 1.0, ..Crowd::of(people) };
        assert_eq!(fewest(silent, &even(38), &ROUND).unwrap().areas_count(), 1);
        // With one more person: two halves of 12 x 12, and each senses 15 x 12.
        assert_eq!(fewest(silent, &even(39), &ROUND), Ok(Split { across: 2, up: 1 }));
    }

    #[test]
    fn what_fits_nowhere_is_told() {
        let packed = Crowd::of(1_000_000);
        let found = fewest(HALL, &packed, &ROUND);
        assert_eq!(found, Err(PlanError::TooMuch { what: "sensing thread" }));
    }
}
