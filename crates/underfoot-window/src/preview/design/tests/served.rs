//! Layouts for the floor of a server.

use egui_kittest::kittest::NodeT;

use super::*;
use crate::preview::{ServerLink, ServerState};

/// The map on the floor of a server, in Design mode.
fn joined(takes_layouts: bool) -> Desk {
    let state = ServerState {
        address: "127.0.0.1:9002".into(),
        link: ServerLink::Joined,
        takes_layouts,
        left_out: 0,
        areas: Vec::new(),
    };
    let text = builtin_layout("map").unwrap();
    let feed: ServerFeed = Box::new(move || state.clone());
    Desk::served(text, text, None, tempfile::tempdir().unwrap(), Some(feed))
}

/// The controls of the layouts that the floor got since the last call.
fn put(desk: &Desk) -> Vec<usize> {
    let tried = desk.commands.try_iter().filter_map(|command| match command {
        PreviewCommand::Try { layout, .. } => Some(layout.widgets.len()),
        _ => None,
    });
    tried.collect()
}

#[test]
fn a_server_gets_a_design_when_the_user_puts_it_on_the_floor() {
    let mut desk = joined(true);
    let controls = desk.designer().layout().widgets.len();
    desk.command(Modifiers::COMMAND, Key::A);
    desk.key(Key::Delete);
    assert_eq!(put(&desk), Vec::<usize>::new(), "edits stay in the window");
    desk.command(Modifiers::COMMAND, Key::Z);
    desk.click("Put on the floor");
    assert_eq!(put(&desk), [controls]);
    assert!(desk.designer().is_open, "Design goes on");
}

#[test]
fn a_server_that_keeps_its_layout_offers_no_way_to_put_another() {
    let mut desk = joined(false);
    assert!(desk.window.get_by_label("Put on the floor").accesskit_node().is_disabled());
    desk.click("Put on the floor");
    assert_eq!(put(&desk), Vec::<usize>::new());
    assert!(!Desk::map().says("Put on the floor"), "the window's own floor follows at once");
}
