//! Tables of forces, for sensing without a floor.

use std::collections::VecDeque;
use std::io::{self, BufRead};

use super::{TableError, TableProblems, TableReader, TableRow};
use crate::floor::{Corner, Geometry, TileId};
use crate::sense::ForceFrame;
use crate::units::Instant;

/// Columns on floors with sensors near the corners of their tiles.
const CORNERS: [&[&str]; 1] = [&["t_s", "col", "row", "f_sw", "f_se", "f_nw", "f_ne"]];

/// Columns on floors with sensors at given places, of which a table of plates with three has the first.
const NUMBERS: [&[&str]; 2] =
    [&["t_s", "col", "row", "f_0", "f_1", "f_2"], &["t_s", "col", "row", "f_0", "f_1", "f_2", "f_3"]];

/// Maximum time in a table, in seconds: a year.
const LATEST_S: f64 = 31_557_600.0;

/// Reads a force table, one instant at a time.
///
/// CSV with the columns `t_s,col,row,f_sw,f_se,f_nw,f_ne`: seconds, tile, calibrated and tared newtons. On floors with
/// sensors at given places, the last columns are `f_0,f_1,f_2,f_3` in the order of the floor file; `f_3` is empty or
/// absent for plates with three sensors. The rows of one instant are consecutive, times rise, and a tile without a row
/// in an instant carries no load then.
///
/// Lines that cannot be read are skipped and listed in [`Self::problems`]: a field that is missing, surplus or not a
/// number, a tile off the floor, missing or listed twice in one instant, a time that breaks the order, is below 0 or beyond a
/// year. Of two neighbours in the wrong order, the line that fits the surrounding lines less is skipped.
#[derive(Debug)]
pub struct ForceTable<R> {
    table: TableReader<R>,
    geometry: Geometry,
    row: TableRow,
    /// Loads read ahead, at most three: enough to find the one with the wrong time.
    ahead: VecDeque<Load>,
    /// Time of the last load returned.
    last_s: Option<f64>,
    /// Tiles of the current instant, to be cleared for the next.
    named: Vec<usize>,
}

/// The load of one tile at one instant.
#[derive(Clone, Copy, Debug)]
struct Load {
    line: u64,
    t_s: f64,
    tile: TileId,
    /// The tile's index on the floor.
    index: usize,
    forces: [f32; 4],
}

impl<R: BufRead> ForceTable<R> {
    /// A table for a floor of this geometry; reads and checks the header.
    ///
    /// # Errors
    /// [`TableError`] if the header belongs to another table, or `reader` fails.
    pub fn new(reader: R, geometry: Geometry) -> Result<Self, TableError> {
        let columns: &[_] = if geometry.has_corners() { &CORNERS } else { &NUMBERS };
        let table = TableReader::new(reader, columns)?;
        let (row, ahead, named) = (TableRow::default(), VecDeque::new(), Vec::new());
        Ok(Self { table, geometry, row, ahead, last_s: None, named })
    }

    /// Fills `frame` with the next instant and returns its time in seconds; `None` at the end.
    ///
    /// `frame` must be the one filled last time, or [`ForceFrame::empty`] of the same geometry: only the tiles of the
    /// last instant are cleared.
    ///
    /// # Errors
    /// Those of the reader.
    pub fn next_frame(&mut self, frame: &mut ForceFrame) -> io::Result<Option<f64>> {
        for index in self.named.drain(..) {
            if let Some(forces) = frame.forces.get_mut(index) {
                *forces = [0.0; 4];
            }
        }
        let Some(first) = self.next_in_order()? else { return Ok(None) };
        frame.at = Instant::from_micros((first.t_s * 1e6).round() as u64);
        frame.received = frame.at;
        let mut next = Some(first);
        while let Some(load) = next {
            if self.named.contains(&load.index) {
                let problem = format!("tile {} is named twice in one instant", load.tile);
                self.table.report_line(load.line, problem);
            } else {
                self.named.push(load.index);
                if let Some(forces) = frame.forces.get_mut(load.index) {
                    *forces = load.forces;
                }
            }
            self.settle_order()?;
            next = self.ahead.pop_front_if(|load| load.t_s == first.t_s);
        }
        Ok(Some(first.t_s))
    }

