//! `underfoot export`: a recording as tables.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use serde_json::Value;
use underfoot::recording::{Recording, Speed};
use underfoot::sense::{Assembler, Tare};
use underfoot::serve::{Ended, Server};
use underfoot::sink::{EventSink, Report};
use underfoot::source::{FloorInput, SourceError};

use super::failure::Failure;
use super::replay::whole;

/// Options of `underfoot export`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The recording, as `underfoot run --record` writes it.
    file: PathBuf,
    /// Folder for forces.csv (which `underfoot sense` reads), contacts.csv and events.csv.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
}

/// Writes the tables; fails at the end if the recording is incomplete.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    std::fs::create_dir_all(&args.out).map_err(|error| Failure::File(args.out.clone(), error))?;
    forces(&args.file, &args.out.join("forces.csv"))?;
    events(&args.file, &args.out.join("events.csv"))?;
    let ended = contacts(&args.file, &args.out.join("contacts.csv"));
    outln!("Forces, contacts and events are in {}.", args.out.display());
    ended
}

fn create(path: &Path) -> Result<BufWriter<File>, Failure> {
    File::create(path).map(BufWriter::new).map_err(|error| Failure::File(path.into(), error))
}

/// Writes each frame with all loaded tiles; a frame without load gets a line for its first tile.
fn forces(file: &Path, to: &Path) -> Result<(), Failure> {
    let failed = |error| Failure::File(to.into(), error);
    let recording = Recording::open(file)?;
    let floor = recording.floor().clone();
    let mut source = FloorInput::from(recording.source(Speed::Max)).source;
    let mut assembler = Assembler::with_tare(&floor, Tare::suited_to(&floor));
    let mut out = create(to)?;
    writeln!(out, "t_s,col,row,f_sw,f_se,f_nw,f_ne").map_err(failed)?;
    loop {
        match source.next(Duration::ZERO) {
            Ok(Some(packet)) => assembler.take(&packet),
            Ok(None) => assembler.poll(source.now()),
            Err(SourceError::Ended) => break,
            Err(error) => return Err(error.into()),
        }
        while let Some(frame) = assembler.ready() {
            let is_loaded = |forces: &[f32; 4]| forces.iter().any(|force| *force != 0.0 && force.is_finite());
            let is_empty = !frame.forces.iter().any(is_loaded);
            for (index, (tile, forces)) in floor.geometry.tiles().zip(&frame.forces).enumerate() {
                if is_loaded(forces) || (is_empty && index == 0) {
                    let [sw, se, nw, ne] = forces.map(|force| if force.is_finite() { force } else { 0.0 });
                    let at_s = frame.at.secs();
                    writeln!(out, "{at_s:.6},{},{},{sw},{se},{nw},{ne}", tile.column, tile.row)
                        .map_err(failed)?;
                }
            }
        }
    }
    out.flush().map_err(failed)
}

/// Writes the recorded events of controls.
fn events(file: &Path, to: &Path) -> Result<(), Failure> {
    const FIELDS: [&str; 8] = ["t_s", "id", "event", "value", "force_n", "x_m", "y_m", "contact"];
    let failed = |error| Failure::File(to.into(), error);
    let mut out = create(to)?;
    writeln!(out, "{}", FIELDS.join(",")).map_err(failed)?;
    // The replay of the contacts reports a break in the recording.
    for line in Recording::open(file)?.events().map_while(Result::ok) {
        let Ok(event) = serde_json::from_slice::<Value>(&line) else { continue };
        if event.get("id").is_none() {
            continue;
        }
        let fields = FIELDS.map(|name| match event.get(name) {
            None | Some(Value::Null) => String::new(),
            Some(Value::String(text)) => text.clone(),
            Some(Value::Array(numbers)) => numbers.iter().map(Value::to_string).collect::<Vec<_>>().join(" "),
            Some(value) => value.to_string(),
        });
        writeln!(out, "{}", fields.join(",")).map_err(failed)?;
    }
    out.flush().map_err(failed)
}

/// Writes the contacts of each frame.
fn contacts(file: &Path, to: &Path) -> Result<(), Failure> {
    let failed = |error| Failure::File(to.into(), error);
    let recording = Recording::open(file)?;
    let floor = recording.floor().clone();
    let (layout, method) = (recording.layout().clone(), recording.method());
    let source = recording.source(Speed::Max);
    let progress = source.progress();
    let mut out = create(to)?;
    writeln!(out, "t_s,id,x_m,y_m,force_n,x_velocity_m_s,y_velocity_m_s,ambiguous").map_err(failed)?;
    let rows = Arc::<Mutex<Vec<u8>>>::default();
    let mut server =
        Server::new(&floor, layout, method, source).with_events(Box::new(ContactRows(Arc::clone(&rows))));
    loop {
        let ended = server.turn()?;
        let mut rows = rows.lock().unwrap_or_else(PoisonError::into_inner);
        out.write_all(&rows).map_err(failed)?;
        rows.clear();
        if ended == Ended::Yes {
            break;
        }
    }
    out.flush().map_err(failed)?;
    whole(&progress)
}

/// Collects contacts as lines of a table.
struct ContactRows(Arc<Mutex<Vec<u8>>>);

impl EventSink for ContactRows {
    fn report(&mut self, report: &Report<'_>) {
        let Report::Contacts(at, contacts) = report else { return };
        let mut rows = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for contact in contacts.iter() {
            let (at_s, id, force) = (at.secs(), contact.id.0, contact.force.0);
            let (centroid, velocity, ambiguous) = (contact.centroid, contact.velocity, contact.ambiguous);
            // A write to memory never fails.
            let _ = writeln!(
                rows,
                "{at_s:.6},{id},{},{},{force},{},{},{ambiguous}",
                centroid.x, centroid.y, velocity.x, velocity.y
            );
        }
    }
}
