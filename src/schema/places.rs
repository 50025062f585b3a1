//! Places of the parts of a layout in its text.

use std::ops::Range;
use std::sync::Arc;

use super::control::ControlSpans;

/// Places of the controls of a layout in its text; later findings point to them.
#[derive(Clone, Debug)]
pub struct Places {
    pub(super) name: Arc<str>,
    pub(super) text: Arc<str>,
    /// In the order of the layout's widgets.
    pub(super) widgets: Vec<ControlSpans>,
}

impl PartialEq for Places {
    /// Whether both have the same text, regardless of its name.
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Places {
    pub(super) fn new(name: &str, text: &str, widgets: Vec<ControlSpans>) -> Self {
        Self { name: name.into(), text: text.into(), widgets }
    }

    /// Returns the bytes of the id of the control at `index`, or of its grid's ids, in the text without a byte-order
    /// mark.
    #[must_use]
    pub fn id_span(&self, index: usize) -> Option<Range<usize>> {
        self.widgets.get(index).map(|written| written.id.clone())
    }
}
