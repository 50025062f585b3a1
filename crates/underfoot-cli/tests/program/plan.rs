//! The program's forecast of the number of computers for a floor.

use serde_json::Value;

use crate::end_to_end::{said, underfoot};

/// Constants of a computer, in round numbers.
const CONSTANTS: &str = r#"{"cores":2,"base_us":20,"packet_us":1,"forward_us":0.5,"wake_us":3,"assemble_tile_us":0.1,"sense_tile_us":0.1,
    "person_us":10,"channel_us":1,"active_channel_us":2,"channels":64,"link_mbit":1000}"#;

fn planned(args: &[&str], floor: Option<&str>) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("machine.json"), CONSTANTS).unwrap();
    if let Some(floor) = floor {
        std::fs::write(folder.path().join("hall.ron"), floor).unwrap();
    }
    let output = underfoot()
        .args(["plan", "--machine", "machine.json"])
        .args(args)
        .current_dir(folder.path())
        .output()
        .unwrap();
    (output.status.success(), said(&output))
}

#[test]
fn a_plan_is_made_of_given_constants() {
    let (is_done, text) = planned(&["--tiles", "6x6", "--people", "2", "--json"], None);
    assert!(is_done, "{text}");
    let line = text.lines().find(|line| line.starts_with('{')).unwrap();
    let plan: Value = serde_json::from_str(line).unwrap();
    assert_eq!(plan["total"]["computers"], 1);
    assert_eq!(plan["total"]["packets_per_s"], 6000.0);
    // 20 + 6 + 36 x 0.2 + 2 x 10 us in a millisecond.
    assert!((plan["total"]["sensing_cores"].as_f64().unwrap() - 0.0532).abs() < 1e-9);
    assert_eq!(plan["first_limit"], "channels");
    assert_eq!(plan["machine"]["person_us"], 10.0);
}

#[test]
fn areas_of_a_floor_file_are_planned_by_name() {
    let hall = r#"Floor(columns: 12, rows: 6, areas: [
        (id: "west", at: (0, 0), size: (4, 6)), (id: "east", at: (4, 0), size: (8, 6))])"#;
    let (is_done, text) = planned(&["--floor", "hall.ron", "--people", "4"], Some(hall));
    assert!(is_done, "{text}");
    for expected in
        ["2 areas, as the floor file names them", "\"east\": 8 x 6 tiles, senses 12 x 6", "48 of 64"]
    {
        assert!(text.contains(expected), "no {expected:?} in\n{text}");
    }
}

#[test]
fn what_is_wrong_is_told() {
    for (args, expected) in [
        (&["--tiles", "6"][..], "columns x rows"),
        (&["--machine", "missing.json"], "missing.json"),
        (&["--tiles", "12x12", "--people", "1000000"], "fewer people"),
    ] {
        let args: Vec<&str> = args.to_vec();
        let (is_done, text) = match args.first() {
            Some(&"--machine") => {
                let output = underfoot().arg("plan").args(&args).output().unwrap();
                (output.status.success(), said(&output))
            }
            _ => planned(&args, None),
        };
        assert!(!is_done && text.contains(expected), "{args:?}: {text}");
    }
}
