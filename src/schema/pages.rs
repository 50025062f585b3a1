//! Pages that take turns on one floor, and the controls that switch them.
//!
//! ```ron
//! widgets: [ /* on every page */ ],
//! pages: [
//!     (id: "map", widgets: [(id: "more", kind: "button", …, goto: "settings")]),
//!     (id: "settings", title: "Settings", widgets: [(id: "back", kind: "button", …, goto: "map")]),
//! ],
//! ```

use super::arrange::WIDGETS;
use super::control::Control;
use super::ground::{GROUNDS, GroundDefinition};
use super::lists::MAX_WIDGETS;
use super::problem::Problem;
use super::reader::Reader;
use super::suggest::did_you_mean;
use crate::format::codec::{At, Distinct, Written};
use crate::format::{Id, Text, record};
use crate::layout;
use crate::widget::{Behaviour, WidgetId};

record! {
    /// One of the pages that take turns on one floor.
    pub(super) struct PageRecord = "Page";
    /// Unique among the layout's pages.
    pub(super) id: Written<String> = "id", At(Id);
    /// What people call it.
    pub(super) title: String = "title", Text(200) => String::new();
    /// The controls that are there only while the page is shown.
    pub(super) widgets: Vec<Control> = "widgets", WIDGETS => Vec::new();
    /// What the floor seems to be made of while the page is shown.
    pub(super) grounds: Vec<GroundDefinition> = "grounds", GROUNDS => Vec::new();
}

/// The pages of a layout.
pub(super) const PAGES: Distinct<PageRecord> =
    Distinct { entry: "page", most: MAX_WIDGETS, about: |_, _, _, _| {} };

/// Whether two controls are ever there at the same time.
pub(super) fn can_both_show(one: &Control, other: &Control) -> bool {
    one.page.is_none() || other.page.is_none() || one.page == other.page
}

/// Notes what is wrong between pages and the controls that switch them.
pub(super) fn check(reader: &Reader<'_>, pages: &[PageRecord], controls: &[Control]) {
    for (number, definition) in pages.iter().enumerate() {
        let same = |other: &&PageRecord| other.id().is_some() && other.id == definition.id;
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
            let ids: Vec<&str> = pages.iter().filter_map(PageRecord::id).collect();
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

impl PageRecord {
    /// Its id, if it could be read.
    fn id(&self) -> Option<&str> {
        (!self.id.at.is_empty()).then_some(&self.id.value)
    }

    /// The page as the engine knows it.
    pub(super) fn checked(&self) -> layout::Page {
        layout::Page { id: WidgetId::new(&self.id.value), title: self.title.clone() }
    }
}

/// The number of the page among `pages` that has this `id`.
pub(super) fn number_of(id: &str, pages: &[PageRecord]) -> Option<usize> {
    pages.iter().position(|definition| definition.id() == Some(id))
}
