//! Messages of controls to other programs, and the state machine that decides when each goes out.
//!
//! ```text
//! layout -MessagePlan-> Messenger <- events, held controls, contacts, state of the link, time
//!                Messenger -> orders: down, up, stroke, steps of a wheel, motion, OSC, MIDI, DMX, MQTT, programs
//! ```
//!
//! Everything here is pure: the caller passes the time, and carries out the orders.

mod content;
mod discovery;
mod dmx;
mod feet;
mod feet_settings;
mod key;
mod key_names;
mod messenger;
mod midi;
mod mpe;
mod mqtt;
mod news;
mod order;
mod outbox;
mod pace;
mod plan;
mod pointer;
mod sending;
mod target;
#[cfg(test)]
mod tests;
mod trigger;

pub use dmx::{ArtNetTarget, DMX_CHANNELS, DMX_MAX, DmxLevel, DmxSettings, SacnTarget};
pub use feet_settings::{ARRIVAL_N, ContactPayload, ContactSending, MpeSettings};
pub use key::{KeyStroke, KeySymbol};
pub use messenger::Messenger;
pub use midi::{
    BendSettings, ControllerSettings, MIDI_FINE_MAX, MIDI_MAX, MidiMessage, MidiNote, NoteSettings,
    PressureSettings, ProgramSettings,
};
pub use mqtt::{MqttMessage, MqttSettings, MqttSwitch, MqttTarget};
pub use news::MessageNews;
pub use order::{Act, Holdable, MessageOrder, OscValue, StandingState, Unsent};
pub use plan::MessagePlan;
pub use sending::{
    MAX_ARGUMENTS, MAX_MESSAGES, MouseButton, OscArgument, OscSettings, Payload, Sending, When,
};
pub use target::{
    Destination, KeyboardTarget, MAX_TARGETS, MidiTarget, OscTarget, OscTransport, ProgramTarget, SendTarget,
    TargetSort,
};
pub use trigger::Trigger;
