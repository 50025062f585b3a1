//! Tiles, channels and tables in floor files.

use std::ops::Range;

use super::node::Node;
use super::problem::Problem;
use crate::floor::{Corner, Geometry, Response, SensorId, TileId};
use underfoot_format::codec::By;
use underfoot_format::describe::FieldType;
use underfoot_format::text::RonText;
use underfoot_format::{Codec, Includes, Name};

/// The tiles that are valid in a file: those on the floor, or all if its geometry could not be read.
#[derive(Clone, Copy)]
pub(super) struct ValidTiles(pub(super) Option<Geometry>);

impl Includes<Self> for ValidTiles {
    fn included(&self) -> &Self {
        self
    }
}

impl ValidTiles {
    /// Reads a cell of the grid, with or without a tile.
    fn cell(self, column: Node<'_>, row: Node<'_>) -> Option<TileId> {
        let block = self.0.map(|geometry| geometry.block());
        let any = 0..Geometry::FARTHEST + 1 + Geometry::MAX_SIDE;
        tile(column, row, block.map_or([any.clone(), any], |block| [block.column_range(), block.row_range()]))
    }

    fn tile(self, column: Node<'_>, row: Node<'_>) -> Option<TileId> {
        let tile = self.cell(column, row)?;
        if self.0.is_some_and(|geometry| geometry.is_missing(tile)) {
            let problem = Problem::error(column.span(), format!("tile {tile} is missing on this floor"));
            let problem = problem.expected("expected a tile of the floor");
            column.report(problem.help("`missing` lists the cells without a tile"));
            return None;
        }
        Some(tile)
    }

    /// Reads the name or the number of a sensor, whichever the floor's sensors have.
    fn sensor(self, node: Node<'_>) -> Option<SensorName> {
        let numbered = self.0.map_or(node.peek_number().is_some(), |geometry| !geometry.has_corners());
        if numbered {
            return node
                .whole(0..=3)
                .map(|number| SensorName { sensor: Corner::ALL[number as usize], numbered });
        }
        Name.read(node, None, &()).map(|sensor| SensorName { sensor, numbered })
    }
}

/// A sensor of a tile as files write it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SensorName {
    pub(super) sensor: Corner,
    /// Whether it has a number, since the file gives its place, instead of the name of a corner.
    numbered: bool,
}

impl SensorName {
    /// The name of `sensor` on a floor of this `geometry`.
    pub(super) fn of(sensor: Corner, geometry: &Geometry) -> Self {
        Self { sensor, numbered: !geometry.has_corners() }
    }

    fn text(&self) -> RonText {
        if self.numbered { RonText::Whole(self.sensor.index() as i64) } else { Name.write(&self.sensor) }
    }
}

/// A sensor of a tile, by name or number.
pub(super) const SENSOR: By<SensorName, ValidTiles> = By {
    shape: || FieldType::Words("Sw, Se, Nw or Ne; 0 to 3 where `sensors_m` gives the places of sensors"),
    read: |node, valid| valid.sensor(node),
    write: SensorName::text,
    stand_in: || SensorName { sensor: Corner::SouthWest, numbered: false },
};

/// Reads a tile within these columns and rows.
pub(super) fn tile(column: Node<'_>, row: Node<'_>, [columns, rows]: [Range<u16>; 2]) -> Option<TileId> {
    let number = |name, node: Node<'_>, range: Range<u16>| {
        Node { name, ..node }.whole(range.start.into()..=u32::from(range.end) - 1)
    };
    let (column, row) = (number("column", column, columns), number("row", row, rows));
    Some(TileId::new(column? as u16, row? as u16))
}

/// A tile, as `(column, row)`.
pub(super) const TILE: By<TileId, ValidTiles> = By {
    shape: || FieldType::Words("(column, row), each a whole number from 0"),
    read: |node, valid| {
        let [column, row] = node.tuple("(column, row)")?;
        valid.tile(column, row)
    },
    write: |tile| RonText::Tuple(whole([tile.column, tile.row])),
    stand_in: TileId::default,
};

/// A cell of the grid, with or without a tile, as `(column, row)`.
pub(super) const CELL: By<TileId, ValidTiles> = By {
    read: |node, valid| {
        let [column, row] = node.tuple("(column, row)")?;
        valid.cell(column, row)
    },
    ..TILE
};

pub(super) fn whole(numbers: [u16; 2]) -> Vec<RonText> {
    numbers.into_iter().map(|number| RonText::Whole(number.into())).collect()
}

/// Width and depth in tiles, as `(columns, rows)`.
pub(super) const TILES: By<[u16; 2]> = By {
    shape: || FieldType::Words("(columns, rows), each a whole number from 1"),
    read: |node, ()| {
        let sides = node.tuple::<2>("(columns, rows)")?;
        let [columns, rows] = sides.map(|side| side.whole(1..=Geometry::MAX_SIDE.into()));
        Some([columns? as u16, rows? as u16])
    },
    write: |sides| RonText::Tuple(whole(*sides)),
    stand_in: || [1, 1],
};

