//! `underfoot sense`: contacts and cursor from a force table.

use std::io::{self, BufRead, BufWriter, Write};
use std::path::PathBuf;

use clap::Args;
use underfoot::floor::Geometry;
use underfoot::outgoing::json::{ContactRecord, CursorRecord, SensedRecord};
use underfoot::sense::{Contact, Cursor, CursorPicker, ForceFrame, ForceTable, Method, Sensing};

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::output::note_failure;
use super::table;

/// Options of `underfoot sense`.
#[derive(Args, Clone, Debug)]
pub(crate) struct SenseArgs {
    /// Force table: CSV with the columns `t_s,col,row,f_sw,f_se,f_nw,f_ne`
    file: PathBuf,

    /// Geometry and position maps are those of this floor; a force table needs no calibration.
    #[command(flatten)]
    floor: FloorArgs,

    /// The paper's plain method: one contact per group of touching tiles
    #[arg(long)]
    eq4: bool,
}

/// Maximum size of a table in bytes: a day of a floor of 36 tiles at 1 kHz, read line by line.
const MOST_BYTES: u64 = 128 << 30;

/// Time at the beginning of a table in which the noise of the tiles is learnt (s).
const LEARNT_S: f64 = 2.0;

/// Maximum number of tile readings kept for that: 25 MB of them.
const MOST_READINGS: usize = 1 << 20;

/// Prints one JSON line per instant of the table on standard output.
///
/// The noise of the tiles is learnt from the first two seconds, before the first line is printed.
/// The cursor is that of a region as large as the floor. Ends when the reader of the output is gone.
///
/// # Errors
/// If the floor file is invalid or the table can't be opened or read; after all instants, if lines of the table were
/// skipped.
pub(crate) fn run(args: &SenseArgs) -> Result<(), Failure> {
    let floor = args.floor.load()?;
    let geometry = floor.geometry;
    let file = table::open(&args.file, MOST_BYTES)?;
    let method = if args.eq4 { Method::Eq4 } else { Method::Tracker };
    let mut forces =
        ForceTable::new(file, geometry).map_err(|error| table::refused(&args.file, "force table", &error))?;
    table::warn_of_unread(&args.file, forces.unread());
    let mut sensing = Sensing::new(geometry, method).with_maps(&floor.position_maps);
    let mut picker = CursorPicker::default();
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    let mut instants = Instants::of(&mut forces, &geometry);
    sensing.learn_noise(instants.ahead());
    loop {
        let (t_s, frame) = match instants.next() {
            Ok(Some(instant)) => instant,
            Ok(None) => break,
            Err(error) => {
                out.flush().unwrap_or_else(note_failure);
                return Err(Failure::File(args.file.clone(), error));
            }
        };
        let contacts = sensing.update(frame);
        let cursor = picker.update(geometry.bounds(), contacts, frame.at);
        if let Err(error) = write_line(&mut out, t_s, contacts, cursor) {
            note_failure(error);
            return Ok(());
        }
    }
    out.flush().unwrap_or_else(note_failure);
    table::conclude(table::left_out(&args.file, forces.problems()).as_slice())
}

/// The instants of a table, of which the first [`LEARNT_S`] are read ahead.
struct Instants<'a, R> {
    table: &'a mut ForceTable<R>,
    /// The frame of the last instant read.
    frame: ForceFrame,
    /// Times and frames read ahead, and the number of those already returned.
    times: Vec<f64>,
    frames: Vec<ForceFrame>,
    returned: usize,
    /// Failure of the reader behind them.
    failure: Option<io::Error>,
}

impl<'a, R: BufRead> Instants<'a, R> {
    fn of(table: &'a mut ForceTable<R>, geometry: &Geometry) -> Self {
        let frame = ForceFrame::empty(geometry);
        let mut read =
            Self { table, frame, times: Vec::new(), frames: Vec::new(), returned: 0, failure: None };
        let most = (MOST_READINGS / geometry.tile_count().max(1)).max(1);
        while read.frames.len() < most {
            match read.table.next_frame(&mut read.frame) {
                Ok(Some(t_s)) => {
                    read.times.push(t_s);
                    read.frames.push(read.frame.clone());
                    if read.times.first().is_some_and(|first| t_s - first >= LEARNT_S) {
                        break;
                    }
                }
                Ok(None) => break,
                Err(error) => {
                    read.failure = Some(error);
                    break;
                }
            }
        }
        read
    }

    /// The frames read ahead.
    fn ahead(&self) -> &[ForceFrame] {
        &self.frames
    }

    /// The next instant with its time in seconds; `None` at the end of the table.
    fn next(&mut self) -> io::Result<Option<(f64, &ForceFrame)>> {
        let at = self.returned;
        if at < self.frames.len() {
            self.returned += 1;
            return Ok(self.times.get(at).copied().zip(self.frames.get(at)));
        }
        self.frames = Vec::new();
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        Ok(self.table.next_frame(&mut self.frame)?.map(|t_s| (t_s, &self.frame)))
    }
}

fn write_line(
    out: &mut impl Write,
    t_s: f64,
    contacts: &[Contact],
    cursor: Option<Cursor>,
) -> io::Result<()> {
    let contacts = contacts.iter().map(ContactRecord::full).collect();
    let record = SensedRecord { t_s, contacts, cursor: cursor.map(CursorRecord::from) };
    serde_json::to_writer(&mut *out, &record)?;
    out.write_all(b"\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_the_fields_that_other_tools_count_on() {
        let mut out = Vec::new();
        write_line(&mut out, 1.25, &[], None).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "{\"t_s\":1.25,\"contacts\":[],\"cursor\":null}\n");
    }
}
