//! The effect tuner: a slider for each number of an effect; a change is drawn and played at once.

use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{
    self, Align, Button, ComboBox, Layout, Margin, Panel, RichText, ScrollArea, Sense, Slider, TextEdit, Ui,
    WidgetInfo, vec2,
};

use super::super::feed::PreviewCommand;
use super::super::handheld::panel_at;
use super::super::shown::ShownFloor;
use super::super::stage::StageOfWindow;
use super::super::style::{is_entered, panel_frame, quiet, section};
use super::super::trace::Trace;
use underfoot::feel::{Effect, EffectKind, Gesture, Knob};
use underfoot::floor::TileId;
use underfoot::schema::{NamedEffect, write_named_effect};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Pause of the hand after which the effect is played automatically, in seconds.
const RESTS_S: f64 = 0.12;

/// The state of the tuner.
pub(crate) struct Tuner {
    pub(crate) is_open: bool,
    effects: Vec<NamedEffect>,
    /// Index of the chosen effect, in its original form.
    chosen: usize,
    /// The effect with the present changes.
    effect: Arc<Effect>,
    trace: Option<Trace>,
    /// Whether each change is played automatically.
    by_itself: bool,
    /// Time of the last change that has not been played, and time of the last play.
    changed_s: Option<f64>,
    played_s: Option<f64>,
    /// The name for saving.
    name: String,
}

/// The tile on which an effect is played.
struct Place {
    /// Column and row.
    name: String,
    /// The maximum force of its actuator, in newtons.
    full_scale: f32,
}

/// The requests of one frame of the tuner.
#[derive(Default)]
struct Wishes {
    play: bool,
    save: bool,
    changed: bool,
    choose: Option<usize>,
}

impl Tuner {
    pub(crate) fn new(effects: Vec<NamedEffect>) -> Option<Self> {
        let first = effects.iter().position(|effect| effect.name == "crisp_click").unwrap_or(0);
        let mut tuner = Self {
            is_open: false,
            chosen: first,
            effect: Arc::clone(&effects.get(first)?.effect),
            name: String::new(),
            effects,
            trace: None,
            by_itself: true,
            changed_s: None,
            played_s: None,
        };
        tuner.choose(first);
        Some(tuner)
    }

    fn choose(&mut self, index: usize) {
        let Some(named) = self.effects.get(index) else { return };
        self.chosen = index;
        self.effect = Arc::clone(&named.effect);
        self.name.clone_from(&named.name);
        self.trace = None;
    }

    fn is_turned(&self) -> bool {
        self.effects.get(self.chosen).is_some_and(|named| *named.effect != *self.effect)
    }

    fn about(&self) -> &str {
        self.effects.get(self.chosen).map_or("", |named| named.about.as_str())
    }

