//! The keys of an X keyboard, by the symbols on them.

use underfoot::messages::{KeyStroke, KeySymbol};
use x11rb::connection::Connection;
use x11rb::errors::ReplyError;
use x11rb::protocol::xproto::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// The keysym of the left shift key.
const SHIFT: u32 = 0xffe1;

/// The symbols of all keys, without and with the shift key.
#[derive(Debug)]
pub(super) struct Keymap {
    keys: Vec<(u8, [u32; 2])>,
}

impl Keymap {
    /// Reads the layout of the keyboard that is in use.
    pub(super) fn read(connection: &RustConnection) -> Result<Self, ReplyError> {
        let setup = connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let count = last.saturating_sub(first).saturating_add(1);
        let mapping = connection.get_keyboard_mapping(first, count)?.reply()?;
        let per_key = usize::from(mapping.keysyms_per_keycode).max(1);
        let symbols = |keysyms: &[u32]| [0, 1].map(|level| keysyms.get(level).copied().unwrap_or_default());
        let keys = (first..=last).zip(mapping.keysyms.chunks(per_key).map(symbols)).collect();
        Ok(Self { keys })
    }

    /// Returns the codes of the keys to press, in their order: modifiers, the shift key if the symbol needs it, the
    /// key itself.
    ///
    /// # Errors
    /// The symbol that is on no key.
    pub(super) fn codes(&self, stroke: &KeyStroke) -> Result<Vec<u8>, KeySymbol> {
        let mut codes = Vec::new();
        for symbol in stroke.keys() {
            let keysym = symbol.keysym();
            let at = |level: usize| self.keys.iter().find(|(_, symbols)| symbols.get(level) == Some(&keysym));
            match (at(0), at(1)) {
                (Some((code, _)), _) => codes.push(*code),
                (None, Some((code, _))) => {
                    let shift = self.keys.iter().find(|(_, symbols)| symbols.contains(&SHIFT));
                    codes.extend(shift.map(|(code, _)| *code).filter(|shift| !codes.contains(shift)));
                    codes.push(*code);
                }
                (None, None) => return Err(symbol),
            }
        }
        Ok(codes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capital_letter_needs_the_shift_key_once() {
        let keymap = Keymap { keys: vec![(38, [0x61, 0x41]), (50, [SHIFT, 0]), (37, [0xffe3, 0])] };
        let codes = |text: &str| keymap.codes(&text.parse().unwrap());
        assert_eq!(codes("a"), Ok(vec![38]));
        assert_eq!(codes("A"), Ok(vec![50, 38]));
        assert_eq!(codes("Control+Shift+A"), Ok(vec![37, 50, 38]));
        assert_eq!(codes("z"), Err(KeySymbol::Character('z')));
    }
}
