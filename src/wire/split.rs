//! Iteration over the messages of a datagram.

use super::guard::Bundle;
use super::sensor_message::RawMessage;

/// Calls `take` with the address and the bytes of each message of `datagram`. The datagram must have been decoded: it
/// is well-formed and within the nesting limit.
pub fn each_message(datagram: &[u8], take: &mut impl FnMut(&[u8], &[u8])) {
    match Bundle::of(datagram) {
        Some(bundle) => bundle.elements().for_each(|element| each_message(element, take)),
        None => {
            if let Some(message) = RawMessage::split(datagram) {
                take(message.address, datagram);
            }
        }
    }
}
