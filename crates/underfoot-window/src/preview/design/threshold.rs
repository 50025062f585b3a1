//! Sets thresholds from recorded presses, in any mode.

use super::Designer;
use crate::edit::{Document, Edit};
use crate::preview::app::App;
use crate::preview::feed::LayoutCause;
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

impl Designer {
    /// The edits that set a threshold of the control called `id`, its present thresholds, and the number of other
    /// controls from the same record, such as a grid.
    fn thresholding(
        &self,
        id: &WidgetId,
        which: Threshold,
        force: Newtons,
    ) -> Option<(Vec<Edit>, Thresholds, usize)> {
        let layout = self.layout();
        let index = layout.widget_index(id.as_str())?;
        let now = layout.widgets.get(index)?.behaviour.thresholds();
        let record = self.document.record_of(index)?;
        let made = (0..layout.widgets.len())
            .filter(|widget| *widget != index && self.document.record_of(*widget).as_ref() == Some(&record));
        let edits = match which {
            Threshold::Press => Document::pressing(&record, now, force),
            Threshold::Release => Document::releasing(&record, now, force),
        };
        Some((edits, now, made.count()))
    }

    fn thresholds_of(&self, id: &WidgetId) -> Option<Thresholds> {
        let index = self.layout().widget_index(id.as_str())?;
        Some(self.layout().widgets.get(index)?.behaviour.thresholds())
    }
}

impl App {
    /// Sets a threshold of the control called `id` in the layout's text as one undo step, and tries it on the floor;
    /// returns a message about the change.
    pub(in crate::preview) fn set_threshold(
        &mut self,
        id: &WidgetId,
        which: Threshold,
        force: Newtons,
    ) -> String {
        let Some(designer) = &mut self.designer else {
            return "This layout can't be changed here.".into();
        };
        let Some((edits, before, others)) = designer.thresholding(id, which, force) else {
            return format!("{id} is not in the layout that is being designed.");
        };
        if let Err(refusal) = designer.document.edit(&edits) {
            return refusal.short();
        }
        let after = designer.thresholds_of(id).unwrap_or(before);
        self.try_layout(LayoutCause::Designed);
        told(id, before, after, others)
    }

    /// Undoes the last step of the layout and tries the result on the floor; returns whether anything changed.
    pub(in crate::preview) fn undo_design(&mut self) -> bool {
        let Some(designer) = &mut self.designer else { return false };
        let before = designer.document.revision();
        designer.undo();
        let is_changed = designer.document.revision() != before;
        if is_changed {
            self.try_layout(LayoutCause::Designed);
        }
        is_changed
    }
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
