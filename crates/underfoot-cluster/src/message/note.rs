//! Messages between neighbours: the haptic cues on each other's tiles.

use serde::{Deserialize, Serialize};
use underfoot::feel::{Click, Cue, Lasting, Manner, Spot, SustainedCue, Tone};
use underfoot::units::{Instant, Newtons};

use crate::auth::{Echo, EnvelopeHead};

/// A tile by its column and row on the whole floor, and the weight of the cue there.
pub type NoteSpot = (u16, u16, f32);

/// A message of one node to a neighbour: a datagram of its own beside those of the boards.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// The version of the messages: [`super::VERSION`].
    pub version: u32,
    /// The floor: [`super::fingerprint`] of the node's floor file.
    pub floor: u64,
    /// The area that the node serves.
    pub area: String,
    /// The node's nonce; it changes at a restart.
    #[serde(skip)]
    pub node: u64,
    /// The note's number, from 1; datagrams to other neighbours have numbers between.
    #[serde(skip)]
    pub sequence: u64,
    /// The time of sending, on the node's clock.
    #[serde(skip)]
    pub sent: u64,
    /// The message of the neighbour that this one answers.
    #[serde(skip)]
    pub echo: Option<Echo>,
    /// Number of cues in all earlier notes.
    pub earlier: u64,
    /// The transient cues.
    pub cues: Vec<NoteCue>,
    /// All sustained cues on the neighbour's tiles.
    pub lasting: Vec<NoteLasting>,
}

/// A transient cue.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NoteCue {
    /// The time at which the foot caused it, on the node's clock.
    pub at: u64,
    /// The tiles on which it plays.
    pub spots: Vec<NoteSpot>,
    /// The click.
    pub click: Click,
    /// The tone that follows the click.
    pub tone: Option<Tone>,
    /// How it mixes with other cues on the same tiles.
    pub manner: Manner,
}

/// A sustained cue: it lasts as long as a foot slides, presses or pushes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NoteLasting {
    /// Its number, unique within that node.
    pub key: u32,
    /// The tiles on which it plays.
    pub spots: Vec<NoteSpot>,
    /// The effect.
    pub effect: Lasting,
    /// How it mixes with other cues on the same tiles.
    pub manner: Manner,
    /// Slip speed, in metres per second.
    pub speed_m_s: f32,
    /// Normal force, in newtons.
    pub force_n: f32,
}

impl Note {
    /// The note with the contents of its envelope.
    #[must_use]
    pub fn in_envelope(self, head: &EnvelopeHead, echo: Option<Echo>) -> Self {
        let EnvelopeHead { from, counter, sent } = *head;
        Self { node: from, sequence: counter, sent, echo, ..self }
    }
}

impl NoteCue {
    /// `cue` on `spots` of a neighbour. Only its own node plays it through loudspeakers.
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

    /// The cue on `spots`, starting at `at`.
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
    /// `sustained` on `spots` of a neighbour.
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

    /// The sustained cue with the number `key` on `spots`.
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
