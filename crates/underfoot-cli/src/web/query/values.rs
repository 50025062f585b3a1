//! The current values of OSC addresses: the messages that a floor would send now.

use std::collections::HashMap;

use rosc::{OscPacket, OscType};
use underfoot::engine::{ControlState, Snapshot};
use underfoot::layout::Layout;
use underfoot::outgoing::{
    write_contacts, write_control, write_device, write_health, write_mute, write_page,
};
use underfoot::wire::Prefix;

/// The arguments of the messages that report states, by address.
#[derive(Debug, Default)]
pub(super) struct CurrentValues(HashMap<String, Vec<OscType>>);

impl CurrentValues {
    /// Those of a floor in this state.
    pub(super) fn of_floor(layout: &Layout, floor: &Snapshot, prefix: &Prefix) -> Self {
        let (mut values, mut bytes) = (Self::default(), Vec::new());
        for state in (0..layout.widgets.len()).filter_map(|index| ControlState::of(layout, index, floor)) {
            write_control(prefix, &state, &mut bytes);
            values.take(&bytes);
        }
        write_health(prefix, floor.link, floor.link_cause.as_ref(), &floor.health, &mut bytes);
        values.take(&bytes);
        let page = layout.pages.get(floor.page).map_or("", |page| page.id.as_str());
        write_page(prefix, page, &mut bytes);
        values.take(&bytes);
        write_mute(prefix, &floor.muted, &mut bytes);
        values.take(&bytes);
        if let Some(device) = &floor.device {
            write_device(prefix, device, &mut bytes);
            values.take(&bytes);
        }
        write_contacts(prefix, &floor.contacts, &mut bytes, |datagram| values.take(datagram));
        // An address has one value: of several contacts none is it.
        values.0.remove(&prefix.address("contact"));
        values
    }

    /// The value of an address, if it has one.
    pub(super) fn of(&self, address: &str) -> Option<&[OscType]> {
        self.0.get(address).map(Vec::as_slice)
    }

    fn take(&mut self, datagram: &[u8]) {
        each_message(datagram, &mut |address, args| {
            self.0.insert(address.to_owned(), args);
        });
    }
}

/// Gives each message of a datagram of our own to `see`.
pub(super) fn each_message(datagram: &[u8], see: &mut impl FnMut(&str, Vec<OscType>)) {
    if let Ok((_, packet)) = rosc::decoder::decode_udp(datagram) {
        each_of_packet(packet, see);
    }
}

fn each_of_packet(packet: OscPacket, see: &mut impl FnMut(&str, Vec<OscType>)) {
    match packet {
        OscPacket::Message(message) => see(&message.addr, message.args),
        OscPacket::Bundle(bundle) => {
            bundle.content.into_iter().for_each(|packet| each_of_packet(packet, see));
        }
    }
}
