//! `underfoot sense`: contacts and cursor from a force table.

use std::error::Error;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Write};
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use underfoot::floor::Geometry;
use underfoot::sense::{
    Contact, ContactId, Covariance, Cursor, CursorPicker, ForceFrame, ForceTable, Method, Quality, Sensing,
};

/// What `underfoot sense` is asked to do.
#[derive(Args, Clone, Debug)]
pub(crate) struct SenseArgs {
    /// Force table: CSV with the header `t_s,col,row,f_sw,f_se,f_nw,f_ne`
    file: PathBuf,

    /// Columns and rows of the floor, such as 8x4
    #[arg(long, value_name = "CxR", default_value = "6x6", value_parser = parse_grid)]
    grid: Geometry,

    /// The paper's plain method: one contact per group of touching tiles
    #[arg(long)]
    eq4: bool,
}

/// Prints one JSON line per instant of the table on standard output.
///
/// The cursor is the one of a region as large as the floor. Ends quietly when
/// nobody reads the output any more.
///
/// # Errors
/// If the file can't be opened or read, or a line of it breaks the format; the
/// instants before that line have then been printed.
pub(crate) fn run(args: &SenseArgs) -> Result<(), Box<dyn Error>> {
    let file = File::open(&args.file).map_err(|error| format!("{}: {error}", args.file.display()))?;
    let method = if args.eq4 { Method::Eq4 } else { Method::Tracker };
    let mut table = ForceTable::new(BufReader::new(file), args.grid)
        .map_err(|error| format!("{}: {error}", args.file.display()))?;
    let mut sensing = Sensing::new(args.grid, method);
    let mut picker = CursorPicker::default();
    let mut frame = ForceFrame::empty(&args.grid);
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    loop {
        let t_s = match table.next_frame(&mut frame) {
            Ok(Some(t_s)) => t_s,
            Ok(None) => break,
            Err(error) => {
                out.flush()?;
                return Err(format!("{}: {error}", args.file.display()).into());
            }
        };
        let contacts = sensing.update(&frame);
        let cursor = picker.update(args.grid.bounds(), contacts, frame.at);
        match write_line(&mut out, t_s, contacts, cursor) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
            written => written?,
        }
    }
    match out.flush() {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        flushed => Ok(flushed?),
    }
}

fn parse_grid(text: &str) -> Result<Geometry, String> {
    let (columns, rows) = text.split_once(['x', 'X']).ok_or("expected columns x rows, such as 8x4")?;
    let side =
        |text: &str| text.trim().parse::<u16>().map_err(|_| format!("{text:?} is not a number of tiles"));
    Geometry::of_paper_tiles(side(columns)?, side(rows)?).map_err(|error| error.to_string())
}

#[derive(Serialize)]
struct Line<'a> {
    t_s: f64,
    contacts: Contacts<'a>,
    cursor: Option<CursorLine>,
}

/// Serialises straight from the contacts, so that a long table costs no list per line.
struct Contacts<'a>(&'a [Contact]);

impl Serialize for Contacts<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(ContactLine::of))
    }
}

#[derive(Serialize)]
struct ContactLine<'a> {
    id: ContactId,
    x_m: f32,
    y_m: f32,
    force_n: f32,
    tiles: Tiles<'a>,
    vx_m_s: f32,
    vy_m_s: f32,
    covariance_m2: Covariance,
    ambiguous: bool,
    quality: Quality,
    difference_m: Option<[f32; 2]>,
}

impl<'a> ContactLine<'a> {
    fn of(contact: &'a Contact) -> Self {
        Self {
            id: contact.id,
            x_m: contact.centroid.x,
            y_m: contact.centroid.y,
            force_n: contact.force.0,
            tiles: Tiles(contact),
            vx_m_s: contact.velocity.x,
            vy_m_s: contact.velocity.y,
            covariance_m2: contact.covariance,
            ambiguous: contact.ambiguous,
            quality: contact.quality,
            difference_m: contact.difference.map(Into::into),
        }
    }
}

struct Tiles<'a>(&'a Contact);

impl Serialize for Tiles<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.tiles.iter().map(|load| [load.tile.column, load.tile.row]))
    }
}

#[derive(Serialize)]
struct CursorLine {
    id: ContactId,
    x_m: f32,
    y_m: f32,
    force_n: f32,
}

fn write_line(
    out: &mut impl Write,
    t_s: f64,
    contacts: &[Contact],
    cursor: Option<Cursor>,
) -> io::Result<()> {
    let cursor = cursor.map(|cursor| CursorLine {
        id: cursor.contact,
        x_m: cursor.position.x,
        y_m: cursor.position.y,
        force_n: cursor.force.0,
    });
    serde_json::to_writer(&mut *out, &Line { t_s, contacts: Contacts(contacts), cursor })?;
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

    #[test]
    fn grids_are_columns_by_rows() {
        assert_eq!(parse_grid("8x4").unwrap(), Geometry::of_paper_tiles(8, 4).unwrap());
        assert!(parse_grid("8").is_err());
        assert!(parse_grid("0x4").unwrap_err().contains("1 to 256"));
    }
}
