//! Messages of nodes and gateways: one JSON object each, in an envelope of [`crate::auth`].
//!
//! The envelope holds sender, number, time and echo of a message, and the JSON does not; these fields are filled in
//! from the envelope.
//!
//! Times are whole microseconds on the sender's clock. A node's clock starts with its program; the gateway estimates
//! the offset to its own clock.

mod contact;
mod event;
mod layout;
mod note;
mod request;
mod text;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use underfoot::floor::Floor;
use underfoot::sink::AreaState;

use crate::auth::{Echo, EnvelopeHead};

pub use contact::NodeContact;
pub use event::{NodeEvent, NodeValue};
pub use layout::{LayoutMessage, LayoutName, LayoutOrder, LayoutStanding};
pub use note::{Note, NoteCue, NoteLasting, NoteSpot};
pub use request::{NodeAnswer, NodeRequest, NodeState};
pub use text::{is_id, shown};

/// The version of the messages; a receiver refuses any other.
pub const VERSION: u32 = 3;

/// Longest message, in bytes: a layout of the greatest length of a file, with each character escaped.
pub const MAX_BYTES: usize = 1 << 23;

/// The report of a node, some hundred times a second.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NodeMessage {
    /// The version of the messages: [`VERSION`].
    pub version: u32,
    /// The floor: [`fingerprint`] of the node's floor file.
    pub floor: u64,
    /// The area that the node serves.
    pub area: String,
    /// The node's nonce; it changes at a restart.
    #[serde(skip)]
    pub node: u64,
    /// A name of the node for people, such as the address that it listens on.
    pub name: String,
    /// The message's number, from 1.
    #[serde(skip)]
    pub sequence: u64,
    /// The time of sending.
    #[serde(skip)]
    pub sent: u64,
    /// The message of the gateway that this one answers.
    #[serde(skip)]
    pub echo: Option<Echo>,
    /// The time of the newest frame of forces; `None` before the first.
    pub frame: Option<u64>,
    /// Whether the node's boards are silent.
    pub silent: bool,
    /// All contacts of that frame, those beyond the area too.
    pub contacts: Vec<NodeContact>,
    /// Frames before that one that no message has reported yet, oldest first: several were assembled at once.
    pub earlier: Vec<NodeFrame>,
    /// The number of the first of `events`; the others follow in sequence.
    pub first_event: u64,
    /// The events since the last message, in order.
    pub events: Vec<NodeEvent>,
    /// The controls that feet hold at that frame.
    pub held: Vec<String>,
    /// The values of the controls that no foot holds; only some messages have them.
    pub values: Option<Vec<(String, NodeValue)>>,
    /// The page shown last, if there was a report of one.
    pub page: Option<String>,
    /// The answers to requests.
    pub answers: Vec<NodeAnswer>,
    /// The state of the node's layouts.
    pub layout: LayoutStanding,
}

/// The contacts of one frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NodeFrame {
    /// The frame's time.
    pub at: u64,
    /// All its contacts, those beyond the area too.
    pub contacts: Vec<NodeContact>,
}

impl NodeMessage {
    /// The message with the contents of its envelope.
    #[must_use]
    pub fn in_envelope(self, head: &EnvelopeHead, echo: Option<Echo>) -> Self {
        let EnvelopeHead { from, counter, sent } = *head;
        Self { node: from, sequence: counter, sent, echo, ..self }
    }
}

/// A message of a gateway to all nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ToNodes {
    /// The state of the floor, twenty times a second, and at once when it changes.
    Beat(GatewayMessage),
    /// A layout to check.
    Layout(LayoutMessage),
}

impl ToNodes {
    /// The message with the contents of its envelope.
    #[must_use]
    pub fn in_envelope(self, head: &EnvelopeHead) -> Self {
        let EnvelopeHead { from: gateway, sent, .. } = *head;
        match self {
            Self::Beat(message) => Self::Beat(GatewayMessage { gateway, sent, ..message }),
            Self::Layout(message) => Self::Layout(LayoutMessage { gateway, ..message }),
        }
    }
}

/// The state of the floor as a gateway sends it to all nodes, twenty times a second.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GatewayMessage {
    /// The version of the messages: [`VERSION`].
    pub version: u32,
    /// The gateway's nonce; it changes at a restart.
    #[serde(skip)]
    pub gateway: u64,
    /// The time of sending.
    #[serde(skip)]
    pub sent: u64,
    /// The standing of each area with the gateway.
    pub areas: Vec<(String, AreaStanding)>,
    /// Requests of apps without an answer so far, in their order; each is repeated until its answer arrives.
    pub requests: Vec<NodeRequest>,
    /// The layout that nodes are to run.
    pub layout: LayoutOrder,
}

