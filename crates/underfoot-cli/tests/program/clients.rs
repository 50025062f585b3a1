//! Independent programs read our output and drive controls: python-osc and python-tuio, if they are installed.

use std::process::Command;

/// Exit status of a script without a library.
const NOT_RUN: i32 = 77;

/// Runs a script of this folder on the program, with further arguments; prints why it does not run where Python or a
/// library is missing.
///
/// # Panics
///
/// If the script fails.
pub(crate) fn try_script(name: &str, arguments: &[&str]) {
    let script = format!("{}/tests/program/{name}", env!("CARGO_MANIFEST_DIR"));
    let command = [script.as_str(), env!("CARGO_BIN_EXE_underfoot")];
    let Ok(output) = Command::new("python3").args(command).args(arguments).output() else {
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

/// `./dev test` prints beforehand whether this test will run: `pip install python-osc python-tuio`.
#[test]
fn python_clients_understand_everything_and_see_everybody_leave() {
    try_script("clients.py", &[concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron")]);
}
