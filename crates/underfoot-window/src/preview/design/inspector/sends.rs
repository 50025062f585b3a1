//! The messages of a control, one below the other: when, to which target, and what.

use eframe::egui::accesskit::Role;
use eframe::egui::{self, ComboBox, DragValue, RichText, Ui, WidgetInfo};

use super::super::edited::EditedLayout;
use super::field::{FieldEdits, TypedTexts, row_px};
use super::send_choices::{content_name, contents, first, refitted, time_name, times};
use super::send_texts::{MessageText, any, no_key, no_note};
use super::{FrameEdits, Inspector};
use crate::edit::{Address, Edit};
use crate::preview::icons::Icon;
use crate::preview::style::quiet;
use underfoot::layout::Widget;
use underfoot::messages::{
    KeyStroke, MAX_MESSAGES, MidiNote, MouseButton, Payload, SendTarget, Sending, TargetSort,
};
use underfoot::schema::{version_with, written_messages};
use underfoot_format::Named;
use underfoot_scene::scene::Theme;

/// Width of the drop-downs and fields of a message, in points.
pub(super) const PART_PX: f32 = 126.0;

/// The field of the messages.
const FIELD: &str = "send";

/// Targets that a layout without one can begin with.
const BEGINNINGS: [(&str, TargetSort); 6] = [
    ("keys", TargetSort::Keyboard),
    ("desk", TargetSort::Osc),
    ("synth", TargetSort::Midi),
    ("lights", TargetSort::Dmx),
    ("home", TargetSort::Mqtt),
    ("program", TargetSort::Program),
];

impl Inspector {
    /// Shows the messages of `widget` for editing; returns the edits of one, if any.
    pub(super) fn sends(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        edited: &EditedLayout,
        record: &Address,
        widget: &Widget,
    ) -> FrameEdits {
        let count = widget.send.len();
        let title = if count == 0 { "Messages".to_owned() } else { format!("Messages ({count})") };
        let header = egui::CollapsingHeader::new(RichText::new(title).strong()).id_salt("messages");
        let shown = header.default_open(count > 0).show_unindented(ui, |ui| {
            // Names and fields of a row have one middle.
            ui.spacing_mut().interact_size.y = row_px(ui);
            let written = edited.document.written(record, FIELD);
            if written.is_some_and(|text| text.contains('{')) {
                // The fields of a pattern belong to a whole grid.
                ui.label(quiet(theme, "They are filled in for each control of the grid: edit them as text."));
                return None;
            }
            let targets = &edited.layout().targets;
            let list = MessageList { theme, widget, targets, texts: &mut self.typed };
            let edits = list.show(ui)?;
            Some(match edits {
                ListEdit::Messages(all) => set(edited, record, &all),
                ListEdit::Unwritten => vec![Edit::unset(record, FIELD)],
                ListEdit::Target(name, sort) => {
                    let target = format!("(name: \"{name}\", to: {})", sort.example());
                    let all = match edited.document.written(&Address::LAYOUT, "targets") {
                        Some(list) if !targets.is_empty() => {
                            let inside =
                                list.trim_end().trim_end_matches(']').trim_end().trim_end_matches(',');
                            format!("{inside}, {target}]")
                        }
                        _ => format!("[{target}]"),
                    };
                    let mut edits = raised(edited, version_with(sort));
                    edits.push(Edit::set(&Address::LAYOUT, "targets", all));
                    edits
                }
            })
        });
        let edits = shown.body_returned.flatten()?;
        // The edits of one drag are one undo step.
        let pressed_s = ui.input(|i| i.pointer.press_start_time().filter(|_| i.pointer.primary_down()));
        Some((FIELD.into(), FieldEdits { edits, stroke: pressed_s.map(f64::to_bits) }))
    }
}

/// The edits that write `sendings`.
fn set(edited: &EditedLayout, record: &Address, sendings: &[Sending]) -> Vec<Edit> {
    let first = edited.layout().targets.iter().map(|target| version_with(target.to.sort())).max();
    let mut edits = first.map(|first| raised(edited, first)).unwrap_or_default();
    edits.push(Edit::set(record, FIELD, written_messages(sendings)));
    edits
}

/// The edit that raises the version of a file older than the `first` one with such messages.
fn raised(edited: &EditedLayout, first: u32) -> Vec<Edit> {
    let version = edited.document.written(&Address::LAYOUT, "version").and_then(|text| text.parse().ok());
    let is_old = version.is_some_and(|version: u32| version < first);
    is_old.then(|| Edit::set(&Address::LAYOUT, "version", first.to_string())).into_iter().collect()
}

