//! The board's number, in a sector of flash that new firmware leaves as it is.

use core::ptr::read_volatile;

/// The last sector of a Pico's flash, behind all that `memory.x` gives to the program.
const PLACE: *const [u8; 8] = 0x101F_F000 as *const [u8; 8];

/// The beginning of a written identity.
const MARK: [u8; 4] = *b"UFid";

/// Erased flash.
const ERASED: [u8; 8] = [0xFF; 8];

/// The number of this board; 0 if none was written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Identity(pub(crate) u16);

impl Identity {
    /// Reads it from flash; `None` if the sector holds something else.
    pub(crate) fn read() -> Option<Self> {
        // SAFETY: flash is mapped there, all bytes are valid, and nothing in this program writes it.
        let bytes = unsafe { read_volatile(PLACE) };
        if bytes == ERASED {
            return Some(Self(0));
        }
        let [a, b, c, d, low, high, not_low, not_high] = bytes;
        let number = u16::from_le_bytes([low, high]);
        let is_sound = [a, b, c, d] == MARK && u16::from_le_bytes([not_low, not_high]) == !number;
        is_sound.then_some(Self(number))
    }
}
