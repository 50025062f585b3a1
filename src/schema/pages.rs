//! Pages of a layout, of which one is shown at a time, and the controls that switch them.
//!
//! ```ron
//! widgets: [ /* on every page */ ],
//! pages: [
//!     (id: "map", widgets: [(id: "more", kind: "button", …, goto: "settings")]),
//!     (id: "settings", title: "Settings", widgets: [(id: "back", kind: "button", …, goto: "map")]),
//! ],
//! ```

use super::arrange::WIDGETS;
use super::context::LayoutContext;
use super::control::WrittenControl;
use super::ground::{GROUNDS, GroundDefinition};
use super::lists::MAX_WIDGETS;
use super::problem::Problem;
use super::reader::Reader;
use super::suggest::did_you_mean;
use crate::layout;
use crate::widget::{Behaviour, WidgetId};
use underfoot_format::codec::{At, Distinct, Written};
use underfoot_format::{Id, Text, record};

record! {
    /// One of the pages of a layout; one is shown at a time.
    pub(super) struct LayoutPageRecord = "Page" with LayoutContext;
    /// Unique among the layout's pages.
    pub(super) id: Written<String> = "id", At(Id);
    /// Its title for people.
    pub(super) title: String = "title", Text(200) => String::new();
    /// The controls that exist only while the page is shown.
    pub(super) widgets: Vec<WrittenControl> = "widgets", WIDGETS => Vec::new();
    /// The simulated grounds while the page is shown.
    pub(super) grounds: Vec<GroundDefinition> = "grounds", GROUNDS => Vec::new();
}

/// The pages of a layout.
pub(super) const PAGES: Distinct<LayoutPageRecord> =
    Distinct { entry: "page", most: MAX_WIDGETS, about: |_, _, _, _| {} };

/// Whether two controls can be present at the same time.
pub(super) fn can_both_show(one: &WrittenControl, other: &WrittenControl) -> bool {
    one.page.is_none() || other.page.is_none() || one.page == other.page
}

/// Reports conflicts between pages and the controls that switch them.
pub(super) fn check(reader: &Reader<'_>, pages: &[LayoutPageRecord], controls: &[WrittenControl]) {
    for (number, definition) in pages.iter().enumerate() {
        let same = |other: &&LayoutPageRecord| other.id().is_some() && other.id == definition.id;
        if let Some(earlier) = pages[..number].iter().find(same) {
            let message = format!("two pages have the id \"{}\"", definition.id.value);
            let expected = format!("the first is on line {}", reader.line(&earlier.id.at));
            reader.report(Problem::error(definition.id.at.clone(), message).expected(expected));
        }
    }
    for control in controls {
        let Some(goto) = &control.goto else { continue };
        if number_of(&goto.value, pages).is_none() && pages.iter().all(|definition| definition.id().is_some())
        {
            let ids: Vec<&str> = pages.iter().filter_map(LayoutPageRecord::id).collect();
            let problem = Problem::error(goto.at.clone(), format!("there is no page \"{}\"", goto.value));
            let help = did_you_mean(&goto.value, &ids, '"');
            let help = help.unwrap_or_else(|| format!("add pages: [(id: \"{}\", widgets: [])]", goto.value));
            reader.report(problem.expected("no page is called so").help(help));
        }
        let clicks = control.kind.as_ref().is_none_or(|kind| matches!(kind.behaviour, Behaviour::Button(_)));
        if !clicks {
            let problem = Problem::error(goto.at.clone(), "only a button's click switches pages");
            reader.report(problem.expected("this control never clicks").help("use a kind of button"));
        }
    }
}

impl LayoutPageRecord {
    /// Returns its id, if it could be read.
    fn id(&self) -> Option<&str> {
        (!self.id.at.is_empty()).then_some(&self.id.value)
    }

    /// Makes the page for the engine.
    pub(super) fn checked(&self) -> layout::Page {
        layout::Page { id: WidgetId::new(&self.id.value), title: self.title.clone() }
    }
}

/// Returns the index of the page with this `id` among `pages`.
pub(super) fn number_of(id: &str, pages: &[LayoutPageRecord]) -> Option<usize> {
    pages.iter().position(|definition| definition.id() == Some(id))
}
