//! `underfoot share`: a layout as a link, with a visit; and the layout of a link as files.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema;
use underfoot::source::LinkFaults;
use underfoot_sim::RecordedFeet;
use underfoot_window::link::{LinkError, MAX_TEXT, SharedLayout, SharedVisit};

use super::failure::Failure;
use super::floor_args::grid;
use super::layout_args::{DEFAULT_LAYOUT, LayoutArgs};
#[cfg(feature = "preview")]
use super::linked::{LinkedVisit, geometry_of};
use super::play;
use super::quality_arg::QualityArg;

/// Options of `underfoot share`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    /// The size of the floor for which the layout is made, for example 8x4 (columns x rows).
    #[arg(long, value_name = "CxR", value_parser = grid)]
    grid: Option<Geometry>,
    /// Address of the page that opens the layout, the web edition of underfoot; without it, the link begins with `#`,
    /// and goes behind the address of any such page or into `underfoot preview`.
    #[arg(long, value_name = "URL", default_value = "", hide_default_value = true)]
    page: String,
    /// Also put a visit into the link: the feet of the scenario in this file, or of the visit in the link in this file;
    /// `session` for the built-in session, or a visit to each control of a layout that it does not fit. The
    /// link then shows the feet on a simulated floor.
    #[arg(long, value_name = "FILE")]
    visit: Option<PathBuf>,
    #[command(flatten)]
    quality: QualityArg,
    /// Seed of the floor of the visit: it determines sensors and noise.
    #[arg(long, default_value_t = 1, requires = "visit")]
    seed: u64,
}

impl From<LinkError> for Failure {
    fn from(error: LinkError) -> Self {
        Self::Other(error.to_string())
    }
}

/// Prints the link.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let geometry = args.grid.unwrap_or_default();
    let shared =
        SharedLayout { grid: args.grid.map(|grid| (grid.columns(), grid.rows())), ..read(&args.layout)? };
    let mut shared = shared.with_used_only(&geometry)?;
    if let Some(file) = &args.visit {
        let layout =
            schema::parse_layout(&shared.text, &shared.name, &shared.all_kinds()?, &geometry)?.layout;
        shared.visit = Some(args.visit(file, &layout, &geometry)?);
    }
    let fragment = shared.fragment()?;
    let page = args.page.split('#').next().unwrap_or_default();
    outln!("{page}{fragment}");
    Ok(())
}

/// Name of the built-in visits in place of a file.
const SESSION: &str = "session";

/// Maximum length of a file with a link, in bytes.
const MAX_LINK: u64 = 1 << 20;

impl Args {
    /// The visit in `file` to `layout`.
    fn visit(&self, file: &Path, layout: &Layout, geometry: &Geometry) -> Result<SharedVisit, Failure> {
        let is_session = file.to_str() == Some(SESSION) && !file.exists();
        if !is_session
            && let Ok(text) = schema::read_bounded(file, MAX_LINK)
            && let Ok(linked) = SharedLayout::of_link(&text)
        {
            let lacks = || Failure::Other(format!("{}: the link has no visit", file.display()));
            return linked.visit.ok_or_else(lacks);
        }
        let (mut script, faults) = play::script((!is_session).then_some(file), layout, geometry)?;
        if faults != LinkFaults::default() {
            errln!("The faults of the scenario are not in the link: it has the feet alone.");
        }
        Ok(SharedVisit::new(&RecordedFeet::of(&mut script), self.quality.quality, self.seed)?)
    }
}

/// The texts of the layout, and of all kinds and effects beside it.
fn read(files: &LayoutArgs) -> Result<SharedLayout, Failure> {
    let (name, text) = match files.path() {
        Some(path) => {
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
            (name, text_at(path)?)
        }
        None => {
            let name = files.layout.as_deref().and_then(Path::to_str).unwrap_or(DEFAULT_LAYOUT);
            (name.to_owned(), schema::builtin_layout(name).unwrap_or_default().to_owned())
        }
    };
    Ok(SharedLayout { name, text, ..own_texts(files)? })
}

/// The texts of all kinds and effects beside the layout, as a layout without a text.
pub(crate) fn own_texts(files: &LayoutArgs) -> Result<SharedLayout, Failure> {
    let texts =
        |folder: Option<PathBuf>| folder.map_or_else(|| Ok(BTreeMap::new()), |folder| texts_in(&folder));
    let (kinds, effects) = (texts(files.kinds_folder())?, texts(files.effects_folder())?);
    Ok(SharedLayout { kinds, effects, ..SharedLayout::default() })
}

fn text_at(path: &Path) -> Result<String, Failure> {
    schema::read_bounded(path, MAX_TEXT as u64).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            let bytes = std::fs::metadata(path)
                .map_or(MAX_TEXT + 1, |file| usize::try_from(file.len()).unwrap_or(usize::MAX));
            LinkError::TooLong { bytes }.into()
        }
        _ => Failure::File(path.into(), error),
    })
}

