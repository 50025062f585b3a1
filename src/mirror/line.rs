//! The lines of a server, limited to the parts that a window stores: each is small, whatever a server sends.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, SeqAccess, Visitor};
use serde_json::{Value, json};

use crate::widget::OffReason;
use underfoot_format::label::{self, MAX_LABEL};

/// Maximum length of a reason in characters, such as the problems of a layout.
const MOST_OF_A_REASON: usize = 4096;

/// A line of a server: a report about a control or a page, or the reason for a refused request. Parsing drops unknown
/// fields and anything that is too long.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
pub struct ServerLine {
    pub(super) event: Word,
    pub(super) id: Word,
    pub(super) page: Option<Word>,
    request: Word,
    why: Reason,
    pub(super) value: Said,
    pub(super) range: Said,
    pub(super) label: Said,
    pub(super) indicator: Said,
    pub(super) enabled: Said,
    /// The reason why it is off.
    off: Said,
    pub(super) locked: Said,
}

impl ServerLine {
    /// Reads a line.
    ///
    /// # Errors
    /// An error if the text is not a JSON object, or has another type in the place of a string.
    pub fn read(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The name of the event: `state`, `changed`, `page`, `error` or another word.
    #[must_use]
    pub fn event(&self) -> &str {
        &self.event.0
    }

    /// The refused request; empty in other lines.
    #[must_use]
    pub fn request(&self) -> &str {
        &self.request.0
    }

    /// Whether an app has switched the control off; `None` in lines without this information.
    pub(super) fn is_disabled(&self) -> Option<bool> {
        self.enabled.flag().map(|_| matches!(&self.off, Said::Text(off) if off == OffReason::Disabled.name()))
    }

    /// The reason for the refusal, on one line or several; empty in other lines.
    #[must_use]
    pub fn why(&self) -> &str {
        &self.why.0
    }
}

/// An id, or another word: at most as long as a label, and of visible characters.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Word(pub(super) String);

impl<'de> Deserialize<'de> for Word {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Text(|text: &str| Self(label::cleaned(text, MAX_LABEL).into_owned())).read(deserializer)
    }
}

/// A sentence or several lines of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Reason(pub(super) String);

impl<'de> Deserialize<'de> for Reason {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let cut = |text: &str| {
            let text = &text[..text.floor_char_boundary(MOST_OF_A_REASON)];
            let lines = text.lines().map(|line| label::cleaned(line, MOST_OF_A_REASON));
            Self(lines.collect::<Vec<_>>().join("\n"))
        };
        Text(cut).read(deserializer)
    }
}

/// Deserializes a string without storing a copy of it.
struct Text<F>(F);

impl<T, F: Fn(&str) -> T> Text<F> {
    fn read<'de, D: Deserializer<'de>>(self, deserializer: D) -> Result<T, D::Error>
    where
        T: Default,
    {
        deserializer.deserialize_any(self)
    }
}

impl<T: Default, F: Fn(&str) -> T> Visitor<'_> for Text<F> {
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

/// One property of a control in a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Said {
    /// Nothing, or a value that no control has.
    #[default]
    Nothing,
    Flag(bool),
    Number(f64),
    Text(String),
    Numbers([f64; 2]),
}

impl Said {
    /// The value as arguments of a request; `None` if the line has no value.
    pub(super) fn arguments(&self) -> Option<Vec<Value>> {
        Some(match self {
            Self::Nothing => return None,
            Self::Flag(on) => vec![json!(on)],
            // Requests take a choice as an integer.
            Self::Number(number) if number.fract() == 0.0 => vec![json!(*number as i64)],
            Self::Number(number) => vec![json!(number)],
            Self::Text(text) => vec![json!(text)],
            Self::Numbers(numbers) => numbers.iter().map(|number| json!(number)).collect(),
        })
    }

    pub(super) fn flag(&self) -> Option<bool> {
        if let Self::Flag(on) = self { Some(*on) } else { None }
    }

    pub(super) fn number(&self) -> Option<f64> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }
}

impl<'de> Deserialize<'de> for Said {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SaidVisitor)
    }
}

struct SaidVisitor;