    fn show(&mut self, ui: &mut Ui, theme: &Theme, now_s: f64, place: &Place) -> Wishes {
        let mut wishes = Wishes::default();
        self.heading(ui, theme, &mut wishes);
        self.picture(ui, theme, now_s, place.full_scale);
        self.buttons(ui, theme, place, &mut wishes);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_width(ui.available_width() - 8.0);
            wishes.changed |= self.knobs(ui, theme);
            ui.add_space(8.0);
        });
        wishes
    }

    fn heading(&mut self, ui: &mut Ui, theme: &Theme, wishes: &mut Wishes) {
        section(ui, theme, "Effect", |ui| {
            ui.label(quiet(theme, self.effect.kind.name()).size(12.0));
        });
        ui.horizontal(|ui| {
            let name = self.effects.get(self.chosen).map_or("", |named| named.name.as_str());
            let menu = ComboBox::from_id_salt("effect").selected_text(name).width(190.0).height(420.0);
            let response = menu.show_ui(ui, |ui| {
                // Effects of one kind stand together.
                let mut order: Vec<usize> = (0..self.effects.len()).collect();
                order.sort_by_key(|&index| {
                    let kind = self.effects[index].effect.kind.name();
                    EffectKind::names().iter().position(|known| *known == kind)
                });
                let mut kind = "";
                for index in order {
                    let named = &self.effects[index];
                    if named.effect.kind.name() != kind {
                        kind = named.effect.kind.name();
                        ui.label(quiet(theme, kind).size(11.5));
                    }
                    let label = ui.selectable_label(index == self.chosen, &named.name);
                    if label.on_hover_text(&named.about).clicked() {
                        wishes.choose = Some(index);
                    }
                }
            });
            response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Effect"));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.add_enabled(self.is_turned(), Button::new("Revert")).clicked() {
                    wishes.choose = Some(self.chosen);
                }
            });
        });
        ui.add(egui::Label::new(quiet(theme, self.about()).size(12.0)).truncate());
    }

    /// Shows the waveform, the spectrum and the important figures.
    fn picture(&mut self, ui: &mut Ui, theme: &Theme, now_s: f64, full_scale: f32) {
        let effect = &self.effect;
        let trace = self.trace.get_or_insert_with(|| Trace::of(effect, &Gesture::usual(effect)));
        let width = ui.available_width();
        let figures = match &trace.analysis {
            Some(analysis) => {
                let within = 100.0 * analysis.within;
                format!(
                    "{:.1} N peak,  {within:.1} % in band,  {:.0} Hz",
                    analysis.peak, analysis.centroid_hz
                )
            }
            None => "silence".to_owned(),
        };
        let (rect, response) = ui.allocate_exact_size(vec2(width, 92.0), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Waveform: {figures}")));
        let played = self.played_s.map(|played| (now_s - played) as f32);
        trace.wave(&ui.painter_at(rect), theme, rect, played);
        let (rect, response) = ui.allocate_exact_size(vec2(width, 92.0), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Spectrum"));
        trace.spectrum(&ui.painter_at(rect), theme, rect);
        let outside = trace.analysis.as_ref().is_some_and(|analysis| analysis.within < 0.95);
        let beyond = trace.analysis.as_ref().is_some_and(|analysis| analysis.peak > full_scale);
        let ink = if outside || beyond { theme.warning } else { theme.ink };
        let label = ui.label(RichText::new(figures).size(12.5).color(color(ink)));
        if beyond {
            label
                .on_hover_text(format!("Beyond the actuator's {full_scale:.0} N: the limiter holds it down"));
        } else if outside {
            label.on_hover_text("More than a twentieth of it lies where actuators move little");
        }
    }

    fn buttons(&mut self, ui: &mut Ui, theme: &Theme, place: &Place, wishes: &mut Wishes) {
        ui.horizontal(|ui| {
            let play = Button::new(RichText::new("Play").strong()).min_size(vec2(82.0, 28.0));
            let play = ui.add(play.fill(color(theme.accent.mix(theme.plate, 0.72))));
            play.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Play"));
            wishes.play |= play.on_hover_text("Plays it on the selected tile").clicked();
            ui.checkbox(&mut self.by_itself, "at each change");
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let text = quiet(theme, format!("on tile {}", place.name)).size(12.0);
                ui.label(text).on_hover_text("The selected tile: shift-click another one on the floor");
            });
        });
        ui.horizontal(|ui| {
            let is_name = underfoot::schema::is_effect_name(&self.name);
            let edit = ui.add(TextEdit::singleline(&mut self.name).desired_width(172.0).char_limit(64));
            edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Name to save as"));
            let save = ui.add_enabled(is_name, Button::new("Save as RON"));
            wishes.save |= is_name && is_entered(ui, &edit);
            wishes.save |= save
                .on_hover_text("Into the folder `effects`: layouts and kinds can name it at once")
                .on_disabled_hover_text("A name is made of a-z, 0-9 and _")
                .clicked();
        });
    }

    /// Shows a slider for each number; returns whether one was moved.
    fn knobs(&mut self, ui: &mut Ui, theme: &Theme) -> bool {
        let mut turned = (*self.effect).clone();
        let mut changed = false;
        let mut part: Option<String> = None;
        turned.turn(&mut |knob: &Knob, value: &mut f32| {
            if part.as_ref() != Some(&knob.part) {
                part = Some(knob.part.clone());
                ui.add_space(5.0);
                if !knob.part.is_empty() {
                    ui.label(quiet(theme, &knob.part).size(12.0));
                }
            }
            changed |= slider(ui, knob, value);
        });
        // The visit rebalances even an unchanged effect, to the same numbers.
        if changed {
            self.effect = Arc::new(turned);
            self.trace = None;
        }
        changed
    }
}