/// The texts of the files named `*.ron` in a folder, by their names.
fn texts_in(folder: &Path) -> Result<BTreeMap<String, String>, Failure> {
    let failed = |error| Failure::File(folder.into(), error);
    let mut texts = BTreeMap::new();
    for entry in folder.read_dir().map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.extension().is_some_and(|ending| ending == "ron")
            && let Some(name) = path.file_name()
        {
            texts.insert(name.to_string_lossy().into_owned(), text_at(&path)?);
        }
    }
    Ok(texts)
}

/// The files of a link.
#[cfg(feature = "preview")]
pub(crate) struct Unpacked {
    /// The layout.
    pub(crate) layout: PathBuf,
    /// The size of its floor; `None` for the usual one.
    pub(crate) geometry: Option<Geometry>,
    /// The visit to it.
    pub(crate) visit: Option<LinkedVisit>,
}

/// Writes the files of a link into a folder of their own below `state`.
///
/// A folder in which the user has changed something stays as it is: the files then go into another one.
#[cfg(feature = "preview")]
pub(crate) fn unpack(link: &str, state: &Path) -> Result<Unpacked, Failure> {
    let shared = SharedLayout::of_link(link)?;
    let (geometry, visit) = (geometry_of(&shared)?, LinkedVisit::of(&shared)?);
    let unpacked = |layout| Unpacked { layout, geometry, visit };
    let name = file_name(&shared.name, "layout");
    let stem = name.trim_end_matches(".ron");
    for number in 1.. {
        let suffix = if number == 1 { String::new() } else { format!("-{number}") };
        let folder = state.join("links").join(format!("{stem}{suffix}"));
        let layout = folder.join(&name);
        let mut files = vec![(layout.clone(), &shared.text)];
        for (below, texts) in [("widgets", &shared.kinds), ("effects", &shared.effects)] {
            let place = folder.join(below);
            files.extend(texts.iter().map(|(file, text)| (place.join(file_name(file, "own")), text)));
        }
        let is_as_sent = |(path, text): &(PathBuf, &String)| {
            schema::read_bounded(path, MAX_TEXT as u64).is_ok_and(|there| there == **text)
        };
        if !folder.exists() {
            for (path, text) in &files {
                let into = path.parent().unwrap_or(&folder);
                std::fs::create_dir_all(into).map_err(|error| Failure::File(into.into(), error))?;
                schema::save_text(text, path)?;
            }
            return Ok(unpacked(layout));
        }
        if files.iter().all(is_as_sent) {
            return Ok(unpacked(layout));
        }
    }
    Err(Failure::Other("there are too many folders of links".into()))
}

/// A name from a link as the name of a file in a folder: without anything that could lead out of it.
#[cfg(feature = "preview")]
fn file_name(sent: &str, usual: &str) -> String {
    let stem = sent.trim_end_matches(".ron");
    let is_plain = |letter: &char| letter.is_alphanumeric() || "-_ ".contains(*letter);
    let stem: String = stem.chars().filter(is_plain).take(64).collect();
    let stem = stem.trim();
    format!("{}.ron", if stem.is_empty() { usual } else { stem })
}

#[cfg(all(test, feature = "preview"))]
mod tests {
    use super::*;

    fn shared(name: &str, title: &str) -> SharedLayout {
        SharedLayout {
            name: name.into(),
            text: format!("Layout(version: 1, title: \"{title}\")"),
            effects: [("../../thud.ron".to_owned(), "Effect()".to_owned())].into(),
            ..SharedLayout::default()
        }
    }

    #[test]
    fn a_link_is_unpacked_once_and_never_over_what_the_user_has_changed() {
        let state = tempfile::tempdir().unwrap();
        let link = shared("room.ron", "one").fragment().unwrap();
        let unpacked = || unpack(&link, state.path()).unwrap().layout;
        let first = unpacked();
        assert_eq!(first, state.path().join("links/room/room.ron"));
        assert_eq!(unpacked(), first);
        std::fs::write(&first, "mine").unwrap();
        assert_eq!(unpacked(), state.path().join("links/room-2/room.ron"));
        assert_eq!(std::fs::read_to_string(first).unwrap(), "mine");
    }

    #[test]
    fn names_in_a_link_lead_out_of_no_folder() {
        let state = tempfile::tempdir().unwrap();
        let link = shared("../../../etc/passwd", "x").fragment().unwrap();
        let path = unpack(&link, state.path()).unwrap().layout;
        assert_eq!(path, state.path().join("links/etcpasswd/etcpasswd.ron"));
        assert!(state.path().join("links/etcpasswd/effects/thud.ron").exists());
        for (sent, name) in
            [("..", "layout.ron"), ("", "layout.ron"), (".ron", "layout.ron"), ("süd 2.ron", "süd 2.ron")]
        {
            assert_eq!(file_name(sent, "layout"), name);
        }
    }
}
