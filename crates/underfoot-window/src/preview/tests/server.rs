//! A window on a server's floor.

use super::*;
use crate::preview::{ServerLink, ServerState};

/// A window that has joined a server, and the state of the server.
fn room() -> (Room, Arc<Mutex<ServerState>>) {
    let state = ServerState {
        address: "10.0.0.7:9002".into(),
        link: ServerLink::Joined,
        takes_layouts: true,
        left_out: 0,
        areas: Vec::new(),
    };
    let state = Arc::new(Mutex::new(state));
    let mut room = Room::of(false, 1280.0, 800.0);
    let told = Arc::clone(&state);
    room.window.state_mut().shown.server_feed = Some(Box::new(move || told.lock().unwrap().clone()));
    room.run(2);
    (room, state)
}

#[test]
fn the_status_line_says_whom_the_window_has_joined_and_what_is_lost() {
    let (mut room, state) = room();
    assert!(room.says("joined 10.0.0.7:9002"));
    state.lock().unwrap().left_out = 1200;
    room.run(2);
    assert!(room.says("200 packets left out on the way"));
    state.lock().unwrap().link = ServerLink::Lost("the server is silent".into());
    room.write(Snapshot { link: LinkState::Lost, ..at_rest(&map()) });
    assert!(room.says("lost 10.0.0.7:9002: the server is silent; trying again"));
}

#[test]
fn what_is_designed_goes_to_the_server_once_it_is_to_be_tried() {
    let (mut room, _state) = room();
    room.window.key_press(Key::F2);
    room.run(3);
    let designer = room.window.state().designer.as_ref().unwrap();
    let text = designer.text_of_layout().to_owned();
    room.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    room.run(3);
    room.window.key_press(Key::ArrowRight);
    room.run(3);
    assert_ne!(room.window.state().designer.as_ref().unwrap().text_of_layout(), text, "it is edited");
    assert_eq!(room.commands.try_iter().count(), 0, "not with every step of an edit");
    room.window.key_press(Key::F2);
    room.run(6);
    let commands: Vec<_> = room.commands.try_iter().collect();
    assert!(matches!(commands[..], [PreviewCommand::Try { .. }]), "{commands:?}");
}
