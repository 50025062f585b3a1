//! How the device that plays the samples is doing.

use std::fmt;

/// How the device that moves the actuators is doing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceStatus {
    /// Its name.
    pub name: String,
    /// What the system knows it by: stays the same when it is unplugged and comes back, and from day to day.
    pub id: String,
    /// Whether it plays.
    pub state: DeviceState,
    /// Why it does not play, for a person; empty while it plays.
    pub why: String,
    /// Samples per second.
    pub sample_rate: u32,
    /// Channels in use or kept silent.
    pub channels: u16,
    /// Frames in a block as the device asks for them; 0 before the first.
    pub block: u32,
    /// Blocks played so far: while it plays, this never stands still for long.
    pub blocks: u64,
    /// Times when samples came too late for the device.
    pub underruns: u64,
    /// Times it was opened anew: after it was lost, hung, or needed larger blocks.
    pub reopened: u64,
    /// Whether its thread goes before everybody else's.
    pub priority: Priority,
}

/// Whether a device plays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceState {
    /// It plays.
    #[default]
    Playing,
    /// It is unplugged or its host has gone; it is searched for once a second.
    Lost,
    /// It is there and takes no samples; it is opened anew once a second.
    Faulty,
    /// It is there and can no longer do what the floor needs; it is examined once a second.
    Unfit,
}

impl DeviceState {
    /// The word for it in messages to other programs.
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

/// Whether the device's thread goes before everybody else's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Priority {
    /// The host sees to it, or it was not asked for yet.
    #[default]
    Hosts,
    /// It has real-time priority.
    RealTime,
    /// The system did not allow it: samples come late when the machine is busy.
    Denied,
}

impl Priority {
    /// The word for it in messages to other programs.
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
    /// Whether others should be told of this after `told`: anything but that it has gone on playing.
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
    /// One line: `Card: playing 36 channels at 96000 Hz in blocks of 64`, and what is not well.
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
