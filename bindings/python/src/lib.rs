//! The runtime for programs in Python; `underfoot/__init__.pyi` describes each name.
//!
//! During a wait other Python threads run, no lock is held, and signals are checked every 50 ms.

mod event;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyError, PyOSError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use underfoot::engine::{ControlState, ValueRange};
use underfoot::glam::Vec2;
use underfoot::recording::Speed;
use underfoot::runtime::{ControlHandle, Kind, Refusal, Session, SessionBuilder, SessionSnapshot};
use underfoot::widget::{Indicator, SetError, Value};
use underfoot_sim::{FloorQuality, UnknownQuality};

use event::{fields, to_python};

create_exception!(
    underfoot,
    Refused,
    PyException,
    "The floor does not do what was asked; nothing has changed."
);

/// Interval between two checks for signals during a wait.
const SLICE: Duration = Duration::from_millis(50);

/// A running floor.
#[pyclass(frozen, subclass, name = "Session", module = "underfoot._underfoot")]
struct PySession {
    /// `None` once it is closed.
    floor: Mutex<Option<Session>>,
    /// Whether the caller has taken the last event.
    over: AtomicBool,
}

impl PySession {
    /// A handle of its own, so that no thread waits for a lock.
    fn handle(&self) -> Option<Session> {
        self.floor.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn open(&self) -> PyResult<Session> {
        self.handle().ok_or_else(|| Refused::new_err("the session is closed"))
    }

    fn snapshot(&self) -> PyResult<SessionSnapshot> {
        Ok(self.open()?.snapshot())
    }

    /// The state of one control.
    fn known(&self, id: &str) -> PyResult<ControlState> {
        self.open()?.control(id).and_then(|control| control.state()).map_err(|refusal| refused(&refusal))
    }

    /// Calls `what` with one control, while other threads run.
    fn with_control(
        &self,
        py: Python<'_>,
        id: &str,
        what: impl FnOnce(ControlHandle<'_>) -> Result<(), Refusal> + Send,
    ) -> PyResult<()> {
        let floor = self.open()?;
        py.detach(move || floor.control(id).and_then(what)).map_err(|refusal| refused(&refusal))
    }
}

fn refused(refusal: &Refusal) -> PyErr {
    let text = refusal.to_string();
    match refusal {
        Refusal::UnknownControl { .. } | Refusal::UnknownPage { .. } => PyKeyError::new_err(text),
        Refusal::Control { why: SetError::WrongType, .. } => PyTypeError::new_err(text),
        _ => Refused::new_err(text),
    }
}

/// A floor that has started, for the constructor of [`PySession`] and of its subclasses.
#[pyclass(frozen, module = "underfoot._underfoot")]
struct Started(Session);

impl Started {
    /// Starts the session that `builder` gives, while other threads run.
    fn new(
        py: Python<'_>,
        every_change: bool,
        builder: impl FnOnce() -> PyResult<SessionBuilder> + Send,
    ) -> PyResult<Self> {
        py.detach(move || {
            let builder = builder()?;
            let builder = if every_change { builder.every_change() } else { builder };
            builder.start().map(Self).map_err(|error| PyOSError::new_err(error.to_string()))
        })
    }
}

/// The error for files with problems.
fn bad_files(problems: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(problems.to_string())
}

/// Starts a floor with boards that send to `address`.
#[pyfunction]
fn listen(
    py: Python<'_>,
    address: String,
    layout: PathBuf,
    floor: Option<PathBuf>,
    every_change: bool,
) -> PyResult<Started> {
    Started::new(py, every_change, move || {
        let mut builder = Session::listen(address);
        if let Some(path) = floor {
            builder = builder.floor_file(path).map_err(bad_files)?;
        }
        builder.layout_file(layout).map_err(bad_files)
    })
}

/// Replays a recording; as fast as possible without a `speed`.
#[pyfunction]
fn replay(py: Python<'_>, recording: PathBuf, speed: Option<f64>, every_change: bool) -> PyResult<Started> {
    let speed = match speed {
        None => Speed::Max,
        Some(times) if times > 0.0 && times.is_finite() => Speed::Times(times),
        Some(_) => {
            return Err(PyValueError::new_err(
                "the speed is a number above 0, or None for as fast as can be",
            ));
        }
    };
    Started::new(py, every_change, move || {
        Session::replay(recording, speed).map_err(|error| PyOSError::new_err(error.to_string()))
    })
}

/// Starts a simulated floor of a quality by its name; without a file `scenario`, with the built-in one.
#[pyfunction]
fn simulated(
    py: Python<'_>,
    layout: PathBuf,
    scenario: Option<PathBuf>,
    quality: &str,
    every_change: bool,
) -> PyResult<Started> {
    let quality: FloorQuality =
        quality.parse().map_err(|error: UnknownQuality| PyValueError::new_err(error.to_string()))?;
    Started::new(py, every_change, move || {
        underfoot_sim::session_from_files(layout, scenario.as_deref(), quality).map_err(bad_files)
    })
}

/// The state of a control, as a dictionary; `off` as a tuple of reason and text.
fn state<'py>(py: Python<'py>, state: &ControlState) -> PyResult<Bound<'py, PyDict>> {
    let ends = |scale: &underfoot::widget::Scale| (scale.min, scale.max);
    let dict = PyDict::new(py);
    dict.set_item("value", state.value.map(|value| to_python(py, value)).transpose()?)?;
    dict.set_item("label", &*state.label)?;
    dict.set_item("enabled", state.enabled)?;
    dict.set_item("off", state.off.as_ref().map(|off| (off.reason.name(), &*off.text)))?;
    dict.set_item("locked", state.locked)?;
    dict.set_item("pressed", state.pressed)?;
    dict.set_item("armed", state.armed)?;
    dict.set_item("indicator", state.indicator.name())?;
    match &state.range {
        Some(ValueRange::Number(scale)) => dict.set_item("range", ends(scale))?,
        Some(ValueRange::Pair(x, y)) => dict.set_item("range", (ends(x), ends(y)))?,
        Some(ValueRange::Choices(_)) | None => dict.set_item("range", py.None())?,
    }
    let step = match &state.range {
        Some(ValueRange::Number(scale)) if scale.step > 0.0 => Some(scale.step),
        _ => None,
    };
    let options = match &state.range {
        Some(ValueRange::Choices(names)) => Some(names.clone()),
        _ => None,
    };
    dict.set_item("step", step)?;
    dict.set_item("options", options)?;
    dict.set_item("page", state.page.as_ref().map(|page| page.as_str()))?;
    Ok(dict)
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
    fn new(started: &Started) -> Self {
        Self { floor: Mutex::new(Some(started.0.clone())), over: AtomicBool::new(false) }
    }

