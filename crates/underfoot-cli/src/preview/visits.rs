//! Visits recorded, saved and exported for the window, on a thread of their own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant as HostInstant};

use underfoot::engine::Snapshot;
use underfoot::recording::RecordingSwitch;
use underfoot::runtime::Session;
use underfoot::serve::FloorCommand;
use underfoot_sim::{FeetTape, FloorBuild};
use underfoot_window::link::{SharedVisit, VisitTape};
use underfoot_window::preview::{VisitDesk, VisitForm, VisitOrder, VisitSize, VisitState, VisitWork};

use super::super::export::{ExportForm, Exported, FILM_WIDTH, RecordedPart, export};
use super::super::failure::Failure;
use super::super::own_program;

/// Maximum number of commands that wait: a person's clicks during an export.
const ORDERS_WAITING: usize = 64;

/// Maximum wait for the tare in use.
const PATIENCE: Duration = Duration::from_millis(500);

/// The window's end of the thread.
pub(super) struct Visits {
    orders: SyncSender<VisitOrder>,
    shared: Arc<Shared>,
    /// Records the feet beside the recording; `None` unless the floor is simulated.
    feet: Option<VisitTape>,
}

/// State that the thread and the window share.
#[derive(Default)]
struct Shared {
    state: Mutex<VisitState>,
    /// File and beginning of the recording in progress.
    recording: Mutex<Option<(PathBuf, HostInstant)>>,
    stops_export: AtomicBool,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, VisitState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn recording(&self) -> MutexGuard<'_, Option<(PathBuf, HostInstant)>> {
        self.recording.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Length and size of the recording in progress.
    fn size(&self) -> Option<VisitSize> {
        let recording = self.recording();
        let (path, begun) = recording.as_ref()?;
        Some(VisitSize { length_s: begun.elapsed().as_secs_f64(), bytes: length(path) })
    }
}

impl Visits {
    /// Records the floor of `session` by `switch`, and its feet by `tape` if it is simulated.
    pub(super) fn of_floor(
        session: Session,
        switch: RecordingSwitch,
        tape: Option<(FeetTape, FloorBuild)>,
    ) -> Self {
        let folder = std::env::temp_dir();
        let file = folder.join(format!("underfoot-visit-{}.mcap", std::process::id()));
        let feet = tape.map(|(tape, build)| VisitTape::new(tape, build));
        Self { feet, ..Self::start(VisitState::default(), file, Some((session, switch))) }
    }

    /// Exports the recording at `path`, of this length.
    pub(super) fn of_recording(path: &Path) -> Self {
        let kept = Some(VisitSize { length_s: 0.0, bytes: length(path) });
        let off = Some("A recording is shown".to_owned());
        Self::start(VisitState { kept, off, ..VisitState::default() }, path.into(), None)
    }

    /// Records nothing, for this reason.
    pub(super) fn off(why: &str) -> Self {
        let off = Some(why.to_owned());
        Self::start(VisitState { off, ..VisitState::default() }, PathBuf::new(), None)
    }

    fn start(state: VisitState, file: PathBuf, floor: Option<(Session, RecordingSwitch)>) -> Self {
        let shared = Arc::new(Shared { state: Mutex::new(state), ..Shared::default() });
        let (orders, received) = sync_channel(ORDERS_WAITING);
        let clerk = Clerk { file, floor, shared: Arc::clone(&shared) };
        thread::spawn(move || clerk.work(&received));
        Self { orders, shared, feet: None }
    }
}

impl VisitDesk for Visits {
    fn state(&mut self) -> VisitState {
        let recording = self.shared.size();
        VisitState { recording, ..self.shared.state().clone() }
    }

    fn lead(&mut self, order: VisitOrder) {
        self.lead_feet(&order);
        if matches!(order, VisitOrder::StopExport) {
            self.shared.stops_export.store(true, Ordering::Relaxed);
        } else if self.orders.try_send(order).is_err() {
            self.shared.state().told = Some("Too much is asked at once: wait for the export".into());
        }
    }

    fn shared(&self) -> Option<Result<SharedVisit, String>> {
        self.feet.as_ref()?.kept().map(|kept| kept.visit.clone())
    }
}

impl Visits {
    /// Records the feet together with the floor.
    fn lead_feet(&mut self, order: &VisitOrder) {
        let is_unsaved = self.shared.state().is_unsaved;
        let Some(feet) = &mut self.feet else { return };
        match order {
            // The recording does not begin either.
            VisitOrder::Begin(_) if is_unsaved => {}
            VisitOrder::Begin(_) => feet.begin(),
            VisitOrder::End => feet.end(),
            VisitOrder::Discard => feet.discard(),
            _ => {}
        }
    }
}

/// Carries out the commands.
struct Clerk {
    /// The recording: the last one of the floor, or the one on display.
    file: PathBuf,
    /// `None` for a recording.
    floor: Option<(Session, RecordingSwitch)>,
    shared: Arc<Shared>,
}

