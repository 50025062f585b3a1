//! A page of controls.

use crate::widget::WidgetId;

/// A page of controls, shown together with the controls on all pages.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Unique among the layout's pages.
    pub id: WidgetId,
    /// Its title for people; may be empty.
    pub title: String,
}
