//! The side panel's list of contacts.

use eframe::egui::Ui;

use super::super::style::{TextRow, quiet, row, section};
use underfoot::engine::Snapshot;
use underfoot::wire::LinkState;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Minimum number of lines, so that nothing below moves when feet appear and disappear.
const LINES: usize = 3;

/// Right ends of the figures, as shares of the width.
const COLUMNS: [f32; 4] = [0.50, 0.68, 0.84, 1.0];

/// Maximum number of contacts in the list.
const MOST: usize = 8;

/// Shows one line for each contact, heaviest first, as the snapshot sorts them.
pub(super) fn contacts_part(ui: &mut Ui, theme: &Theme, snapshot: &Snapshot) {
    // The heading's line holds the units, over their columns.
    let rect = section(ui, theme, "Contacts", |_| {});
    let line = TextRow { ui, rect, size: 12.0 };
    for (column, unit) in COLUMNS.into_iter().zip(["x m", "y m", "N", "m/s"]) {
        line.right(column, unit, color(theme.quiet));
    }
    let leads = |id| snapshot.cursors.iter().flatten().any(|cursor| cursor.contact == id);
    ui.spacing_mut().item_spacing.y = 2.0;
    for contact in snapshot.contacts.iter().take(MOST) {
        let cursor = leads(contact.id);
        let (at, force, speed) = (contact.centroid, contact.force.0, contact.velocity.length());
        let id = contact.id.0;
        let what = if cursor { "cursor" } else { "" };
        let spoken = format!("Contact {id} {what}: {force:.0} newtons at {:.2}, {:.2} metres", at.x, at.y);
        let line = row(ui, 19.0, 13.0, &spoken);
        let ink = color(theme.ink);
        let name = color(if cursor { theme.cursor } else { theme.contact });
        line.left(0.0, 0.12, &format!("{id}"), name);
        line.left(0.13, 0.34, what, name);
        let figures =
            [format!("{:.3}", at.x), format!("{:.3}", at.y), format!("{force:.0}"), format!("{speed:.2}")];
        for (column, figure) in COLUMNS.into_iter().zip(figures) {
            line.right(column, &figure, ink);
        }
    }
    for missing in snapshot.contacts.len()..LINES {
        let line = row(ui, 19.0, 13.0, "");
        if missing == 0 {
            let is_known = snapshot.link != LinkState::Lost;
            let text = if is_known { "nobody on the floor" } else { "not known: the link is lost" };
            line.left(0.0, 1.0, text, color(theme.quiet));
        }
    }
    let more = snapshot.contacts.len().saturating_sub(MOST);
    if more > 0 {
        ui.label(quiet(theme, format!("and {more} more")));
    }
    ui.spacing_mut().item_spacing.y = 5.0;
}
