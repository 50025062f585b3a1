//! The keys of lists: arrows, Home, End and the page keys.

use eframe::egui::{FocusDirection, Key, Response, Ui};

/// Rows that a page key passes where the height of the list is unknown.
const PAGE: usize = 8;

/// Moves the keyboard through the whole list, scrolled-out rows included: by a row, by a page, to an end. It does not
/// leave the list.
pub(super) fn go_on(ui: &Ui, shown: &[Response]) {
    let Some(at) = shown.iter().position(Response::has_focus) else { return };
    let last = shown.len() - 1;
    let page = page(ui, shown);
    let steps = [
        (Key::ArrowUp, at.saturating_sub(1)),
        (Key::ArrowDown, last.min(at + 1)),
        (Key::PageUp, at.saturating_sub(page)),
        (Key::PageDown, last.min(at + page)),
        (Key::Home, 0),
        (Key::End, last),
    ];
    let pressed = steps.into_iter().filter(|(key, _)| ui.input(|i| i.key_pressed(*key)));
    let targets: Vec<usize> = pressed.map(|(_, to)| to).collect();
    let [to] = targets[..] else { return };
    // egui's own movement would leave the list.
    ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
    if let Some(next) = shown.get(to).filter(|_| to != at) {
        next.request_focus();
        next.scroll_to_me(None);
    }
}

/// The number of rows that the visible part of the list holds, without one that stays in view.
fn page(ui: &Ui, shown: &[Response]) -> usize {
    let rows = shown.windows(2).filter_map(|pair| match pair {
        [one, other] => Some(other.rect.top() - one.rect.top()),
        _ => None,
    });
    let row = rows.fold(0.0_f32, f32::max);
    if row < 1.0 {
        return PAGE;
    }
    let count = (ui.clip_rect().height() / row).floor() as usize;
    count.saturating_sub(1).max(1)
}
