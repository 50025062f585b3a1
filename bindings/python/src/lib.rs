//! The runtime for programs in Python; `underfoot/__init__.pyi` says what each name does.
//!
//! While it waits, other Python threads run, and signals are looked after every 50 ms. No lock is held meanwhile.

mod event;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyError, PyOSError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use underfoot::glam::Vec2;
use underfoot::runtime::{Control, Kind, Refusal, Session, Snapshot};
use underfoot::widget::{Indicator, SetError, Value};

use event::{Event, to_python};

create_exception!(
    underfoot,
    Refused,
    PyException,
    "The floor does not do what was asked; nothing has changed."
);

/// How long a wait lasts before signals are looked after.
const SLICE: Duration = Duration::from_millis(50);

/// A floor at work.
#[pyclass(frozen, subclass, name = "Session", module = "underfoot._underfoot")]
struct PySession {
    /// `None` once it is closed.
    floor: Mutex<Option<Session>>,
    /// Whether the last event was taken.
    over: AtomicBool,
}

impl PySession {
    /// A handle of its own, so that nobody waits for a lock.
    fn handle(&self) -> Option<Session> {
        self.floor.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn open(&self) -> PyResult<Session> {
        self.handle().ok_or_else(|| Refused::new_err("the session is closed"))
    }

    fn snapshot(&self) -> PyResult<Snapshot> {
        Ok(self.open()?.snapshot())
    }

    /// Does `what` with one control, while other threads run.
    fn with_control(
        &self,
        py: Python<'_>,
        id: &str,
        what: impl FnOnce(Control<'_>) -> Result<(), Refusal> + Send,
    ) -> PyResult<()> {
        let floor = self.open()?;
        py.detach(move || floor.control(id).and_then(what)).map_err(|refusal| refused(id, refusal))
    }
}

fn refused(id: &str, refusal: Refusal) -> PyErr {
    match refusal {
        Refusal::Control(SetError::Unknown) => PyKeyError::new_err(id.to_owned()),
        Refusal::Control(SetError::WrongType) => PyTypeError::new_err(format!("{id}: {refusal}")),
        _ => Refused::new_err(format!("{id}: {refusal}")),
    }
}

/// True or False, a number, or two.
#[derive(FromPyObject)]
enum Given {
    Switch(bool),
    Number(f32),
    Pair(f32, f32),
}

impl From<Given> for Value {
    fn from(given: Given) -> Self {
        match given {
            Given::Switch(on) => Self::Switch(on),
            Given::Number(number) => Self::Number(number),
            Given::Pair(east, north) => Self::Pair(Vec2::new(east, north)),
        }
    }
}

#[pymethods]
impl PySession {
    #[new]
    #[pyo3(signature = (address, layout, *, floor=None, every_change=false))]
    fn new(
        py: Python<'_>,
        address: String,
        layout: std::path::PathBuf,
        floor: Option<std::path::PathBuf>,
        every_change: bool,
    ) -> PyResult<Self> {
        let started = py.detach(move || {
            let mut builder = Session::listen(address);
            if let Some(path) = floor {
                builder = builder
                    .floor_file(path)
                    .map_err(|problems| PyValueError::new_err(problems.to_string()))?;
            }
            builder = builder
                .layout_file(layout)
                .map_err(|problems| PyValueError::new_err(problems.to_string()))?;
            if every_change {
                builder = builder.every_change();
            }
            builder.start().map_err(|error| PyOSError::new_err(error.to_string()))
        })?;
        Ok(Self { floor: Mutex::new(Some(started)), over: AtomicBool::new(false) })
    }

    /// The next event within `timeout` seconds; without a number, whenever it comes. `None` when there is none.
    #[pyo3(signature = (timeout=None))]
    fn next_event(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Option<Event>> {
        let begun = Instant::now();
        let patience = match timeout {
            None => Duration::MAX,
            Some(seconds) => Duration::try_from_secs_f64(seconds.max(0.0))
                .map_err(|error| PyValueError::new_err(error.to_string()))?,
        };
        loop {
            let Some(floor) = self.handle() else { return Ok(None) };
            let left = patience.saturating_sub(begun.elapsed());
            // The handle goes here as well: as the last one it waits for the floor's thread.
            if let Some(event) = py.detach(move || floor.next_event_timeout(left.min(SLICE))) {
                if matches!(event.kind, Kind::Ended(_)) {
                    self.over.store(true, Ordering::Release);
                }
                return Event::of(py, &event).map(Some);
            }
            py.check_signals()?;
            if left.is_zero() || self.over.load(Ordering::Acquire) {
                return Ok(None);
            }
        }
    }

    /// Whether the last event was taken, or the session is closed.
    #[getter]
    fn over(&self) -> bool {
        self.over.load(Ordering::Acquire) || self.handle().is_none()
    }

    fn __iter__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Event>> {
        self.next_event(py, None)
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __exit__(
        &self,
        py: Python<'_>,
        _kind: &Bound<'_, PyAny>,
        _value: &Bound<'_, PyAny>,
        _trace: &Bound<'_, PyAny>,
    ) {
        self.close(py);
    }

    fn stop(&self) {
        self.handle().into_iter().for_each(|floor| floor.stop());
    }

    fn close(&self, py: Python<'_>) {
        let floor = self.floor.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(floor) = floor {
            // Whoever waits for an event has a handle and gives it back then.
            floor.stop();
            py.detach(move || drop(floor));
        }
    }

    fn held(&self, id: &str) -> bool {
        self.handle().is_some_and(|floor| floor.held(id).is_fresh())
    }

    #[getter]
    fn dropped(&self) -> u64 {
        self.handle().map_or(0, |floor| floor.dropped())
    }

    fn __getitem__(&self, py: Python<'_>, id: &str) -> PyResult<Option<Py<PyAny>>> {
        let state = self.snapshot()?.control(id).ok_or_else(|| PyKeyError::new_err(id.to_owned()))?;
        state.value.map(|value| to_python(py, value)).transpose()
    }

    fn __setitem__(&self, py: Python<'_>, id: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let value: Given = value.extract().map_err(|_| {
            PyTypeError::new_err("a value is True or False, a number, or two numbers in a tuple")
        })?;
        self.with_control(py, id, |control| control.set(value))
    }

    fn __contains__(&self, id: &str) -> PyResult<bool> {
        Ok(self.snapshot()?.layout.widget_index(id).is_some())
    }

    /// The names of all controls, in the order of the layout.
    fn ids(&self) -> PyResult<Vec<String>> {
        Ok(self.snapshot()?.layout.widgets.iter().map(|widget| widget.id.to_string()).collect())
    }

    fn state<'py>(&self, py: Python<'py>, id: &str) -> PyResult<Bound<'py, PyDict>> {
        let state = self.snapshot()?.control(id).ok_or_else(|| PyKeyError::new_err(id.to_owned()))?;
        let dict = PyDict::new(py);
        dict.set_item("value", state.value.map(|value| to_python(py, value)).transpose()?)?;
        dict.set_item("label", &*state.label)?;
        dict.set_item("enabled", state.enabled)?;
        dict.set_item("locked", state.locked)?;
        dict.set_item("pressed", state.pressed)?;
        dict.set_item("armed", state.armed)?;
        dict.set_item("indicator", state.indicator.name())?;
        Ok(dict)
    }

