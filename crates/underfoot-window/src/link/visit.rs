//! A visit in a link: the feet of a simulated floor over time, and the floor.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use serde::{Deserialize, Serialize};
use underfoot_sim::{BadFeet, FloorBuild, FloorQuality, RecordedFeet};

use super::LinkError;

/// Maximum length of a visit in a link, in letters: some minutes of feet that never rest. Browsers take addresses of
/// some 80,000 letters and more.
pub const MAX_VISIT: usize = 48 * 1024;

/// Maximum length of the feet before they are packed, in bytes: recorded feet have at most 60,000 points, each with less
/// than nine bytes as a rule.
const MAX_CODE: u64 = 1 << 20;

/// A visit to a layout: feet on a simulated floor. The same visit gives the same events in the program and in every
/// browser.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SharedVisit {
    /// Name of the floor's quality.
    quality: String,
    /// Seed of the floor.
    seed: u64,
    /// The feet: [`RecordedFeet::encode`], zlib and base64url.
    feet: String,
}

impl SharedVisit {
    /// A visit with these feet on a floor of this quality and seed.
    ///
    /// # Errors
    /// [`LinkError::LongVisit`] if it has more than [`MAX_VISIT`] letters.
    pub fn new(feet: &RecordedFeet, quality: FloorQuality, seed: u64) -> Result<Self, LinkError> {
        let code = feet.encode();
        let mut packed = Vec::new();
        let read = ZlibEncoder::new(code.as_slice(), Compression::best()).read_to_end(&mut packed);
        read.map_err(|_| LinkError::LongVisit { letters: code.len() })?;
        let visit = Self { quality: quality.name().to_owned(), seed, feet: URL_SAFE_NO_PAD.encode(packed) };
        visit.check_length().map(|()| visit)
    }

    /// Number of letters that the feet take in a link, before the link itself packs them a little more.
    #[must_use]
    pub fn letters(&self) -> usize {
        self.feet.len()
    }

    pub(super) fn check_length(&self) -> Result<(), LinkError> {
        let letters = self.feet.len();
        if letters > MAX_VISIT { Err(LinkError::LongVisit { letters }) } else { Ok(()) }
    }

    /// The feet.
    ///
    /// # Errors
    /// [`LinkError::Feet`] if they are damaged, or written by a newer program; [`LinkError::LongVisit`].
    pub fn feet(&self) -> Result<RecordedFeet, LinkError> {
        self.check_length()?;
        let packed = URL_SAFE_NO_PAD.decode(&self.feet).map_err(|_| BadFeet::Damaged)?;
        let mut code = Vec::new();
        let unpacked = ZlibDecoder::new(packed.as_slice()).take(MAX_CODE + 1).read_to_end(&mut code);
        if unpacked.is_err() || code.len() as u64 > MAX_CODE {
            return Err(BadFeet::Damaged.into());
        }
        Ok(RecordedFeet::decode(&code)?)
    }

    /// The quality of the floor.
    ///
    /// # Errors
    /// [`LinkError::Quality`] if this program does not know it.
    pub fn quality(&self) -> Result<FloorQuality, LinkError> {
        self.quality.parse().map_err(|_| LinkError::Quality(self.quality.chars().take(32).collect()))
    }

    /// The way to the floor.
    ///
    /// # Errors
    /// As for [`SharedVisit::quality`].
    pub fn build(&self) -> Result<FloorBuild, LinkError> {
        Ok(FloorBuild::of(self.quality()?, self.seed))
    }
}
