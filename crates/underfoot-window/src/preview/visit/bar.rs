//! The button that records, and the bar for the recording: save, play again, export.

use std::path::PathBuf;
use std::time::Duration;

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Key, Margin, Modifiers, Panel, ProgressBar, RichText, Ui, WidgetInfo};

use super::{VisitDesk, VisitForm, VisitOrder, VisitSize, VisitState};
use crate::preview::icons::{self, Icon};
use crate::preview::share::LayoutToShare;
use crate::preview::style::{panel_frame, quiet, selected_ground, switch_button};
use underfoot::engine::Snapshot;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Time between frames while a clock or a progress bar moves.
const PICTURE: Duration = Duration::from_millis(100);

/// The forms of an export: name, and the ending of the file's name.
const FORMS: [(VisitForm, &str, &str); 3] = [
    (VisitForm::Picture, "Animated picture (GIF)", ".gif"),
    (VisitForm::Recording, "Recording (MCAP)", ".mcap"),
    (VisitForm::Tables, "Tables (CSV)", "-tables"),
];

/// The button, the bar, and the texts in it.
pub(in crate::preview) struct VisitBar {
    desk: Box<dyn VisitDesk>,
    state: VisitState,
    is_open: bool,
    /// Name of the files, without their endings.
    name: String,
    form: VisitForm,
    /// The layout on which the last recording began; `None` where it is not known.
    layout: Option<LayoutToShare>,
}

/// A button of the bar that the window follows.
pub(in crate::preview) enum VisitAction {
    /// Give the visit away as a link.
    Share(Box<LayoutToShare>),
    /// Play the visit in a page of its own.
    Play(Box<LayoutToShare>),
}

/// Returns the layout on the screen; `None` where it cannot be shared.
type LayoutOnScreen<'a> = &'a dyn Fn() -> Option<LayoutToShare>;

impl VisitBar {
    pub(in crate::preview) fn new(desk: Box<dyn VisitDesk>) -> Self {
        Self {
            desk,
            state: VisitState::default(),
            is_open: false,
            name: "visit".into(),
            form: VisitForm::default(),
            layout: None,
        }
    }

