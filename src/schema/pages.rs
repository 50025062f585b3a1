//! Pages that take turns on one floor, and the controls that switch them.
//!
//! ```ron
//! widgets: [ /* on every page */ ],
//! pages: [
//!     (id: "map", widgets: [(id: "more", kind: "button", …, goto: "settings")]),
//!     (id: "settings", title: "Settings", widgets: [(id: "back", kind: "button", …, goto: "map")]),
//! ],
//! ```

use std::ops::Range;

use super::arrange;
use super::control::Control;
use super::fields::Fields;
use super::goto::Goto;
use super::ground::{self, GroundDefinition};
use super::inherit::Choice;
use super::lists::list;
use super::node::Node;
use super::problem::Problem;
use super::reader::Reader;
use super::suggest::did_you_mean;
use crate::layout;
use crate::widget::{Behaviour, WidgetId};

/// One page as written. What could not be read is `None` and has been reported.
pub(super) struct PageDefinition<'r> {
    id: Option<&'r str>,
    id_at: Range<usize>,
    title: Option<&'r str>,
}

/// The pages of a layout; their controls are added to `controls`.
pub(super) fn read<'r>(
    fields: &mut Fields<'r>,
    kinds: &Choice<'_>,
    room: &mut usize,
    controls: &mut Vec<Control>,
    grounds: &mut Vec<GroundDefinition>,
) -> Vec<PageDefinition<'r>> {
    let mut number = 0;
    let (pages, _) = list(fields, "pages", "page", |node| {
        number += 1;
        PageDefinition::read(node, kinds, room, (number - 1, &mut *grounds))
    });
    let mut pages_read = Vec::with_capacity(pages.len());
    for (number, (definition, own)) in pages.into_iter().enumerate() {
        controls.extend(own.into_iter().map(|mut control| {
            control.page = Some(number);
            control
        }));
        pages_read.push(definition);
    }
    pages_read
}

/// Whether two controls are ever there at the same time.
pub(super) fn can_both_show(one: &Control, other: &Control) -> bool {
    one.page.is_none() || other.page.is_none() || one.page == other.page
}

/// Notes what is wrong between pages and the controls that switch them.
pub(super) fn check(reader: &Reader<'_>, pages: &[PageDefinition<'_>], controls: &[Control]) {
    for (number, definition) in pages.iter().enumerate() {
        let same = |other: &&PageDefinition<'_>| other.id.is_some() && other.id == definition.id;
        if let Some(earlier) = pages[..number].iter().find(same) {
            let message = format!("two pages have the id \"{}\"", definition.id.unwrap_or_default());
            let expected = format!("the first is on line {}", reader.line(&earlier.id_at));
            reader.report(Problem::error(definition.id_at.clone(), message).expected(expected));
        }
    }
    for control in controls {
        let Some(goto) = &control.goto else { continue };
        if number_of(goto, pages).is_none() && pages.iter().all(|definition| definition.id.is_some()) {
            let ids: Vec<&str> = pages.iter().filter_map(|definition| definition.id).collect();
            let problem = Problem::error(goto.at.clone(), format!("there is no page \"{}\"", goto.id));
            let help = did_you_mean(&goto.id, &ids, '"');
            let help = help.unwrap_or_else(|| format!("add pages: [(id: \"{}\", widgets: [])]", goto.id));
            reader.report(problem.expected("no page is called so").help(help));
        }
        let clicks = control.kind.as_ref().is_none_or(|kind| matches!(kind.behaviour, Behaviour::Button(_)));
        if !clicks {
            let problem = Problem::error(goto.at.clone(), "only a button's click switches pages");
            reader.report(problem.expected("this control never clicks").help("use a kind of button"));
        }
    }
}

impl<'r> PageDefinition<'r> {
    fn read(
        node: Node<'r>,
        kinds: &Choice<'_>,
        room: &mut usize,
        (number, grounds): (usize, &mut Vec<GroundDefinition>),
    ) -> Option<(Self, Vec<Control>)> {
        let mut fields = node.fields("Page")?;
        let id = fields.read("id", None, |node| node.id());
        let title = fields.read("title", Some(""), |node| node.text(200));
        let widgets = fields.take("widgets");
        let controls = widgets.map(|node| arrange::read(node, kinds, room)).unwrap_or_default();
        grounds.extend(ground::read(&mut fields, Some(number)));
        let id_at = fields.span("id");
        fields.finish();
        Some((Self { id, id_at, title }, controls))
    }

    /// The page as the engine knows it.
    pub(super) fn checked(&self) -> Option<layout::Page> {
        Some(layout::Page { id: WidgetId::new(self.id?), title: self.title?.to_owned() })
    }
}

/// The number of the page that `goto` names among `pages`.
pub(super) fn number_of(goto: &Goto, pages: &[PageDefinition<'_>]) -> Option<usize> {
    pages.iter().position(|definition| definition.id == Some(&goto.id))
}
