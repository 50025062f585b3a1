//! Texts and lists of limited length.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{DeserializeOwned, Deserializer, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use underfoot_format::label::{self, MAX_LABEL};

/// Maximum length of a sentence in bytes, such as the problems of a layout.
pub(super) const MOST_OF_A_SENTENCE: usize = 4096;

/// An id, or another word.
///
/// Reading shortens it to the length of a label and drops invisible characters; null is the empty word.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(transparent)]
pub struct Word(pub String);

impl Word {
    /// The word as a text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns `text` without what a word can't hold.
    pub(super) fn cleaned(text: &str) -> Self {
        Self(label::cleaned(text, MAX_LABEL).into_owned())
    }
}

impl From<&str> for Word {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl PartialEq<str> for Word {
    fn eq(&self, text: &str) -> bool {
        self.0 == text
    }
}

impl PartialEq<&str> for Word {
    fn eq(&self, text: &&str) -> bool {
        self.0 == *text
    }
}

impl<'de> Deserialize<'de> for Word {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor(Self::cleaned))
    }
}

/// A sentence, or several lines of them.
///
/// Reading keeps the first 4096 bytes and drops invisible characters; null is the empty sentence.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Sentence(pub String);

impl From<&str> for Sentence {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl<'de> Deserialize<'de> for Sentence {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor(|text: &str| {
            let (text, _) = text.split_at(text.floor_char_boundary(MOST_OF_A_SENTENCE));
            let lines = text.lines().map(|line| label::cleaned(line, MOST_OF_A_SENTENCE));
            Self(lines.collect::<Vec<_>>().join("\n"))
        }))
    }
}

/// Passes a text to a function without a copy of all of it.
struct TextVisitor<F>(F);

impl<T: Default, F: Fn(&str) -> T> Visitor<'_> for TextVisitor<F> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a text or null")
    }

    fn visit_str<E>(self, text: &str) -> Result<T, E> {
        Ok((self.0)(text))
    }

    fn visit_unit<E>(self) -> Result<T, E> {
        Ok(T::default())
    }
}

/// A list. Reading keeps its first `MOST` entries, and counts the others; writing writes all.
#[derive(Clone, Debug, PartialEq)]
pub struct Few<T, const MOST: usize> {
    /// The entries.
    pub kept: Vec<T>,
    /// Number of entries that reading left out.
    pub left_out: u64,
}

impl<T, const MOST: usize> Default for Few<T, MOST> {
    fn default() -> Self {
        Self { kept: Vec::new(), left_out: 0 }
    }
}

impl<T, const MOST: usize> Few<T, MOST> {
    /// Whether there is no entry.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty() && self.left_out == 0
    }
}

impl<T, const MOST: usize> FromIterator<T> for Few<T, MOST> {
    fn from_iter<I: IntoIterator<Item = T>>(entries: I) -> Self {
        Self { kept: entries.into_iter().collect(), left_out: 0 }
    }
}

impl<T: Serialize, const MOST: usize> Serialize for Few<T, MOST> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.kept.serialize(serializer)
    }
}

impl<'de, T: DeserializeOwned, const MOST: usize> Deserialize<'de> for Few<T, MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(FewVisitor(PhantomData))
    }
}

struct FewVisitor<T, const MOST: usize>(PhantomData<T>);

impl<'de, T: DeserializeOwned, const MOST: usize> Visitor<'de> for FewVisitor<T, MOST> {
    type Value = Few<T, MOST>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Few<T, MOST>, A::Error> {
        let mut few = Few::default();
        while few.kept.len() < MOST {
            let Some(entry) = list.next_element()? else { return Ok(few) };
            few.kept.push(entry);
        }
        while list.next_element::<IgnoredAny>()?.is_some() {
            few.left_out += 1;
        }
        Ok(few)
    }
}
