//! Layouts on their way to nodes.

use serde::{Deserialize, Serialize};

use super::fnv;

/// Names a layout.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct LayoutName {
    /// The gateway's number for it: greater than those of earlier ones. 0 for a layout from the node's own file.
    pub revision: u64,
    /// A hash of its text. Layouts with the same text are the same, whichever gateway numbered them.
    pub digest: u64,
}

impl LayoutName {
    /// The name of the layout that `text` describes.
    #[must_use]
    pub fn of(revision: u64, text: &str) -> Self {
        Self { revision, digest: fnv(text.as_bytes()) }
    }
}

impl PartialEq for LayoutName {
    fn eq(&self, other: &Self) -> bool {
        self.digest == other.digest
    }
}

/// A layout, for all nodes to check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LayoutMessage {
    /// The version of the messages: [`super::VERSION`].
    pub version: u32,
    /// The nonce of the gateway that sends it.
    #[serde(skip)]
    pub gateway: u64,
    /// The name of the layout.
    pub name: LayoutName,
    /// The layout of the whole floor, as a file describes it.
    pub text: String,
}

/// The state of a node's layouts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LayoutStanding {
    /// The layout that is on its floor, or will be as soon as no foot holds a control.
    pub running: Option<LayoutName>,
    /// The last one that passed its check.
    pub ready: Option<LayoutName>,
    /// The last one that failed its check, and the reason.
    pub refused: Option<(LayoutName, String)>,
}

/// A gateway's instruction about layouts; it repeats it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LayoutOrder {
    /// The layout that all nodes are to have.
    pub current: Option<LayoutName>,
    /// The time from which it applies, for each node with a known clock, on that clock.
    pub from: Vec<(String, u64)>,
}
