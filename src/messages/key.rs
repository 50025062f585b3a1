//! Keys by name, with modifiers: `Right`, `a`, `Control+Shift+z`.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::key_names::{MODIFIERS, NAMED_KEYS};

/// One key of a keyboard, by its symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum KeySymbol {
    /// The key that types this character.
    Character(char),
    /// The key with this name.
    Named(&'static str),
}

/// A key, and the modifiers that are down while it is.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(try_from = "String", into = "String")]
pub struct KeyStroke {
    modifiers: Vec<KeySymbol>,
    key: KeySymbol,
}

impl KeySymbol {
    /// Its number in the X Window System: the keysym of its name, that of Latin-1, or 0x01000000 plus the code point.
    #[must_use]
    pub fn keysym(self) -> u32 {
        match self {
            Self::Named(name) => {
                NAMED_KEYS.iter().find(|(known, _)| *known == name).map_or(0, |(_, keysym)| *keysym)
            }
            Self::Character(c) if matches!(c, ' '..='~' | '\u{a0}'..='\u{ff}') => u32::from(c),
            Self::Character(c) => 0x0100_0000 + u32::from(c),
        }
    }

    /// The key called `name`: one visible character, or the name of a key.
    fn named(name: &str) -> Option<Self> {
        let mut characters = name.chars();
        if let (Some(character), None) = (characters.next(), characters.next()) {
            return (!character.is_control() && !character.is_whitespace())
                .then_some(Self::Character(character));
        }
        NAMED_KEYS.iter().find(|(known, _)| *known == name).map(|(known, _)| Self::Named(known))
    }
}

impl KeyStroke {
    /// The keys in the order in which they go down; they come up in the opposite order.
    pub fn keys(&self) -> impl DoubleEndedIterator<Item = KeySymbol> + '_ {
        self.modifiers.iter().copied().chain([self.key])
    }

    /// The names of all keys that have no character of their own.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMED_KEYS.iter().map(|(name, _)| *name)
    }
}

impl FromStr for KeyStroke {
    /// The part of the text that names no key.
    type Err = String;

    /// Reads a key such as `Right`, `a`, `Control+Shift+z`, `+` or `Control++`; the last two are written with `plus`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (before, last) = match text.strip_suffix('+') {
            Some("") => (None, "plus"),
            Some(before) if before.ends_with('+') => (before.strip_suffix('+'), "plus"),
            _ => text.rsplit_once('+').map_or((None, text), |(before, last)| (Some(before), last)),
        };
        let parts = before.into_iter().flat_map(|before| before.split('+'));
        let key = KeySymbol::named(last).ok_or_else(|| last.to_owned())?;
        let mut modifiers = Vec::new();
        for part in parts {
            let known =
                MODIFIERS.iter().find(|modifier| **modifier == part).ok_or_else(|| part.to_owned())?;
            let modifier = KeySymbol::Named(known);
            if modifiers.contains(&modifier) || modifier == key {
                return Err(part.to_owned());
            }
            modifiers.push(modifier);
        }
        Ok(Self { modifiers, key })
    }
}

impl TryFrom<String> for KeyStroke {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<KeyStroke> for String {
    fn from(key: KeyStroke) -> Self {
        key.to_string()
    }
}

impl fmt::Display for KeySymbol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Character(character) => write!(f, "{character}"),
            Self::Named(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for KeyStroke {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.modifiers.iter().try_for_each(|modifier| write!(f, "{modifier}+"))?;
        self.key.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_with_their_modifiers_and_written_again() {
        for text in ["Right", "a", "é", "Control+Shift+z", "Alt+F4", "space", "Control+plus", "Shift"] {
            assert_eq!(text.parse::<KeyStroke>().unwrap().to_string(), text);
        }
        for (text, wrong) in [("Rihgt", "Rihgt"), ("", ""), ("Ctrl+a", "Ctrl"), ("Shift+Shift+a", "Shift")] {
            assert_eq!(text.parse::<KeyStroke>().unwrap_err(), wrong);
        }
    }

    #[test]
    fn plus_is_a_key_beside_being_the_sign_between_keys() {
        for (text, written) in
            [("+", "plus"), ("Control++", "Control+plus"), ("Control+Shift++", "Control+Shift+plus")]
        {
            assert_eq!(text.parse::<KeyStroke>().unwrap().to_string(), written);
        }
        for (text, wrong) in [("Control+", ""), ("++", ""), ("+a", ""), ("+++", ""), ("a++", "a")] {
            assert_eq!(text.parse::<KeyStroke>().unwrap_err(), wrong, "{text}");
        }
    }

    #[test]
    fn characters_have_the_numbers_of_the_x_window_system() {
        let keysym = |text: &str| text.parse::<KeyStroke>().unwrap().keys().last().unwrap().keysym();
        assert_eq!(["a", "é", "€", "Right"].map(keysym), [0x61, 0xe9, 0x0100_20ac, 0xff53]);
    }
}
