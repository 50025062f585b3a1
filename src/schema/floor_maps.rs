//! Floor files: position maps.

use super::behaviour::single;
use super::day;
use super::fields::Fields;
use super::floor::{Grid, Seen};
use super::node::Node;
use super::problem::Problem;
use crate::floor::{Floor, MapRecord, PositionMap};

/// Position maps of the tiles that are listed; tiles that are not have none.
pub(super) fn maps(node: Node<'_>, grid: Grid, floor: &mut Floor) -> Option<()> {
    let mut seen = Seen::new();
    for node in node.list("map", usize::MAX)? {
        let Some(mut fields) = node.fields("Map") else { continue };
        let tile = fields.read("tile", None, |node| grid.tile(node));
        let none = PositionMap::NONE;
        let trims = fields.read("trims", Some(none.trims), |node| table(node, PositionMap::MOST_TRIM));
        let bends = fields.read("bends", Some(none.bends), |node| table(node, PositionMap::MOST_BEND));
        let record = record(&mut fields);
        let span = fields.span("tile");
        fields.finish();
        let Some(tile) = tile else { continue };
        seen.check(node.reader, tile, || format!("the map of tile {tile}"), span);
        let index = floor.geometry.index(tile).unwrap_or(usize::MAX);
        let slots = (floor.position_maps.get_mut(index), floor.map_records.get_mut(index));
        if let ((Some(map), Some(old)), (Some(trims), Some(bends), Some(record))) =
            (slots, (trims, bends, record))
        {
            let residual_m = record.map_or(PositionMap::SOME_RESIDUAL_M, |record| record.residual_m);
            *map = Some(PositionMap { trims, bends, residual_m });
            *old = record;
        }
    }
    Some(())
}

fn record(fields: &mut Fields<'_>) -> Option<Option<MapRecord>> {
    let day = fields.read("mapped", Some(None), |node| day::read(node).map(Some));
    let residual_m = fields.read("residual_m", Some(None), |node| single(node, 0.0..=10.0).map(Some));
    match (day?, residual_m?) {
        (Some(day), Some(residual_m)) => Some(Some(MapRecord { day, residual_m })),
        (None, None) => Some(None),
        (day, _) => {
            day::report_half(fields, ("mapped", "residual_m"), day.is_some());
            None
        }
    }
}

/// `ROWS` lists of `COLUMNS` numbers from -`most` to `most`.
fn table<const ROWS: usize, const COLUMNS: usize>(
    node: Node<'_>,
    most: f32,
) -> Option<[[f32; COLUMNS]; ROWS]> {
    let rows: Vec<_> = node
        .list(node.name, usize::MAX)?
        .into_iter()
        .map(|row| {
            let numbers: Vec<_> = row
                .list(node.name, usize::MAX)?
                .into_iter()
                .map(|number| single(number, -f64::from(most)..=f64::from(most)))
                .collect();
            exactly(row, numbers)
        })
        .collect();
    exactly(node, rows)
}

/// All of `entries`, if there are as many as there must be and each could be read.
fn exactly<T, const COUNT: usize>(node: Node<'_>, entries: Vec<Option<T>>) -> Option<[T; COUNT]> {
    if entries.len() != COUNT {
        let problem = Problem::error(node.span(), format!("`{}` has {} entries", node.name, entries.len()));
        node.report(problem.expected(format!("expected {COUNT}")));
        return None;
    }
    let entries: Option<Vec<T>> = entries.into_iter().collect();
    entries?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::super::parse_floor;
    use crate::floor::PositionMap;

    fn complaints(fields: &str) -> String {
        let text = format!("Floor(columns: 2, rows: 1,\n{fields}\n)");
        parse_floor(&text, "floor.ron").unwrap_err().to_string()
    }

    #[test]
    fn maps_belong_to_the_tiles_that_are_listed() {
        let zeros = "0, 0, 0, 0, 0, 0, 0, 0, 0, 0";
        let text = format!(
            "Floor(columns: 2, rows: 1, tared: \"2026-11-20\", maps: [
                (tile: (1, 0), bends: [[0.1, {}], [{zeros}]], mapped: \"2026-11-19\", residual_m: 0.004),
            ])",
            &zeros[3..]
        );
        let floor = parse_floor(&text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(floor.position_maps[0], None);
        let map = floor.position_maps[1].unwrap();
        assert_eq!((map.bends[0][0], map.trims), (0.1, PositionMap::NONE.trims));
        assert_eq!(floor.map_records[1].unwrap().residual_m, 0.004);
        assert_eq!(floor.tared.unwrap().to_string(), "2026-11-20");
    }

    #[test]
    fn wrong_maps_and_days_are_all_named() {
        let told = complaints(
            "tared: \"20.11.2026\",
            sensors: [(tile: (0, 0), corner: Sw, calibrated: \"2026-11-20\")],
            maps: [
                (tile: (0, 0), trims: [[0, 0], [0], [0]], bends: [[7]]),
                (tile: (1, 0), residual_m: 0.1),
                (tile: (1, 0)),
            ],",
        );
        for said in [
            "`tared` is no day",
            "`calibrated` needs `residual` beside it",
            "expected 4",
            "expected 21",
            "`bends` is out of range",
            "`residual_m` needs `mapped` beside it",
            "the map of tile (1, 0) comes twice",
        ] {
            assert!(told.contains(said), "{said}: {told}");
        }
    }
}
