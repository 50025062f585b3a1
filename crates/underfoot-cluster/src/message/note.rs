//! What neighbours tell each other: what is felt on the other's tiles.

use serde::{Deserialize, Serialize};
use underfoot::feel::{Click, Cue, Lasting, Manner, Spot, SustainedCue, Tone};
use underfoot::units::{Instant, Newtons};

use crate::auth::{Echo, Head};

/// A tile by its column and row on the whole floor, and the share of the level that is felt there.
pub type NoteSpot = (u16, u16, f32);

/// What one node tells a neighbour: a datagram of its own beside those of the boards.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// The version of the messages: [`super::VERSION`].
    pub version: u32,
    /// Which floor: [`super::fingerprint`] of the node's floor file.
    pub floor: u64,
    /// Which area the node serves.
    pub area: String,
    /// The node's nonce: another one after a restart.
    #[serde(skip)]
    pub node: u64,
    /// The note's number, from 1; datagrams to other neighbours have numbers between.
    #[serde(skip)]
    pub sequence: u64,
    /// When it was sent, on the node's clock.
    #[serde(skip)]
    pub sent: u64,
    /// The message of the neighbour that it answers.
    #[serde(skip)]
    pub echo: Option<Echo>,
    /// How many cues earlier notes had.
    pub earlier: u64,
    /// What is felt once.
    pub cues: Vec<NoteCue>,
    /// All that lasts on the neighbour's tiles.
    pub lasting: Vec<NoteLasting>,
}

/// Something felt once.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NoteCue {
    /// When the foot caused it, on the node's clock.
    pub at: u64,
    /// Where it is felt.
    pub spots: Vec<NoteSpot>,
    /// The click.
    pub click: Click,
    /// What sounds for a while.
    pub tone: Option<Tone>,
    /// How it gets along with what else is felt there.
    pub manner: Manner,
}

/// Something felt for as long as a foot slides, presses or pushes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NoteLasting {
    /// Tells it from others of that node.
    pub key: u32,
    /// Where it is felt.
    pub spots: Vec<NoteSpot>,
    /// What is felt.
    pub effect: Lasting,
    /// How it gets along with what else is felt there.
    pub manner: Manner,
    /// Slip speed, in metres per second.
    pub speed_m_s: f32,
    /// Normal force, in newtons.
    pub force_n: f32,
}

impl Note {
    /// The note with the contents of its envelope.
    #[must_use]
    pub fn in_envelope(self, head: &Head, echo: Option<Echo>) -> Self {
        let Head { from, counter, sent } = *head;
        Self { node: from, sequence: counter, sent, echo, ..self }
    }
}

impl NoteCue {
    /// `cue`, felt on `spots` of a neighbour. It is heard from the loudspeakers of its own node alone.
    #[must_use]
    pub fn of(cue: &Cue, spots: Vec<NoteSpot>) -> Self {
        Self {
            at: cue.at.micros(),
            spots,
            click: cue.click.clone(),
            tone: cue.tone.clone(),
            manner: cue.manner,
        }
    }

    /// The cue, felt from `at` on `spots`.
    #[must_use]
    pub fn cue(&self, at: Instant, spots: impl IntoIterator<Item = Spot>) -> Cue {
        Cue {
            at,
            received: at,
            spots: spots.into_iter().collect(),
            click: self.click.clone(),
            tone: self.tone.clone(),
            manner: self.manner,
            audio_gain: 0.0,
            heard_at: None,
        }
    }
}

impl NoteLasting {
    /// `sustained`, felt on `spots` of a neighbour.
    #[must_use]
    pub fn of(sustained: &SustainedCue, spots: Vec<NoteSpot>) -> Self {
        Self {
            key: sustained.key,
            spots,
            effect: sustained.effect,
            manner: sustained.manner,
            speed_m_s: sustained.speed_m_s,
            force_n: sustained.force.0,
        }
    }

    /// What lasts, by the name `key`, on `spots`.
    #[must_use]
    pub fn sustained(&self, key: u32, spots: impl IntoIterator<Item = Spot>) -> SustainedCue {
        SustainedCue {
            key,
            spots: spots.into_iter().collect(),
            effect: self.effect,
            manner: self.manner,
            speed_m_s: self.speed_m_s,
            force: Newtons(self.force_n),
            audio_gain: 0.0,
        }
    }
}
