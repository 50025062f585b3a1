//! The steps of the set-up, in their usual order.

/// A step. Each can be repeated and left at any time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetupStep {
    /// Boards are found.
    Boards,
    /// The shape of the floor is chosen, and its file is written.
    Shape,
    /// Boards that are swapped are found by steps on tiles.
    Wiring,
    /// Readings, noise and range of the sensors; the tare.
    Readings,
    /// A person on marks gives the laws of the sensors.
    Standing,
    /// A first layout is opened.
    Layout,
}

impl SetupStep {
    /// All steps.
    pub const ALL: [Self; 6] =
        [Self::Boards, Self::Shape, Self::Wiring, Self::Readings, Self::Standing, Self::Layout];

    /// Returns its position in [`SetupStep::ALL`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns its name in the window.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Boards => "Find boards",
            Self::Shape => "Choose the shape",
            Self::Wiring => "Check the wiring",
            Self::Readings => "Look at the readings",
            Self::Standing => "Calibrate by standing",
            Self::Layout => "Press a button",
        }
    }

    /// Returns the step after it; `None` after the last one.
    #[must_use]
    pub fn next(self) -> Option<Self> {
        Self::ALL.get(self.index() + 1).copied()
    }

    /// Whether it works on a floor file.
    #[must_use]
    pub const fn needs_floor(self) -> bool {
        !matches!(self, Self::Boards | Self::Shape)
    }
}
