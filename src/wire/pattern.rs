//! Patterns in OSC addresses, part by part.
//!
//! rosc's matcher is not used: there `[0-9]` matches several digits, `*` matches at least one character, and nothing
//! backtracks, so that a request would reach other controls than OSC specifies.

/// Whether `text` has pattern characters.
#[must_use]
pub fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?', '[', ']', '{', '}'])
}

/// Whether `pattern` matches `name`; both are parts of addresses, without slashes, of ASCII characters.
///
/// A malformed pattern (a bracket that is not closed) matches nothing. For any pattern, the work is bounded by the
/// product of both lengths.
///
/// # Source
/// Open Sound Control 1.0, "OSC Message Dispatching and Pattern Matching": `?` is any one character, `*` any number
/// of characters, `[a-cx]` one of these, `[!a-c]` one that is not, `{one,two}` one of these words.
#[must_use]
pub fn matches(pattern: &str, name: &str) -> bool {
    let name = name.as_bytes();
    // Positions in the name that the part of the pattern read so far can reach.
    let mut reached = vec![false; name.len() + 1];
    reached[0] = true;
    let mut rest = pattern.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let (step, after) = match first {
            b'*' => {
                if let Some(start) = reached.iter().position(|reached| *reached) {
                    reached.iter_mut().skip(start).for_each(|reached| *reached = true);
                }
                rest = after;
                continue;
            }
            b'?' => (Step::AnyOne, after),
            b'[' => match split_at(after, b']') {
                Some((set, behind)) => (Step::OneOf(set), behind),
                None => return false,
            },
            b'{' => match split_at(after, b'}') {
                Some((words, behind)) => (Step::Words(words), behind),
                None => return false,
            },
            b']' | b'}' => return false,
            character => (Step::This(character), after),
        };
        (reached, rest) = (advance(&reached, name, &step), after);
    }
    reached.last() == Some(&true)
}

/// One element of a pattern with a known number of characters.
enum Step<'a> {
    AnyOne,
    This(u8),
    OneOf(&'a [u8]),
    Words(&'a [u8]),
}

fn split_at(text: &[u8], end: u8) -> Option<(&[u8], &[u8])> {
    let at = text.iter().position(|character| *character == end)?;
    Some((text.get(..at)?, text.get(at + 1..)?))
}

/// Returns the positions in the name reachable by `step` from those in `reached`.
fn advance(reached: &[bool], name: &[u8], step: &Step<'_>) -> Vec<bool> {
    let mut next = vec![false; reached.len()];
    for (at, _) in reached.iter().enumerate().filter(|(_, reached)| **reached) {
        let behind = name.get(at..).unwrap_or_default();
        let mut reach = |length: usize| {
            if let Some(next) = next.get_mut(at + length) {
                *next = true;
            }
        };
        match step {
            Step::Words(words) => {
                let words = words.split(|character| *character == b',');
                words.filter(|word| behind.starts_with(word)).for_each(|word| reach(word.len()));
            }
            Step::AnyOne if !behind.is_empty() => reach(1),
            Step::This(character) if behind.first() == Some(character) => reach(1),
            Step::OneOf(set) if behind.first().is_some_and(|character| is_in(*character, set)) => reach(1),
            Step::AnyOne | Step::This(_) | Step::OneOf(_) => {}
        }
    }
    next
}

/// Whether `character` is in `set`, `a-cx` or `!a-cx`; a minus sign at the end stands for itself.
fn is_in(character: u8, set: &[u8]) -> bool {
    let (wanted, mut rest) = match set {
        [b'!', rest @ ..] => (false, rest),
        rest => (true, rest),
    };
    let mut found = false;
    loop {
        rest = match *rest {
            [first, b'-', last, ref behind @ ..] => {
                found |= (first.min(last)..=first.max(last)).contains(&character);
                behind
            }
            [one, ref behind @ ..] => {
                found |= one == character;
                behind
            }
            [] => return found == wanted,
        };
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn patterns_mean_what_osc_1_0_says() {
        let cases = [
            ("zoom", "zoom", true),
            ("*", "", true),
            ("zo*", "zo", true),
            ("*m", "zoom", true),
            ("z*o*m", "zoom", true),
            ("z?om", "zoom", true),
            ("z?om", "zom", false),
            ("??", "zoom", false),
            ("tile[0-9]", "tile7", true),
            ("tile[0-9]", "tile12", false),
            ("tile[!0-9]", "tilex", true),
            ("tile[!0-9]", "tile7", false),
            ("[a-]", "-", true),
            ("{zoom,zo}om", "zoom", true),
            ("{zoom,home}", "home", true),
            ("{zoom,home}", "zoo", false),
            ("{,lower_}left", "left", true),
            ("zoom]", "zoom]", false),
            ("[zoom", "z", false),
            ("{zoom", "zoom", false),
            ("", "", true),
        ];
        for (pattern, name, expected) in cases {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn a_hostile_pattern_takes_no_time() {
        let (pattern, name) = (format!("{}b", "*a".repeat(60)), "a".repeat(120));
        assert!(!matches(&pattern, &name));
    }

    proptest! {
        /// Any name matches the patterns that leave one of its parts open.
        #[test]
        fn a_name_is_meant_by_what_leaves_parts_of_it_open(name in "[a-z0-9_]{1,12}", cut in 0_usize..12, to in 0_usize..12) {
            let (from, to) = (cut.min(to).min(name.len()), cut.max(to).min(name.len()));
            let (before, middle, behind) = (&name[..from], &name[from..to], &name[to..]);
            let star = format!("{before}*{behind}");
            let marks = format!("{before}{}{behind}", "?".repeat(middle.len()));
            let sets: String = middle.chars().map(|one| format!("[{one}!]")).collect();
            let sets = format!("{before}{sets}{behind}");
            let words = format!("{before}{{x,{middle},yy}}{behind}");
            for pattern in [star, marks, sets, words] {
                prop_assert!(matches(&pattern, &name), "{} {}", pattern, name);
            }
            let longer = format!("{name}?");
            prop_assert!(!matches(&longer, &name));
        }

        #[test]
        fn nothing_makes_it_stumble(pattern in "[ -~]{0,40}", name in "[ -~]{0,40}") {
            let _ = matches(&pattern, &name);
        }
    }
}
