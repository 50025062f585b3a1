//! A recording as an animated picture.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;
use std::time::Duration;

use underfoot::engine::Snapshot;
use underfoot::serve::Ended;
use underfoot_scene::picture::Film;
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

use super::super::failure::Failure;
use super::super::fonts::fonts;
use super::part::RecordedPart;
use super::{Exported, PlayedRecording, Tell, exported};

/// Time from one drawing to the next: viewers of GIF files show shorter ones too slowly or not at all on slow
/// machines, and feet still move smoothly.
const STEP: Duration = Duration::from_millis(80);

/// Writes the floor of a part as a GIF file, drawn as the window draws it.
pub(super) fn write(
    file: &Path,
    to: &Path,
    width_px: u32,
    part: &RecordedPart,
    tell: Tell<'_>,
) -> Result<Exported, Failure> {
    let failed = |error| Failure::File(to.into(), error);
    let PlayedRecording { floor, mut server, progress } = PlayedRecording::open(file)?;
    let mut film = Film::new(BufWriter::new(File::create(to).map_err(failed)?), width_px);
    let (mut scene, mut snapshot, mut next) = (Scene::new(), Snapshot::default(), part.from);
    loop {
        let ended = server.turn()?;
        let now = server.engine().now();
        if ended == Ended::Yes || part.is_over(now) {
            break;
        }
        if !tell(part.share(now)) {
            return Ok(Exported::Stopped);
        }
        if now >= next {
            server.snapshot(&mut snapshot);
            let view = View {
                show: Show::PICTURE,
                ..View::new(&floor.geometry, server.engine().layout(), &snapshot, &Theme::LIGHT)
            };
            scene::draw(&mut scene, &view);
            film.add(&scene, fonts(), now.since(part.from))?;
            // A floor that was silent for a while has no drawings of that time.
            while next <= now {
                next = next + STEP;
            }
        }
    }
    let end = server.engine().now().min(part.to).since(part.from);
    let out = film.finish(end)?;
    let written = out.into_inner().map_err(io::Error::from).and_then(|file| file.sync_all());
    written.map_err(failed)?;
    Ok(exported(&progress))
}
