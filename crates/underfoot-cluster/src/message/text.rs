//! Names and texts of other computers, cleaned before they reach a terminal or an app.

use underfoot::label::cleaned;

use super::{NodeAnswer, NodeMessage};

/// Most characters of a node's name and of a reason in one line.
const MOST_LINE: usize = 160;

/// Most characters of the reason for refusing a layout, which has several lines.
const MOST_REASON: usize = 4096;

/// Whether `text` can be the id of a control, a page or an area: 1 to 64 of a-z, 0-9 and _.
#[must_use]
pub fn is_id(text: &str) -> bool {
    let is_part = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    (1..=64).contains(&text.len()) && text.bytes().all(is_part)
}

/// `text` in one line of at most `most` characters that labels may hold; line ends become spaces.
#[must_use]
pub fn shown(text: &str, most: usize) -> String {
    cleaned(&text.replace('\n', " "), most).into_owned()
}

/// Like [`shown`], with its lines.
fn shown_lines(text: &str, most: usize) -> String {
    let lines: Vec<_> = text.split('\n').map(|line| cleaned(line, most)).collect();
    lines.join("\n").chars().take(most).collect()
}

impl NodeMessage {
    /// Whether all its ids are valid.
    #[must_use]
    pub fn has_good_ids(&self) -> bool {
        let events = self.events.iter().map(|event| &event.id);
        let values = self.values.iter().flatten().map(|(id, _)| id);
        let states = self.answers.iter().flat_map(|answer| &answer.states).flat_map(|state| state.ids());
        // The page of a layout without pages has no name.
        let page = self.page.iter().filter(|page| !page.is_empty());
        let all = events.chain(values).chain(&self.held).chain(page).chain(states);
        std::iter::once(&self.area).chain(all).all(|id| is_id(id))
    }

    /// Cleans and shortens its texts, which reach terminals and apps.
    pub fn tidy(&mut self) {
        self.name = shown(&self.name, MOST_LINE);
        self.answers.iter_mut().for_each(NodeAnswer::tidy);
        if let Some((_, why)) = &mut self.layout.refused {
            *why = shown_lines(why, MOST_REASON);
        }
    }
}

impl NodeAnswer {
    fn tidy(&mut self) {
        if let Some(why) = &mut self.refused {
            *why = shown(why, MOST_LINE);
        }
        self.states.iter_mut().for_each(|state| state.tidy());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_is_short_and_plain() {
        assert!(is_id("west_2") && is_id(&"a".repeat(64)));
        for other in ["", "West", "a b", "a\u{1b}[2J", "ü", "a/b", &"a".repeat(65)] {
            assert!(!is_id(other), "{other:?}");
        }
    }

    #[test]
    fn a_text_loses_control_characters_and_its_excess() {
        assert_eq!(shown("node\u{1b}[2J\r\u{202e}\u{7}one\ntwo", 99), "node[2Jone two");
        assert_eq!(shown(&"x".repeat(99), 5), "xxxxx");
        assert_eq!(shown_lines("a\nb\u{9b}c\rd", 99), "a\nbcd");
    }

    #[test]
    fn all_texts_of_a_message_are_cleaned() {
        let bad = "\u{1b}]0;owned\u{7}".repeat(1000);
        let mut message = NodeMessage { name: bad.clone(), ..NodeMessage::default() };
        message.answers =
            vec![NodeAnswer { refused: Some(bad.clone()), states: Vec::new(), ..NodeAnswer::default() }];
        message.layout.refused = Some((Default::default(), bad));
        message.tidy();
        let texts =
            [message.name, message.answers.remove(0).refused.unwrap(), message.layout.refused.unwrap().1];
        for text in texts {
            assert!(text.starts_with("]0;owned]0;owned") && text.len() <= MOST_REASON, "{text:?}");
            assert!(!text.contains(|c: char| c.is_control()), "{text:?}");
        }
    }
}
