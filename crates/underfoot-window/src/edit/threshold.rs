//! Sets the thresholds of a control from measurements instead of its text.

use super::address::Address;
use super::change::Edit;
use underfoot::units::Newtons;
use underfoot::widget::Thresholds;
use underfoot_format::text::RonText;

/// Maximum ratio of release force to press force without chatter under a swaying foot, as the reader's warning
/// states.
const RELEASE_MOST: f32 = 0.8;

/// The edits that set the press threshold of `record`'s controls to `press` newtons; `now` holds the present
/// thresholds. Both become whole newtons; the release threshold keeps its ratio to the press threshold, at most
/// 0.8.
#[must_use]
pub fn pressing(record: &Address, now: Thresholds, press: Newtons) -> Vec<Edit> {
    let press = press.0.round();
    let share = (now.release.0 / now.press.0).min(RELEASE_MOST);
    let release = (share * press).round().min((RELEASE_MOST * press).floor()).max(1.0);
    let set = |field: &str, force: f32| Edit::set(record, field, RonText::single(force).inline());
    vec![set("press_n", press), set("release_n", release)]
}

/// The edits that set the release threshold to `release` newtons; at most 0.8 of the press threshold, which
/// stays.
#[must_use]
pub fn releasing(record: &Address, now: Thresholds, release: Newtons) -> Vec<Edit> {
    let most = (RELEASE_MOST * now.press.0).floor().max(1.0);
    let release = RonText::single(release.0.round().clamp(1.0, most));
    vec![Edit::set(record, "release_n", release.inline())]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::edit::Document;
    use underfoot::floor::Floor;
    use underfoot::schema::{Kinds, builtin_layout};

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
        document.edit(&pressing(&home, now, Newtons(90.3))).unwrap();
        let (home, now) = of(&document, "home");
        assert_eq!((now.press, now.release), (Newtons(90.0), Newtons(60.0)));
        document.edit(&releasing(&home, now, Newtons(500.0))).unwrap();
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
        assert!(document.edit(&pressing(&home, now, Newtons(4.0))).is_err());
        assert!(document.edit(&pressing(&home, now, Newtons(f32::NAN))).is_err());
        assert_eq!(document.text(), builtin_layout("map").unwrap());
    }
}
