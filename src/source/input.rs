//! The input of a floor, in parts.

use std::fmt;

use super::{Journal, Port, Replay, SensorSource};

/// Everything that a floor takes in: packets, and beside them requests and layouts.
///
/// Any [`SensorSource`] is an input of packets alone. A wrapper of a source gets the packets and nothing else, so that
/// it can't withhold requests:
///
/// ```
/// use underfoot::source::{FloorInput, SensorSource};
///
/// fn wrapped(input: FloorInput, wrap: impl Fn(Box<dyn SensorSource>) -> Box<dyn SensorSource>) -> FloorInput {
///     FloorInput { source: wrap(input.source), ..input }
/// }
/// ```
///
/// A source with more than packets, such as `UdpSource`, is not a [`SensorSource`]: it becomes an
/// input as a whole, and its packets alone do not compile.
///
/// ```compile_fail,E0277
/// use underfoot::source::{SensorSource, UdpSource};
///
/// fn packets_alone(source: UdpSource) -> impl SensorSource {
///     source
/// }
/// ```
///
/// All parts belong on one thread: a call of one may wait for a call of another.
pub struct FloorInput {
    /// The packets.
    pub source: Box<dyn SensorSource>,
    /// The network port; `None` for a source without a network, such as a simulation or a recording.
    pub port: Option<Box<dyn Port>>,
    /// The requests and layouts of a recording or of another server, if the packets are theirs.
    pub replay: Option<Box<dyn Replay>>,
    /// Notes of the requests and layouts from all origins, innermost recording first.
    pub journals: Vec<Box<dyn Journal>>,
}

impl<S: SensorSource + 'static> From<S> for FloorInput {
    /// An input of packets alone.
    fn from(source: S) -> Self {
        Self { source: Box::new(source), port: None, replay: None, journals: Vec::new() }
    }
}

impl fmt::Debug for FloorInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FloorInput")
            .field("port", &self.port.is_some())
            .field("replay", &self.replay.is_some())
            .field("journals", &self.journals.len())
            .finish_non_exhaustive()
    }
}
