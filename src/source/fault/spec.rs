//! The text form of faults, for command lines and scenarios.

use std::str::FromStr;
use std::time::Duration;

use thiserror::Error;

use super::{Bursts, LinkFaults, Outage, Stall};
use crate::units::Instant;

/// The error for a text that is not a fault: the text, the reason, and the correct forms.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "`{written}` is not a fault ({why}): write loss=5%, duplicate=10%, delay=10%:20ms, damage=1%, bursts=1s:50ms, \
     silent=10s..12s, board=3:10s..12s, frozen=3:10s..12s, stall=10s..10.2s, swapped=0:1, panic=20s or nemesis=SEED:60s:BOARDS"
)]
pub struct BadFault {
    written: String,
    why: &'static str,
}

/// Maximum time in a fault: a day.
const LONGEST_S: f64 = 86_400.0;

impl FromStr for LinkFaults {
    type Err = BadFault;

    /// Parses one fault:
    ///
    /// | text | fault |
    /// |---|---|
    /// | `loss=5%` | packets are lost independently |
    /// | `duplicate=10%` | packets arrive twice |
    /// | `delay=10%:20ms` | packets are delayed by up to this time |
    /// | `damage=1%` | packets have one damaged number |
    /// | `bursts=1s:50ms` | in every second all packets of 50 ms are lost |
    /// | `silent=10s..12s` | the whole floor is unplugged |
    /// | `board=3:10s..12s` | board 3 is unplugged |
    /// | `frozen=3:10s..12s` | board 3 sends the same readings over and over |
    /// | `stall=10s..10.2s` | packets are held back and arrive all at once |
    /// | `panic=20s` | the thread that receives the packets panics |
    /// | `swapped=0:1` | two boards use each other's address |
    /// | `nemesis=7:60s:6` | most of these, chosen by seed 7, for a minute, on a floor of six boards |
    ///
    /// Times are on the source's clock, 0 at its start. Use [`LinkFaults::and`] to combine several.
    fn from_str(text: &str) -> Result<Self, BadFault> {
        let bad = |why| BadFault { written: text.escape_debug().to_string(), why };
        let (name, value) = text.split_once('=').ok_or_else(|| bad("it has no `=`"))?;
        let mut faults = Self::default();
        match name {
            "loss" => faults.loss = share(value).map_err(bad)?,
            "duplicate" => faults.duplicate = share(value).map_err(bad)?,
            "damage" => faults.damage = share(value).map_err(bad)?,
            "delay" => {
                let (part, most) = pair(value).map_err(bad)?;
                (faults.delay, faults.delay_up_to) = (share(part).map_err(bad)?, span(most).map_err(bad)?);
            }
            "bursts" => {
                let (every, length) = pair(value).map_err(bad)?;
                let bursts = Bursts { every: span(every).map_err(bad)?, length: span(length).map_err(bad)? };
                if bursts.length >= bursts.every {
                    return Err(bad("a burst must be shorter than the time from one to the next"));
                }
                faults.bursts = Some(bursts);
            }
            "silent" => faults.outages.push(outage(None, value).map_err(bad)?),
            "board" => faults.outages.push(of_board(value).map_err(bad)?),
            "frozen" => faults.frozen.push(of_board(value).map_err(bad)?),
            "stall" => {
                let Outage { from, until, .. } = outage(None, value).map_err(bad)?;
                faults.stalls.push(Stall { from, until });
            }
            "panic" => faults.panic_at = Some(Instant::START + span(value).map_err(bad)?),
            "swapped" => {
                let (one, other) = pair(value).map_err(bad)?;
                let (one, other) = (number(one).map_err(bad)?, number(other).map_err(bad)?);
                if one == other {
                    return Err(bad("a board cannot be swapped with itself"));
                }
                faults.swapped.push((one, other));
            }
            "nemesis" => {
                let (seed, rest) = pair(value).map_err(bad)?;
                let (length, boards) = pair(rest).map_err(bad)?;
                let seed = seed.parse().map_err(|_| bad("a seed is a whole number"))?;
                faults = Self::nemesis(seed, span(length).map_err(bad)?, number(boards).map_err(bad)?);
            }
            _ => return Err(bad("there is no such fault")),
        }
        Ok(faults)
    }
}

