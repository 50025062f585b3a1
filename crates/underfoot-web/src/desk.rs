//! Layouts put on the floor, and the commands of the window.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError};

use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::schema;
use underfoot::serve::{FloorCommand, Server};
use underfoot::sink::SharedSender;
use underfoot::widget::WidgetId;
use underfoot::wire::ControlMessage;
use underfoot_sim::FeetTape;
use underfoot_window::edit::{self, Document};
use underfoot_window::preview::{LayoutCause, LayoutNews, Notice, PreviewCommand, Warnings};

use super::kinds::OwnTexts;
use super::plan::FIRST;

/// Carries out the commands of the window, on the thread of the page: nothing here may wait.
pub(crate) struct PageDesk {
    pub(crate) floor: Arc<Floor>,
    pub(crate) choices: Vec<String>,
    pub(crate) own: OwnTexts,
    pub(crate) asked: Receiver<PreviewCommand>,
    pub(crate) to_floor: SharedSender<FloorCommand>,
    pub(crate) layouts: SyncSender<LayoutNews>,
    pub(crate) notices: SyncSender<Notice>,
    /// Commands for which the floor had no room.
    pub(crate) late: Vec<FloorCommand>,
    /// The number of layouts that the floor got.
    pub(crate) revision: u64,
    /// The controls that a check of the floor has switched off.
    pub(crate) off: Vec<WidgetId>,
    /// Records feet for a layout.
    pub(crate) tape: FeetTape,
}

impl PageDesk {
    /// Carries out what the window has asked for of the floor of `server`.
    pub(crate) fn work(&mut self, server: &Server) {
        for command in std::mem::take(&mut self.late) {
            self.give(command);
        }
        // A floor that stands still takes no more.
        while self.late.is_empty()
            && let Ok(asked) = self.asked.try_recv()
        {
            match asked.for_floor() {
                Ok(command) => self.give(command),
                Err(asked) => self.process(asked, server),
            }
        }
    }

    fn give(&mut self, command: FloorCommand) {
        match self.to_floor.try_send(command) {
            Ok(()) => {}
            Err(TrySendError::Full(command)) => self.late.push(command),
            Err(TrySendError::Disconnected(_)) => self.tell("The floor has ended: load the page again."),
        }
    }

    fn tell(&self, text: impl Into<String>) {
        // A full channel has more than the window can show.
        let _ = self.notices.try_send(Notice::Text(text.into()));
    }

    fn process(&mut self, asked: PreviewCommand, server: &Server) {
        match asked {
            PreviewCommand::Open(choice) => self.open(choice),
            PreviewCommand::Try { layout, name, warnings, cause } => self.put(&layout, name, warnings, cause),
            PreviewCommand::TurnControlsOff(true) => self.turn_off(server),
            PreviewCommand::TurnControlsOff(false) => {
                for id in std::mem::take(&mut self.off) {
                    self.give(FloorCommand::Control(ControlMessage::Enable { id }));
                }
            }
            PreviewCommand::SaveEffect { name, text } => self.save_effect(&name, &text),
            PreviewCommand::SaveFloor { .. } => {
                self.tell("The floor of this page is simulated: there is nothing to keep of it.");
            }
            // No other program changes the files of a page.
            PreviewCommand::Watch(_)
            // The floor has carried these out.
            | PreviewCommand::Enable { .. }
            | PreviewCommand::Set { .. }
            | PreviewCommand::Mute(_)
            | PreviewCommand::MuteTile { .. }
            | PreviewCommand::Feel { .. } => {}
        }
    }

    fn open(&mut self, choice: usize) {
        let name = self.choices.get(choice).map_or(FIRST, String::as_str).to_owned();
        let text = schema::builtin_layout(&name).unwrap_or_default();
        match Document::read(&name, text, &self.own.read(None), &self.floor) {
            Ok(document) => {
                let warnings = Warnings::from(&document.review());
                self.put(document.layout(), name, warnings, LayoutCause::Opened);
            }
            Err(problems) => {
                let refused = LayoutNews::Refused { name, diagnostics: problems.to_string() };
                // As for notices.
                let _ = self.layouts.try_send(refused);
            }
        }
    }

    fn put(&mut self, layout: &Layout, name: String, warnings: Warnings, cause: LayoutCause) {
        self.revision += 1;
        self.tape.cut();
        self.give(FloorCommand::SetLayout(Box::new(layout.clone())));
        let (layout, revision) = (Arc::new(layout.clone()), self.revision);
        let _ = self.layouts.try_send(LayoutNews::Loaded { layout, revision, name, cause, warnings });
    }

    fn turn_off(&mut self, server: &Server) {
        let mut snapshot = Snapshot::default();
        server.snapshot(&mut snapshot);
        let on = server
            .engine()
            .layout()
            .widgets
            .iter()
            .zip(&snapshot.widgets)
            .filter(|(_, state)| !state.disabled);
        self.off = on.map(|(widget, _)| widget.id.clone()).collect();
        for id in self.off.clone() {
            self.give(FloorCommand::Control(ControlMessage::Disable { id }));
        }
    }

    /// Keeps an effect for the layouts of this page, and shows the layout with it.
    fn save_effect(&self, name: &str, text: &str) {
        let file = format!("{name}.ron");
        // Text that a person has added beside the numbers stays.
        let text = edit::refit(&self.own.effect(&file), text);
        self.own.keep_effect(file, text);
        let _ = self.layouts.try_send(LayoutNews::Changed);
        self.tell(format!(
            "Kept in this page: write \"{name}\" where it shall be felt. Share takes it along."
        ));
    }
}
