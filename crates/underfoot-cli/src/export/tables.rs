//! A recording as tables: forces, contacts and events.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use serde_json::Value;
use underfoot::floor::Corner;
use underfoot::recording::{Recording, Speed};
use underfoot::sense::{Assembler, Tare};
use underfoot::serve::Ended;
use underfoot::sink::{EventSink, Report};
use underfoot::source::{FloorInput, SourceError};

use super::super::failure::Failure;
use super::part::RecordedPart;
use super::{Exported, PlayedRecording, Tell, exported};

/// Writes the tables of a part into a folder.
pub(super) fn write(
    file: &Path,
    folder: &Path,
    part: &RecordedPart,
    tell: Tell<'_>,
) -> Result<Exported, Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::File(folder.into(), error))?;
    // Each of the two replays is half of the work; the lines of events take no time.
    let mut first = |share: f64| tell(0.5 * share);
    if let Exported::Stopped = forces(file, &folder.join("forces.csv"), part, &mut first)? {
        return Ok(Exported::Stopped);
    }
    events(file, &folder.join("events.csv"), part)?;
    contacts(file, &folder.join("contacts.csv"), part, &mut |share| tell(0.5 + 0.5 * share))
}

fn create(path: &Path) -> Result<BufWriter<File>, Failure> {
    File::create(path).map(BufWriter::new).map_err(|error| Failure::File(path.into(), error))
}

/// Writes each frame with all loaded tiles; a frame without load gets a line for its first tile.
fn forces(file: &Path, to: &Path, part: &RecordedPart, tell: Tell<'_>) -> Result<Exported, Failure> {
    let failed = |error| Failure::File(to.into(), error);
    let recording = Recording::open(file)?;
    let floor = recording.floor().clone();
    let mut source = FloorInput::from(recording.source(Speed::Max)).source;
    let mut assembler = Assembler::with_tare(&floor, Tare::suited_to(&floor));
    let mut out = create(to)?;
    let names = Corner::ALL.map(|sensor| floor.geometry.sensor_name(sensor));
    writeln!(out, "t_s,col,row,f_{}", names.join(",f_")).map_err(failed)?;
    loop {
        match source.next(Duration::ZERO) {
            Ok(Some(packet)) => assembler.take(&packet),
            Ok(None) => assembler.poll(source.now()),
            Err(SourceError::Ended) => break,
            Err(error) => return Err(error.into()),
        }
        if part.is_over(source.now()) {
            break;
        }
        if !tell(part.share(source.now())) {
            return Ok(Exported::Stopped);
        }
        while let Some(frame) = assembler.ready() {
            if !part.holds(frame.at) {
                continue;
            }
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
    out.flush().map_err(failed)?;
    Ok(Exported::Whole)
}

/// Writes the recorded events of controls.
fn events(file: &Path, to: &Path, part: &RecordedPart) -> Result<(), Failure> {
    const FIELDS: [&str; 8] = ["t_s", "id", "event", "value", "force_n", "x_m", "y_m", "contact"];
    let failed = |error| Failure::File(to.into(), error);
    let mut out = create(to)?;
    writeln!(out, "{}", FIELDS.join(",")).map_err(failed)?;
    // The replay of the contacts reports a break in the recording.
    for line in Recording::open(file)?.events().map_while(Result::ok) {
        let Ok(event) = serde_json::from_slice::<Value>(&line) else { continue };
        let at_s = event.get("t_s").and_then(Value::as_f64);
        if event.get("id").is_none() || at_s.is_some_and(|at_s| !part.holds_s(at_s)) {
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
fn contacts(file: &Path, to: &Path, part: &RecordedPart, tell: Tell<'_>) -> Result<Exported, Failure> {
    let failed = |error| Failure::File(to.into(), error);
    let PlayedRecording { server, progress, .. } = PlayedRecording::open(file)?;
    let mut out = create(to)?;
    writeln!(out, "t_s,id,x_m,y_m,force_n,x_velocity_m_s,y_velocity_m_s,ambiguous").map_err(failed)?;
    let rows = Arc::<Mutex<Vec<u8>>>::default();
    let mut server = server.with_events(Box::new(ContactRows { rows: Arc::clone(&rows), part: *part }));
    loop {
        let ended = server.turn()?;
        let mut rows = rows.lock().unwrap_or_else(PoisonError::into_inner);
        out.write_all(&rows).map_err(failed)?;
        rows.clear();
        drop(rows);
        if ended == Ended::Yes || part.is_over(server.engine().now()) {
            break;
        }
        if !tell(part.share(server.engine().now())) {
            return Ok(Exported::Stopped);
        }
    }
    out.flush().map_err(failed)?;
    Ok(exported(&progress))
}

/// Collects the contacts of a part as lines of a table.
struct ContactRows {
    rows: Arc<Mutex<Vec<u8>>>,
    part: RecordedPart,
}

impl EventSink for ContactRows {
    fn report(&mut self, report: &Report<'_>) {
        let Report::Contacts(at, contacts) = report else { return };
        if !self.part.holds(*at) {
            return;
        }
        let mut rows = self.rows.lock().unwrap_or_else(PoisonError::into_inner);
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