    /// The problems of the lines so far.
    #[must_use]
    pub fn problems(&self) -> &TableProblems {
        self.table.problems()
    }

    /// Names of the columns that are not read, as the header has them.
    #[must_use]
    pub fn unread(&self) -> &[String] {
        self.table.unread()
    }

    fn next_in_order(&mut self) -> io::Result<Option<Load>> {
        self.settle_order()?;
        let next = self.ahead.pop_front();
        self.last_s = next.map(|load| load.t_s).or(self.last_s);
        Ok(next)
    }

    /// Reads ahead and skips lines until the first two loads ahead are in the order of time.
    fn settle_order(&mut self) -> io::Result<()> {
        loop {
            self.read_ahead(2)?;
            let (Some(first), Some(second)) = (self.ahead.front(), self.ahead.get(1)) else { return Ok(()) };
            let (first, second) = (*first, *second);
            if second.t_s >= first.t_s {
                return Ok(());
            }
            self.read_ahead(3)?;
            let third = self.ahead.get(2).map(|third| third.t_s);
            let fits_before = self.last_s.is_none_or(|last| second.t_s >= last);
            // At the end of the table no later line can decide: the first load counts as right.
            let is_first_wrong =
                fits_before && third.map_or(self.last_s.is_some(), |third| third < first.t_s);
            let (wrong, problem) = if is_first_wrong {
                (0, "its time lies after the one below")
            } else {
                (1, "its time lies before the one above")
            };
            let line = if wrong == 0 { first.line } else { second.line };
            self.ahead.remove(wrong);
            self.table.report_line(line, problem.to_owned());
        }
    }

    fn read_ahead(&mut self, count: usize) -> io::Result<()> {
        while self.ahead.len() < count && self.table.next_row(&mut self.row)? {
            let load = self.load();
            self.ahead.extend(load);
        }
        Ok(())
    }