impl LinkFaults {
    /// Combines two sets of faults: the greater of each share and delay; bursts and panic of `other` replace those of
    /// `self`.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.loss = self.loss.max(other.loss);
        self.duplicate = self.duplicate.max(other.duplicate);
        self.damage = self.damage.max(other.damage);
        self.delay = self.delay.max(other.delay);
        self.delay_up_to = self.delay_up_to.max(other.delay_up_to);
        self.bursts = other.bursts.or(self.bursts);
        self.panic_at = other.panic_at.or(self.panic_at);
        self.outages.extend(other.outages);
        self.frozen.extend(other.frozen);
        self.stalls.extend(other.stalls);
        self.swapped.extend(other.swapped);
        self
    }
}

fn pair(text: &str) -> Result<(&str, &str), &'static str> {
    text.split_once(':').ok_or("a `:` is missing")
}

fn number(text: &str) -> Result<u16, &'static str> {
    text.parse().map_err(|_| "boards are numbered from 0")
}

/// Parses `5%` or `0.05`; 0 to 1.
fn share(text: &str) -> Result<f64, &'static str> {
    let (digits, unit) = text.strip_suffix('%').map_or((text, 1.0), |digits| (digits, 0.01));
    let share = digits.parse::<f64>().map_err(|_| "a share is written 5% or 0.05")? * unit;
    if (0.0..=1.0).contains(&share) { Ok(share) } else { Err("a share lies between 0 and 100 %") }
}

/// Parses `20ms`, `1.5s` or `1.5` (seconds); up to a day.
fn span(text: &str) -> Result<Duration, &'static str> {
    let (digits, unit) = match (text.strip_suffix("ms"), text.strip_suffix('s')) {
        (Some(digits), _) => (digits, 1e-3),
        (None, Some(digits)) => (digits, 1.0),
        (None, None) => (text, 1.0),
    };
    let seconds = digits.parse::<f64>().map_err(|_| "a time is written 20ms or 1.5s")? * unit;
    if (0.0..=LONGEST_S).contains(&seconds) {
        Ok(Duration::from_secs_f64(seconds))
    } else {
        Err("a time lies between 0 and a day")
    }
}

/// Parses `10s..12s`.
fn outage(board: Option<u16>, text: &str) -> Result<Outage, &'static str> {
    let (from, until) = text.split_once("..").ok_or("a stretch of time is written 10s..12s")?;
    let (from, until) = (Instant::START + span(from)?, Instant::START + span(until)?);
    if from < until { Ok(Outage { board, from, until }) } else { Err("it ends before it begins") }
}

/// Parses `3:10s..12s`.
fn of_board(text: &str) -> Result<Outage, &'static str> {
    let (board, when) = pair(text)?;
    outage(Some(number(board)?), when)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_can_be_written() {
        let read = |text: &str| text.parse::<LinkFaults>().unwrap();
        let at = |ms| Instant::from_millis(ms);
        assert_eq!(read("loss=5%"), LinkFaults { loss: 0.05, ..LinkFaults::default() });
        assert_eq!(read("loss=0.05"), read("loss=5%"));
        let delayed =
            LinkFaults { delay: 0.1, delay_up_to: Duration::from_millis(20), ..LinkFaults::default() };
        assert_eq!(read("delay=10%:20ms"), delayed);
        let lost = Outage { board: Some(3), from: at(10_000), until: at(12_500) };
        assert_eq!(read("board=3:10s..12.5s").outages, [lost]);
        assert_eq!(read("frozen=3:10..12.5").frozen, [lost]);
        assert_eq!(read("silent=10s..12500ms").outages, [Outage { board: None, ..lost }]);
        assert_eq!(read("stall=1s..1.2s").stalls, [Stall { from: at(1000), until: at(1200) }]);
        assert_eq!(read("panic=20s").panic_at, Some(at(20_000)));
        assert_eq!(read("swapped=0:1").swapped, [(0, 1)]);
        let both = read("loss=5%").and(read("loss=1%")).and(read("swapped=2:3")).and(read("bursts=1s:50ms"));
        assert_eq!((both.loss, both.swapped.len(), both.bursts.is_some()), (0.05, 1, true));
    }

    #[test]
    fn what_is_no_fault_is_told_with_all_that_are() {
        for text in [
            "",
            "loss",
            "loss=",
            "loss=nan",
            "loss=101%",
            "loss=-1",
            "silent=12s..10s",
            "silent=1s..inf",
            "board=1s..2s",
            "board=-1:1s..2s",
            "swapped=1:1",
            "bursts=50ms:1s",
            "fire=1",
            "nemesis=1",
            "delay=1e400:1s",
            "stall=1s..1e300s",
            "loss=5%\u{1b}[2J",
        ] {
            let error = text.parse::<LinkFaults>().unwrap_err().to_string();
            assert!(error.contains("write loss=5%") && !error.contains('\u{1b}'), "{text}: {error}");
        }
    }
}
