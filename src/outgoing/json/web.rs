//! Requests and greetings of the web server.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::text::{Sentence, Word};

/// A request of a client, such as `{"request":"widget/zoom/set","args":[0.5]}`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RequestRecord {
    /// The arguments.
    #[serde(default)]
    pub args: Vec<Value>,
    /// The address without its prefix.
    pub request: String,
}

/// The answer to a refused request: a line `error`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RefusalRecord {
    /// The request; empty if it could not be read.
    pub request: Word,
    /// The reason.
    pub why: Sentence,
}

/// The number of clients has changed: a line `clients`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ClientsRecord {
    /// Number of connected clients.
    pub connected: usize,
    /// Number of messages that clients missed, since they did not read.
    pub dropped: u64,
}

/// The greeting of a web client: a line `floor`, with its fields in the order of their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FloorRecord {
    /// The controls, each as a [`PlacedControl`].
    pub controls: Vec<Value>,
    /// Size of the floor in metres, northwards.
    pub depth_m: f64,
    /// Always `floor`.
    pub event: Word,
    /// The state of the link, by name.
    pub link: Word,
    /// The cause of unusable frames, by name.
    pub link_cause: Option<Word>,
    /// The page that is shown; null without pages.
    pub page: Option<Word>,
    /// Depth of a tile in metres, if it differs from its width.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tile_depth_m: Option<f64>,
    /// Width of a tile, in metres.
    pub tile_m: f64,
    /// The title of the layout.
    pub title: String,
    /// The cause of unusable frames as a sentence.
    pub why: Option<Sentence>,
    /// Size of the floor in metres, eastwards.
    pub width_m: f64,
}

/// The place and the state of a control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlacedControl {
    /// Its kind in the layout.
    pub kind: String,
    /// South-west corner in floor metres, eastwards.
    pub x_m: f64,
    /// South-west corner in floor metres, northwards.
    pub y_m: f64,
    /// Size in metres, eastwards.
    pub width_m: f64,
    /// Size in metres, northwards.
    pub depth_m: f64,
    /// The fields of its [`super::StateRecord`].
    #[serde(flatten)]
    pub state: Map<String, Value>,
}

/// The greeting of a window that joins: a line `mirror`. `C` is the form of the controls' states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GreetingRecord<C> {
    /// Always `mirror`.
    pub event: Word,
    /// The version of the stream.
    pub version: u8,
    /// The method that makes contacts from tile forces, by name.
    pub method: Word,
    /// The server's time, in seconds.
    pub t_s: f64,
    /// The page that is shown; null without pages.
    pub page: Option<Word>,
    /// Whether the server accepts layouts from others.
    pub takes_layouts: bool,
    /// The floor file.
    pub floor: String,
    /// The layout file.
    pub layout: String,
    /// The state of each control.
    pub controls: C,
}
