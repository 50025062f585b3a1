//! `underfoot export`: a recording, or a part of it, in other forms.

mod film;
mod part;
mod tables;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use underfoot::floor::Floor;
use underfoot::recording::{Progress, Recording, Speed};
use underfoot::serve::Server;
use underfoot_scene::picture;

use super::failure::Failure;
use super::replay::whole;
pub(crate) use part::RecordedPart;

/// Options of `underfoot export`.
#[derive(clap::Args, Debug)]
#[command(group = clap::ArgGroup::new("form").required(true).multiple(true))]
pub(crate) struct Args {
    /// The recording, as `underfoot run --record` writes it.
    file: PathBuf,
    /// Folder for forces.csv (which `underfoot sense` reads), contacts.csv and events.csv.
    #[arg(short, long, value_name = "DIR", group = "form")]
    out: Option<PathBuf>,
    /// The floor as an animated picture.
    #[arg(long, value_name = "FILE", group = "form")]
    gif: Option<PathBuf>,
    /// The part as a recording of its own. It shows the part only, and also has all that came before, on which the
    /// events depend.
    #[arg(long, value_name = "FILE", group = "form")]
    mcap: Option<PathBuf>,
    /// Begin at this time of the recording, in seconds.
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    from: f64,
    /// End at this time of the recording, in seconds; without it, at its end.
    #[arg(long, value_name = "S")]
    to: Option<f64>,
    /// Width of the animated picture, in pixels.
    #[arg(long, value_name = "PX", default_value_t = FILM_WIDTH, requires = "gif", value_parser = width)]
    width: u32,
}

/// Width of an animated picture in pixels, unless another one is given: labels are readable.
pub(crate) const FILM_WIDTH: u32 = 800;

/// Maximum width of an animated picture in pixels: a projector.
const WIDEST: u32 = 3840;

fn width(text: &str) -> Result<u32, String> {
    let least = *picture::WIDTHS.start();
    let width = text.parse().ok().filter(|width| (least..=WIDEST).contains(width));
    width.ok_or_else(|| format!("write a number from {least} to {WIDEST}"))
}

/// Receives the share of the work that is done, from 0 to 1; `false` from it stops the work.
pub(crate) type Tell<'a> = &'a mut dyn FnMut(f64) -> bool;

/// How an export ended.
#[derive(Debug)]
pub(crate) enum Exported {
    /// The files are complete.
    Whole,
    /// The files end where the recording breaks off or is damaged.
    UpToBreak(Failure),
    /// It was stopped.
    Stopped,
}

/// The form of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ExportForm {
    /// A folder of tables.
    Tables,
    /// A recording.
    Recording,
    /// An animated picture of this width in pixels.
    Film(u32),
}

/// Writes a part of the recording at `file` to `to`. A stopped export leaves no unfinished picture or recording.
pub(crate) fn export(
    file: &Path,
    part: &RecordedPart,
    form: ExportForm,
    to: &Path,
    tell: Tell<'_>,
) -> Result<Exported, Failure> {
    match form {
        ExportForm::Tables => tables::write(file, to, part, tell),
        ExportForm::Film(width_px) => {
            let exported = film::write(file, to, width_px, part, tell)?;
            if matches!(exported, Exported::Stopped) {
                fs::remove_file(to).map_err(|error| Failure::File(to.into(), error))?;
            }
            Ok(exported)
        }
        ExportForm::Recording => {
            let trimmed = Recording::open(file)?.trim(to, (part.from, part.to), |at| tell(part.share(at)))?;
            match trimmed {
                None => Ok(Exported::Stopped),
                Some(trimmed) => match trimmed.broken {
                    None => Ok(Exported::Whole),
                    Some(why) => Ok(Exported::UpToBreak(Failure::Other(format!(
                        "{} has all of {} up to its break ({why})",
                        to.display(),
                        file.display()
                    )))),
                },
            }
        }
    }
}

/// Writes the forms; fails at the end if the recording is incomplete.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let part = RecordedPart::of(&args.file, args.from, args.to)?;
    let forms = [
        (args.out.as_deref(), ExportForm::Tables, "Forces, contacts and events are in"),
        (args.gif.as_deref(), ExportForm::Film(args.width), "The animated picture is"),
        (args.mcap.as_deref(), ExportForm::Recording, "The recording of the part is"),
    ];
    let mut ended = Ok(());
    for (to, form, words) in forms {
        let Some(to) = to else { continue };
        let exported = export(&args.file, &part, form, to, &mut |_| true)?;
        outln!("{words} {}.", to.display());
        if let Exported::UpToBreak(failure) = exported {
            ended = ended.and(Err(failure));
        }
    }
    ended
}

/// A recording played by a server as fast as it goes.
struct PlayedRecording {
    floor: Floor,
    server: Server,
    progress: Arc<Progress>,
}

impl PlayedRecording {
    /// Opens the recording at `file`.
    fn open(file: &Path) -> Result<Self, Failure> {
        let recording = Recording::open(file)?;
        let floor = recording.floor().clone();
        let (layout, method) = (recording.layout().clone(), recording.method());
        let source = recording.source(Speed::Max);
        let progress = source.progress();
        let server = Server::new(&floor, layout, method, source);
        Ok(Self { floor, server, progress })
    }
}

/// How an export ends that has read all of its part.
fn exported(progress: &Progress) -> Exported {
    whole(progress).map_or_else(Exported::UpToBreak, |()| Exported::Whole)
}
