//! The settings of messages to lights, brokers and programs.

use eframe::egui::Ui;

use super::send_texts::{MessageText, any, no_topic};
use super::sends::{MessageList, whole};
use crate::preview::style::quiet;
use underfoot::messages::{
    DMX_CHANNELS, DMX_MAX, DmxSettings, MAX_ARGUMENTS, MqttSettings, Payload, Sending, When,
};

impl MessageList<'_> {
    /// Shows the settings of a content for lights, a broker or a program; returns the changed content.
    pub(super) fn device(&mut self, ui: &mut Ui, index: usize, sending: &Sending) -> Option<Payload> {
        let name = |part: &str| format!("{part} of message {}", index + 1);
        match &sending.payload {
            Payload::Dmx(settings) => light(ui, &name, sending.when, *settings).map(Payload::Dmx),
            Payload::Mqtt(topic, settings) => {
                let typed = self.typed(ui, MessageText::new(&name("Topic"), topic, no_topic).wide("topic"));
                let changed = self.broker_texts(ui, &name, sending.when, settings);
                let is_changed = typed.is_some() || changed != *settings;
                is_changed.then(|| Payload::Mqtt(typed.unwrap_or_else(|| topic.clone()), changed))
            }
            Payload::Run(arguments) => {
                let written = arguments.join(" ");
                // One line has blanks between arguments.
                if arguments.iter().any(|argument| argument.is_empty() || argument.contains(' ')) {
                    ui.label(quiet(self.theme, format!("{written} (edit it as text)")));
                    return None;
                }
                let typed =
                    self.typed(ui, MessageText::new(&name("Arguments"), &written, any).wide("arguments"))?;
                Some(Payload::Run(typed.split_whitespace().take(MAX_ARGUMENTS).map(str::to_owned).collect()))
            }
            _ => None,
        }
    }

    /// Shows the texts of an event or of a hold; an empty one is the usual text. A value has none.
    fn broker_texts(
        &mut self,
        ui: &mut Ui,
        name: &impl Fn(&str) -> String,
        when: When,
        now: &MqttSettings,
    ) -> MqttSettings {
        let mut changed = now.clone();
        let mut text = |ui: &mut Ui, part: &str, hint: &str, text: &mut Option<String>| {
            ui.end_row();
            ui.label(part);
            let now = text.clone().unwrap_or_default();
            let typed = self.typed(ui, MessageText::new(&name(part), &now, any).wide(hint));
            if let Some(typed) = typed {
                *text = Some(typed).filter(|typed| !typed.is_empty());
            }
        };
        match when {
            When::On(trigger) => text(ui, "Text", trigger.name(), &mut changed.payload),
            When::While => {
                text(ui, "Text", "ON", &mut changed.payload);
                text(ui, "Text after it", "OFF", &mut changed.off);
            }
            When::Value => {}
        }
        changed
    }
}

/// Shows the channel and the levels of a light; returns other settings.
fn light(ui: &mut Ui, name: &impl Fn(&str) -> String, when: When, now: DmxSettings) -> Option<DmxSettings> {
    let short = |number: i64| u16::try_from(number).ok();
    let most = if now.fine { u16::MAX } else { DMX_MAX };
    let mut changed = now;
    let channel = whole(ui, &name("Channel"), now.channel.into(), 1..=DMX_CHANNELS.into());
    changed.channel = channel.and_then(short).unwrap_or(now.channel);
    let level = whole(ui, &name("Level"), now.top().into(), 0..=most.into());
    changed.to = level.and_then(short).or(now.to);
    // An event sets the level for good.
    if !matches!(when, When::On(_)) {
        let rest = whole(ui, &name("At rest"), now.from.into(), 0..=most.into());
        changed.from = rest.and_then(short).unwrap_or(now.from);
    }
    (changed != now).then_some(changed)
}
