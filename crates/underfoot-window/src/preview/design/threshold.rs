//! Sets thresholds from recorded presses, in any mode.

use super::Designer;
use crate::edit::{Document, Edit, pressing, releasing};
use crate::preview::feed::LayoutCause;
use crate::preview::shown::ShownFloor;
use underfoot::layout::Layout;
use underfoot::units::Newtons;
use underfoot::widget::{Thresholds, WidgetId};

/// A threshold of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::preview) enum Threshold {
    /// The force that presses the control; the other threshold changes in proportion.
    Press,
    /// The force below which the control is released.
    Release,
}

impl Threshold {
    /// The minimum of the threshold, in newtons.
    pub(in crate::preview) fn least(self) -> f32 {
        match self {
            Self::Press => 10.0,
            Self::Release => 1.0,
        }
    }
}

/// The edits that set a threshold of the control called `id`, its present thresholds, and the number of other
/// controls from the same record, such as a grid.
fn thresholding(
    document: &Document,
    id: &WidgetId,
    which: Threshold,
    force: Newtons,
) -> Option<(Vec<Edit>, Thresholds, usize)> {
    let layout = document.layout();
    let index = layout.widget_index(id.as_str())?;
    let now = layout.widgets.get(index)?.behaviour.thresholds();
    let record = document.record_of(index)?;
    let made = (0..layout.widgets.len())
        .filter(|widget| *widget != index && document.record_of(*widget).as_ref() == Some(&record));
    let edits = match which {
        Threshold::Press => pressing(&record, now, force),
        Threshold::Release => releasing(&record, now, force),
    };
    Some((edits, now, made.count()))
}

fn thresholds_of(layout: &Layout, id: &WidgetId) -> Option<Thresholds> {
    let index = layout.widget_index(id.as_str())?;
    Some(layout.widgets.get(index)?.behaviour.thresholds())
}

/// Sets a threshold of the control called `id` in the layout's text as one undo step, and tries it on the floor;
/// returns a message about the change. Without a designer, nothing changes.
pub(in crate::preview) fn set_threshold(
    designer: Option<&mut Designer>,
    shown: &ShownFloor,
    id: &WidgetId,
    which: Threshold,
    force: Newtons,
) -> String {
    let Some(designer) = designer else {
        return "This layout can't be changed here.".into();
    };
    let document = &mut designer.edited.document;
    let Some((edits, before, others)) = thresholding(document, id, which, force) else {
        return format!("{id} is not in the layout that is being designed.");
    };
    if let Err(refusal) = document.edit(&edits) {
        return refusal.short();
    }
    let after = thresholds_of(document.layout(), id).unwrap_or(before);
    designer.try_layout(shown, LayoutCause::Designed);
    told(id, before, after, others)
}

/// Undoes the last step of the layout and tries the result on the floor; returns whether anything changed.
pub(in crate::preview) fn undo_design(designer: &mut Designer, shown: &ShownFloor) -> bool {
    let before = designer.edited.document.revision();
    designer.edited.undo();
    let is_changed = designer.edited.document.revision() != before;
    if is_changed {
        designer.try_layout(shown, LayoutCause::Designed);
    }
    is_changed
}

/// The message about a change.
fn told(id: &WidgetId, before: Thresholds, after: Thresholds, others: usize) -> String {
    let newtons = |force: Newtons| format!("{:.0} N", force.0);
    let with = match others {
        0 => String::new(),
        1 => " and its neighbour in the grid".into(),
        more => format!(" and {more} others of its grid"),
    };
    let change = |what: &str, before: Newtons, after: Newtons| {
        if before == after {
            format!("{what} {}, as before", newtons(after))
        } else {
            format!("{what} {}, was {}", newtons(after), newtons(before))
        }
    };
    let mut text = format!(
        "{id}{with}: {}; {}.",
        change("takes", before.press, after.press),
        change("lets go below", before.release, after.release)
    );
    if after.share.is_some() {
        text.push_str(" Once a person’s weight is known, their share of it counts instead.");
    }
    text
}
