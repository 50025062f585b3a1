//! What happened, as Python sees it.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use underfoot::runtime::{self, Kind};
use underfoot::widget::{EventKind, Value};

/// One thing that happened on a floor.
#[pyclass(frozen, get_all, module = "underfoot")]
pub(crate) struct Event {
    t_s: f64,
    kind: &'static str,
    name: &'static str,
    id: String,
    value: Option<Py<PyAny>>,
    force_n: f32,
    x_m: f32,
    y_m: f32,
    contact: Option<u32>,
    text: String,
}

impl Event {
    pub(crate) fn of(py: Python<'_>, event: &runtime::Event) -> PyResult<Self> {
        let kind = if matches!(event.kind, Kind::Control(_)) { "control" } else { event.kind.name() };
        let value = match event.kind {
            Kind::Control(EventKind::Changed(value)) => Some(to_python(py, value)?),
            Kind::Control(EventKind::Swiped(direction)) => Some(direction.name().into_py_any(py)?),
            _ => None,
        };
        let text = match event.kind {
            Kind::Link(state) => state.name().to_owned(),
            Kind::LinkCause => event.message().to_owned(),
            Kind::Ended(reason) if event.message().is_empty() => reason.name().to_owned(),
            Kind::Ended(reason) => format!("{}: {}", reason.name(), event.message()),
            _ => String::new(),
        };
        Ok(Self {
            t_s: event.at.micros() as f64 / 1e6,
            kind,
            name: event.kind.name(),
            id: event.id().to_owned(),
            value,
            force_n: event.force.0,
            x_m: event.position.x,
            y_m: event.position.y,
            contact: event.contact.map(|contact| contact.0),
            text,
        })
    }
}

#[pymethods]
impl Event {
    #[classattr]
    fn __match_args__() -> (&'static str, &'static str, &'static str) {
        ("id", "name", "value")
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let value = match &self.value {
            Some(value) => value.bind(py).repr()?.to_string(),
            None => "None".into(),
        };
        Ok(format!(
            "<Event {} {} value={value} text={:?} at {:.3} s>",
            self.id, self.name, self.text, self.t_s
        ))
    }
}

/// True or False, a number, a whole number for a choice, or two numbers.
pub(crate) fn to_python(py: Python<'_>, value: Value) -> PyResult<Py<PyAny>> {
    match value {
        Value::Switch(on) => on.into_py_any(py),
        Value::Number(number) => number.into_py_any(py),
        Value::Choice(choice) => choice.into_py_any(py),
        Value::Pair(pair) => (pair.x, pair.y).into_py_any(py),
    }
}
