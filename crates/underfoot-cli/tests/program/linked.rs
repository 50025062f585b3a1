//! Visits in links: made of scenarios and of other links, and played without a window.

use serde_json::Value;

use crate::end_to_end::{said, underfoot};

/// The output of the program, which must succeed.
fn printed(arguments: &[&str]) -> String {
    let output = underfoot().args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// The events of controls among JSON lines: time, event and control.
fn events(lines: &str) -> Vec<(f64, String, String)> {
    let lines = lines.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let known = ["pressed", "released", "clicked", "changed"];
    let event = |line: Value| {
        let name = line["event"].as_str().filter(|name| known.contains(name))?.to_owned();
        Some((line["t_s"].as_f64()?, name, line["id"].as_str()?.to_owned()))
    };
    lines.filter_map(event).collect()
}

#[test]
fn the_visit_of_a_link_presses_what_the_scenario_presses_within_some_milliseconds() {
    let link = printed(&["share", "map", "--visit", "session"]);
    let link = link.trim();
    assert!(link.starts_with("#1.") && link.len() < 20_000, "{} letters", link.len());
    let linked = events(&printed(&["session", link, "--json"]));
    let lived = events(&printed(&["session", "map", "--json"]));
    let words = |events: &[(f64, String, String)]| -> Vec<String> {
        let steps = events.iter().filter(|(_, event, _)| event != "changed");
        steps.map(|(_, event, id)| format!("{event} {id}")).collect()
    };
    assert!(words(&lived).contains(&"pressed home".to_owned()), "{lived:?}");
    assert_eq!(words(&linked), words(&lived));
    // A slider changes a little more or less often: the feet of a link are rounded.
    let presses = |events: &[(f64, String, String)]| -> Vec<(f64, String)> {
        let presses = events.iter().filter(|(_, event, _)| event == "pressed");
        presses.map(|(at_s, _, id)| (*at_s, id.clone())).collect()
    };
    for ((one_s, id), (other_s, _)) in presses(&linked).into_iter().zip(presses(&lived)) {
        assert!((one_s - other_s).abs() < 0.03, "{id}: {one_s} {other_s}");
    }
    assert_eq!(printed(&["session", link, "--json"]), printed(&["session", link, "--json"]), "to the letter");
}

#[test]
fn a_visit_goes_from_link_to_link_with_its_floor_and_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("visit.txt");
    let quality = ["--quality", "moderate", "--seed", "9"];
    let first = printed(&[&["share", "first_steps", "--visit", "session"][..], &quality].concat());
    std::fs::write(&file, format!("https://example.org/floor/{first}")).unwrap();
    let visit = file.to_str().unwrap();
    assert_eq!(printed(&["share", "first_steps", "--visit", visit]), first);
    let out = folder.path().join("out");
    let told = printed(&["session", first.trim(), "--rate", "8000", "--out", out.to_str().unwrap()]);
    assert!(told.contains("Played"), "{told}");
    let log = std::fs::read_to_string(out.join("events.jsonl")).unwrap();
    assert_eq!(events(&log), events(&printed(&["session", first.trim(), "--json"])));
    assert!(!events(&log).is_empty() && out.join("floor.png").exists());
}

#[test]
fn what_cannot_be_shared_or_played_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let alone = printed(&["share", "map"]);
    let link = printed(&["share", "map", "--visit", "session"]);
    let scenario = write("a.ron", r#"Scenario(title: "t", steps: [Press(widget: "nothing")])"#);
    let (without, link) = (write("alone.txt", &alone), link.trim());
    let cut = &link[..link.len() - 30];
    for (arguments, why) in [
        (vec!["share", "map", "--visit", &without], "has no visit"),
        (vec!["share", "map", "--visit", &scenario], "nothing"),
        (vec!["share", "map", "--visit", "missing.ron"], "missing.ron"),
        (vec!["session", link, "--scenario", &scenario], "has a visit already"),
        (vec!["session", link, "--grid", "8x4"], "has its own floor"),
        (vec!["session", cut, "--json"], "damaged"),
        (vec!["session", "#1.", "--json"], "damaged"),
    ] {
        let output = underfoot().args(&arguments).output().unwrap();
        assert!(!output.status.success(), "{arguments:?}");
        assert!(said(&output).contains(why), "{arguments:?}: {}", said(&output));
    }
}
