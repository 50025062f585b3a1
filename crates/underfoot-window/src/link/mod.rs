//! A layout in a link: the text of the layout, with its own kinds and effects, behind the `#` of an address; and a visit
//! to it.
//!
//! ```text
//! SharedLayout -JSON-> bytes -zlib-> bytes -base64url-> #1.eNqrVkrOz0tVslIqSExPLVayUkpJTcvMS1WyMlSqBQCGAAhr
//! ```
//!
//! The part behind `#` stays in the browser: no server gets it. The number in front is the version of this form.

mod parts;
mod tape;
#[cfg(test)]
mod tests;
mod visit;

use std::collections::BTreeMap;
use std::io::{Read, Write};

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema::{Diagnostics, Effects, Kinds, parse_layout};
use underfoot_sim::BadFeet;

pub use parts::{EFFECTS, KINDS, ReadableParts, UnreadablePart};
pub use tape::{KeptVisit, VisitTape};
pub use visit::{MAX_VISIT, SharedVisit};

/// Maximum length of all texts of a link together, in bytes.
pub const MAX_TEXT: usize = 32 * 1024;

/// Maximum length of the JSON: most characters of a text take one byte there, line ends and quotes two, and control
/// characters six. The letters of a visit take one byte.
const MAX_JSON: u64 = 6 * MAX_TEXT as u64 + MAX_VISIT as u64 + 4096;

/// Maximum length of the part behind `#`: texts that do not compress at all, and a visit.
const MAX_LINK: usize = 2 * MAX_JSON as usize;

/// The version of the form.
const VERSION: &str = "1";

/// A layout that travels in a link, with all that it needs beyond what comes with underfoot.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SharedLayout {
    /// The name of its file.
    pub name: String,
    /// The text of its file.
    pub text: String,
    /// Columns and rows of the floor for which it is made, if those are not the usual ones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grid: Option<(u16, u16)>,
    /// The texts of its own kinds of controls, by the names of their files.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub kinds: BTreeMap<String, String>,
    /// The texts of its own effects, by the names of their files.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub effects: BTreeMap<String, String>,
    /// A visit to the layout. Programs from before visits show the layout alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visit: Option<SharedVisit>,
}

/// The reason why a layout and a link do not go together.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum LinkError {
    /// The texts are too long for a link.
    #[error("the layout has {} kB, and a link holds {} kB: give the file instead", bytes.div_ceil(1024), MAX_TEXT / 1024)]
    TooLong {
        /// The length of all texts together.
        bytes: usize,
    },
    /// The link holds no layout.
    #[error("the link holds no layout: one begins with #1. and was made by Share or `underfoot share`")]
    NoLayout,
    /// A newer program has made the link.
    #[error("the link was made by a newer underfoot (its form is {0}): this one is too old for it")]
    Newer(String),
    /// Letters of the link are missing or wrong.
    #[error("the link is damaged: it may have been cut where it was sent; ask for it again, or for the file")]
    Damaged,
    /// The visit has more than a link holds.
    #[error("the visit takes {} kB, and a link holds {} kB of it: record a shorter one", letters.div_ceil(1024), MAX_VISIT / 1024)]
    LongVisit {
        /// The length of the visit in the link.
        letters: usize,
    },
    /// The feet of the visit cannot be read.
    #[error("the visit in the link cannot be played: {0}")]
    Feet(#[from] BadFeet),
    /// The visit is on a floor that this program cannot simulate.
    #[error("the visit in the link is on a floor of the quality {0:?}, which this underfoot does not know")]
    Quality(String),
}

impl SharedLayout {
    /// The kinds and effects that come with underfoot, and those of the link.
    ///
    /// # Errors
    /// The problems of the first effect, or of the kinds, that cannot be read.
    pub fn all_kinds(&self) -> Result<Kinds, Diagnostics> {
        let mut effects = Effects::builtin();
        for (file, text) in &self.effects {
            effects.add(text, file)?;
        }
        let mut kinds = Kinds::shipped(effects)?;
        let files = self.kinds.iter().map(|(file, text)| (file.as_str(), text.as_str()));
        kinds.add_all(&files.collect::<Vec<_>>())?;
        Ok(kinds)
    }

