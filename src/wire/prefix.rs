//! Prefix of OSC addresses.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use thiserror::Error;

/// The prefix of this program's OSC addresses: `/underfoot` by default.
///
/// It does not apply to boards: the floor file sets their addresses.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Prefix(Arc<str>);

/// A text is not a valid prefix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a prefix is made of parts like /lab/floor_2: a slash, then letters, digits, `_` and `-`; 200 in all"
)]
pub struct BadPrefix;

impl Prefix {
    /// Returns the prefix as text, such as `/underfoot`.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns the address of `path` under this prefix: `widget/zoom/set` becomes `/underfoot/widget/zoom/set`.
    #[must_use]
    pub fn address(&self, path: &str) -> String {
        format!("{}/{path}", self.0)
    }

    /// Returns the part of `address` after the prefix and a slash; `None` if it has another prefix.
    #[must_use]
    pub fn path<'a>(&self, address: &'a str) -> Option<&'a str> {
        address.strip_prefix(&*self.0)?.strip_prefix('/')
    }
}

impl Default for Prefix {
    fn default() -> Self {
        Self("/underfoot".into())
    }
}

impl fmt::Display for Prefix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl FromStr for Prefix {
    type Err = BadPrefix;

    /// Reads `/lab/floor_2`; removes one slash at the end.
    fn from_str(text: &str) -> Result<Self, BadPrefix> {
        let text = text.strip_suffix('/').unwrap_or(text);
        let in_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
        let is_part = |part: &str| !part.is_empty() && part.chars().all(in_part);
        let parts = text.strip_prefix('/').ok_or(BadPrefix)?;
        if text.len() <= 200 && parts.split('/').all(is_part) {
            Ok(Self(text.into()))
        } else {
            Err(BadPrefix)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_are_whole_parts_of_addresses() {
        let prefix: Prefix = "/lab/floor_2/".parse().unwrap();
        assert_eq!(prefix.address("contacts"), "/lab/floor_2/contacts");
        assert_eq!(prefix.path("/lab/floor_2/widget/a/set"), Some("widget/a/set"));
        assert_eq!(prefix.path("/lab/floor_25/widget/a/set"), None);
        assert_eq!(Prefix::default().path("/underfoot"), None);
        for bad in ["", "/", "lab", "//lab", "/lab//x", "/l*b", "/lab x", &format!("/{}", "a".repeat(200))] {
            assert_eq!(bad.parse::<Prefix>(), Err(BadPrefix), "{bad}");
        }
    }
}
