//! Commands of the window: layouts opened and tried, effects saved, controls set.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender};
use std::thread;

use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::runtime::{ControlsOff, Session};
use underfoot::schema::{self, Diagnostics, Saved};
use underfoot_sim::FeetTape;
use underfoot_window::edit;
use underfoot_window::preview::{LayoutCause, LayoutNews, Notice, PreviewCommand, Warnings};

use super::super::failure::Failure;
use super::super::layout_args::{DEFAULT_LAYOUT, LayoutArgs};
use super::super::watch::FileWatch;

/// Gives layouts to the floor and reports them to the window.
#[derive(Clone)]
pub(super) struct Desk {
    pub(super) session: Session,
    pub(super) layouts: SyncSender<LayoutNews>,
    /// Records feet for a layout; `None` unless the floor is simulated.
    pub(super) tape: Option<FeetTape>,
}

impl Desk {
    /// Puts the layout on the floor, or reports why it can't be read.
    fn take(&self, name: &str, cause: LayoutCause, read: Result<(Layout, Diagnostics), String>) {
        match read {
            Ok((layout, warnings)) => self.put(name, cause, layout, Warnings::from(&warnings)),
            Err(diagnostics) => {
                let _ = self.layouts.send(LayoutNews::Refused { name: name.to_owned(), diagnostics });
            }
        }
    }

    fn put(&self, name: &str, cause: LayoutCause, layout: Layout, warnings: Warnings) {
        if let Some(tape) = &self.tape {
            tape.cut();
        }
        let loaded = Arc::new(layout.clone());
        let revision = self.session.set_layout(layout);
        let name = name.to_owned();
        let _ = self.layouts.send(LayoutNews::Loaded { layout: loaded, revision, name, cause, warnings });
    }

    /// Reports each change of the files to the window, which has the text.
    pub(super) fn watch(&self, files: &LayoutArgs) -> Result<Option<FileWatch>, Failure> {
        let layouts = self.layouts.clone();
        FileWatch::on_change(files, move || {
            // If the queue is full, it already contains changes.
            let _ = layouts.try_send(LayoutNews::Changed);
        })
    }
}

/// Executes the commands of the window, with the data needed for that.
pub(super) struct CommandHandler {
    pub(super) files: LayoutArgs,
    /// Dropped when the next one starts.
    pub(super) watch: Option<FileWatch>,
    pub(super) choices: Vec<String>,
    pub(super) floor: Floor,
    pub(super) desk: Desk,
    /// Present during a check of the floor.
    pub(super) controls_off: Option<ControlsOff>,
}

impl CommandHandler {
    /// Executes the commands of the window, on a thread that ends with the window.
    pub(super) fn process_commands(
        mut self,
        commands: Receiver<PreviewCommand>,
        notices: SyncSender<Notice>,
    ) {
        thread::spawn(move || {
            for wanted in commands {
                match wanted.for_floor() {
                    Ok(command) => {
                        if !self.desk.session.send(command) {
                            break;
                        }
                    }
                    Err(wanted) => self.process(wanted, &notices),
                }
            }
        });
    }

    /// Executes a command that concerns layouts, files or checks.
    fn process(&mut self, wanted: PreviewCommand, notices: &SyncSender<Notice>) {
        match wanted {
            PreviewCommand::Open(choice) => self.open(choice),
            PreviewCommand::Watch(path) => {
                self.files.layout = path;
                match self.desk.watch(&self.files) {
                    Ok(watch) => self.watch = watch,
                    Err(failure) => drop(notices.send(failure.to_string().into())),
                }
            }
            PreviewCommand::Try { layout, name, warnings, cause } => {
                self.desk.put(&name, cause, Arc::unwrap_or_clone(layout), warnings);
            }
            PreviewCommand::TurnControlsOff(off) => {
                self.controls_off = off.then(|| self.desk.session.controls_off());
            }
            PreviewCommand::SaveFloor { floor, path } => {
                let _ = notices.send(keep_floor(&floor, &path).into());
            }
            PreviewCommand::SaveEffect { name, text } => {
                // The window may be closed already.
                let _ = notices.send(self.save(&name, &text).into());
            }
            // The floor has carried these out.
            PreviewCommand::Enable { .. }
            | PreviewCommand::Set { .. }
            | PreviewCommand::Mute(_)
            | PreviewCommand::MuteTile { .. }
            | PreviewCommand::Feel { .. } => {}
        }
    }

    fn open(&mut self, choice: usize) {
        let name = self.choices.get(choice).map_or(DEFAULT_LAYOUT, String::as_str).to_owned();
        self.files.layout = Some(PathBuf::from(&name));
        let read = self.files.reviewed(&self.floor).map_err(|failure| failure.to_string());
        self.desk.take(&name, LayoutCause::Opened, read);
    }

    /// Saves an effect in the folder that layouts read, and shows the layout with it; returns the message for the
    /// window.
    fn save(&self, name: &str, text: &str) -> String {
        let folder = self.files.effects_folder().unwrap_or_else(|| {
            let beside = self.files.path().and_then(Path::parent);
            beside.map_or_else(|| PathBuf::from("effects"), |folder| folder.join("effects"))
        });
        let path = folder.join(format!("{name}.ron"));
        if let Err(error) = std::fs::create_dir_all(&folder) {
            return format!("{} can't be made: {error}", folder.display());
        }
        // Text that a person has added beside the numbers stays.
        let old = std::fs::read_to_string(&path).unwrap_or_default();
        let text = edit::refit(&old, text);
        match schema::save_text(&text, &path) {
            Ok(_) => {
                let _ = self.desk.layouts.send(LayoutNews::Changed);
                format!("Saved in {}: write \"{name}\" where it shall be felt.", path.display())
            }
            Err(error) => error.to_string(),
        }
    }
}

/// Saves a checked floor; returns the message for the window.
pub(super) fn keep_floor(floor: &Floor, path: &Path) -> String {
    match schema::save_floor(floor, path) {
        Ok(Saved::New) => format!("Written to {}.", path.display()),
        Ok(Saved::Unchanged) => format!("{} holds all this already.", path.display()),
        Ok(Saved::Replaced { backup }) => {
            format!("Written to {}; what it held before is in {}.", path.display(), backup.display())
        }
        Err(error) => error.to_string(),
    }
}
