//! Where the parts of a layout are written.

#[cfg(feature = "edit")]
use std::ops::Range;
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

    /// Bytes of the text, without a byte-order mark, where the control at `index` has its id, or its grid its ids.
    #[cfg(feature = "edit")]
    pub(crate) fn id_span(&self, index: usize) -> Option<Range<usize>> {
        self.widgets.get(index).map(|written| written.id.clone())
    }
}
