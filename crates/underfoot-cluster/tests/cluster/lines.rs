//! Lines of JSON that a program prints, each with the time of its arrival.

use std::io::{BufRead, BufReader, Read, Write};
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

/// One line.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) came: Instant,
    pub(crate) json: Value,
}

impl Line {
    /// The time in the line, in seconds.
    pub(crate) fn t_s(&self) -> f64 {
        self.json["t_s"].as_f64().unwrap_or(f64::NAN)
    }

    /// The control and its event.
    pub(crate) fn done(&self) -> Option<(String, String)> {
        let text = |name: &str| self.json[name].as_str().map(str::to_owned);
        // States and ignored feet are not events.
        Some((text("id")?, text("event").filter(|event| event != "state" && event != "ignored")?))
    }

    pub(crate) fn area(&self) -> Option<(&str, &str)> {
        (self.json["event"] == "area")
            .then(|| Some((self.json["area"].as_str()?, self.json["state"].as_str()?)))?
    }

    pub(crate) fn contacts(&self) -> Option<Vec<(u64, f64, f64)>> {
        let contacts = self.json["contacts"].as_array()?;
        let number = |one: &Value, name: &str| one[name].as_f64().unwrap_or(f64::NAN);
        let contact = |one: &Value| (one["id"].as_u64().unwrap_or(0), number(one, "x_m"), number(one, "y_m"));
        Some(contacts.iter().map(contact).collect())
    }
}

/// All lines so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines(Arc<(Mutex<Vec<Line>>, Condvar)>);

impl Lines {
    /// Reads `out` until it ends.
    pub(crate) fn of(out: impl Read + Send + 'static) -> Self {
        let lines = Self::default();
        let told = lines.clone();
        thread::spawn(move || {
            for line in BufReader::new(out).lines().map_while(Result::ok) {
                told.take(&line);
            }
        });
        lines
    }

    fn take(&self, line: &str) {
        let came = Instant::now();
        let json = serde_json::from_str(line).unwrap();
        self.0.0.lock().unwrap().push(Line { came, json });
        self.0.1.notify_all();
    }

    pub(crate) fn all(&self) -> Vec<Line> {
        self.0.0.lock().unwrap().clone()
    }

    pub(crate) fn len(&self) -> usize {
        self.0.0.lock().unwrap().len()
    }

    /// The first line from number `from` on for which `wanted` holds, after waiting for it.
    pub(crate) fn find(&self, from: usize, what: &str, wanted: impl Fn(&Line) -> bool) -> Line {
        let end = Instant::now() + Duration::from_secs(30);
        let mut next = from;
        let mut lines = self.0.0.lock().unwrap();
        loop {
            if let Some(line) = lines.iter().skip(next).find(|line| wanted(line)) {
                return line.clone();
            }
            next = lines.len();
            let left = end.saturating_duration_since(Instant::now());
            assert!(!left.is_zero(), "no line says {what}; the last is {:?}", lines.last());
            lines = self.0.1.wait_timeout(lines, left).unwrap().0;
        }
    }
}

/// Takes whole lines, as from a program.
impl Write for Lines {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        std::str::from_utf8(bytes).unwrap().lines().for_each(|line| self.take(line));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
