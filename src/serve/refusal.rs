//! Reasons for which a floor rejects a request of an app.

use std::fmt;

use thiserror::Error;

use crate::floor::NoSuchSensor;
use crate::layout::Layout;
use crate::widget::{SetError, WidgetId};
use underfoot_format::suggest::{listed, nearest};

/// Reason for which a floor rejected a request of an app; the floor is unchanged.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The control rejects the request: another type, locked, in use, or guarded ([`SetError::Momentary`]: only a
    /// foot can hold it).
    #[error("{id}: {why}")]
    Control {
        /// The control.
        id: WidgetId,
        /// Reason of the rejection.
        why: SetError,
    },
    /// The layout has no control of this name.
    #[error("there is no control {id:?}{}", DidYouMean(nearest))]
    UnknownControl {
        /// The requested name.
        id: String,
        /// The control of the layout with the most similar name; `None` if no name is similar.
        nearest: Option<WidgetId>,
    },
    /// The layout has no page of this name.
    #[error("there is no page {id:?}: {}", Pages(pages))]
    UnknownPage {
        /// The requested name.
        id: String,
        /// The pages of the layout.
        pages: Vec<WidgetId>,
    },
    /// The floor has no such sensor.
    #[error(transparent)]
    NoSensor(#[from] NoSuchSensor),
    /// The session is over.
    #[error("the session is over")]
    Ended,
    /// The sensing thread did not answer within 200 ms; it may still carry out the request.
    #[error("the floor does not answer")]
    NoAnswer,
}

impl Refusal {
    pub(crate) fn unknown_control(id: &str, layout: &Layout) -> Self {
        let ids = layout.widgets.iter().map(|widget| widget.id.as_str());
        Self::UnknownControl { id: id.to_owned(), nearest: nearest(id, ids).map(WidgetId::new) }
    }

    pub(crate) fn unknown_page(id: &str, layout: &Layout) -> Self {
        let pages = layout.pages.iter().map(|page| page.id.clone()).collect();
        Self::UnknownPage { id: id.to_owned(), pages }
    }

    /// Returns the reason without the name of an existing control, for answers that come with its address.
    #[must_use]
    pub fn reason(&self) -> String {
        match self {
            Self::Control { why, .. } => why.to_string(),
            other => other.to_string(),
        }
    }
}

/// The end of a sentence about an unknown name.
struct DidYouMean<'a>(&'a Option<WidgetId>);

impl fmt::Display for DidYouMean<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(nearest) => write!(f, "; did you mean {:?}?", nearest.as_str()),
            None => Ok(()),
        }
    }
}

/// The pages of the layout, in words.
struct Pages<'a>(&'a [WidgetId]);

impl fmt::Display for Pages<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.0.iter().map(|page| format!("{:?}", page.as_str())).collect();
        match names.as_slice() {
            [] => f.write_str("the layout has no pages"),
            [only] => write!(f, "the layout has only {only}"),
            many => write!(f, "the layout has {}", listed(many, "and")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;
    use crate::schema::{Kinds, builtin_layout, parse_layout};

    fn layout(name: &str) -> Layout {
        let text = builtin_layout(name).unwrap();
        parse_layout(text, name, &Kinds::builtin(), &Geometry::default()).unwrap().layout
    }

    #[test]
    fn a_misspelt_control_comes_with_the_nearest_name() {
        let map = layout("map");
        let text = |id: &str| Refusal::unknown_control(id, &map).to_string();
        assert_eq!(text("zom"), r#"there is no control "zom"; did you mean "zoom"?"#);
        assert_eq!(text("Satelite"), r#"there is no control "Satelite"; did you mean "satellite"?"#);
        assert_eq!(text("volume"), r#"there is no control "volume""#);
        // No content of a name can control a terminal.
        assert_eq!(text("\u{1b}[2J"), r#"there is no control "\u{1b}[2J""#);
    }

    #[test]
    fn an_unknown_page_names_the_pages() {
        let mut map = layout("map");
        let text = |layout: &Layout| Refusal::unknown_page("settings", layout).to_string();
        assert_eq!(text(&map), r#"there is no page "settings": the layout has no pages"#);
        let page = |id: &str| crate::layout::Page { id: WidgetId::new(id), title: String::new() };
        map.pages = vec![page("map")];
        assert_eq!(text(&map), r#"there is no page "settings": the layout has only "map""#);
        map.pages = ["map", "tools", "help"].map(page).into();
        assert_eq!(text(&map), r#"there is no page "settings": the layout has "map", "tools" and "help""#);
    }

    #[test]
    fn an_answer_beside_an_address_does_not_repeat_the_name() {
        let locked = Refusal::Control { id: WidgetId::new("zoom"), why: SetError::Locked };
        assert_eq!(locked.to_string(), "zoom: the control is locked");
        assert_eq!(locked.reason(), "the control is locked");
    }
}