    /// The same layout without the kinds and effects that it does not use on a floor of this geometry.
    ///
    /// # Errors
    /// All problems of the texts: a layout with errors is not shared.
    pub fn with_used_only(mut self, geometry: &Geometry) -> Result<Self, Diagnostics> {
        let read = |shared: &Self| -> Result<Layout, Diagnostics> {
            let kinds = shared.all_kinds()?;
            Ok(parse_layout(&shared.text, &shared.name, &kinds, geometry)?.layout)
        };
        let whole = read(&self)?;
        type Texts = fn(&mut SharedLayout) -> &mut BTreeMap<String, String>;
        let both: [Texts; 2] = [|shared| &mut shared.kinds, |shared| &mut shared.effects];
        for texts in both {
            for file in texts(&mut self).keys().cloned().collect::<Vec<_>>() {
                let Some(text) = texts(&mut self).remove(&file) else { continue };
                if read(&self).ok().as_ref() != Some(&whole) {
                    texts(&mut self).insert(file, text);
                }
            }
        }
        Ok(self)
    }

    /// The length of all texts together, in bytes.
    #[must_use]
    pub fn len(&self) -> usize {
        let of = |texts: &BTreeMap<String, String>| -> usize {
            texts.iter().map(|(name, text)| name.len() + text.len()).sum()
        };
        self.name.len() + self.text.len() + of(&self.kinds) + of(&self.effects)
    }

    /// Whether there is no text at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The part of a link behind the address of the page: `#` and the layout.
    ///
    /// # Errors
    /// [`LinkError::TooLong`] if the texts have more than [`MAX_TEXT`] bytes, [`LinkError::LongVisit`] for a visit of
    /// more than [`MAX_VISIT`] letters.
    pub fn fragment(&self) -> Result<String, LinkError> {
        let bytes = self.len();
        if bytes > MAX_TEXT {
            return Err(LinkError::TooLong { bytes });
        }
        self.visit.as_ref().map_or(Ok(()), SharedVisit::check_length)?;
        let json = serde_json::to_vec(self).map_err(|_| LinkError::TooLong { bytes })?;
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
        let packed = packer.write_all(&json).and_then(|()| packer.finish());
        let packed = packed.map_err(|_| LinkError::TooLong { bytes })?;
        Ok(format!("#{VERSION}.{}", URL_SAFE_NO_PAD.encode(packed)))
    }

    /// The layout in `link`: a whole address, or its part from `#` on.
    ///
    /// # Errors
    /// [`LinkError`] says why the link cannot be read; any text gives a layout or an error.
    pub fn of_link(link: &str) -> Result<Self, LinkError> {
        let (_, fragment) = link.split_once('#').ok_or(LinkError::NoLayout)?;
        if fragment.len() > MAX_LINK {
            return Err(LinkError::Damaged);
        }
        // Letters and chats break long lines.
        let fragment: String = fragment.split_whitespace().collect();
        let (version, data) = fragment.split_once('.').ok_or(LinkError::NoLayout)?;
        match version {
            VERSION => {}
            newer if newer.parse::<u32>().is_ok_and(|newer| newer > 1) => {
                return Err(LinkError::Newer(newer.into()));
            }
            _ => return Err(LinkError::NoLayout),
        }
        let packed = URL_SAFE_NO_PAD.decode(data).map_err(|_| LinkError::Damaged)?;
        let mut json = Vec::new();
        let unpacked = ZlibDecoder::new(packed.as_slice()).take(MAX_JSON + 1).read_to_end(&mut json);
        if unpacked.is_err() || json.len() as u64 > MAX_JSON {
            return Err(LinkError::Damaged);
        }
        let shared: Self = serde_json::from_slice(&json).map_err(|_| LinkError::Damaged)?;
        if shared.len() > MAX_TEXT {
            return Err(LinkError::Damaged);
        }
        if let Some(visit) = &shared.visit {
            visit.feet()?;
            visit.quality()?;
        }
        Ok(shared)
    }
}