/// Shows one slider in the unit of its name; returns whether it was moved.
fn slider(ui: &mut Ui, knob: &Knob, value: &mut f32) -> bool {
    let mut shown = *value * knob.scale;
    let mut moved = false;
    ui.horizontal(|ui| {
        // A constant width for every value aligns the ends of the sliders.
        ui.spacing_mut().interact_size.x = 56.0;
        ui.spacing_mut().slider_width = (ui.available_width() - 178.0).max(60.0);
        let (rect, _) = ui.allocate_exact_size(vec2(100.0, 18.0), Sense::hover());
        let font = egui::FontId::proportional(13.0);
        let ink = ui.visuals().text_color();
        ui.painter().text(rect.left_center(), egui::Align2::LEFT_CENTER, knob.name, font, ink);
        let slider = Slider::new(&mut shown, knob.range.0..=knob.range.1)
            .logarithmic(knob.by_ratio)
            .smallest_positive(0.01)
            .max_decimals(if knob.whole { 0 } else { 4 })
            .step_by(if knob.whole { 1.0 } else { 0.0 });
        let response = ui.add(slider.custom_formatter(|value, _| short(value)));
        let spoken = format!("{} {}", knob.part, knob.name).trim().to_owned();
        response.widget_info(|| WidgetInfo::slider(true, f64::from(shown), &spoken));
        moved = response.changed();
    });
    if moved {
        *value = shown / knob.scale;
    }
    moved
}

/// A number with three significant digits.
fn short(value: f64) -> String {
    let digits = match value.abs() {
        large if large >= 100.0 => 0,
        large if large >= 10.0 => 1,
        large if large >= 1.0 => 2,
        0.0 => 0,
        small if small >= 0.1 => 3,
        _ => 4,
    };
    format!("{value:.digits$}")
}

impl Tuner {
    /// The tuner at the window's left edge, if it is open, or at the right of a narrow one; it plays effects on `tile`.
    pub(in crate::preview) fn panel(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        tile: TileId,
        stage: &StageOfWindow,
    ) {
        if !self.is_open {
            return;
        }
        let now_s = shown.now_s;
        let frame = panel_frame(theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        let panel = panel_at(stage.sheet(), || {
            let panel = if stage.is_wide() { Panel::left("tuner") } else { Panel::right("tuner") };
            let widest = stage.widest();
            let panel = panel.resizable(true).default_size(332.0);
            panel.size_range(290.0_f32.min(widest)..=520.0_f32.min(widest))
        });
        let index = shown.floor.geometry.index(tile).unwrap_or(0);
        let actuator = shown.floor.actuators.get(index).copied().flatten();
        let place = Place {
            name: format!("{}, {}", tile.column, tile.row),
            full_scale: actuator.map_or(f32::INFINITY, |actuator| actuator.full_scale.0),
        };
        let wishes = panel.frame(frame).show(ui, |ui| self.show(ui, theme, now_s, &place)).inner;
        if let Some(index) = wishes.choose {
            self.choose(index);
        }
        if wishes.changed || wishes.choose.is_some() {
            self.changed_s = Some(now_s);
        }
        let rested = self.changed_s.is_some_and(|changed| now_s - changed >= RESTS_S) && self.by_itself;
        if wishes.play || rested {
            self.changed_s = None;
            self.played_s = Some(now_s);
            let (effect, gesture) = (Arc::clone(&self.effect), Gesture::usual(&self.effect));
            shown.command(PreviewCommand::Feel { effect, gesture, tile: index });
        }
        if wishes.save {
            let about = self.about().to_owned();
            let named = NamedEffect { name: self.name.clone(), about, effect: Arc::clone(&self.effect) };
            let text = write_named_effect(&named);
            shown.command(PreviewCommand::SaveEffect { name: named.name.clone(), text });
            // From now on, the list contains it.
            match self.effects.iter().position(|known| known.name == named.name) {
                Some(index) => {
                    self.effects[index] = named;
                    self.chosen = index;
                }
                None => {
                    let index = self.effects.partition_point(|known| known.name < named.name);
                    self.effects.insert(index, named);
                    self.chosen = index;
                }
            }
        }
    }
}