/// The sensor on a channel of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ChannelSensor {
    tile: TileId,
    name: SensorName,
}

impl ChannelSensor {
    /// The name of `sensor` on a floor of this `geometry`.
    pub(super) fn of(sensor: SensorId, geometry: &Geometry) -> Self {
        Self { tile: sensor.tile, name: SensorName::of(sensor.corner, geometry) }
    }

    pub(super) const fn id(self) -> SensorId {
        SensorId { tile: self.tile, corner: self.name.sensor }
    }
}

/// The sensor on a channel, as `(column, row, corner)`, or `None`.
pub(super) const CHANNEL: By<Option<ChannelSensor>, ValidTiles> = By {
    shape: || FieldType::Words("(column, row, Sw), or None for a channel without a sensor"),
    read: |node, valid| {
        if node.is_none() {
            return Some(None);
        }
        let [column, row, name] = node.tuple("(column, row, corner)")?;
        let tile = valid.tile(column, row);
        let name = valid.sensor(Node { name: "corner", ..name });
        Some(Some(ChannelSensor { tile: tile?, name: name? }))
    },
    write: |sensor| {
        sensor.map_or(RonText::Nothing, |ChannelSensor { tile, name }| {
            let mut values = whole([tile.column, tile.row]);
            values.push(name.text());
            RonText::Tuple(values)
        })
    },
    stand_in: || None,
};

/// Lists of numbers, each from minus this value to this value.
pub(super) struct Table(pub(super) f32);

impl<const ROWS: usize, const COLUMNS: usize> Codec<[[f32; COLUMNS]; ROWS]> for Table {
    type Context = ();

    fn read(
        &self,
        node: Node<'_>,
        _: Option<&[[f32; COLUMNS]; ROWS]>,
        (): &(),
    ) -> Option<[[f32; COLUMNS]; ROWS]> {
        let most = f64::from(self.0);
        let number = |node: Node<'_>| node.number(-most..=most).map(|number| number.single);
        exactly(node, |row| exactly(row, number))
    }

    fn write(&self, table: &[[f32; COLUMNS]; ROWS]) -> RonText {
        let row = |row: &[f32; COLUMNS]| RonText::List(row.iter().copied().map(RonText::Single).collect());
        RonText::List(table.iter().map(row).collect())
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("lists of numbers that were measured")
    }

    fn stand_in(&self) -> [[f32; COLUMNS]; ROWS] {
        [[0.0; COLUMNS]; ROWS]
    }
}

/// Reads all entries with `read`; `None` if their number is wrong or one of them could not be read.
fn exactly<'r, T, const COUNT: usize>(
    node: Node<'r>,
    read: impl Fn(Node<'r>) -> Option<T>,
) -> Option<[T; COUNT]> {
    let entries: Vec<Option<T>> = node.list(node.name, usize::MAX)?.into_iter().map(read).collect();
    if entries.len() != COUNT {
        let problem = Problem::error(node.span(), format!("`{}` has {} entries", node.name, entries.len()));
        node.report(problem.expected(format!("expected {COUNT}")));
        return None;
    }
    let entries: Option<Vec<T>> = entries.into_iter().collect();
    entries?.try_into().ok()
}

/// Pairs of a rising frequency in hertz and a gain within these two limits.
pub(super) struct Points(pub(super) f64, pub(super) f64);

impl Codec<Vec<(f32, f32)>> for Points {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Vec<(f32, f32)>>, (): &()) -> Option<Vec<(f32, f32)>> {
        let nodes = node.list("point", Response::MOST_POINTS)?;
        if nodes.len() < 2 {
            let problem = Problem::error(node.span(), format!("`{}` has too few points", node.name));
            node.report(
                problem.expected("expected 2 or more").help("write [(50, -3.5), (100, 0), (750, -6)]"),
            );
            return None;
        }
        let single = |node: Node<'_>, range| node.number(range).map(|number| number.single);
        let mut last = 0.0;
        let mut point = |node: Node<'_>| {
            let [hz, gain] = node.tuple("(hertz, gain)")?;
            let hz = single(Node { name: "hertz", ..hz }, 1.0..=20_000.0);
            let gain = single(Node { name: "gain", ..gain }, self.0..=self.1);
            let (hz, gain) = (hz?, gain?);
            if hz <= last {
                let problem = Problem::error(node.span(), "the hertz of a response must rise");
                node.report(problem.expected(format!("expected more than {last}")));
                return None;
            }
            last = hz;
            Some((hz, gain))
        };
        let points: Vec<Option<(f32, f32)>> = nodes.into_iter().map(&mut point).collect();
        points.into_iter().collect()
    }

    fn write(&self, points: &Vec<(f32, f32)>) -> RonText {
        let point =
            |&(hz, gain): &(f32, f32)| RonText::Tuple(vec![RonText::Single(hz), RonText::Single(gain)]);
        RonText::List(points.iter().map(point).collect())
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("a list of 2 to 1024 pairs (hertz, gain), by frequency")
    }

    fn stand_in(&self) -> Vec<(f32, f32)> {
        Vec::new()
    }
}
