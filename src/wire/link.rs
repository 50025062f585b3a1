//! Whether sensor packets arrive.

/// Whether sensor packets arrive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinkState {
    /// No packet has come yet.
    #[default]
    Waiting,
    /// Packets arrive from every board.
    Live,
    /// Packets arrive, but not from every board.
    Partial,
    /// Nothing has come for 100 ms or more; every control is released.
    Lost,
}

impl LinkState {
    /// The word for it in OSC and JSON.
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
