//! Sources of a map's pictures: a folder, or a server of tiles.

use std::fs::{self, File};
use std::io::{self, Cursor, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::time::Duration;

use eframe::egui::ColorImage;
use image::{ImageReader, Limits};
use thiserror::Error;
use ureq::Agent;

/// A level of the map, and the column and row of a tile from the north-west corner.
pub type Key = [u32; 3];

/// The longest side of a picture, in pixels.
const LONGEST: u32 = 2048;

/// Greatest size of a picture, in bytes: a photograph of that size.
const MOST_BYTES: u64 = 8 << 20;

/// Time within which a server must send a picture.
const PATIENCE: Duration = Duration::from_secs(10);

/// The deepest level: one of its tiles covers less than ten metres.
const DEEPEST: u32 = 22;

/// The reason for a missing picture.
#[derive(Debug, Error)]
pub enum NoPicture {
    /// The source lacks this tile.
    #[error("there is none")]
    Missing,
    /// The picture cannot be decoded.
    #[error("{0}")]
    Broken(String),
    /// The source cannot be reached at present.
    #[error("{0}")]
    Unreachable(String),
}

/// A source of pictures.
pub enum Source {
    /// A folder with `level/x/y.png`, and the levels that it has, lowest first.
    Folder(PathBuf, Vec<u32>),
    /// The address of a picture, in which `{z}`, `{x}` and `{y}` stand for level, column and row.
    Server(String, Agent),
}

impl Source {
    /// A server where `place` begins with `http://` or `https://`, else a folder.
    ///
    /// # Errors
    /// A message for the user. Whether a server answers shows only later.
    pub fn open(place: &str) -> Result<Self, String> {
        if place.starts_with("http://") || place.starts_with("https://") {
            return server(place);
        }
        folder(Path::new(place))
    }

    /// The level with pictures nearest to their own size at this zoom.
    pub fn level(&self, zoom: f64) -> Option<u32> {
        match self {
            Self::Server(..) => Some(zoom.round().clamp(0.0, f64::from(DEEPEST)) as u32),
            Self::Folder(_, levels) => {
                let far = |level: &u32| (f64::from(*level) - zoom).abs();
                levels.iter().copied().min_by(|one, other| far(one).total_cmp(&far(other)))
            }
        }
    }

    /// Reads a picture; blocks until it is there.
    ///
    /// # Errors
    /// [`NoPicture`] shows whether another attempt can help.
    pub fn read(&self, key: Key) -> Result<ColorImage, NoPicture> {
        picture(&self.bytes(key)?)
    }

    fn bytes(&self, [level, x, y]: Key) -> Result<Vec<u8>, NoPicture> {
        match self {
            Self::Folder(folder, _) => {
                let path = folder.join(format!("{level}/{x}/{y}.png"));
                let mut bytes = Vec::new();
                let read = File::open(path).and_then(|file| file.take(MOST_BYTES).read_to_end(&mut bytes));
                read.map(|_| bytes).map_err(|error| match error.kind() {
                    ErrorKind::NotFound => NoPicture::Missing,
                    _ => NoPicture::Broken(error.to_string()),
                })
            }
            Self::Server(address, agent) => {
                let number = |text: String, name: &str, value: u32| text.replace(name, &value.to_string());
                let address = number(number(number(address.clone(), "{z}", level), "{x}", x), "{y}", y);
                match agent.get(address).call() {
                    Ok(mut answer) => {
                        let body = answer.body_mut().with_config().limit(MOST_BYTES);
                        body.read_to_vec().map_err(|error| NoPicture::Unreachable(error.to_string()))
                    }
                    Err(ureq::Error::StatusCode(404 | 410)) => Err(NoPicture::Missing),
                    Err(error) => Err(NoPicture::Unreachable(error.to_string())),
                }
            }
        }
    }
}

fn server(address: &str) -> Result<Source, String> {
    if let Some(missing) = ["{z}", "{x}", "{y}"].into_iter().find(|part| !address.contains(part)) {
        return Err(format!(
            "{address}: no {missing} in it; such as http://127.0.0.1:8080/{{z}}/{{x}}/{{y}}.png"
        ));
    }
    if address.starts_with("https://") && !cfg!(feature = "https") {
        return Err(format!("{address}: this program was built without the feature `https`"));
    }
    let config = Agent::config_builder().timeout_global(Some(PATIENCE)).user_agent(concat!(
        env!("CARGO_PKG_NAME"),
        "/",
        env!("CARGO_PKG_VERSION")
    ));
    Ok(Source::Server(address.into(), config.build().new_agent()))
}

fn folder(folder: &Path) -> Result<Source, String> {
    let wrong = |why: &str| format!("{}: {why}", folder.display());
    let entries = fs::read_dir(folder).map_err(|error| wrong(&error.to_string()))?;
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut levels: Vec<u32> =
        names.filter_map(|name| name.parse().ok()).filter(|level| *level <= DEEPEST).collect();
    levels.sort_unstable();
    if levels.is_empty() {
        return Err(wrong("no folder of a level in it, such as `3`; tiles are `level/x/y.png`"));
    }
    Ok(Source::Folder(folder.into(), levels))
}

fn picture(bytes: &[u8]) -> Result<ColorImage, NoPicture> {
    let broken = |error: &dyn std::fmt::Display| NoPicture::Broken(error.to_string());
    let guessed: io::Result<_> = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let mut reader = guessed.map_err(|error| broken(&error))?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
    reader.limits(limits);
    let picture = reader.decode().map_err(|error| broken(&error))?.into_rgba8();
    let size = [picture.width() as usize, picture.height() as usize];
    Ok(ColorImage::from_rgba_unmultiplied(size, &picture))
}
