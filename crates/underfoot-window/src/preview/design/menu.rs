//! The menu of the right mouse button.

use eframe::egui::{self, Ui, ViewportCommand};

use super::edited::EditedLayout;
use super::in_place::InPlace;
use crate::edit::Facet;

/// An entry of the menu.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MenuEntry {
    EditText,
    Rename,
    Copy,
    Cut,
    Paste(Option<Facet>),
    Duplicate,
    MakeAlike,
    Group,
    Ungroup,
    ToFront,
    ToBack,
    Delete,
}

/// The entries in order, each with its keys; a line separates sections.
const SECTIONS: [&[(MenuEntry, &str, &str)]; 4] = [
    &[(MenuEntry::EditText, "Edit the label", "Enter"), (MenuEntry::Rename, "Rename", "")],
    &[
        (MenuEntry::Copy, "Copy", "Ctrl+C"),
        (MenuEntry::Cut, "Cut", "Ctrl+X"),
        (MenuEntry::Paste(None), "Paste", "Ctrl+V"),
        (MenuEntry::Paste(Some(Facet::Appearance)), "Paste appearance", "Ctrl+Alt+V"),
        (MenuEntry::Paste(Some(Facet::Feel)), "Paste feel", "Ctrl+Shift+V"),
        (MenuEntry::Duplicate, "Duplicate", "Ctrl+D"),
    ],
    &[
        (MenuEntry::MakeAlike, "Make alike", "Ctrl+E"),
        (MenuEntry::Group, "Group", "Ctrl+G"),
        (MenuEntry::Ungroup, "Ungroup", "Ctrl+Shift+G"),
        (MenuEntry::ToFront, "To the front", "Ctrl+]"),
        (MenuEntry::ToBack, "To the back", "Ctrl+["),
    ],
    &[(MenuEntry::Delete, "Delete", "Delete")],
];

/// Shows the entries for the selection; an entry without effect here is off and says why.
pub(super) fn show_menu(ui: &mut Ui, edited: &mut EditedLayout, in_place: &mut Option<InPlace>) {
    for (number, section) in SECTIONS.iter().enumerate() {
        if number > 0 {
            ui.separator();
        }
        for (entry, name, keys) in *section {
            let off = why_off(*entry, edited);
            let button = ui.add_enabled(off.is_none(), egui::Button::new(*name).shortcut_text(*keys));
            let button = button.on_disabled_hover_text(off.unwrap_or_default());
            if button.clicked() {
                act(*entry, ui.ctx(), edited, in_place);
                ui.close();
            }
        }
    }
}

/// The reason why an entry has no effect now.
fn why_off(entry: MenuEntry, edited: &EditedLayout) -> Option<&'static str> {
    let items = edited.selected_items();
    let is_one = matches!(items[..], [_]);
    match entry {
        MenuEntry::Paste(None) => None,
        _ if items.is_empty() => Some("nothing is selected"),
        MenuEntry::EditText | MenuEntry::Rename | MenuEntry::ToFront | MenuEntry::ToBack if !is_one => {
            Some("for one thing at a time")
        }
        MenuEntry::MakeAlike if items.len() < 2 => Some("select several: they become as the first one is"),
        MenuEntry::Ungroup if !matches!(items[..], [item] if item.is_group) => Some("this is no group"),
        _ => None,
    }
}

fn act(entry: MenuEntry, ctx: &egui::Context, edited: &mut EditedLayout, in_place: &mut Option<InPlace>) {
    let first = edited.selected.first().cloned();
    match entry {
        MenuEntry::EditText => begin(edited, in_place, first.map(|record| InPlace::text_of(edited, &record))),
        MenuEntry::Rename => begin(edited, in_place, first.map(|record| InPlace::name_of(edited, &record))),
        MenuEntry::Copy => drop(edited.copy(ctx)),
        MenuEntry::Cut => edited.cut(ctx),
        MenuEntry::Paste(facet) => {
            edited.pasting = Some((facet, ctx.cumulative_pass_nr()));
            // The text of the clipboard comes as an event of a later frame.
            ctx.send_viewport_cmd(ViewportCommand::RequestPaste);
        }
        MenuEntry::Duplicate => edited.duplicate(),
        MenuEntry::MakeAlike => edited.make_alike(),
        MenuEntry::Group => edited.group(),
        MenuEntry::Ungroup => edited.ungroup(),
        MenuEntry::ToFront => edited.reorder(false),
        MenuEntry::ToBack => edited.reorder(true),
        MenuEntry::Delete => edited.delete(),
    }
}

/// Begins to edit a text on the floor, or shows why that is impossible.
pub(super) fn begin(
    edited: &mut EditedLayout,
    in_place: &mut Option<InPlace>,
    found: Option<Result<InPlace, String>>,
) {
    if edited.holds_locked() {
        return;
    }
    match found {
        Some(Ok(editor)) => *in_place = Some(editor),
        Some(Err(reason)) => edited.complain(reason),
        None => {}
    }
}
