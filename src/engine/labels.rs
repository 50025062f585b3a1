//! Labels that apps write on controls.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::layout::Layout;
use crate::widget::WidgetId;

/// What apps have written on controls, in place of what the layout says.
#[derive(Debug, Default)]
pub(super) struct Labels {
    written: BTreeMap<WidgetId, Arc<str>>,
}

/// Most characters of a label, as in layouts.
const LONGEST: usize = 64;

impl Labels {
    /// Writes `text` on the control at `index`; what is longer than a label may be is left out.
    pub(super) fn write(&mut self, layout: &mut Layout, index: usize, text: &str) {
        let Some(widget) = layout.widgets.get_mut(index) else { return };
        let end = text.char_indices().nth(LONGEST).map_or(text.len(), |(at, _)| at);
        widget.label = text[..end].to_owned();
        self.written.insert(widget.id.clone(), widget.label.as_str().into());
    }

    /// Writes all of them on the controls of another layout; those it does not have are forgotten.
    pub(super) fn apply(&mut self, layout: &mut Layout) {
        self.written.retain(|id, _| layout.widget_index(id.as_str()).is_some());
        for widget in &mut layout.widgets {
            if let Some(label) = self.written.get(&widget.id) {
                widget.label = label.as_ref().to_owned();
            }
        }
    }

    /// The controls written on, by their index in `layout`, and what is written.
    pub(super) fn iter<'a>(&'a self, layout: &'a Layout) -> impl Iterator<Item = (usize, Arc<str>)> + 'a {
        self.written.iter().filter_map(|(id, label)| Some((layout.widget_index(id.as_str())?, label.clone())))
    }
}
