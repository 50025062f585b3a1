//! OSC messages that are repeated while they are valid.

use crate::units::Instant;
use crate::widget::WidgetId;
use crate::wire::sent::{self, Sent};
use crate::wire::{Prefix, write};

/// The controls held by feet at one moment; repeated 50 times a second while there are any.
///
/// A receiver must treat a control as released after 100 ms without a report: the server, the network or a board may
/// have failed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HeldReport {
    /// Time on the floor's sample clock.
    pub at: Instant,
    /// The controls that are held.
    pub held: Vec<WidgetId>,
    /// Controls that were held in the last report and are not any more.
    pub ended: Vec<WidgetId>,
    /// Number of the report, from 1, wrapping at 2^32.
    pub sequence: u32,
}

/// Writes each held control as an OSC message `/underfoot/widget/<id>/held 1 <sequence>`, and each ended one with 0;
/// passes every datagram to `send`.
///
/// Both arguments are ints; the sequence continues with negative numbers after 2^31 - 1.
pub fn write_held(prefix: &Prefix, report: &HeldReport, bytes: &mut Vec<u8>, mut send: impl FnMut(&[u8])) {
    let held = report.held.iter().map(|id| (id, true));
    let ended = report.ended.iter().map(|id| (id, false));
    for (id, held) in ended.chain(held) {
        let message = sent::Held { held, sequence: report.sequence.cast_signed() };
        write(&message.packet_of(prefix, id), bytes);
        send(bytes);
    }
}

/// Writes the alive signal of the server as the OSC message `/underfoot/alive <sequence>`, an int.
pub fn write_alive(prefix: &Prefix, sequence: u32, bytes: &mut Vec<u8>) {
    write(&sent::Alive { sequence: sequence.cast_signed() }.packet(prefix), bytes);
}

#[cfg(test)]
mod tests {
    use rosc::{OscMessage, OscPacket, OscType, decoder};

    use super::*;

    fn decoded(bytes: &[u8]) -> (String, Vec<OscType>) {
        match decoder::decode_udp(bytes) {
            Ok((_, OscPacket::Message(OscMessage { addr, args }))) => (addr, args),
            other => panic!("not a message: {other:?}"),
        }
    }

    #[test]
    fn what_is_held_and_what_has_ended_are_messages_with_the_same_number() {
        let report = HeldReport {
            held: vec![WidgetId::new("drive")],
            ended: vec![WidgetId::new("zoom")],
            sequence: 1 << 31,
            ..HeldReport::default()
        };
        let mut told = Vec::new();
        write_held(&Prefix::default(), &report, &mut vec![1, 2], |bytes| told.push(decoded(bytes)));
        let message = |id: &str, on| {
            (format!("/underfoot/widget/{id}/held"), vec![OscType::Int(on), OscType::Int(i32::MIN)])
        };
        assert_eq!(told, [message("zoom", 0), message("drive", 1)]);
    }

    #[test]
    fn a_sign_of_life_is_one_number() {
        let mut bytes = vec![7];
        write_alive(&Prefix::default(), 3, &mut bytes);
        assert_eq!(decoded(&bytes), ("/underfoot/alive".into(), vec![OscType::Int(3)]));
    }
}
