//! The latency tables of `underfoot run`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use underfoot::sink::{LatencyMeter, LatencyStages};

use super::failure::Failure;

/// Options for reports of the latency.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct LatencyArgs {
    /// Print at the end the latency from each packet to its click, stage by stage.
    #[arg(long)]
    latency: bool,
    /// Write the same as a table: stage, from and to in microseconds, number of clicks.
    #[arg(long, value_name = "FILE.csv")]
    latency_csv: Option<PathBuf>,
}

impl LatencyArgs {
    /// Prints the latencies in `stages`; on standard error if standard output has JSON.
    pub(crate) fn tell(&self, stages: &LatencyStages, is_json: bool) -> Result<(), Failure> {
        match stages.whole.summary() {
            None => errln!("No cue was played."),
            Some(_) if self.latency && is_json => errln!("{}", report(stages)),
            Some(_) if self.latency => outln!("{}", report(stages)),
            Some(summary) => errln!("From packet to first sample handed on: {summary}."),
        }
        match &self.latency_csv {
            Some(path) => write_csv(stages, path),
            None => Ok(()),
        }
    }
}

/// Name, description and meter of each stage.
fn named(stages: &LatencyStages) -> [(&'static str, &'static str, &LatencyMeter); 5] {
    [
        ("link", "from the packet's arrival until it is taken", &stages.link),
        ("engine", "from there until its cue is sent", &stages.engine),
        ("audio", "from there until the callback has handed on its first sample", &stages.audio),
        ("whole", "from the packet to the callback", &stages.whole),
        ("sounding", "from the packet until that sample sounds, by the device's account", &stages.sounding),
    ]
}

fn ms(span: Duration) -> f64 {
    span.as_secs_f64() * 1e3
}

fn report(stages: &LatencyStages) -> String {
    let count = stages.whole.summary().map_or(0, |summary| summary.count);
    let mut text = format!("From packet to click, {count} cues, in milliseconds:\n\n");
    text += "            median     95 %     99 %  longest   5-95 %\n";
    for (name, _, meter) in named(stages) {
        let Some(summary) = meter.summary() else { continue };
        let spread = summary.p95.saturating_sub(summary.p5);
        let figures = [summary.median, summary.p95, summary.p99, summary.max, spread];
        // Writing to a string never fails.
        let _ = write!(text, "{name:<10}");
        for figure in figures {
            let _ = write!(text, " {:>8.3}", ms(figure));
        }
        text.push('\n');
    }
    for (name, what, meter) in named(stages) {
        if let Some(histogram) = histogram(meter) {
            let _ = write!(text, "\n{name}: {what}\n{histogram}");
        }
    }
    text
}

/// Number of rows of a histogram up to the 99th percentile; one more holds longer latencies.
const ROWS: u64 = 14;

/// Width of the longest bar, in characters.
const BAR: u64 = 50;

/// The distribution as text, a row per range of equal width; `None` without data.
fn histogram(meter: &LatencyMeter) -> Option<String> {
    let summary = meter.summary()?;
    let from = summary.p5.as_micros() as u64;
    let to = summary.p99.as_micros() as u64 + 1;
    let step = step(to.saturating_sub(from).div_ceil(ROWS));
    let first = from / step;
    let rows = (to / step - first + 1) as usize;
    let mut counts = vec![0_u64; rows + 2];
    for bucket in meter.buckets() {
        let row = (bucket.from.as_micros() as u64 / step + 1).saturating_sub(first);
        counts[(row as usize).min(rows + 1)] += bucket.count;
    }
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut text = String::new();
    for (row, count) in counts.iter().copied().enumerate() {
        let edge = |row: u64| (first + row) as f64 * step as f64 * 1e-3;
        let range = match row {
            0 => format!("under {:7.3}", edge(0)),
            row if row == rows + 1 => format!(" over {:7.3}", edge(rows as u64)),
            row => format!("from  {:7.3}", edge(row as u64 - 1)),
        };
        if (row == 0 || row == rows + 1) && count == 0 {
            continue;
        }
        let bar = "#".repeat((count * BAR).div_ceil(most) as usize);
        // Writing to a string never fails.
        let _ = writeln!(text, "  {range} | {bar} {count}");
    }
    Some(text)
}

/// The least of 1, 2, 5, 10, 20, ... microseconds that is not less than `least`.
fn step(least: u64) -> u64 {
    let mut unit = 1;
    loop {
        if let Some(step) = [1, 2, 5].map(|digit| digit * unit).into_iter().find(|step| *step >= least) {
            return step;
        }
        unit *= 10;
    }
}

fn write_csv(stages: &LatencyStages, path: &Path) -> Result<(), Failure> {
    let mut table = String::from("stage,from_us,to_us,count\n");
    for (name, _, meter) in named(stages) {
        for bucket in meter.buckets() {
            let (from, to) = (bucket.from.as_micros(), bucket.to.as_micros());
            // Writing to a string never fails.
            let _ = writeln!(table, "{name},{from},{to},{}", bucket.count);
        }
    }
    std::fs::write(path, table).map_err(|error| Failure::File(path.to_owned(), error))?;
    errln!("Latencies written to {}.", path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cue_is_in_a_row_of_the_histogram() {
        let meter = LatencyMeter::new();
        assert_eq!(histogram(&meter), None);
        (0..1000).for_each(|n| meter.record(Duration::from_micros(100 + n % 300)));
        [Duration::from_micros(10), Duration::from_secs(2)].into_iter().for_each(|rare| meter.record(rare));
        let text = histogram(&meter).unwrap();
        let sum: u64 = text.lines().filter_map(|line| line.rsplit(' ').next()?.parse::<u64>().ok()).sum();
        assert_eq!(sum, 1002, "{text}");
        // A step of 1, 2 or 5 leaves between two fifths and all of the rows; two more are for outliers.
        assert!((ROWS as usize * 2 / 5 + 2..=ROWS as usize + 3).contains(&text.lines().count()), "{text}");
        assert!(text.lines().next().unwrap().contains("under") && text.contains(" over "), "{text}");
    }

    #[test]
    fn steps_are_round() {
        assert_eq!([0, 1, 2, 3, 5, 6, 17, 21, 100, 101].map(step), [1, 1, 2, 5, 5, 10, 20, 50, 100, 200]);
    }

    #[test]
    fn the_table_names_every_stage_that_was_measured() {
        let stages = LatencyStages::default();
        for (_, _, meter) in &named(&stages)[..4] {
            meter.record(Duration::from_micros(120));
        }
        let text = report(&stages);
        assert!(text.contains("whole") && !text.contains("sounding"), "{text}");
        assert!(text.contains("link          0.120    0.120    0.120    0.120    0.000"), "{text}");
    }
}
