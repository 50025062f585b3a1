//! Tables of forces, for sensing without a floor.

use std::io::{self, BufRead, Read};

use thiserror::Error;

use super::ForceFrame;
use crate::floor::{Geometry, TileId};
use crate::units::Instant;

const HEADER: &str = "t_s,col,row,f_sw,f_se,f_nw,f_ne";

/// No line of a force table is longer.
const LINE_LIMIT: u64 = 1024;

/// Why a force table could not be read on.
#[derive(Debug, Error)]
pub enum ForceTableError {
    /// The file itself could not be read.
    #[error("cannot read the force table: {0}")]
    Io(#[from] io::Error),
    /// A line is not what the format asks for.
    #[error("line {line}: {problem}")]
    Line {
        /// Which line, from 1.
        line: u64,
        /// What is wrong with it, and what was expected.
        problem: String,
    },
}

/// Reads a force table, one instant at a time.
///
/// CSV with the header `t_s,col,row,f_sw,f_se,f_nw,f_ne`: seconds, tile, calibrated
/// and tared newtons. The rows of one instant are consecutive, times rise, and a
/// tile that an instant doesn't name carries no load then.
#[derive(Debug)]
pub struct ForceTable<R> {
    reader: R,
    geometry: Geometry,
    line: u64,
    text: String,
    /// The first row of the next instant, already read.
    ahead: Option<Row>,
    /// Tiles named in the instant that is being read, to be cleared for the next.
    named: Vec<usize>,
    last: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    t_s: f64,
    tile: TileId,
    forces: [f32; 4],
    line: u64,
}

impl<R: BufRead> ForceTable<R> {
    /// A table for a floor of this geometry; reads and checks the header.
    ///
    /// # Errors
    /// If the file can't be read, or starts with anything but the header.
    pub fn new(reader: R, geometry: Geometry) -> Result<Self, ForceTableError> {
        let text = String::with_capacity(128);
        let mut table = Self { reader, geometry, line: 0, text, ahead: None, named: Vec::new(), last: None };
        if !table.read_line()? || table.text.trim_start_matches('\u{feff}') != HEADER {
            return Err(table.problem(format!("expected the header {HEADER}")));
        }
        table.ahead = table.read_row()?;
        Ok(table)
    }

    /// Fills `frame` with the next instant and gives its time in seconds; `None` at the end.
    ///
    /// `frame` must be the one filled last time, or [`ForceFrame::empty`] of the
    /// same geometry: only the tiles named last time are cleared.
    ///
    /// # Errors
    /// At the first line that breaks the format, with its number: a field missing,
    /// too many or not a number, a tile off the floor or named twice in one
    /// instant, a time before the one above it, below 0 or beyond a year.
    pub fn next_frame(&mut self, frame: &mut ForceFrame) -> Result<Option<f64>, ForceTableError> {
        for index in self.named.drain(..) {
            if let Some(forces) = frame.forces.get_mut(index) {
                *forces = [0.0; 4];
            }
        }
        let Some(first) = self.ahead.take() else { return Ok(None) };
        if self.last.is_some_and(|last| first.t_s < last) {
            return Err(problem(first.line, "its time lies before the one above".into()));
        }
        frame.at = Instant::from_micros((first.t_s * 1e6).round() as u64);
        frame.received = frame.at;
        let mut row = first;
        loop {
            let Some(index) = self.geometry.index(row.tile) else {
                let block = self.geometry.block();
                return Err(problem(
                    row.line,
                    format!("tile {} is not on a floor of {block}; try --grid", row.tile),
                ));
            };
            if self.named.contains(&index) {
                return Err(problem(row.line, format!("tile {} is named twice in one instant", row.tile)));
            }
            self.named.push(index);
            if let Some(forces) = frame.forces.get_mut(index) {
                *forces = row.forces;
            }
            match self.read_row()? {
                Some(next) if next.t_s == first.t_s => row = next,
                next => {
                    self.ahead = next;
                    break;
                }
            }
        }
        self.last = Some(first.t_s);
        Ok(Some(first.t_s))
    }

    /// Reads a line without its end into `text`; false at the end of the file.
    fn read_line(&mut self) -> Result<bool, ForceTableError> {
        self.text.clear();
        self.line += 1;
        let read = self.reader.by_ref().take(LINE_LIMIT).read_line(&mut self.text)?;
        if read as u64 == LINE_LIMIT {
            return Err(self.problem(format!("longer than {LINE_LIMIT} bytes; not a force table")));
        }
        self.text.truncate(self.text.trim_end_matches(['\n', '\r']).len());
        Ok(read > 0)
    }

