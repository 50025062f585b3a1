//! The commands of the units for systemd: gateway and node notify their manager when they are ready.
#![cfg(unix)]

use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::ports::free_port;
use crate::unit_files::Unit;

/// A program that ends with the test in any case.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs the command of a unit; returns its first notification.
fn first_sign(unit: &str, site: &Path) -> String {
    let notify = site.join(unit);
    let manager = UnixDatagram::bind(&notify).unwrap();
    manager.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    let command = Unit::named(unit).command(site, "west", &[]);
    assert_eq!(command[0], "underfoot-cluster");
    let _program = Command::new(env!("CARGO_BIN_EXE_underfoot-cluster"))
        .args(&command[1..])
        .env("NOTIFY_SOCKET", &notify)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map(Ended)
        .unwrap();
    let mut sign = [0; 64];
    let length = manager.recv(&mut sign).unwrap();
    String::from_utf8_lossy(&sign[..length]).into_owned()
}

#[test]
fn gateway_and_node_of_the_units_are_ready() {
    let site = tempfile::tempdir().unwrap();
    let files = site.path().join("underfoot");
    std::fs::create_dir(&files).unwrap();
    let (boards, gateway) = (free_port(), free_port());
    let floor = format!(
        "Floor(version: 1, columns: 2, rows: 2, gateway: \"127.0.0.1:{gateway}\", areas: [(id: \"west\", at: (0, 0), \
         size: (2, 2), listen: \"127.0.0.1:{boards}\")])"
    );
    std::fs::write(files.join("floor.ron"), floor).unwrap();
    let page = "Layout(version: 1, regions: [(id: \"all\", at: (0, 0), size: (2, 2))], \
                widgets: [(id: \"it\", kind: \"button\", at: (0, 0), size: (1, 1))])";
    std::fs::write(files.join("layout.ron"), page).unwrap();
    for unit in ["underfoot-gateway.service", "underfoot-node@.service"] {
        assert_eq!(first_sign(unit, site.path()), "READY=1", "{unit}");
    }
}
