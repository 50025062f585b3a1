//! Layouts on their way to nodes.

use serde::{Deserialize, Serialize};

use super::fnv;

/// Which layout.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct LayoutName {
    /// The gateway's number for it: greater than those of earlier ones. 0 for one that a node has from its own file.
    pub revision: u64,
    /// A number of its text. Layouts with the same text are the same, whoever numbered them.
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
    /// Which layout.
    pub name: LayoutName,
    /// The layout of the whole floor, as a file describes it.
    pub text: String,
}

/// How a node stands with layouts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LayoutStanding {
    /// The layout that is on its floor, or will be as soon as no foot holds a control.
    pub running: Option<LayoutName>,
    /// The last one that it has found good.
    pub ready: Option<LayoutName>,
    /// The last one that it has not, and why.
    pub refused: Option<(LayoutName, String)>,
}

/// What a gateway says of layouts, again and again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LayoutOrder {
    /// The layout that all nodes are to have.
    pub current: Option<LayoutName>,
    /// From when on, for each node whose clock is known, on that clock.
    pub from: Vec<(String, u64)>,
}