    fn set_range(&self, py: Python<'_>, id: &str, least: f32, greatest: f32) -> PyResult<()> {
        self.with_control(py, id, |control| control.set_range(least..=greatest))
    }

    fn set_label(&self, py: Python<'_>, id: &str, label: &str) -> PyResult<()> {
        self.with_control(py, id, |control| control.set_label(label))
    }

    fn set_indicator(&self, py: Python<'_>, id: &str, lamp: &str) -> PyResult<()> {
        let lamp = Indicator::ALL.into_iter().find(|other| other.name() == lamp);
        let lamp = lamp.ok_or_else(|| PyValueError::new_err("a lamp is off, on, busy or attention"))?;
        self.with_control(py, id, |control| control.set_indicator(lamp))
    }

    fn set_enabled(&self, py: Python<'_>, id: &str, enabled: bool) -> PyResult<()> {
        self.with_control(py, id, |control| control.set_enabled(enabled))
    }

    fn set_locked(&self, py: Python<'_>, id: &str, locked: bool) -> PyResult<()> {
        self.with_control(py, id, |control| control.set_locked(locked))
    }

    fn set_page(&self, py: Python<'_>, page: &str) -> PyResult<()> {
        let floor = self.open()?;
        py.detach(move || floor.set_page(page)).map_err(|refusal| refused(page, refusal))
    }

    #[getter]
    fn page(&self) -> PyResult<Option<String>> {
        Ok(self.snapshot()?.page().map(str::to_owned))
    }

    #[getter]
    fn link(&self) -> PyResult<&'static str> {
        Ok(self.snapshot()?.floor.link.name())
    }

    /// Name and sentence of the cause for which boards that send give no usable frame.
    #[getter]
    fn link_cause(&self) -> PyResult<Option<(&'static str, String)>> {
        Ok(self.snapshot()?.floor.link_cause.map(|cause| (cause.name(), cause.to_string())))
    }

    /// Number, x, y, force and velocity of each foot on the floor.
    #[allow(clippy::type_complexity)]
    fn contacts(&self) -> PyResult<Vec<(u32, f32, f32, f32, f32, f32)>> {
        let contacts = self.snapshot()?.floor.contacts;
        let row = |foot: &underfoot::sense::Contact| {
            (foot.id.0, foot.centroid.x, foot.centroid.y, foot.force.0, foot.velocity.x, foot.velocity.y)
        };
        Ok(contacts.iter().map(row).collect())
    }

    /// The force on each tile in newtons, in the order of tile indices.
    fn forces(&self) -> PyResult<Vec<f32>> {
        Ok(self.snapshot()?.floor.tiles.iter().map(|tile| tile.force.0).collect())
    }
}

#[pymodule]
mod _underfoot {
    #[pymodule_export]
    use super::{Event, PySession, Refused};
}