impl Clerk {
    fn work(mut self, orders: &Receiver<VisitOrder>) {
        for order in orders {
            let told = match order {
                VisitOrder::Begin(snapshot) => self.begin(&snapshot).map(|()| None),
                VisitOrder::End => {
                    self.end();
                    Ok(None)
                }
                VisitOrder::Save(to) => self.save(&to).map(Some),
                VisitOrder::PlayAgain => self.play().map(|()| None),
                VisitOrder::Discard => {
                    self.discard();
                    Ok(None)
                }
                VisitOrder::Export { form, to, part } => self.export(form, &to, part).map(Some),
                VisitOrder::StopExport => Ok(None),
            };
            self.shared.state().told = told.unwrap_or_else(|failure| Some(failure.to_string()));
        }
        self.end();
        // Closing the window must not delete a visit.
        if self.shared.state().is_unsaved {
            errln!("The last visit was not saved: it is in {}.", self.file.display());
        } else {
            self.discard();
        }
    }

    fn begin(&mut self, snapshot: &Snapshot) -> Result<(), Failure> {
        let Some((session, switch)) = &self.floor else { return Ok(()) };
        if self.shared.state().is_unsaved {
            return Err(Failure::Other("save or discard the last visit first".into()));
        }
        let (to, tare) = sync_channel(1);
        let tare = session.send(FloorCommand::GiveTare(to)).then(|| tare.recv_timeout(PATIENCE).ok());
        switch.begin(&self.file, snapshot, tare.flatten().flatten())?;
        *self.shared.recording() = Some((self.file.clone(), HostInstant::now()));
        let mut state = self.shared.state();
        (state.kept, state.is_unsaved) = (None, false);
        Ok(())
    }

    fn end(&mut self) {
        let Some((_, switch)) = &self.floor else { return };
        let Some(size) = self.shared.size() else { return };
        switch.end();
        *self.shared.recording() = None;
        let mut state = self.shared.state();
        state.kept = Some(VisitSize { bytes: length(&self.file), ..size });
        state.is_unsaved = true;
    }

    /// Saves the recording; an existing file of that name stays.
    fn save(&mut self, to: &Path) -> Result<String, Failure> {
        let to = free(to);
        // A rename does not reach another disk.
        fs::copy(&self.file, &to).map_err(|error| Failure::File(to.clone(), error))?;
        self.shared.state().is_unsaved = false;
        Ok(format!("Saved in {}.", absolute(&to).display()))
    }

    fn play(&self) -> Result<(), Failure> {
        let failed = |error| Failure::File(self.file.clone(), error);
        let mut window = own_program::command().map_err(failed)?;
        window.arg("preview").arg(&self.file).stdin(Stdio::null());
        let mut window = window.spawn().map_err(failed)?;
        // The system keeps a process that has ended until somebody waits for it.
        thread::spawn(move || window.wait());
        Ok(())
    }

    /// Deletes the recording of a floor.
    fn discard(&mut self) {
        let mut state = self.shared.state();
        if self.floor.is_some() && state.kept.take().is_some() {
            state.is_unsaved = false;
            // It may be gone already.
            let _ = fs::remove_file(&self.file);
        }
    }

    fn export(&self, form: VisitForm, to: &Path, part: Option<(f64, f64)>) -> Result<String, Failure> {
        let to = free(to);
        let form = match form {
            VisitForm::Picture => ExportForm::Film(FILM_WIDTH),
            VisitForm::Recording => ExportForm::Recording,
            VisitForm::Tables => ExportForm::Tables,
        };
        let name = to.display().to_string();
        let shared = &self.shared;
        shared.stops_export.store(false, Ordering::Relaxed);
        shared.state().work = Some(VisitWork { name: name.clone(), share: 0.0 });
        let (from_s, to_s) = part.map_or((0.0, None), |(from, to)| (from, Some(to)));
        let exported = RecordedPart::of(&self.file, from_s, to_s).and_then(|part| {
            export(&self.file, &part, form, &to, &mut |share| {
                if let Some(work) = &mut shared.state().work {
                    work.share = share;
                }
                !shared.stops_export.load(Ordering::Relaxed)
            })
        });
        shared.state().work = None;
        Ok(match exported? {
            Exported::Whole => format!("Exported to {}.", absolute(&to).display()),
            Exported::UpToBreak(failure) => failure.to_string(),
            Exported::Stopped => format!("The export to {name} was stopped."),
        })
    }
}

/// The path from the root, which shows its folder to the user; the path itself where the current folder is unknown.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

fn length(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |file| file.len())
}

/// The path, or the first one like it with a number that does not exist yet.
fn free(path: &Path) -> PathBuf {
    let named = |number: u32| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().map(|ending| format!(".{}", ending.to_string_lossy()));
        path.with_file_name(format!("{stem}-{number}{}", ending.unwrap_or_default()))
    };
    let numbered = (2..u32::MAX).map(named);
    std::iter::once(path.to_owned()).chain(numbered).find(|path| !path.exists()).unwrap_or_default()
}
