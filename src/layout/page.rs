//! A page of controls.

use crate::widget::WidgetId;

/// A page of controls: those on it are there while it is shown, together with those on all pages.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Unique among the layout's pages.
    pub id: WidgetId,
    /// What people call it; may be empty.
    pub title: String,
}
