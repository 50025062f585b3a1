//! Splits keys and clicks over frames, so that slow frames keep their order.
//!
//! egui passes all events since the last frame to the widgets at once. Two Tab keys are then one step, and letters
//! typed before a Tab go into the field behind it: a window with slow frames loses fast input. Events after a key
//! that moves the focus therefore wait for the next frame.

use eframe::egui::{Event, Key};

/// The events that wait for the next frame.
#[derive(Debug, Default)]
pub(super) struct Turns {
    waiting: Vec<Event>,
}

impl Turns {
    /// Leaves in `events` those that one frame can take, in order; returns whether others remain for the next.
    ///
    /// With `parts_clicks`, a turn ends at a press or release of a button, so that the frame sees the pointer at that
    /// place. Simulated feet follow the whole path themselves.
    pub(super) fn take(&mut self, events: &mut Vec<Event>, parts_clicks: bool) -> bool {
        self.waiting.append(events);
        let count = first_turn(&self.waiting, parts_clicks);
        events.extend(self.waiting.drain(..count));
        !self.waiting.is_empty()
    }
}

/// The number of `events` that one frame can take.
fn first_turn(events: &[Event], parts_clicks: bool) -> usize {
    let mut has_input = false;
    let mut has_click = false;
    for (at, event) in events.iter().enumerate() {
        let (leads, clicks, types) = (leads_elsewhere(event), is_click(event), is_typed(event));
        // A click may move the focus to the field for the typed text.
        let is_next = match () {
            () if leads => has_input,
            () if clicks => parts_clicks && has_input,
            () if types => has_click,
            () => parts_clicks && has_click && matches!(event, Event::PointerMoved(_)),
        };
        if is_next {
            return at;
        }
        if leads {
            let is_rest_empty = !events[at + 1..].iter().any(|event| is_typed(event) || is_click(event));
            return if is_rest_empty { events.len() } else { at + 1 };
        }
        has_input |= clicks || types;
        has_click |= clicks;
    }
    events.len()
}

/// Whether the event is a key that moves the keyboard focus or acts on the widget with the focus. A held key repeats
/// as often as frames allow.
fn leads_elsewhere(event: &Event) -> bool {
    let Event::Key { key, pressed: true, repeat: false, .. } = event else { return false };
    matches!(
        key,
        Key::Tab
            | Key::Enter
            | Key::Escape
            | Key::F2
            | Key::F6
            | Key::ArrowUp
            | Key::ArrowDown
            | Key::ArrowLeft
            | Key::ArrowRight
    )
}

fn is_click(event: &Event) -> bool {
    matches!(event, Event::PointerButton { .. })
}

fn is_typed(event: &Event) -> bool {
    matches!(
        event,
        Event::Key { pressed: true, .. } | Event::Text(_) | Event::Paste(_) | Event::Cut | Event::Copy
    )
}

#[cfg(test)]
mod tests {
    use eframe::egui::{self, Modifiers, PointerButton, Pos2, pos2};

    use super::*;

    fn key(key: Key) -> [Event; 2] {
        let event = |pressed| Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        [event(true), event(false)]
    }

    fn button(pos: Pos2, pressed: bool) -> [Event; 2] {
        let modifiers = Modifiers::NONE;
        [
            Event::PointerMoved(pos),
            Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers },
        ]
    }

    fn text(text: &str) -> Vec<Event> {
        text.chars().map(|letter| Event::Text(letter.into())).collect()
    }

    /// The events of each frame if all arrive within the first.
    fn turns(events: Vec<Event>, parts_clicks: bool) -> Vec<Vec<Event>> {
        let (mut queue, mut frame, mut all) = (Turns::default(), events, Vec::new());
        while queue.take(&mut frame, parts_clicks) {
            all.push(std::mem::take(&mut frame));
        }
        all.push(frame);
        all
    }

    #[test]
    fn nothing_is_lost_or_overtaken() {
        let [(tab, _), (down, up)] = [key(Key::Tab), key(Key::ArrowDown)].map(|[down, up]| (down, up));
        let events =
            [text("ab"), key(Key::Tab).into(), text("c"), vec![down.clone(), up.clone(), down, up, tab]];
        let events = events.concat();
        let turns = turns(events.clone(), true);
        assert_eq!(turns.concat(), events);
        let leading = |turn: &Vec<Event>| turn.iter().filter(|event| leads_elsewhere(event)).count();
        assert!(turns.iter().all(|turn| leading(turn) <= 1));
        assert_eq!(turns[0], text("ab"), "what was typed counts before the focus goes on");
        assert_eq!(turns.len(), 6, "{turns:?}");
    }

    #[test]
    fn one_key_and_letters_take_one_frame_and_a_path_of_the_pointer_stays_whole() {
        assert_eq!(turns(key(Key::Tab).into(), true).len(), 1);
        assert_eq!(turns(text("quick"), true).len(), 1);
        let (here, there) = (pos2(1.0, 2.0), pos2(30.0, 2.0));
        let click = [button(here, true), button(there, false)].concat();
        assert_eq!(turns(click.clone(), false), vec![click.clone()]);
        let parted = turns([click.clone(), vec![Event::PointerMoved(here)]].concat(), true);
        assert_eq!(parted.len(), 3, "where it began is seen, and where it ended");
        assert_eq!(parted[1], click[2..], "it came from where it began");
        let typed = [click, text("4")].concat();
        assert_eq!(turns(typed, false).len(), 2, "the field that is clicked on is typed into");
    }

    /// The defect that this module prevents: a window that gets all events at once.
    #[test]
    fn fields_are_filled_however_many_keys_come_at_once() {
        let (ctx, mut queue) = (egui::Context::default(), Turns::default());
        let mut fields = ["".to_owned(), "".to_owned(), "".to_owned()];
        let tab = || key(Key::Tab).to_vec();
        let mut events = [tab(), text("one"), tab(), tab(), text("three")].concat();
        loop {
            let mut input = egui::RawInput { events: std::mem::take(&mut events), ..Default::default() };
            let goes_on = queue.take(&mut input.events, true);
            let mut drawn = ctx.run_ui(input, |ui| {
                for field in &mut fields {
                    ui.text_edit_singleline(field);
                }
            });
            drawn.textures_delta.clear();
            if !goes_on {
                break;
            }
        }
        assert_eq!(fields, ["one", "", "three"]);
    }
}
