//! State of the link: the arrival of sensor packets.

/// State of the link: the arrival of sensor packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinkState {
    /// No packet has come yet.
    #[default]
    Waiting,
    /// Packets arrive from every board.
    Live,
    /// Packets arrive, but not from every board.
    Partial,
    /// No packet for 100 ms or more; every control is released.
    Lost,
}

impl LinkState {
    /// Returns its name in OSC and JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Live => "live",
            Self::Partial => "partial",
            Self::Lost => "lost",
        }
    }
}
