//! Tables in the formats of users, read by the program.

use std::fs;
use std::path::Path;

use super::end_to_end::{said, underfoot};

/// Five rows of one load, in this format.
fn table(header: &str, end: &str, separator: char) -> String {
    let rows = (0..5).map(|step| {
        let fields = [format!("{:.2}", 0.01 * f64::from(step)), "1,1,100,100,100,100".into()].join(",");
        let fields = if separator == ';' { fields.replace(',', ";").replace('.', ",") } else { fields };
        format!("{fields}{end}")
    });
    std::iter::once(format!("{header}{end}")).chain(rows).collect()
}

/// The output of `underfoot sense` for a table, its messages and its exit status.
fn sense(folder: &Path, text: &str) -> (String, String, Option<i32>) {
    let path = folder.join("table.csv");
    fs::write(&path, text).unwrap();
    let output = underfoot().arg("sense").arg(&path).output().unwrap();
    (String::from_utf8_lossy(&output.stdout).into_owned(), said(&output), output.status.code())
}

const HEADER: &str = "t_s,col,row,f_sw,f_se,f_nw,f_ne";

#[test]
fn a_table_says_the_same_however_a_program_has_written_it() {
    let folder = tempfile::tempdir().unwrap();
    let (plain, _, status) = sense(folder.path(), &table(HEADER, "\n", ','));
    assert_eq!((plain.lines().count(), status), (5, Some(0)));
    let quoted = HEADER.split(',').map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(",");
    for text in [
        table(HEADER, "\n", ',') + "\n",
        table(HEADER, "\n\n", ','),
        table(&quoted, "\n", ','),
        table(&HEADER.replace(',', ", "), "\r\n", ','),
        table(HEADER, "\r", ','),
        format!("\u{feff}{}", table(HEADER, "\r\n", ',')),
        table(HEADER, ",,\n", ','),
        table(&format!("# {HEADER}"), "\n", ','),
        table(&HEADER.replace(',', ";"), "\n", ';'),
    ] {
        let (lines, told, status) = sense(folder.path(), &text);
        assert_eq!((lines.as_str(), status), (plain.as_str(), Some(0)), "{text:?}: {told}");
    }
}

#[test]
fn a_bad_line_is_named_and_costs_no_instant_but_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let good = table(HEADER, "\n", ',');
    let (plain, ..) = sense(folder.path(), &good);
    for bad in ["nonsense", "0.025,1,1,100", "0.025,99,1,1,1,1,1", "0.025,1,1,a,1,1,1", "\"0.025,1,1,1,1,1,1"]
    {
        let mut lines: Vec<&str> = good.lines().collect();
        lines.insert(4, bad);
        let (read, told, status) = sense(folder.path(), &lines.join("\n"));
        assert_eq!((read.as_str(), status), (plain.as_str(), Some(1)), "{bad}: {told}");
        assert!(told.contains("1 line was left out") && told.contains("line 5"), "{bad}: {told}");
    }
}

#[test]
fn a_bad_measurement_is_named_and_the_others_calibrate() {
    let folder = tempfile::tempdir().unwrap();
    let measured: String = (1..=20)
        .map(|step| f64::from(step) * 0.2)
        .map(|volts| format!("0,0,sw,{volts},{}\n", 0.5 * (1.34 * volts).exp()))
        .collect();
    let loads = folder.path().join("loads.csv");
    fs::write(&loads, format!("col,row,corner,volts,newtons,by\n\n{measured}0,0,sw,soon,1\n")).unwrap();
    let output = underfoot()
        .current_dir(folder.path())
        .args(["calibrate", "curves", "loads.csv", "--grid", "1x1", "--out", "floor.ron"])
        .output()
        .unwrap();
    let told = said(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("line 23, column volts") && told.contains("columns that are not read: \"by\""),
        "{told}"
    );
    let floor = fs::read_to_string(folder.path().join("floor.ron")).unwrap();
    assert!(floor.contains("corner: Sw"), "{floor}");
}
