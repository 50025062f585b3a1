//! The state of the device that plays the samples.

use std::fmt;

/// The state of the device that drives the actuators.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceStatus {
    /// Its name.
    pub name: String,
    /// The system's identifier for it: the same after unplugging and reconnecting, and from day to day.
    pub id: String,
    /// Whether it plays.
    pub state: DeviceState,
    /// Reason why it does not play, as a sentence for people; empty while it plays.
    pub why: String,
    /// Samples per second.
    pub sample_rate: u32,
    /// Channels in use or kept silent.
    pub channels: u16,
    /// Frames per block as requested by the device; 0 before the first block.
    pub block: u32,
    /// Blocks played so far: increases steadily while the device plays.
    pub blocks: u64,
    /// Number of underruns: samples that came too late for the device.
    pub underruns: u64,
    /// Number of reopenings: after a loss, a hang, or a change to larger blocks.
    pub reopened: u64,
    /// The priority of its thread.
    pub priority: Priority,
}

/// Whether a device plays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceState {
    /// It plays.
    #[default]
    Playing,
    /// It is unplugged or its host is gone; the program searches for it once a second.
    Lost,
    /// It is there but takes no samples; the program reopens it once a second.
    Faulty,
    /// It is there but no longer meets the floor's needs; the program examines it once a second.
    Unfit,
}

impl DeviceState {
    /// Its name in messages to other programs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Playing => "playing",
            Self::Lost => "lost",
            Self::Faulty => "faulty",
            Self::Unfit => "unfit",
        }
    }
}

/// The scheduling priority of the device's thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Priority {
    /// The host controls it, or the thread has not asked for it yet.
    #[default]
    Hosts,
    /// It has real-time priority.
    RealTime,
    /// The system denied it: samples come late when the machine is busy.
    Denied,
}

impl Priority {
    /// Its name in messages to other programs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hosts => "host",
            Self::RealTime => "real-time",
            Self::Denied => "denied",
        }
    }
}

impl DeviceStatus {
    /// Whether this status is worth reporting after `told`: true for every change except more blocks played.
    #[must_use]
    pub(crate) fn is_news_after(&self, told: &Self) -> bool {
        let Self { blocks: _, .. } = self;
        *self != Self { blocks: self.blocks, ..told.clone() }
    }

    /// Whether it plays, at the priority it needs, and no sample ever came late.
    #[must_use]
    pub fn is_well(&self) -> bool {
        self.state == DeviceState::Playing && self.priority != Priority::Denied && self.underruns == 0
    }
}

impl fmt::Display for DeviceStatus {
    /// One line: `Card: playing 36 channels at 96000 Hz in blocks of 64`, followed by any faults.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.name)?;
        match self.state {
            DeviceState::Playing => {
                write!(f, "playing {} channels at {} Hz", self.channels, self.sample_rate)?;
                if self.block > 0 {
                    write!(f, " in blocks of {}", self.block)?;
                }
            }
            state => write!(f, "{}, {}", state.name(), self.why)?,
        }
        if self.underruns > 0 {
            write!(f, ", {} underruns", self.underruns)?;
        }
        if self.reopened > 0 {
            write!(f, ", reopened {} times", self.reopened)?;
        }
        if self.priority == Priority::Denied {
            write!(f, ", without real-time priority")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn going_on_is_no_news_and_everything_else_is() {
        let told = DeviceStatus { name: "Card".into(), blocks: 7, ..DeviceStatus::default() };
        assert!(!DeviceStatus { blocks: 8, ..told.clone() }.is_news_after(&told));
        assert!(DeviceStatus { underruns: 1, ..told.clone() }.is_news_after(&told));
        assert!(DeviceStatus { state: DeviceState::Lost, ..told.clone() }.is_news_after(&told));
    }

    #[test]
    fn one_line_says_what_is_not_well() {
        let mut status = DeviceStatus {
            name: "Card".into(),
            sample_rate: 96_000,
            channels: 36,
            block: 64,
            ..DeviceStatus::default()
        };
        assert_eq!(status.to_string(), "Card: playing 36 channels at 96000 Hz in blocks of 64");
        assert!(status.is_well());
        status.underruns = 3;
        status.state = DeviceState::Lost;
        status.why = "unplugged".into();
        assert_eq!(status.to_string(), "Card: lost, unplugged, 3 underruns");
        assert!(!status.is_well());
    }
}
