//! The messages of a datagram, one by one.

use super::guard::Bundle;
use super::sensor_message::RawMessage;

/// Calls `take` with the address and the bytes of each message of `datagram`, which has been decoded: it is
/// well-formed, and nests no deeper than datagrams may.
pub(crate) fn each_message(datagram: &[u8], take: &mut impl FnMut(&[u8], &[u8])) {
    match Bundle::of(datagram) {
        Some(bundle) => bundle.elements().for_each(|element| each_message(element, take)),
        None => {
            if let Some(message) = RawMessage::split(datagram) {
                take(message.address, datagram);
            }
        }
    }
}
