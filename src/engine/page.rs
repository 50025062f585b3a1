//! The change of page, as events report it.

use crate::units::Instant;
use crate::widget::WidgetId;

/// A page of controls has replaced another.
#[derive(Clone, Debug, PartialEq)]
pub struct PageShown {
    /// When, on the floor's sample clock.
    pub at: Instant,
    /// The new page.
    pub page: WidgetId,
}
