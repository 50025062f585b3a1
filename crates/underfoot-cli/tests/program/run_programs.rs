//! Programs that controls start, only where the operator allows it.

use std::path::Path;
use std::time::Duration;

use crate::holds::client::Client;
use crate::holds::site::{Boards, Site};
use crate::targets::until;

/// A floor whose pedal makes the folder `name` by `mkdir`.
fn site(name: &Path) -> Site {
    let text = format!(
        r#"Layout(
    version: 4,
    targets: [(name: "make", to: Run("mkdir"))],
    regions: [(id: "left", at: (0, 0), size: (1, 2)), (id: "right", at: (1, 0), size: (2, 2))],
    widgets: [
        (id: "drive", kind: "dead_man", at: (0, 0), size: (0.9, 0.9), send: [On(pressed, Run("make", [{:?}]))]),
        (id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9), press_n: 60, release_n: 40),
    ],
)"#,
        name.display().to_string()
    );
    let site = Site::new();
    std::fs::write(site.folder().join("page.ron"), text).unwrap();
    site
}

#[test]
fn a_foot_starts_a_program_where_the_operator_allows_it() {
    if !cfg!(feature = "run") {
        println!("not run: the program is built without the feature run");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // A name that a shell would take apart.
    let made = folder.path().join("a foot; $HOME");
    let site = site(&made);
    let run = site.run(&Client::new(), &["--allow-run"]);
    let boards = Boards::start(&site, run.address);
    until("the folder is there", || made.is_dir());
    drop(boards);
}

#[test]
fn no_foot_starts_a_program_without_the_option() {
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("made");
    let site = site(&made);
    let run = site.run(&Client::new(), &[]);
    let boards = Boards::start(&site, run.address);
    std::thread::sleep(Duration::from_millis(2000));
    drop(boards);
    assert!(!made.exists());
    let said = run.end();
    assert!(said.iter().any(|line| line.contains("No program starts for make")), "{said:#?}");
    let told = said.iter().filter(|line| line.contains("target make: ")).count();
    assert_eq!(told, 1, "{said:#?}");
}
