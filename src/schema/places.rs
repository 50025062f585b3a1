//! Where the parts of a layout are written.

use std::sync::Arc;

use super::control::ControlSpans;

/// Where the controls of a layout are written: what is found out about them later is shown there.
#[derive(Clone, Debug)]
#[cfg_attr(not(feature = "ergonomics"), expect(dead_code, reason = "only a review points at these"))]
pub struct Places {
    pub(super) name: Arc<str>,
    pub(super) text: Arc<str>,
    /// In the order of the layout's widgets.
    pub(super) widgets: Vec<ControlSpans>,
}

impl PartialEq for Places {
    /// Whether both are of the same text, whatever it is called.
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Places {
    pub(super) fn new(name: &str, text: &str, widgets: Vec<ControlSpans>) -> Self {
        Self { name: name.into(), text: text.into(), widgets }
    }
}
