//! Short states in coloured pills: the link, muted parts, simulated faults, and the news of the layout's file.

use eframe::egui::Ui;

use crate::preview::feed::LayoutCause;
use crate::preview::rehearsal::Rehearsal;
use crate::preview::shown::ShownFloor;
use crate::preview::style::pill;
use underfoot::layout::Colour;
use underfoot::wire::LinkState;
use underfoot_scene::scene::Theme;

/// Time for which the window reports that a saved file was loaded, in seconds.
pub(in crate::preview) const TELL_S: f64 = 6.0;

/// The result of the last change to the layout file, for some seconds.
pub(super) fn file_news(shown: &ShownFloor) -> Option<String> {
    let file = shown.messages.file.as_ref()?;
    let is_new = file.diagnostics.is_none() && shown.now_s - file.at_s < TELL_S && !file.came_by_itself();
    let what = match file.cause {
        Some(LayoutCause::Opened) => "opened",
        Some(LayoutCause::Served) => "on the server’s floor",
        _ => "saved changes loaded",
    };
    is_new.then(|| format!("{}: {what}", file.name))
}

/// Shows the number of simulated faults and the muted parts.
pub(super) fn mutes(ui: &mut Ui, theme: &Theme, shown: &ShownFloor, rehearsal: Option<&Rehearsal>) {
    let rehearsed = rehearsal.map_or(0, Rehearsal::count);
    if rehearsed > 0 {
        let text = if rehearsed == 1 { "1 fault on".into() } else { format!("{rehearsed} faults on") };
        pill(ui, theme.warning, theme, &text)
            .on_hover_text("Faults are rehearsed; the side panel mends them");
    }
    match &shown.snapshot().muted {
        muted if muted.all => {
            pill(ui, theme.warning, theme, "muted").on_hover_text("Nothing is felt or heard");
        }
        muted if !muted.is_nothing() => {
            let text = format!("{} muted", muted.tiles.len());
            pill(ui, theme.warning, theme, &text).on_hover_text("Tiles that are not felt");
        }
        _ => {}
    }
}

/// Shows the state of the link; for a recording, the state at the time on display.
pub(super) fn link_state(ui: &mut Ui, theme: &Theme, shown: &ShownFloor, is_recorded: bool) {
    let state = shown.snapshot().link;
    let (text, colour) = link(state, theme);
    match (is_recorded, state) {
        (false, _) => drop(pill(ui, colour, theme, text)),
        (true, LinkState::Live) => {
            pill(ui, theme.accent, theme, "replay").on_hover_text("A recording is shown");
        }
        (true, _) => {
            let hint = "A recording is shown, in which the floor was so";
            pill(ui, colour, theme, &format!("replay: {text}")).on_hover_text(hint);
        }
    }
}

fn link(state: LinkState, theme: &Theme) -> (&'static str, Colour) {
    match state {
        LinkState::Waiting => ("waiting", theme.warning),
        LinkState::Live => ("live", theme.good),
        LinkState::Partial => ("partial", theme.warning),
        LinkState::Lost => ("lost", theme.fault),
    }
}
