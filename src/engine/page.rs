//! The change of page, as events tell it.

use crate::units::Instant;
use crate::widget::WidgetId;

/// A page of controls has taken the place of another.
#[derive(Clone, Debug, PartialEq)]
pub struct PageShown {
    /// When, on the floor's sample clock.
    pub at: Instant,
    /// The page that is shown now.
    pub page: WidgetId,
}
