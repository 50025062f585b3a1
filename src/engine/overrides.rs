//! Labels and ranges that apps have set in place of those of the layout.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::layout::Layout;
use crate::widget::{Scale, WidgetId};

/// Labels and ranges by the ids of their controls, also for later layouts.
#[derive(Debug, Default)]
pub(super) struct Overrides {
    labels: BTreeMap<WidgetId, Arc<str>>,
    ranges: BTreeMap<WidgetId, [f32; 2]>,
}

/// Maximum number of characters of a label, the same as in layouts.
const LONGEST: usize = 64;

impl Overrides {
    /// Writes `text` on control number `index` of `layout`, cut to the maximum length of a label.
    pub(super) fn write_label(&mut self, layout: &mut Layout, index: usize, text: &str) {
        let Some(widget) = layout.widgets.get_mut(index) else { return };
        let end = text.char_indices().nth(LONGEST).map_or(text.len(), |(at, _)| at);
        widget.label = text[..end].to_owned();
        self.labels.insert(widget.id.clone(), widget.label.as_str().into());
    }

    /// Stores the range of the control named `id`, already set in its layout.
    pub(super) fn keep_range(&mut self, id: WidgetId, ends: [f32; 2]) {
        self.ranges.insert(id, ends);
    }

    /// Applies the settings of apps to a new layout; drops those without a control in it.
    pub(super) fn apply(&mut self, layout: &mut Layout) {
        self.labels.retain(|id, _| layout.widget_index(id.as_str()).is_some());
        for widget in &mut layout.widgets {
            if let Some(label) = self.labels.get(&widget.id) {
                widget.label = label.as_ref().to_owned();
            }
            // A control that cannot have the range any more keeps the range of its layout.
            let range = self.ranges.get(&widget.id);
            match range.and_then(|&[least, greatest]| widget.behaviour.with_range(least, greatest)) {
                Some(behaviour) => widget.behaviour = behaviour,
                None => drop(self.ranges.remove(&widget.id)),
            }
        }
        self.ranges.retain(|id, _| layout.widget_index(id.as_str()).is_some());
    }

    /// The labels that apps wrote, with the index of their control.
    pub(super) fn labels<'a>(&'a self, layout: &'a Layout) -> impl Iterator<Item = (usize, Arc<str>)> + 'a {
        self.labels.iter().filter_map(|(id, label)| Some((layout.widget_index(id.as_str())?, label.clone())))
    }

    /// The ranges that apps set, with the index of their control.
    pub(super) fn ranges<'a>(&'a self, layout: &'a Layout) -> impl Iterator<Item = (usize, Scale)> + 'a {
        self.ranges.keys().filter_map(|id| {
            let index = layout.widget_index(id.as_str())?;
            Some((index, *layout.widgets.get(index)?.behaviour.scale()?))
        })
    }
}
