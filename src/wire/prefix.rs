//! What OSC addresses begin with.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use thiserror::Error;

/// What the OSC addresses of this program begin with: `/underfoot` unless somebody wants it otherwise.
///
/// Boards are not concerned: the floor file names their addresses.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Prefix(Arc<str>);

/// Why a text is not a prefix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a prefix is made of parts like /lab/floor_2: a slash, then letters, digits, `_` and `-`; 200 in all"
)]
pub struct BadPrefix;

impl Prefix {
    /// The prefix as text, such as `/underfoot`.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The address `path` under this prefix: `widget/zoom/set` becomes `/underfoot/widget/zoom/set`.
    #[must_use]
    pub fn address(&self, path: &str) -> String {
        format!("{}/{path}", self.0)
    }

    /// What follows the prefix and a slash in `address`; `None` if it begins otherwise.
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

    /// Reads `/lab/floor_2`; one slash at the end is left out.
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
