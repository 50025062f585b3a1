//! A message of the layout on the floor, for those who send it and for those who show it.

use std::fmt;
use std::sync::Arc;

use super::order::{Act, MessageOrder};
use super::plan::MessagePlan;
use crate::units::Instant;

/// One message that a control or a foot gives.
///
/// Sessions report it as data. Only a sink that the operator has given a layout's targets sends it.
#[derive(Clone, Debug, PartialEq)]
pub struct MessageNews {
    /// Its time.
    pub at: Instant,
    /// The message, and the index of its target.
    pub order: MessageOrder,
    /// All messages of the layout on the floor, with the targets.
    pub plan: Arc<MessagePlan>,
}

impl MessageNews {
    /// The name of its target in the layout.
    #[must_use]
    pub fn target(&self) -> &str {
        self.plan.targets.get(self.order.target).map_or("", |target| &target.name)
    }

    /// Whether a later message of the same control replaces it for those who only show messages: all but those that go
    /// down or come up.
    #[must_use]
    pub const fn is_replaceable(&self) -> bool {
        !matches!(self.order.act, Act::Down(..) | Act::Up(_) | Act::Stroke(_))
    }
}

impl fmt::Display for MessageNews {
    /// Its target and its content.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.target(), self.order.act)
    }
}