    /// The next event within `timeout` seconds; without a number, waits for ever. `None` when there is none.
    #[pyo3(signature = (timeout=None))]
    fn next_event<'py>(
        &self,
        py: Python<'py>,
        timeout: Option<f64>,
    ) -> PyResult<Option<Bound<'py, PyTuple>>> {
        let begun = Instant::now();
        let patience = match timeout {
            None => Duration::MAX,
            Some(seconds) => Duration::try_from_secs_f64(seconds.max(0.0))
                .map_err(|error| PyValueError::new_err(error.to_string()))?,
        };
        loop {
            let Some(floor) = self.handle() else { return Ok(None) };
            let left = patience.saturating_sub(begun.elapsed());
            // The handle is dropped here as well: the last one waits for the floor's thread.
            if let Some(event) = py.detach(move || floor.next_event_timeout(left.min(SLICE))) {
                if matches!(event.kind, Kind::Ended(_)) {
                    self.over.store(true, Ordering::Release);
                }
                return fields(py, &event).map(Some);
            }
            py.check_signals()?;
            if left.is_zero() || self.over.load(Ordering::Acquire) {
                return Ok(None);
            }
        }
    }

    /// Whether the caller has taken the last event, or the session is closed.
    #[getter]
    fn over(&self) -> bool {
        self.over.load(Ordering::Acquire) || self.handle().is_none()
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
            // A thread that waits for an event has a handle and drops it then.
            floor.stop();
            py.detach(move || drop(floor));
        }
    }

    fn held(&self, id: &str) -> PyResult<bool> {
        let Some(floor) = self.handle() else { return Ok(false) };
        Ok(floor.held(id).map_err(|refusal| refused(&refusal))?.is_fresh())
    }

    /// The address for boards.
    #[getter]
    fn address(&self) -> PyResult<Option<String>> {
        Ok(self.open()?.local_addr().map(|address| address.to_string()))
    }

    #[getter]
    fn dropped(&self) -> u64 {
        self.handle().map_or(0, |floor| floor.dropped())
    }

    fn __getitem__(&self, py: Python<'_>, id: &str) -> PyResult<Option<Py<PyAny>>> {
        self.known(id)?.value.map(|value| to_python(py, value)).transpose()
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
        state(py, &self.known(id)?)
    }

    /// The name and the state of each control, in the order of the layout.
    fn controls<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyDict>)>> {
        let snapshot = self.snapshot()?;
        snapshot.controls().map(|control| Ok((control.id.to_string(), state(py, &control)?))).collect()
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
        py.detach(move || floor.set_page(page)).map_err(|refusal| refused(&refusal))
    }

    #[getter]
    fn page(&self) -> PyResult<Option<String>> {
        Ok(self.snapshot()?.page().map(str::to_owned))
    }

    #[getter]
    fn link(&self) -> PyResult<&'static str> {
        Ok(self.snapshot()?.floor.link.name())
    }

    /// Name and sentence of the reason why boards that send give no usable frame.
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

    /// Rows and columns of tiles.
    #[getter]
    fn shape(&self) -> PyResult<(u16, u16)> {
        let floor = self.open()?;
        Ok((floor.geometry().rows(), floor.geometry().columns()))
    }

    /// The force on each tile in newtons, in the order of tile indices: single-precision numbers of this machine.
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let tiles = self.snapshot()?.floor.tiles;
        let size = tiles.len() * size_of::<f32>();
        PyBytes::new_with(py, size, |bytes| {
            for (place, tile) in bytes.chunks_exact_mut(size_of::<f32>()).zip(&tiles) {
                place.copy_from_slice(&tile.force.0.to_ne_bytes());
            }
            Ok(())
        })
    }
}

#[pymodule]
mod _underfoot {
    #[pymodule_export]
    use super::{PySession, Refused, listen, replay, simulated};

    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "Python's name")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
