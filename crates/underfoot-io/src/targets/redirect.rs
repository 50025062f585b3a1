//! Targets that the command line moves: `desk=10.0.0.5:53000`, `viewer=:1`.

use underfoot::messages::{Destination, MidiTarget, OscTarget, OscTransport, SendTarget};

/// Moves the target called `name` in `targets` to `place`: for OSC a host and a port, after `tcp:` or `udp:` for
/// another protocol; for a keyboard an X display such as `:1`; for MIDI the name of its port.
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
    }
    Ok(())
}
