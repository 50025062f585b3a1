//! The dialogue that gives a layout away as a link.

use super::*;
use crate::preview::ShareDesk;
use crate::preview::share::Share;

/// Links with the name and the length of a layout, or none.
struct Links(bool);

impl ShareDesk for Links {
    fn link(&self, name: &str, text: &str) -> Result<String, String> {
        let link = format!("https://example.org/#{name}.{}", text.len());
        if self.0 { Ok(link) } else { Err("the layout has 40 kB, and a link holds 32 kB".into()) }
    }
}

fn opened(gives: bool) -> Room {
    let mut room = Room::simulated();
    room.window.state_mut().share = Some(Share::new(Box::new(Links(gives))));
    room.run(2);
    room.window.get_by_label("Share").click();
    room.run(3);
    room
}

#[test]
fn the_layout_on_the_screen_is_in_the_link_and_the_code() {
    let mut room = opened(true);
    let length = builtin_layout("map").unwrap().len();
    let link = room.window.get_by_label("Link").accesskit_node().value();
    assert_eq!(link, Some(format!("https://example.org/#map.{length}")));
    assert!(room.says("QR code of the link"));
    room.window.get_by_label("Copy").click();
    room.run(2);
    assert!(room.says("Copied."));
    assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new());
    room.window.get_by_label("Close").click();
    room.run(2);
    assert!(room.window.query_by_label("Link").is_none());
}

#[test]
fn a_layout_that_is_too_long_for_a_link_says_so() {
    let room = opened(false);
    assert!(room.says("a link holds 32 kB") && room.window.query_by_label("Link").is_none());
}

#[test]
fn without_a_page_that_opens_links_there_is_no_button() {
    assert!(Room::simulated().window.query_by_label("Share").is_none());
}
