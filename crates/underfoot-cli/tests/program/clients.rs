//! Independent programs read our output and drive controls: python-osc and python-tuio, if they are installed.

use std::process::Command;

/// Exit status of the script without a library.
const NOT_RUN: i32 = 77;

/// `./dev test` prints beforehand whether this test will run: `pip install python-osc python-tuio`.
#[test]
fn python_clients_understand_everything_and_see_everybody_leave() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/clients.py");
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
    let Ok(output) = Command::new("python3").args([script, env!("CARGO_BIN_EXE_underfoot"), layout]).output()
    else {
        println!("not run: there is no python3");
        return;
    };
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(NOT_RUN) {
        println!("{said}");
        return;
    }
    assert!(output.status.success(), "{said}");
}
