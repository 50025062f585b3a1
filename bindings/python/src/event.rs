//! An event as a tuple, from which `underfoot._types` makes an event.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use pyo3::{IntoPyObject, IntoPyObjectExt};
use underfoot::runtime::{self, Kind};
use underfoot::widget::{EventKind, Value};

/// The event's fields in the order of `underfoot._types.event_of`: kind, name, id, value, text, when, force, place,
/// foot.
pub(crate) fn fields<'py>(py: Python<'py>, event: &runtime::Event) -> PyResult<Bound<'py, PyTuple>> {
    let kind = if matches!(event.kind, Kind::Control(_)) { "control" } else { event.kind.name() };
    let value = match event.kind {
        Kind::Control(EventKind::Changed(value)) => Some(to_python(py, value)?),
        Kind::Control(EventKind::Swiped(direction)) => Some(direction.name().into_py_any(py)?),
        Kind::Crack { seed, energy_j } => Some((seed, energy_j).into_py_any(py)?),
        _ => None,
    };
    let text = match event.kind {
        Kind::Link(state) => state.name(),
        Kind::Ignored(why) => why.name(),
        Kind::Ended(reason) => reason.name(),
        _ => "",
    };
    let when_and_where = (
        event.at.micros() as f64 / 1e6,
        event.force.0,
        event.position.x,
        event.position.y,
        event.contact.map(|contact| contact.0),
    );
    (kind, event.kind.name(), event.id(), value, text, event.message(), when_and_where).into_pyobject(py)
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
