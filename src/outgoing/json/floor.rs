//! Pages, grounds and areas of the floor, and gaps between lines.

use serde::{Deserialize, Serialize};

use super::text::{Sentence, Word};
use crate::messages::MessageNews;
use crate::outgoing::AreaNews;

/// A page is shown: a line `page`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PageRecord {
    /// The page.
    pub page: Option<Word>,
}

/// A ground has cracked: a line `crack`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CrackRecord {
    /// The seed of its cracks.
    pub seed: u32,
    /// Energy of the crack, in joules.
    pub energy_j: f32,
    /// Position in floor metres, eastwards.
    pub x_m: f32,
    /// Position in floor metres, northwards.
    pub y_m: f32,
    /// Number of cracks left out since the last line.
    pub skipped: u32,
}

/// The state of an area has changed: a line `area`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AreaRecord {
    /// The area.
    pub area: Word,
    /// Its state: [`crate::outgoing::AreaState::name`].
    pub state: Word,
    /// The reason.
    pub why: Sentence,
    /// Maximum error of its times, in seconds.
    pub uncertainty_s: f64,
}

impl From<&AreaNews> for AreaRecord {
    fn from(AreaNews { area, state, why, uncertainty, .. }: &AreaNews) -> Self {
        Self {
            area: area.as_str().into(),
            state: state.name().into(),
            why: why.as_str().into(),
            uncertainty_s: uncertainty.as_secs_f64(),
        }
    }
}

/// A control or a foot gives a message to another program: a line `sent`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SentRecord {
    /// The control, or the region of the foot.
    pub id: Word,
    /// The name of the target in the layout.
    pub target: Word,
    /// The content, for people.
    pub message: Sentence,
}

impl From<&MessageNews> for SentRecord {
    fn from(news: &MessageNews) -> Self {
        Self {
            id: news.order.control.as_str().into(),
            target: news.target().into(),
            message: news.order.act.to_string().as_str().into(),
        }
    }
}

/// Lines were left out for a slow reader: a line `gap`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GapRecord {
    /// Their number.
    pub dropped: u64,
}
