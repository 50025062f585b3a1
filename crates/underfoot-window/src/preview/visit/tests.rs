//! A visit recorded by the button and by F9, saved and exported.

use std::path::Path;
use std::sync::{Arc, Mutex};

use eframe::egui::Key;
use egui_kittest::kittest::Queryable;

use super::{VisitBar, VisitDesk, VisitForm, VisitOrder, VisitSize, VisitState, VisitWork};
use crate::link::SharedVisit;
use crate::preview::share::Share;
use crate::preview::tests::Room;
use crate::preview::{LayoutToShare, ShareDesk};
use egui_kittest::kittest::NodeT;
use underfoot_sim::{FloorQuality, RecordedFeet};

/// A desk that notes commands and executes none.
#[derive(Clone, Default)]
struct Notes(Arc<Mutex<(VisitState, Vec<VisitOrder>)>>);

impl Notes {
    fn orders(&self) -> Vec<VisitOrder> {
        std::mem::take(&mut self.0.lock().unwrap().1)
    }
}

impl VisitDesk for Notes {
    fn state(&mut self) -> VisitState {
        self.0.lock().unwrap().0.clone()
    }

    fn lead(&mut self, order: VisitOrder) {
        self.0.lock().unwrap().1.push(order);
    }
}

fn room(state: VisitState) -> (Room, Notes) {
    let notes = Notes::default();
    notes.0.lock().unwrap().0 = state;
    let mut room = Room::simulated();
    room.window.state_mut().visit = Some(VisitBar::new(Box::new(notes.clone())));
    room.run(2);
    (room, notes)
}

#[test]
fn a_visit_is_recorded_by_button_and_by_key_and_then_saved() {
    let (mut room, notes) = room(VisitState::default());
    room.window.get_by_label("REC").click();
    room.run(2);
    assert!(matches!(notes.orders()[..], [VisitOrder::Begin(_)]));
    let size = VisitSize { length_s: 72.4, bytes: 3_140_000 };
    notes.0.lock().unwrap().0.recording = Some(size);
    room.run(2);
    assert!(room.says("Stop 1:12 · 3.1 MB"));
    room.window.key_press(Key::F9);
    room.run(2);
    assert!(matches!(notes.orders()[..], [VisitOrder::End]));
    notes.0.lock().unwrap().0 = VisitState { kept: Some(size), is_unsaved: true, ..VisitState::default() };
    room.run(2);
    room.window.get_by_label("Save this visit").click();
    room.run(2);
    room.window.get_by_label("Play again").click();
    room.run(2);
    let orders = notes.orders();
    let [VisitOrder::Save(path), VisitOrder::PlayAgain] = &orders[..] else { panic!("{orders:?}") };
    assert_eq!(path, Path::new("visit.mcap"));
    // Once it is saved, it can still be played.
    notes.0.lock().unwrap().0.is_unsaved = false;
    room.run(2);
    assert!(!room.says("Save this visit") && !room.says("Discard"));
    room.window.get_by_label("Play again").click();
    room.run(2);
    assert!(matches!(notes.orders()[..], [VisitOrder::PlayAgain]));
}

#[test]
fn an_export_shows_its_progress_and_can_be_stopped() {
    let kept = Some(VisitSize { length_s: 20.0, bytes: 5_000_000 });
    let (mut room, notes) = room(VisitState { kept, ..VisitState::default() });
    room.window.get_by_label("Visit").click();
    room.run(2);
    assert!(!room.says("Save this visit"), "the file exists");
    room.window.get_by_label("Export").click();
    room.run(2);
    let orders = notes.orders();
    let [VisitOrder::Export { form: VisitForm::Picture, to, part: None }] = &orders[..] else {
        panic!("{orders:?}")
    };
    assert_eq!(to, Path::new("visit.gif"));
    notes.0.lock().unwrap().0.work = Some(VisitWork { name: "visit.gif".into(), share: 0.42 });
    room.run(2);
    room.window.get_by_label("Cancel").click();
    room.run(2);
    assert!(matches!(notes.orders()[..], [VisitOrder::StopExport]));
}

#[test]
fn a_floor_that_cannot_be_recorded_says_why() {
    let off = Some("The recording of --record is in progress".to_owned());
    let (mut room, notes) = room(VisitState { off, ..VisitState::default() });
    room.window.get_by_label("REC").click();
    room.window.key_press(Key::F9);
    room.run(2);
    assert!(notes.orders().is_empty());
}

/// A desk whose last visit is feet for a link.
struct Feet(Notes);

impl VisitDesk for Feet {
    fn state(&mut self) -> VisitState {
        self.0.state()
    }

    fn lead(&mut self, order: VisitOrder) {
        self.0.lead(order);
    }

    fn shared(&self) -> Option<Result<SharedVisit, String>> {
        let feet = RecordedFeet::default();
        Some(SharedVisit::new(&feet, FloorQuality::Slight, 1).map_err(|error| error.to_string()))
    }
}

/// Links that say whether a visit is in them.
struct Links;

impl ShareDesk for Links {
    fn link(&self, layout: &LayoutToShare) -> Result<String, String> {
        Ok(format!("#{} {}", layout.name, layout.visit.is_some()))
    }

    fn has_page(&self) -> bool {
        false
    }
}

#[test]
fn feet_are_recorded_on_the_layout_of_that_moment_and_given_away_as_a_link() {
    let (mut room, notes) = room(VisitState { is_for_links: true, ..VisitState::default() });
    let app = room.window.state_mut();
    app.visit = Some(VisitBar::new(Box::new(Feet(notes.clone()))));
    app.share = Some(Share::new(Box::new(Links)));
    room.run(2);
    assert!(!room.says("Share"), "without a page, a layout is not shared alone");
    room.window.get_by_label("REC").click();
    room.run(2);
    assert!(matches!(notes.orders()[..], [VisitOrder::Begin(_)]));
    let size = VisitSize { length_s: 5.0, bytes: 900 };
    notes.0.lock().unwrap().0.recording = Some(size);
    room.run(2);
    {
        let state = &mut notes.0.lock().unwrap().0;
        (state.recording, state.kept) = (None, Some(size));
    }
    room.run(2);
    assert!(!room.says("Export") && !room.says("Save this visit"), "there is no file");
    room.window.get_by_label("Share this visit").click();
    room.run(3);
    let link = room.window.get_by_label("Link").accesskit_node().value();
    assert_eq!(link, Some("#map true".to_owned()));
    room.window.get_by_label("Close").click();
    room.run(2);
    room.window.get_by_label("Discard").click();
    room.run(2);
    assert!(matches!(notes.orders()[..], [VisitOrder::Discard]));
}