    fn read_row(&mut self) -> Result<Option<Row>, ForceTableError> {
        if !self.read_line()? {
            return Ok(None);
        }
        self.parse().map(Some).map_err(|text| self.problem(text))
    }

    fn parse(&self) -> Result<Row, String> {
        let mut fields = self.text.split(',').map(str::trim);
        let mut field = |name: &str| fields.next().ok_or_else(|| format!("the field {name} is missing"));
        let t_s = number(field("t_s")?, "t_s", 0.0..=31_557_600.0)?;
        let column = whole(field("col")?, "col")?;
        let row = whole(field("row")?, "row")?;
        let mut forces = [0.0; 4];
        for (force, name) in forces.iter_mut().zip(["f_sw", "f_se", "f_nw", "f_ne"]) {
            *force = number(field(name)?, name, -1e6..=1e6)? as f32;
        }
        match fields.count() {
            0 => Ok(Row { t_s, tile: TileId::new(column, row), forces, line: self.line }),
            extra => Err(format!("{extra} fields too many; expected {HEADER}")),
        }
    }

    fn problem(&self, text: String) -> ForceTableError {
        problem(self.line, text)
    }
}

fn problem(line: u64, problem: String) -> ForceTableError {
    ForceTableError::Line { line, problem }
}

fn number(text: &str, name: &str, range: std::ops::RangeInclusive<f64>) -> Result<f64, String> {
    text.parse().ok().filter(|number| range.contains(number)).ok_or_else(|| {
        format!("{name} must be a number from {} to {}, not {text:?}", range.start(), range.end())
    })
}

fn whole(text: &str, name: &str) -> Result<u16, String> {
    text.parse().map_err(|_| format!("{name} must be a whole number from 0, not {text:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<(f64, Vec<usize>)>, ForceTableError> {
        let geometry = Geometry::default();
        let mut table = ForceTable::new(text.as_bytes(), geometry)?;
        let mut frame = ForceFrame::empty(&geometry);
        let mut instants = Vec::new();
        while let Some(t_s) = table.next_frame(&mut frame)? {
            let loaded = (0..36).filter(|&index| frame.forces[index] != [0.0; 4]).collect();
            instants.push((t_s, loaded));
        }
        Ok(instants)
    }

    fn complaint(rows: &str) -> String {
        read(&format!("{HEADER}\n{rows}")).unwrap_err().to_string()
    }

    #[test]
    fn tiles_absent_at_an_instant_carry_nothing() {
        let rows = "0.000,1,0,1,2,3,4\r\n0.000,0,1,1,0,0,0\n0.001,5,5,0,0,0,9\n0.002,0,0,0,0,0,0";
        let instants = read(&format!("\u{feff}{HEADER}\r\n{rows}")).unwrap();
        assert_eq!(instants, [(0.0, vec![1, 6]), (0.001, vec![35]), (0.002, vec![])]);
        assert_eq!(read(&format!("{HEADER}\n")).unwrap(), []);
    }

    #[test]
    fn every_complaint_names_its_line() {
        assert_eq!(complaint("0,0,0,1,2,3"), "line 2: the field f_ne is missing");
        assert!(complaint("0,0,0,1,2,3,4,5").starts_with("line 2: 1 fields too many"));
        assert!(complaint("0,0,0,1,2,3,x").contains("f_ne must be a number"));
        assert!(complaint("0,0,0,1,2,NaN,3").contains("f_nw must be a number"));
        assert!(complaint("0,0,0,1,2,inf,3").contains("f_nw must be a number"));
        assert!(complaint("-1,0,0,1,2,3,4").contains("t_s must be"));
        assert!(complaint("0,0.5,0,1,2,3,4").contains("col must be a whole number"));
        assert!(complaint("0,6,0,1,2,3,4").contains("try --grid"));
        assert!(complaint("0,0,0,1,2,3,4\n0,0,0,1,2,3,4").starts_with("line 3: tile (0, 0) is named twice"));
        assert!(complaint("1,0,0,1,2,3,4\n0,0,0,1,2,3,4").starts_with("line 3: its time lies before"));
        assert!(complaint("\n").contains("t_s must be"));
        assert!(complaint(&"9".repeat(5000)).contains("longer than"));
    }

    #[test]
    fn anything_without_the_header_is_refused() {
        assert!(read("").unwrap_err().to_string().contains("line 1: expected the header"));
        assert!(read("t_s;col\n").is_err());
        assert!(ForceTable::new(&b"\xff\xfe"[..], Geometry::default()).is_err());
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(rows in "([0-9eE.,+\\-NaInf]{0,12},?\n?){0,40}") {
            let _ = read(&format!("{HEADER}\n{rows}"));
        }
    }
}