    fn load(&mut self) -> Option<Load> {
        let (table, row) = (&mut self.table, &self.row);
        let t_s = table.number(row, 0, 0.0..=LATEST_S);
        let column = table.whole(row, 1, 0..u16::MAX);
        let line = table.whole(row, 2, 0..u16::MAX);
        let tile = column.zip(line).map(|(column, line)| TileId::new(column, line));
        let sensors = tile.map_or(Corner::ALL.len(), |tile| self.geometry.sensor_places(tile).count());
        let mut forces = [Some(0.0); 4];
        for (sensor, force) in forces.iter_mut().enumerate().take(sensors) {
            *force = table.number(row, 3 + sensor, -1e6..=1e6).map(|force| force as f32);
        }
        let [first, second, third, fourth] = forces;
        let (t_s, tile, forces) = (t_s?, tile?, [first?, second?, third?, fourth?]);
        if self.geometry.is_missing(tile) {
            table.report_line(row.line(), format!("tile {tile} is missing on this floor"));
            return None;
        }
        let Some(index) = self.geometry.index(tile) else {
            let block = self.geometry.block();
            let problem = format!("tile {tile} is not on a floor of {block}: give its size (`grid`)");
            table.report_line(row.line(), problem);
            return None;
        };
        Some(Load { line: row.line(), t_s, tile, index, forces })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::floor::{OwnPlate, SensorPlaces, TileBlock};

    const HEADER: &str = "t_s,col,row,f_sw,f_se,f_nw,f_ne";

    /// A time with the tiles that are loaded then.
    type Loaded = (f64, Vec<usize>);

    /// The instants of a table, each with its loaded tiles, and its problems.
    fn read(text: &str) -> Result<(Vec<Loaded>, Vec<String>), TableError> {
        let geometry = Geometry::default();
        let mut table = ForceTable::new(text.as_bytes(), geometry)?;
        let mut frame = ForceFrame::empty(&geometry);
        let mut instants = Vec::new();
        while let Some(t_s) = table.next_frame(&mut frame)? {
            let loaded = (0..36).filter(|&index| frame.forces[index] != [0.0; 4]).collect();
            instants.push((t_s, loaded));
        }
        let problems = table.problems().shown().iter().map(ToString::to_string).collect();
        Ok((instants, problems))
    }

    /// The only problem of these rows.
    fn problem(rows: &str) -> String {
        let (_, problems) = read(&format!("{HEADER}\n{rows}")).unwrap();
        let [problem] = &problems[..] else { panic!("{problems:?}") };
        problem.clone()
    }

    #[test]
    fn tiles_absent_at_an_instant_carry_nothing() {
        let rows = "0.000,1,0,1,2,3,4\r\n0.000,0,1,1,0,0,0\n0.001,5,5,0,0,0,9\n0.002,0,0,0,0,0,0";
        let (instants, problems) = read(&format!("\u{feff}{HEADER}\r\n{rows}")).unwrap();
        assert_eq!(instants, [(0.0, vec![1, 6]), (0.001, vec![35]), (0.002, vec![])]);
        assert_eq!(problems, [""; 0]);
        assert_eq!(read(&format!("{HEADER}\n")).unwrap().0, []);
    }

    #[test]
    fn a_table_of_numbered_sensors_is_in_the_order_of_the_floor_file() {
        let three =
            SensorPlaces::at(&[Vec2::new(-0.1, -0.1), Vec2::new(0.1, -0.1), Vec2::new(0.0, 0.12)]).unwrap();
        let own = OwnPlate { tile: TileId::new(1, 0), size: Vec2::splat(0.304), sensors: three };
        let hole = TileBlock { first: TileId::new(2, 0), columns: 1, rows: 1 };
        let geometry = Geometry::of_paper_tiles(3, 1).unwrap().with_uneven(&[hole], &[own]).unwrap();
        let geometry = geometry.with_sensors(*geometry.sensor_places(TileId::new(0, 0))).unwrap();
        let read = |text: &str| {
            let mut table = ForceTable::new(text.as_bytes(), geometry).unwrap();
            let mut frame = ForceFrame::empty(&geometry);
            let t_s = table.next_frame(&mut frame).unwrap();
            (t_s, frame.forces, table.problems().shown().iter().map(ToString::to_string).collect::<Vec<_>>())
        };
        let (t_s, forces, problems) =
            read("t_s,col,row,f_0,f_1,f_2,f_3\n0,0,0,1,2,3,4\n0,1,0,5,6,7,\n0,2,0,1,1,1,1");
        assert_eq!((t_s, &forces[..2]), (Some(0.0), &[[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 0.0]][..]));
        assert_eq!(problems, ["line 4: tile (2, 0) is missing on this floor"]);
        let (_, forces, problems) = read("t_s,col,row,f_0,f_1,f_2\n0,1,0,5,6,7\n0,0,0,1,2,3");
        assert_eq!(forces[1], [5.0, 6.0, 7.0, 0.0]);
        assert!(problems[0].starts_with("line 3"), "{problems:?}");
        assert!(ForceTable::new(format!("{HEADER}\n").as_bytes(), geometry).is_err());
    }

    #[test]
    fn every_problem_names_its_line() {
        assert_eq!(problem("0,0,0,1,2,3"), "line 2: expected 7 fields, found 6");
        assert!(problem("0,0,0,1,2,3,4,5").starts_with("line 2: expected 7 fields, found 8"));
        assert!(problem("0,0,0,1,2,3,x").starts_with("line 2, column f_ne: expected a number"));
        assert!(problem("0,0,0,1,2,NaN,3").starts_with("line 2, column f_nw: expected a number"));
        assert!(problem("0,0,0,1,2,inf,3").starts_with("line 2, column f_nw: expected a number"));
        assert!(problem("-1,0,0,1,2,3,4").starts_with("line 2, column t_s: expected a number"));
        assert!(problem("1e300,0,0,1,2,3,4").starts_with("line 2, column t_s: expected a number"));
        assert!(problem("0,0.5,0,1,2,3,4").starts_with("line 2, column col: expected a whole number"));
        assert!(problem("0,6,0,1,2,3,4").contains("`grid`"));
        assert!(problem("0,0,0,1,2,3,4\n0,0,0,1,2,3,4").starts_with("line 3: tile (0, 0) is named twice"));
        assert!(problem("1,0,0,1,2,3,4\n0,0,0,1,2,3,4").starts_with("line 3: its time lies before"));
        assert!(problem(&"9".repeat(100_000)).contains("line 2: longer than"));
    }

    /// Five instants of one tile, with the line number `broken` replaced.
    fn times_without(broken: usize, by: &str) -> (Vec<f64>, Vec<String>) {
        let mut rows: Vec<String> = (0..5).map(|step| format!("{step},0,0,1,1,1,1")).collect();
        by.clone_into(&mut rows[broken]);
        let (instants, problems) = read(&format!("{HEADER}\n{}\n", rows.join("\n"))).unwrap();
        (instants.into_iter().map(|(t_s, _)| t_s).collect(), problems)
    }

    #[test]
    fn a_broken_line_costs_no_other_line() {
        let broken =
            ["1,0", "\"", "x", "1,0,0,\"1,1,1,1", "9999,0,0,1,1,1,1", "9,9,9,9,9,9,9", "1,0,0,1,1,1,1,1,1"];
        for line in broken {
            for place in 0..5 {
                let (times, problems) = times_without(place, line);
                let others: Vec<f64> = (0..5).filter(|step| *step != place).map(|step| step as f64).collect();
                // A time that is too late is in order at the end of the table.
                if line.starts_with("9999") && place == 4 {
                    assert_eq!((times.len(), problems.len()), (5, 0));
                    continue;
                }
                assert_eq!(times, others, "{line} in place {place}");
                assert_eq!(problems.len(), 1, "{line} in place {place}: {problems:?}");
                assert!(problems[0].starts_with(&format!("line {}", place + 2)), "{problems:?}");
            }
        }
    }

    #[test]
    fn a_time_that_is_too_early_costs_no_other_line() {
        for place in 2..5 {
            let (times, problems) = times_without(place, "0.5,0,0,1,1,1,1");
            let others: Vec<f64> = (0..5).filter(|step| *step != place).map(|step| step as f64).collect();
            assert_eq!(times, others, "in place {place}");
            assert!(
                problems[0].starts_with(&format!("line {}: its time lies before", place + 2)),
                "{problems:?}"
            );
        }
    }

    #[test]
    fn anything_without_the_header_is_refused() {
        assert!(read("").unwrap_err().to_string().contains("line 1: expected the header"));
        assert!(read("t_s;col\n").is_err());
        assert!(ForceTable::new(&b"\xff\xfe"[..], Geometry::default()).is_err());
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(rows in "([0-9eE.,+\\-NaInf\"#;]{0,12},?[\n\r]?){0,40}") {
            let _ = read(&format!("{HEADER}\n{rows}"));
        }

        /// Good lines are read between any other lines.
        #[test]
        fn good_lines_are_read_whatever_stands_between_them(
            junk in proptest::collection::vec("[0-9a-z.,;\"#\t ]{0,30}", 6),
            end in "\n|\r\n|\r",
        ) {
            // Junk that is itself a row of a tile on the floor would be read.
            let junk = junk.iter().map(|line| format!("{line},?"));
            let rows: Vec<String> =
                junk.zip(0..).flat_map(|(line, step)| [format!("{step},1,1,9,9,9,9"), line]).collect();
            let (instants, _) = read(&format!("{HEADER}{end}{}{end}", rows.join(&end))).unwrap();
            let times: Vec<f64> = instants.iter().map(|(t_s, _)| *t_s).collect();
            proptest::prop_assert_eq!(times, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        }
    }
}