impl<'de> Visitor<'de> for SaidVisitor {
    type Value = Said;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("anything")
    }

    fn visit_bool<E>(self, on: bool) -> Result<Said, E> {
        Ok(Said::Flag(on))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Said, E> {
        Ok(Said::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Said, E> {
        Ok(Said::Number(number as f64))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Said, E> {
        Ok(Said::Number(number))
    }

    fn visit_str<E>(self, text: &str) -> Result<Said, E> {
        Ok(Said::Text(label::cleaned(text, MAX_LABEL).into_owned()))
    }

    fn visit_unit<E>(self) -> Result<Said, E> {
        Ok(Said::Nothing)
    }

    /// Lists of choices, and both ranges of a pair, come from the layout.
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Said, A::Error> {
        let mut numbers = [None; 2];
        for number in &mut numbers {
            *number = list.next_element::<Said>()?.and_then(|said| said.number());
        }
        let mut is_longer = false;
        while list.next_element::<IgnoredAny>()?.is_some() {
            is_longer = true;
        }
        Ok(match numbers {
            [Some(first), Some(second)] if !is_longer => Said::Numbers([first, second]),
            _ => Said::Nothing,
        })
    }

    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<Said, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(Said::Nothing)
    }
}

/// The first `MOST` entries of a list, and the number of further ones.
#[derive(Clone, Debug)]
pub(super) struct Few<T, const MOST: usize> {
    pub(super) kept: Vec<T>,
    pub(super) left_out: u64,
}

impl<T, const MOST: usize> Default for Few<T, MOST> {
    fn default() -> Self {
        Self { kept: Vec::new(), left_out: 0 }
    }
}

impl<'de, T: Deserialize<'de>, const MOST: usize> Deserialize<'de> for Few<T, MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(FewVisitor(PhantomData))
    }
}

struct FewVisitor<T, const MOST: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const MOST: usize> Visitor<'de> for FewVisitor<T, MOST> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> ServerLine {
        ServerLine::read(text).unwrap()
    }

    #[test]
    fn what_is_said_of_a_control_is_kept() {
        let said = line(
            r#"{"t_s":9.9,"event":"state","id":"zoom","value":0.5,"range":[0.0,1.0],"enabled":true,"locked":false,
            "pressed":false,"indicator":"off","label":"Zoom","page":null,"more":[1,{"a":[]}]}"#,
        );
        assert_eq!((said.event(), said.id.0.as_str()), ("state", "zoom"));
        assert_eq!((said.value, said.range), (Said::Number(0.5), Said::Numbers([0.0, 1.0])));
        assert_eq!((said.enabled.flag(), said.locked.flag()), (Some(true), Some(false)));
        assert_eq!((said.label, said.page), (Said::Text("Zoom".into()), None));
    }

    #[test]
    fn nothing_that_is_kept_is_long() {
        let long = "x".repeat(100_000);
        let deep = format!("{}{}", "[".repeat(100), "]".repeat(100));
        let text = format!(
            r#"{{"event":"{long}","id":"{long}","page":"{long}","request":"{long}","why":"{long}","value":"{long}",
            "range":{deep},"label":[{long_list}],"indicator":{{"a":"{long}"}},"enabled":[1,2,3]}}"#,
            long_list = vec!["1"; 50_000].join(",")
        );
        let said = line(&text);
        let lengths = [&said.event, &said.id, &said.request].map(|word| word.0.len());
        assert_eq!(lengths, [MAX_LABEL; 3]);
        assert_eq!(said.page.unwrap().0.len(), MAX_LABEL);
        assert_eq!(said.why.0.len(), MOST_OF_A_REASON);
        assert_eq!(said.value, Said::Text("x".repeat(MAX_LABEL)));
        assert_eq!([said.range, said.label, said.indicator, said.enabled], [const { Said::Nothing }; 4]);
    }

    #[test]
    fn words_and_reasons_hold_only_what_can_be_seen() {
        let said = line(r#"{"id":"a\u202eb\u001b[31m","why":"one\u0007\ntwo\u202e"}"#);
        assert_eq!((said.id.0.as_str(), said.why()), ("ab[31m", "one\ntwo"));
    }

    #[test]
    fn of_a_long_list_the_first_are_kept() {
        let few: Few<u32, 3> = serde_json::from_str("[1,2,3,4,5]").unwrap();
        assert_eq!((few.kept, few.left_out), (vec![1, 2, 3], 2));
    }
}
