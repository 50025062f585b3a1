//! `underfoot rack`, and `underfoot run` on the clock that stands in for a card.

use serde_json::Value;

use super::end_to_end::{channels, peak, said, underfoot};

#[test]
fn the_walk_clicks_every_tile_on_its_own_channel_one_after_the_other() {
    let folder = tempfile::tempdir().unwrap();
    let (floor, wav) = (folder.path().join("floor.ron"), folder.path().join("walk.wav"));
    // Three tiles with swapped wires; the one in the middle has no actuator.
    let actuators = "(tile: (0, 0), channel: 2), (tile: (2, 0), channel: 0)";
    std::fs::write(&floor, format!("Floor(version: 1, columns: 3, rows: 1, actuators: [{actuators}])"))
        .unwrap();
    let walk = |more: &[&str]| {
        let mut walk = underfoot();
        walk.args(["rack", "walk", "--pace-ms", "200", "--floor"])
            .arg(&floor)
            .arg("--wav")
            .arg(&wav)
            .args(more);
        walk.output().unwrap()
    };
    let output = walk(&[]);
    assert!(output.status.success(), "{}", said(&output));
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    let walked: Vec<&str> = lines.lines().map(str::trim).collect();
    assert_eq!(walked, ["0.20 s  tile (0, 0)  channel 2", "0.40 s  tile (2, 0)  channel 0"]);
    let (rate, channels) = channels(&wav);
    let begins = |channel: &[f32]| channel.iter().position(|sample| *sample != 0.0);
    // The exact sample of 0.2 s and 0.4 s, or the one after: a sine begins at zero.
    for (channel, seconds) in [(2, 0.2), (0, 0.4)] {
        let due = (seconds * f64::from(rate)) as usize;
        let found = begins(&channels[channel]).unwrap();
        assert!((due..=due + 1).contains(&found), "channel {channel} at {found}, due at {due}");
        assert!(peak(&channels[channel]) > 0.1);
    }
    assert_eq!(peak(&channels[1]), 0.0);

    let output = walk(&["--only", "2,0", "--clicks", "2"]);
    assert_eq!(String::from_utf8_lossy(&output.stdout).matches("tile (2, 0)").count(), 2);
    let output = walk(&["--only", "1,0"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said(&output).contains("tile (1, 0) has no actuator") && said(&output).contains("row   0 |  2  -  0")
    );
}

#[test]
fn the_map_and_the_devices_are_listed() {
    let output = underfoot().args(["rack", "map"]).output().unwrap();
    assert!(said(&output).contains("36 tiles on 36 channels") && said(&output).contains("row   5 | 30 31"));
    let output = underfoot().args(["rack", "map", "--json", "--grid", "2x2"]).output().unwrap();
    let map: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(map[3], serde_json::json!({ "col": 1, "row": 1, "channel": 3 }));
}

#[cfg(feature = "audio")]
#[test]
fn devices_are_listed_with_what_they_can_do() {
    let output = underfoot().args(["rack", "devices", "--json"]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let devices: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    // The clock that stands in for a card is always there, with any cards of the machine.
    let paced = devices.iter().find(|device| device["id"] == "paced").unwrap();
    assert_eq!((paced["channels"].as_u64(), &paced["rates"][0][1]), (Some(1024), &Value::from(192_000)));
}

/// Twenty floors' worth of one step: the stages are there, and their sum is positive; only an idle machine can
/// measure their durations.
#[cfg(feature = "audio")]
#[test]
fn the_latency_of_clicks_on_a_paced_device_is_told_stage_by_stage() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("latency.csv");
    let address = format!("127.0.0.1:{}", crate::ports::free_port());
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../benches/latency/layout.ron");
    let scenario = concat!(env!("CARGO_MANIFEST_DIR"), "/../../benches/latency/scenario.ron");
    let mut simulated = underfoot()
        .args([
            "simulate",
            layout,
            "--quality",
            "paper",
            "--scenario",
            scenario,
            "--send",
            &address,
            "--seconds",
            "9",
        ])
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let run = underfoot()
        .args(["run", layout, "--listen", &address, "--no-osc", "--json", "--device", "paced", "--latency"])
        .arg("--latency-csv")
        .arg(&table)
        .args(["--seconds", "8"])
        .output()
        .unwrap();
    let _ = simulated.wait();
    assert!(run.status.success(), "{}", said(&run));
    let said = said(&run);
    for stage in ["link", "engine", "audio", "whole", "sounding"] {
        assert!(said.lines().any(|line| line.starts_with(stage)), "{stage} is missing: {said}");
    }
    let device = said.lines().find(|line| line.contains("\"event\":\"device\"")).unwrap();
    let device: Value = serde_json::from_str(device).unwrap();
    assert_eq!((&device["device"], &device["sample_rate"]), (&Value::from("paced"), &Value::from(96_000)));
    let table = std::fs::read_to_string(&table).unwrap();
    assert!(table.starts_with("stage,from_us,to_us,count\nlink,"), "{table}");
}