/// An edit of the list.
enum ListEdit {
    Messages(Vec<Sending>),
    /// The messages of the kind again.
    Unwritten,
    /// A new target with this name.
    Target(&'static str, TargetSort),
}

/// The list of messages of one control.
pub(super) struct MessageList<'a> {
    pub(super) theme: &'a Theme,
    widget: &'a Widget,
    targets: &'a [SendTarget],
    /// The texts in which the user is typing, by name.
    pub(super) texts: &'a mut TypedTexts,
}

impl MessageList<'_> {
    fn show(mut self, ui: &mut Ui) -> Option<ListEdit> {
        let mut edit = None;
        for (index, sending) in self.widget.send.iter().enumerate() {
            let row = ui.push_id(("message", index), |ui| self.message(ui, index, sending)).inner;
            if let Some(row) = row {
                let mut all = self.widget.send.clone();
                match row {
                    Some(changed) => all.splice(index..=index, [changed]).for_each(drop),
                    None => drop(all.remove(index)),
                }
                edit = Some(if all.is_empty() { ListEdit::Unwritten } else { ListEdit::Messages(all) });
            }
            ui.add_space(6.0);
        }
        self.add(ui).or(edit)
    }

    /// Shows one message; returns its new form, or `Some(None)` to remove it.
    fn message(&mut self, ui: &mut Ui, index: usize, sending: &Sending) -> Option<Option<Sending>> {
        let mut changed = None;
        let name = |part: &str| format!("{part} of message {}", index + 1);
        ui.horizontal(|ui| {
            let all = times(&self.widget.behaviour);
            let names: Vec<String> = all.iter().map(|when| time_name(*when)).collect();
            if let Some(when) =
                pick(ui, &name("Time"), &time_name(sending.when), &names).and_then(|at| all.get(at))
            {
                let moved = Sending { when: *when, ..sending.clone() };
                changed = refitted(&moved, sending.payload.sort()).map(Some);
            }
            let remove = ui.small_button(Icon::X.unicode().to_string()).on_hover_text("Remove this message");
            remove.widget_info(|| {
                WidgetInfo::labeled(Role::Button, true, format!("Remove message {}", index + 1))
            });
            if remove.clicked() {
                changed = Some(None);
            }
        });
        ui.horizontal(|ui| {
            let names: Vec<String> = self.targets.iter().map(|target| target.name.clone()).collect();
            let chosen = pick(ui, &name("Target"), &sending.target, &names);
            if let Some(target) = chosen.and_then(|at| self.targets.get(at)) {
                let moved = Sending { target: target.name.clone(), ..sending.clone() };
                changed = refitted(&moved, target.to.sort()).map(Some);
            }
            let all = contents(sending.payload.sort(), sending.when);
            let names: Vec<String> = all.iter().map(|payload| content_name(payload).to_owned()).collect();
            let chosen = pick(ui, &name("Content"), content_name(&sending.payload), &names);
            if let Some(payload) = chosen.and_then(|at| all.get(at)) {
                changed = Some(Some(Sending { payload: payload.clone(), ..sending.clone() }));
            }
        });
        let payload = ui.horizontal_wrapped(|ui| self.payload(ui, index, sending)).inner;
        changed.or(payload.map(|payload| Some(Sending { payload, ..sending.clone() })))
    }

    /// Shows the settings of a content; returns the changed content.
    fn payload(&mut self, ui: &mut Ui, index: usize, sending: &Sending) -> Option<Payload> {
        let name = |part: &str| format!("{part} of message {}", index + 1);
        match &sending.payload {
            Payload::Key(key) => {
                let names: Vec<String> = KeyStroke::names().map(str::to_owned).collect();
                let listed =
                    pick(ui, &name("Key"), &key.to_string(), &names).and_then(|at| names.get(at).cloned());
                let (spoken, now) = (name("Typed key"), key.to_string());
                let typed = self.typed(ui, MessageText::new(&spoken, &now, no_key));
                Some(Payload::Key(listed.or(typed)?.parse().ok()?))
            }
            Payload::Button(button) => {
                let names: Vec<String> =
                    MouseButton::ALL.iter().map(|(name, _)| (*name).to_owned()).collect();
                let chosen = pick(ui, &name("Button"), button.name(), &names)?;
                Some(Payload::Button(MouseButton::ALL.get(chosen)?.1))
            }
            Payload::Wheel(steps) => {
                let steps = whole(ui, &name("Steps"), i64::from(*steps), -1000..=1000)?;
                Some(Payload::Wheel(i32::try_from(steps).ok()?))
            }
            Payload::Pointer(speed) => {
                let speed = whole(ui, &name("Pixels per second"), *speed as i64, 1..=20_000)?;
                Some(Payload::Pointer(speed as f32))
            }
            Payload::Osc(address, settings) => {
                let address =
                    self.typed(ui, MessageText::new(&name("Address"), address, any).wide("/address"))?;
                Some(Payload::Osc(address, settings.clone()))
            }
            Payload::Note(key, settings) => {
                let note = MidiNote { channel: settings.channel, key: *key };
                let (spoken, now) = (name("Note"), note.name());
                let typed = self.typed(ui, MessageText::new(&spoken, &now, no_note));
                let channel = channel(ui, &name("Channel"), settings.channel);
                let mut settings = *settings;
                settings.channel = channel.unwrap_or(settings.channel);
                let key = typed.and_then(|text| MidiNote::key_called(&text));
                (key.is_some() || channel.is_some()).then(|| Payload::Note(key.unwrap_or(note.key), settings))
            }
            Payload::Controller(settings) => {
                let number = whole(ui, &name("Controller"), settings.number.into(), 0..=119);
                let channel = channel(ui, &name("Channel"), settings.channel);
                let mut changed = *settings;
                changed.number =
                    number.and_then(|number| u8::try_from(number).ok()).unwrap_or(changed.number);
                changed.channel = channel.unwrap_or(changed.channel);
                (changed != *settings).then_some(Payload::Controller(changed))
            }
            Payload::Program(program, settings) => {
                let number = whole(ui, &name("Program"), (*program).into(), 0..=127);
                let channel = channel(ui, &name("Channel"), settings.channel);
                let mut settings = *settings;
                settings.channel = channel.unwrap_or(settings.channel);
                let changed = number.and_then(|number| u8::try_from(number).ok());
                (changed.is_some() || channel.is_some())
                    .then(|| Payload::Program(changed.unwrap_or(*program), settings))
            }
            Payload::Bend(settings) => {
                let channel = channel(ui, &name("Channel"), settings.channel)?;
                let mut settings = *settings;
                settings.channel = channel;
                Some(Payload::Bend(settings))
            }
            Payload::Dmx(_) | Payload::Mqtt(..) | Payload::Run(_) => self.device(ui, index, sending),
            Payload::Pressure(settings) => {
                let channel = channel(ui, &name("Channel"), settings.channel)?;
                let mut settings = *settings;
                settings.channel = channel;
                Some(Payload::Pressure(settings))
            }
        }
    }

    /// The buttons that add a message or a target.
    fn add(&self, ui: &mut Ui) -> Option<ListEdit> {
        let mut edit = None;
        ui.horizontal_wrapped(|ui| {
            let first_target = self.targets.first().filter(|_| self.widget.send.len() < MAX_MESSAGES);
            if let Some(target) = first_target
                && ui.button("Add a message").clicked()
            {
                let begun = first(&self.widget.behaviour, &target.name, target.to.sort());
                edit = begun.map(|begun| {
                    ListEdit::Messages(self.widget.send.iter().cloned().chain([begun]).collect())
                });
            }
            let free =
                BEGINNINGS.into_iter().filter(|(name, _)| self.targets.iter().all(|it| it.name != *name));
            ui.menu_button("Add a target", |ui| {
                for (name, sort) in free {
                    if ui.button(format!("{name}: {}", sort.noun())).clicked() {
                        edit = Some(ListEdit::Target(name, sort));
                        ui.close();
                    }
                }
            });
        });
        if self.targets.is_empty() {
            ui.label(quiet(
                self.theme,
                "A message needs a target: keys, OSC, MIDI, lights, MQTT, or a program.",
            ));
        } else {
            ui.label(quiet(self.theme, "Only underfoot run sends; here they are listed among the events."));
        }
        edit
    }
}

/// A drop-down; returns the index of another choice.
fn pick(ui: &mut Ui, name: &str, shown: &str, all: &[String]) -> Option<usize> {
    let mut chosen = None;
    let menu = ComboBox::from_id_salt(name).selected_text(shown).width(PART_PX).height(360.0).truncate();
    let menu = menu.show_ui(ui, |ui| {
        for (index, one) in all.iter().enumerate() {
            if ui.selectable_label(one == shown, one).clicked() && one != shown {
                chosen = Some(index);
            }
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, name));
    chosen
}

/// A whole number; returns another one.
pub(super) fn whole(ui: &mut Ui, name: &str, now: i64, range: std::ops::RangeInclusive<i64>) -> Option<i64> {
    let (short, _) = name.split_once(" of ").unwrap_or((name, ""));
    ui.label(short);
    let mut number = now;
    let field = ui.add(DragValue::new(&mut number).range(range).speed(0.2).update_while_editing(false));
    field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, name));
    (number != now).then_some(number)
}

/// A MIDI channel; returns another one.
fn channel(ui: &mut Ui, name: &str, now: u8) -> Option<u8> {
    whole(ui, name, now.into(), 1..=16).and_then(|channel| u8::try_from(channel).ok())
}