    /// Takes in the state, and handles F9.
    pub(in crate::preview) fn follow(&mut self, ui: &Ui, snapshot: &Snapshot, layout: LayoutOnScreen<'_>) {
        let was_recording = self.state.recording.is_some();
        self.state = self.desk.state();
        if was_recording && self.state.recording.is_none() && self.state.kept.is_some() {
            self.is_open = true;
        }
        if self.state.recording.is_some() || self.state.work.is_some() {
            ui.ctx().request_repaint_after(PICTURE);
        }
        if self.state.off.is_none() && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::F9)) {
            self.switch(snapshot, layout);
        }
    }

    /// Whether a recording is in progress, and whether one is kept: both change the buttons.
    pub(in crate::preview) fn shows(&self) -> [bool; 2] {
        [self.state.recording.is_some(), self.state.kept.is_some()]
    }

    fn switch(&mut self, snapshot: &Snapshot, layout: LayoutOnScreen<'_>) {
        self.desk.lead(match self.state.recording {
            Some(_) => VisitOrder::End,
            None => {
                self.layout = layout();
                VisitOrder::Begin(Box::new(snapshot.clone()))
            }
        });
    }

    /// Shows the button that records; in front of it, the one that opens the bar, if there is a recording. Compact ones
    /// have icons, and the length of the recording.
    pub(in crate::preview) fn button(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        snapshot: &Snapshot,
        layout: LayoutOnScreen<'_>,
        is_compact: bool,
    ) {
        if self.state.kept.is_some() {
            let hint = match self.state.is_for_links {
                true => "Share or play what was recorded",
                false => "Save, play or export what was recorded",
            };
            if switch_button(ui, self.is_open, Icon::Film, "Visit", is_compact, hint) {
                self.is_open = !self.is_open;
            }
        }
        let text = match &self.state.recording {
            Some(size) => format!("Stop {}", written(size)),
            None => "REC".to_owned(),
        };
        let is_on = self.state.recording.is_some();
        let icon = if is_on { Icon::CircleStop } else { Icon::CircleDot };
        let ink = theme.legible(theme.fault, selected_ground(theme));
        let short = match &self.state.recording {
            Some(size) if is_compact => icons::with(icon, &length(size)),
            _ => icons::short(icon, &text, is_compact),
        };
        let shown = RichText::new(short);
        let shown = if is_on { shown.color(color(ink)) } else { shown };
        let button = egui::Button::selectable(is_on, shown).frame_when_inactive(true);
        let button = ui.add_enabled(self.state.off.is_none(), button);
        button.widget_info(|| WidgetInfo::selected(Role::Button, button.enabled(), is_on, &text));
        let button = match &self.state.off {
            Some(why) => button.on_disabled_hover_text(why),
            None if self.state.is_for_links => {
                button.on_hover_text("Record the feet, for a link; F9 does the same")
            }
            None => button.on_hover_text("Record the floor; F9 does the same"),
        };
        if button.clicked() {
            self.switch(snapshot, layout);
        }
    }

    /// Shows the bar; `part` is the part of the time line that is marked, and `makes_links` says whether the window can
    /// make links. Returns the button that the window has to follow.
    pub(in crate::preview) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        part: Option<(f64, f64)>,
        makes_links: bool,
    ) -> Option<VisitAction> {
        let kept = self.state.kept.filter(|_| self.is_open)?;
        let frame = panel_frame(theme, Margin::symmetric(14, 6));
        let mut action = None;
        Panel::bottom("visit").frame(frame).resizable(false).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                ui.label(quiet(theme, format!("Visit {}", written(&kept))));
                if makes_links {
                    action = self.link_buttons(ui);
                }
                if self.state.is_for_links {
                    return self.tell(ui, theme);
                }
                let name = egui::TextEdit::singleline(&mut self.name).desired_width(150.0);
                let field = ui.add(name).on_hover_text("Name of the file, without its ending");
                field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Name of the visit"));
                self.keep_buttons(ui);
                self.export_buttons(ui, part);
                self.tell(ui, theme);
            });
        });
        action
    }

    fn tell(&self, ui: &mut Ui, theme: &Theme) {
        if let Some(told) = &self.state.told {
            ui.label(quiet(theme, told).size(12.5));
        }
    }

    /// The buttons for feet that go into a link.
    fn link_buttons(&mut self, ui: &mut Ui) -> Option<VisitAction> {
        let (shared, layout) = (self.desk.shared()?, self.layout.clone()?);
        let visit = match shared {
            Ok(visit) => visit,
            Err(why) => {
                ui.label(RichText::new(why).size(12.5));
                return self.discard_button(ui);
            }
        };
        let with_visit = || Box::new(LayoutToShare { visit: Some(visit.clone()), ..layout.clone() });
        let hint = "A link that shows the feet again on this layout, and lets other feet take over";
        if ui.button("Share this visit").on_hover_text(hint).clicked() {
            return Some(VisitAction::Share(with_visit()));
        }
        if !self.state.is_for_links {
            return None;
        }
        let hint = "In a page of its own, with a time line";
        if ui.button("Play again").on_hover_text(hint).clicked() {
            return Some(VisitAction::Play(with_visit()));
        }
        self.discard_button(ui)
    }

    fn discard_button(&mut self, ui: &mut Ui) -> Option<VisitAction> {
        if self.state.is_for_links && ui.button("Discard").on_hover_text("Delete the recording").clicked() {
            self.desk.lead(VisitOrder::Discard);
        }
        None
    }

    /// The buttons for the last recording of the floor: a saved one can still be played. A recording on display has a
    /// file and a time line already.
    fn keep_buttons(&mut self, ui: &mut Ui) {
        if self.state.is_unsaved && ui.button("Save this visit").clicked() {
            self.desk.lead(VisitOrder::Save(self.path(".mcap")));
        }
        let hint = "In a window of its own, with a time line to trim it";
        if self.state.off.is_none() && ui.button("Play again").on_hover_text(hint).clicked() {
            self.desk.lead(VisitOrder::PlayAgain);
        }
        if self.state.is_unsaved && ui.button("Discard").on_hover_text("Delete the recording").clicked() {
            self.desk.lead(VisitOrder::Discard);
        }
    }

    fn export_buttons(&mut self, ui: &mut Ui, part: Option<(f64, f64)>) {
        if let Some(work) = &self.state.work {
            let bar = ProgressBar::new(work.share as f32).desired_width(140.0);
            ui.add(bar.text(format!("{} {:.0} %", work.name, 100.0 * work.share)));
            if ui.button("Cancel").clicked() {
                self.desk.lead(VisitOrder::StopExport);
            }
            return;
        }
        let known = FORMS.iter().find(|(form, ..)| *form == self.form);
        let (name, ending) = known.map_or(("", ""), |(_, name, ending)| (*name, *ending));
        let menu = egui::ComboBox::from_id_salt("form of the visit").selected_text(name).width(190.0);
        let menu = menu.show_ui(ui, |ui| {
            for (form, name, _) in FORMS {
                ui.selectable_value(&mut self.form, form, name);
            }
        });
        menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Form of the export"));
        let (text, hint) = match part {
            Some((from, to)) => {
                (format!("Export {from:.1} to {to:.1} s"), "Only the part that is marked on the time line")
            }
            None => ("Export".into(), "All of it; a drag with Shift on the time line marks a part"),
        };
        if ui.button(text).on_hover_text(hint).clicked() {
            self.desk.lead(VisitOrder::Export { form: self.form, to: self.path(ending), part });
        }
    }

    /// The file or folder with this ending.
    fn path(&self, ending: &str) -> PathBuf {
        let name = self.name.trim();
        let name = name.strip_suffix(ending).unwrap_or(name);
        format!("{}{ending}", if name.is_empty() { "visit" } else { name }).into()
    }
}

/// Length and size: `0:12 · 3.1 MB`, or `0:12 · 2.4 kB` for a little.
fn written(size: &VisitSize) -> String {
    let (unit, per_unit) = if size.bytes < 100_000 { ("kB", 1e-3) } else { ("MB", 1e-6) };
    let bytes = format!("{:.1} {unit}", size.bytes as f64 * per_unit);
    // The time line shows the length of a recording that is played.
    if size.length_s > 0.0 { format!("{} · {bytes}", length(size)) } else { bytes }
}

/// Minutes and seconds: `0:12`.
fn length(size: &VisitSize) -> String {
    // The cast from float saturates at the range of the integer.
    let seconds = size.length_s.max(0.0) as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}
