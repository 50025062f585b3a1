//! Targets that the command line moves: `desk=10.0.0.5:53000`, `viewer=:1`.

use underfoot::messages::{
    ArtNetTarget, Destination, MidiTarget, OscTarget, OscTransport, SacnTarget, SendTarget,
};

/// Moves the target called `name` in `targets` to `place`: for OSC a host and a port, after `tcp:` or `udp:` for
/// another protocol; for a keyboard an X display such as `:1`; for MIDI the name of its port; for Art-Net and sACN the
/// address of a receiver; for MQTT a host and a port; for a program its path.
///
/// # Errors
/// Says that there is no such target, or that the place does not suit it.
pub fn redirect(targets: &mut [SendTarget], name: &str, place: &str) -> Result<(), String> {
    let names: Vec<String> = targets.iter().map(|target| target.name.clone()).collect();
    let Some(target) = targets.iter_mut().find(|target| target.name == name) else {
        return Err(match names.is_empty() {
            true => format!("the layout has no target {name:?}; it has none at all"),
            false => format!("the layout has no target {name:?}; it has {}", names.join(", ")),
        });
    };
    match &mut target.to {
        Destination::Keyboard(keyboard) => {
            let number = place.rsplit_once(':').map(|(_, number)| number);
            if !number.is_some_and(|number| number.starts_with(|c: char| c.is_ascii_digit())) {
                return Err(format!("{name} is a keyboard: write an X display, such as {name}=:1"));
            }
            keyboard.display = Some(place.to_owned());
        }
        Destination::Osc(osc) => {
            let (over, address) = match place.split_once(':') {
                Some(("tcp", address)) => (OscTransport::Tcp, address),
                Some(("udp", address)) => (OscTransport::Udp, address),
                _ => (osc.over, place),
            };
            if !OscTarget::is_address(address) {
                return Err(format!("{name} receives OSC: write {name}=127.0.0.1:53000"));
            }
            (osc.address, osc.over) = (address.to_owned(), over);
        }
        Destination::Midi(midi) => {
            if !MidiTarget::is_port(place) {
                return Err(format!("{name} is a MIDI port: write its name, such as {name}=stage"));
            }
            place.clone_into(&mut midi.port);
        }
        Destination::ArtNet(art_net) => {
            if !ArtNetTarget::is_address(place) {
                return Err(format!(
                    "{name} is a node of Art-Net: write its address, such as {name}=10.0.0.20"
                ));
            }
            place.clone_into(&mut art_net.address);
        }
        Destination::Sacn(sacn) => {
            if !SacnTarget::is_address(place) {
                return Err(format!(
                    "{name} is a universe of sACN: write an address, such as {name}=10.0.0.20"
                ));
            }
            sacn.to = Some(place.to_owned());
        }
        Destination::Mqtt(mqtt) => {
            if !OscTarget::is_address(place) {
                return Err(format!("{name} is a broker of MQTT: write {name}=127.0.0.1:1883"));
            }
            place.clone_into(&mut mqtt.address);
        }
        Destination::Run(run) => {
            if place.trim().is_empty() {
                return Err(format!("{name} is a program: write {name}=/usr/bin/notify-send"));
            }
            place.clone_into(&mut run.program);
        }
    }
    Ok(())
}
