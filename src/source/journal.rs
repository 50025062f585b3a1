//! Requests and layouts among the packets of a recording: noted by a journal, repeated by a replay.

use crate::layout::Layout;
use crate::wire::Request;

/// A request or a layout that a floor gets from outside the program.
#[derive(Clone, Debug)]
pub enum Incoming {
    /// A request, to be carried out and answered.
    Request(Request),
    /// A layout that replaces the floor's.
    Layout(Box<Layout>),
}

/// The requests and layouts of a recording or of another server, in their places among its packets.
pub trait Replay: Send {
    /// The next request or layout, if one precedes the next packet and is usable. Requests have no sender: the floor
    /// that was recorded has answered them.
    fn take(&mut self) -> Option<Incoming>;
}

/// Notes the requests and layouts of a floor among its packets, so that a replay of them gives the same events.
pub trait Journal: Send {
    /// Notes a request that the floor is about to carry out.
    fn note_request(&mut self, request: &Request);

    /// Notes a layout that the floor is about to get; an exact journal replaces it by the form that it stores.
    fn note_layout(&mut self, layout: &mut Layout);
}
