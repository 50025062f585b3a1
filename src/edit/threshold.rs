//! When a control counts as pressed, set from elsewhere than its text.

use super::address::Address;
use super::change::Edit;
use super::document::Document;
use crate::format::number::plain;
use crate::units::Newtons;
use crate::widget::Thresholds;

/// Most of the press force at which a control may let go without chattering under a foot that sways, as the reader
/// warns.
const RELEASE_MOST: f32 = 0.8;

impl Document {
    /// What makes the controls of `record` take `press` newtons, `now` being what they take: both thresholds in whole
    /// newtons, the lower one in the same proportion as before and so that it stays below.
    #[must_use]
    pub fn pressing(record: &Address, now: Thresholds, press: Newtons) -> Vec<Edit> {
        let press = press.0.round();
        let share = (now.release.0 / now.press.0).min(RELEASE_MOST);
        let release = (share * press).round().min((RELEASE_MOST * press).floor()).max(1.0);
        let set = |field: &str, force: f32| Edit::set(record, field, plain(force.into()));
        vec![set("press_n", press), set("release_n", release)]
    }

    /// What makes them let go below `release` newtons and leaves the press as it is: at most 0.8 of that.
    #[must_use]
    pub fn releasing(record: &Address, now: Thresholds, release: Newtons) -> Vec<Edit> {
        let most = (RELEASE_MOST * now.press.0).floor().max(1.0);
        vec![Edit::set(record, "release_n", plain(release.0.round().clamp(1.0, most).into()))]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::floor::Floor;
    use crate::schema::{Kinds, builtin_layout};

    fn map() -> Document {
        let floor = Arc::new(Floor::default());
        Document::read("map", builtin_layout("map").unwrap(), &Arc::new(Kinds::builtin()), &floor).unwrap()
    }

    fn of(document: &Document, id: &str) -> (Address, Thresholds) {
        let index = document.layout().widget_index(id).unwrap();
        (document.record_of(index).unwrap(), document.layout().widgets[index].behaviour.thresholds())
    }

    #[test]
    fn the_release_follows_the_press_and_both_are_one_step() {
        let mut document = map();
        let before = document.text().to_owned();
        let (home, now) = of(&document, "home");
        assert_eq!((now.press, now.release), (Newtons(60.0), Newtons(40.0)), "its kind's");
        document.edit(&Document::pressing(&home, now, Newtons(90.3))).unwrap();
        let (home, now) = of(&document, "home");
        assert_eq!((now.press, now.release), (Newtons(90.0), Newtons(60.0)));
        document.edit(&Document::releasing(&home, now, Newtons(500.0))).unwrap();
        let (_, now) = of(&document, "home");
        assert_eq!((now.press, now.release), (Newtons(90.0), Newtons(72.0)), "no nearer than 0.8");
        document.undo().unwrap();
        document.undo().unwrap();
        assert_eq!(document.text(), before);
    }

    #[test]
    fn what_no_control_can_have_is_refused() {
        let mut document = map();
        let (home, now) = of(&document, "home");
        assert!(document.edit(&Document::pressing(&home, now, Newtons(4.0))).is_err());
        assert!(document.edit(&Document::pressing(&home, now, Newtons(f32::NAN))).is_err());
        assert_eq!(document.text(), builtin_layout("map").unwrap());
    }
}
