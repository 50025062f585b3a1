//! Serial ports of this machine, by the names of files and of the command line.

use std::path::Path;

use serialport::{SerialPortType, available_ports};
use underfoot::floor::PortName;

/// A port of this machine.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Listed {
    system: String,
    /// The serial number of its USB device.
    usb: Option<String>,
}

/// Where Linux lists ports; the list cannot be read without it.
const LINUX: &str = "/sys/class/tty";

/// Returns the ports of this machine by name; none if the system does not list them.
fn listed() -> Vec<Listed> {
    if cfg!(target_os = "linux") && !Path::new(LINUX).is_dir() {
        return Vec::new();
    }
    let ports = available_ports().unwrap_or_else(|error| {
        tracing::debug!("the system does not list its serial ports: {error}");
        Vec::new()
    });
    let mut ports: Vec<Listed> = ports
        .into_iter()
        .map(|port| Listed {
            system: port.port_name,
            usb: match port.port_type {
                SerialPortType::UsbPort(device) => device.serial_number,
                _ => None,
            },
        })
        .collect();
    ports.sort();
    ports
}

/// Returns the USB serial ports of this machine, by the serial numbers of their devices where these differ; none if the
/// system does not list them. Machines list sockets on the board that nothing is behind; only USB ports were plugged in.
#[must_use]
pub fn plugged_ports() -> Vec<PortName> {
    plugged_in(&listed())
}

fn plugged_in(listed: &[Listed]) -> Vec<PortName> {
    let usb: Vec<&Listed> = listed.iter().filter(|one| one.usb.is_some()).collect();
    let is_alone = |one: &Listed| usb.iter().filter(|other| other.usb == one.usb).count() == 1;
    let name = |one: &&Listed| match &one.usb {
        Some(number) if is_alone(one) => format!("usb:{number}").parse().ok(),
        _ => one.system.parse().ok(),
    };
    usb.iter().filter_map(name).collect()
}

/// Returns the system's name of `port`; `None` if this machine does not have it.
pub(super) fn find(port: &PortName) -> Option<String> {
    match port {
        // Links and ports that the system does not list, as those of emulators, are files on unix.
        PortName::System(name) if cfg!(unix) => Path::new(name).exists().then(|| name.clone()),
        PortName::System(_) | PortName::Usb(_) => find_in(port, &listed()),
    }
}

/// A device with several ports has one number: the first is used.
fn find_in(port: &PortName, listed: &[Listed]) -> Option<String> {
    let is_it = |one: &&Listed| match port {
        PortName::System(name) => one.system == *name,
        PortName::Usb(number) => one.usb.as_deref() == Some(number),
    };
    listed.iter().find(is_it).map(|one| one.system.clone())
}

/// Returns what to do about `port` if this machine does not have it; `None` if it does.
#[must_use]
pub fn absent(port: &PortName) -> Option<String> {
    find(port).is_none().then(|| remedy(&listed()))
}

fn remedy(listed: &[Listed]) -> String {
    let plugged: Vec<String> = listed
        .iter()
        .filter_map(|one| one.usb.as_ref().map(|number| format!("{} (usb:{number})", one.system)))
        .collect();
    match &plugged[..] {
        [] => "no USB serial port is plugged in; --await-ports waits for one".to_owned(),
        ports => format!("there are {}; --await-ports waits for others", ports.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn desk() -> Vec<Listed> {
        [("/dev/ttyACM0", Some("E6614")), ("/dev/ttyACM1", Some("E6614")), ("/dev/ttyS0", None)]
            .map(|(system, usb)| Listed { system: system.to_owned(), usb: usb.map(str::to_owned) })
            .into()
    }

    #[test]
    fn a_board_is_found_by_its_number_in_any_socket() {
        let find = |name: &str| find_in(&name.parse().unwrap(), &desk());
        assert_eq!(find("usb:E6614").as_deref(), Some("/dev/ttyACM0"));
        assert_eq!(find("/dev/ttyS0").as_deref(), Some("/dev/ttyS0"));
        assert_eq!((find("usb:E66"), find("/dev/ttyACM7")), (None, None));
    }

    #[test]
    fn plugged_ports_have_the_numbers_of_their_devices_if_these_differ() {
        let names =
            |listed: &[Listed]| plugged_in(listed).iter().map(ToString::to_string).collect::<Vec<_>>();
        assert_eq!(names(&desk()), ["/dev/ttyACM0", "/dev/ttyACM1"]);
        assert_eq!(names(&desk()[1..]), ["usb:E6614"]);
    }

    #[test]
    fn a_missing_port_is_answered_with_those_that_are_there() {
        let told = remedy(&desk());
        assert!(told.contains("/dev/ttyACM1 (usb:E6614)") && !told.contains("ttyS0"), "{told}");
        assert!(remedy(&[]).contains("no USB serial port"));
        assert!(absent(&PortName::System("/nowhere/ttyACM0".into())).is_some());
    }
}
