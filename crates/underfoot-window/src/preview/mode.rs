//! The mode of the window: trying the floor, designing its layout, or projecting it.

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Button, Key, Ui, WidgetInfo};

use super::app::App;
use super::icons::{self, Icon};

/// A mode of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WindowMode {
    /// Feet use the floor.
    Try,
    /// The layout is edited.
    Design,
    /// Feet use the floor, and a second window shows it for a projector.
    Project,
}

impl WindowMode {
    const ALL: [Self; 3] = [Self::Try, Self::Design, Self::Project];

    const fn name(self) -> &'static str {
        match self {
            Self::Try => "Try",
            Self::Design => "Design",
            Self::Project => "Project",
        }
    }

    const fn icon(self) -> Icon {
        match self {
            Self::Try => Icon::Footprints,
            Self::Design => Icon::PencilRuler,
            Self::Project => Icon::Projector,
        }
    }

    const fn hint(self) -> &'static str {
        match self {
            Self::Try => "Use the floor with feet; F2 does the same",
            Self::Design => "Change the layout; F2 does the same",
            Self::Project => "The floor alone, in a window of its own for a projector; F11 does the same",
        }
    }
}

impl App {
    /// The mode on display.
    pub(super) fn mode(&self) -> WindowMode {
        match (self.is_designing(), self.projection.is_open()) {
            (true, _) => WindowMode::Design,
            (false, true) => WindowMode::Project,
            (false, false) => WindowMode::Try,
        }
    }

    /// Changes the mode; a field that is being typed is applied first.
    fn turn_to(&mut self, ctx: &egui::Context, mode: WindowMode) {
        if let Some(designer) = self.designer.as_mut()
            && designer.is_open != (mode == WindowMode::Design)
        {
            designer.turn_mode(ctx, &mut self.feet);
        }
        if self.projection.is_open() != (mode == WindowMode::Project) {
            self.projection.toggle();
        }
    }

    /// The reason why a mode cannot be chosen; `None` if it can.
    fn why_not(&self, mode: WindowMode) -> Option<&'static str> {
        match mode {
            WindowMode::Design if self.designer.is_none() => {
                Some("This window has no layout that can be changed")
            }
            WindowMode::Design if self.is_checking() => Some("The floor is being checked: Escape ends that"),
            _ => None,
        }
    }

    /// One switch with a button for each mode; compact ones have icons alone.
    pub(super) fn mode_switch(&mut self, ui: &mut Ui, is_compact: bool) {
        let present = self.mode();
        let mut chosen = None;
        ui.scope(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            for mode in WindowMode::ALL {
                let (is_on, why_not) = (mode == present, self.why_not(mode));
                let text = icons::short(mode.icon(), mode.name(), is_compact);
                let button = Button::selectable(is_on, text).frame_when_inactive(true);
                let button = ui.add_enabled(why_not.is_none(), button);
                button.widget_info(|| {
                    WidgetInfo::selected(Role::RadioButton, why_not.is_none(), is_on, mode.name())
                });
                if button.clicked() {
                    chosen = Some(mode);
                }
                button.on_hover_text(mode.hint()).on_disabled_hover_text(why_not.unwrap_or_default());
            }
        });
        if let Some(mode) = chosen.filter(|mode| *mode != present) {
            self.turn_to(ui.ctx(), mode);
        }
    }

    /// Leaves Design mode for the projection on F11, which Try handles itself.
    pub(super) fn handle_mode_key(&mut self, ui: &Ui) {
        if self.is_designing() && ui.input(|i| i.key_pressed(Key::F11)) {
            self.turn_to(ui.ctx(), WindowMode::Project);
        }
    }
}
