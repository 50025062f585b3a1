//! The settings of messages to lights, brokers and programs.

use eframe::egui::Ui;

use super::sends::{MessageList, whole};
use crate::preview::style::quiet;
use underfoot::messages::{DMX_CHANNELS, DMX_MAX, MAX_ARGUMENTS, MqttTarget, Payload};

impl MessageList<'_> {
    /// Shows the settings of a content for lights, a broker or a program; returns the changed content.
    pub(super) fn device(&mut self, ui: &mut Ui, index: usize, now: &Payload) -> Option<Payload> {
        let name = |part: &str| format!("{part} of message {}", index + 1);
        match now {
            Payload::Dmx(settings) => {
                let number = whole(ui, &name("Channel"), settings.channel.into(), 1..=DMX_CHANNELS.into());
                let most = if settings.fine { u16::MAX } else { DMX_MAX };
                let level = whole(ui, &name("Level"), settings.top().into(), 0..=most.into());
                let short = |number: i64| u16::try_from(number).ok();
                let mut changed = *settings;
                changed.channel = number.and_then(short).unwrap_or(changed.channel);
                changed.to = level.and_then(short).or(changed.to);
                (changed != *settings).then_some(Payload::Dmx(changed))
            }
            Payload::Mqtt(topic, settings) => {
                let topic = self.typed(ui, &name("Topic"), topic)?;
                MqttTarget::is_topic(&topic).then(|| Payload::Mqtt(topic, settings.clone()))
            }
            Payload::Run(arguments) => {
                let written = arguments.join(" ");
                // One line has blanks between arguments.
                if arguments.iter().any(|argument| argument.is_empty() || argument.contains(' ')) {
                    ui.label(quiet(self.theme, format!("{written} (edit it as text)")));
                    return None;
                }
                let typed = self.typed(ui, &name("Arguments"), &written)?;
                Some(Payload::Run(typed.split_whitespace().take(MAX_ARGUMENTS).map(str::to_owned).collect()))
            }
            _ => None,
        }
    }
}
