//! The fields that several controls share, and the members of a group.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Ui, WidgetInfo};

use super::super::edited::EditedLayout;
use super::{Inspector, Shown};
use crate::edit::{Address, Item};
use crate::preview::style::{quiet, section};
use underfoot_scene::egui_painter::Palette;
use underfoot_scene::scene::Theme;

impl Inspector {
    /// Lists the members of a group and the common fields of its controls.
    pub(super) fn members(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        group: &Address,
    ) {
        let is_member = |item: &&Item| item.record.split().is_some_and(|(parent, ..)| parent == *group);
        let members: Vec<Item> = edited.items.iter().filter(is_member).cloned().collect();
        let count = members.len();
        section(ui, theme, &if count == 1 { "1 member".into() } else { format!("{count} members") }, |_| {});
        let mut chosen = None;
        for item in members {
            let what = if item.is_group { "Group" } else { "Control" };
            let name = format!("{what} {}", item.name);
            let row = ui.add(egui::Button::selectable(false, &name).truncate());
            row.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Member: {name}")));
            if row.on_hover_text("Select it alone").clicked() {
                chosen = Some(item.record);
            }
        }
        section(ui, theme, "In common", |_| {});
        self.common_fields(ui, theme, palette, edited, std::slice::from_ref(group));
        if let Some(record) = chosen {
            edited.select_only(record);
        }
    }

    /// The fields that all controls of `records` share, those in groups included; an edit applies to all of them.
    pub(super) fn common_fields(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        records: &[Address],
    ) {
        let mut controls: Vec<&Item> =
            records.iter().flat_map(|record| edited.document.controls_in(&edited.items, record)).collect();
        controls.dedup();
        let all: Vec<Address> = controls.iter().map(|item| item.record.clone()).collect();
        let Some(first) = all.first().cloned() else {
            ui.label(quiet(theme, "Nothing: none of these is a control."));
            return;
        };
        let key = (all.clone(), edited.document.revision());
        if self.common.of.as_ref() != Some(&key) {
            let sections = edited.document.common(&controls);
            self.common = Shown { sections, of: Some(key) };
            self.typed.clear();
        }
        let shown = std::mem::take(&mut self.common.sections);
        self.shared = all;
        let wanted = self.sections(ui, theme, palette, edited, &first, &shown);
        self.apply(edited, &first, wanted);
        self.shared.clear();
        self.common.sections = shown;
    }
}