/// The standing of an area with a gateway.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AreaStanding {
    /// No message of it has arrived yet.
    #[default]
    Waiting,
    /// The gateway reports its contacts and events.
    Live,
    /// Its newest frame is more than 100 ms old: all holds in it are cancelled.
    Lost,
    /// Several nodes claim it: the gateway uses neither.
    Disputed,
}

impl From<AreaStanding> for AreaState {
    fn from(standing: AreaStanding) -> Self {
        match standing {
            AreaStanding::Waiting => Self::Waiting,
            AreaStanding::Live => Self::Live,
            AreaStanding::Lost => Self::Lost,
            AreaStanding::Disputed => Self::Disputed,
        }
    }
}

/// The reason why bytes are not a valid message.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BadMessage {
    /// It is longer than [`MAX_BYTES`].
    #[error("a message of {0} bytes")]
    TooLong(usize),
    /// This version cannot parse it.
    #[error("not a message: {0}")]
    Malformed(#[from] serde_json::Error),
}

/// The bytes of a message; empty for one that cannot be serialised, which does not occur in this crate.
#[must_use]
pub fn encode(message: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(message).unwrap_or_default()
}

/// The message that `bytes` hold.
///
/// # Errors
/// [`BadMessage`] for anything else.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, BadMessage> {
    if bytes.len() > MAX_BYTES {
        return Err(BadMessage::TooLong(bytes.len()));
    }
    Ok(serde_json::from_slice(bytes)?)
}

/// A hash of the positions of the floor's tiles and areas: equal on all computers with the same floor file.
///
/// It leaves out the calibration, which differs between nodes.
#[must_use]
pub fn fingerprint(floor: &Floor) -> u64 {
    let geometry = &floor.geometry;
    let areas: Vec<_> = floor.areas.iter().map(|area| (&area.id, area.tiles)).collect();
    let pitch = geometry.pitch_m();
    let square = format!("{:?} {} {areas:?}", geometry.block(), pitch.x);
    // Computers with older programs serve square grids.
    let text = match geometry.is_square_grid() {
        true => square,
        false => format!("{square} {pitch} {:?} {:?}", geometry.missing(), geometry.own_plates()),
    };
    fnv(text.as_bytes())
}

/// FNV-1a of 64 bits.
fn fnv(bytes: &[u8]) -> u64 {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

#[cfg(test)]
mod tests {
    use underfoot::floor::{Area, Geometry, TileBlock, TileId};

    use super::*;

    #[test]
    fn a_message_is_read_as_it_was_written_and_nothing_else_is() {
        let message = NodeMessage {
            version: VERSION,
            area: "west".into(),
            frame: Some(17),
            held: vec!["drive".into()],
            ..NodeMessage::default()
        };
        assert_eq!(decode::<NodeMessage>(&encode(&message)).unwrap(), message);
        let (head, echo) =
            (EnvelopeHead { from: 1, counter: 2, sent: 3 }, Some(Echo { sent: 4, received: 5 }));
        let filled = decode::<NodeMessage>(&encode(&message)).unwrap().in_envelope(&head, echo);
        assert_eq!((filled.node, filled.sequence, filled.sent, filled.echo), (1, 2, 3, echo));
        assert_eq!(decode::<NodeMessage>(&encode(&filled)).unwrap(), message, "these are in the envelope");
        assert!(decode::<NodeMessage>(&encode(&message)[1..]).is_err());
        assert!(matches!(decode::<NodeMessage>(&vec![b' '; MAX_BYTES + 1]), Err(BadMessage::TooLong(_))));
    }

    #[test]
    fn another_cut_of_the_floor_has_another_fingerprint() {
        let floor = Floor::of(Geometry::of_paper_tiles(12, 6).unwrap());
        let cut = |columns: u16| {
            let area = |id: &str, column, columns| {
                Area::new(id, TileBlock { first: TileId::new(column, 0), columns, rows: 6 })
            };
            fingerprint(
                &floor
                    .clone()
                    .with_areas(vec![area("west", 0, columns), area("east", columns, 12 - columns)]),
            )
        };
        assert_eq!(cut(6), cut(6));
        assert_ne!(cut(6), cut(5));
    }
}
