//! The status light.

use embedded_hal::digital::OutputPin;

/// The state that the light shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    /// The sector of the identity holds something else, so that nothing is sent: eight flashes a second.
    NoIdentity,
    /// A converter does not answer: four flashes a second.
    NoConverter,
    /// No computer has set up the USB device: a short flash each second.
    NoComputer,
    /// No program reads the port: a flash each second.
    NoReader,
    /// All packets leave: steady light.
    Sending,
}

impl Status {
    /// Whether the light is on at this time. It is dark without power, and when the program hangs.
    const fn is_on(self, ms: u32) -> bool {
        match self {
            Self::NoIdentity => ms % 125 < 62,
            Self::NoConverter => ms % 250 < 125,
            Self::NoComputer => ms % 1000 < 50,
            Self::NoReader => ms % 1000 < 500,
            Self::Sending => true,
        }
    }
}

/// The light at one output.
pub(crate) struct Light<P>(pub(crate) P);

impl<P: OutputPin> Light<P> {
    /// Shows `status` at this time in milliseconds.
    pub(crate) fn show(&mut self, status: Status, ms: u32) {
        // An output of this chip cannot fail.
        let _ = self.0.set_state(status.is_on(ms).into());
    }
}
