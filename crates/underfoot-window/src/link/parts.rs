//! Kinds and effects in texts of the user's: those that can be read, and the problems of the others.

use std::collections::BTreeMap;

use underfoot::schema::{Diagnostic, Diagnostics, Effects, Kinds, parse_effect};

use super::SharedLayout;

/// The folder of kinds beside a layout.
pub const KINDS: &str = "widgets";

/// The folder of effects beside a layout.
pub const EFFECTS: &str = "effects";

/// A kind or an effect that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnreadablePart {
    /// Its folder: [`KINDS`] or [`EFFECTS`].
    pub folder: &'static str,
    /// The name of its file.
    pub file: String,
    /// Its problems, with their places.
    pub problems: Diagnostics,
}

/// The kinds and effects of some texts that can be read.
#[derive(Clone, Debug)]
pub struct ReadableParts {
    /// Them, and those that come with underfoot.
    pub kinds: Kinds,
    /// Their texts, as a layout without a text.
    pub texts: SharedLayout,
    /// The others.
    pub unreadable: Vec<UnreadablePart>,
}

impl ReadableParts {
    /// Reads the kinds and effects of `stored` and of `new` on top of the effects `below`. A file of `new` replaces the
    /// one of the same name in `stored`, unless it cannot be read.
    ///
    /// An effect may be made of those in files that come earlier in alphabetical order, and a kind of any other.
    #[must_use]
    pub fn of(below: &Effects, stored: &SharedLayout, new: &SharedLayout) -> Self {
        let mut parts = Self {
            kinds: Kinds::default(),
            texts: SharedLayout { effects: stored.effects.clone(), ..SharedLayout::default() },
            unreadable: Vec::new(),
        };
        let shipped = parts.read_effects(below, &new.effects);
        parts.read_kinds(&shipped, &stored.kinds, &new.kinds);
        parts
    }

    /// Reads the effects, those of `new` in place of those in `texts`; returns the kinds that come with underfoot, with
    /// them.
    fn read_effects(&mut self, below: &Effects, new: &BTreeMap<String, String>) -> Kinds {
        let mut effects = below.clone();
        let mut files: Vec<String> = self.texts.effects.keys().chain(new.keys()).cloned().collect();
        files.sort();
        files.dedup();
        for file in files {
            let stored = self.texts.effects.remove(&file);
            for text in [new.get(&file).cloned(), stored].into_iter().flatten() {
                match with_effect(&effects, &text, &file) {
                    Ok(more) => {
                        effects = more;
                        self.texts.effects.insert(file.clone(), text);
                        break;
                    }
                    Err(problems) => self.refuse(EFFECTS, &file, problems),
                }
            }
        }
        // Each effect was tried with them.
        Kinds::shipped(effects).unwrap_or_else(|_| Kinds::builtin())
    }

    /// Reads the kinds on top of `below`, and drops those with errors until there are none. The stored ones come first:
    /// of two kinds with one name, the later one has the error.
    fn read_kinds(
        &mut self,
        below: &Kinds,
        stored: &BTreeMap<String, String>,
        new: &BTreeMap<String, String>,
    ) {
        let is_replaced = |file: &String| new.contains_key(file);
        let mut files: Vec<(&str, &str)> = Vec::new();
        files.extend(stored.iter().filter(|(file, _)| !is_replaced(file)).map(strs));
        files.extend(new.iter().map(strs));
        loop {
            self.kinds = below.clone();
            let Err(problems) = self.kinds.add_all(&files) else { break };
            let old_of = |(file, text): &(&str, &str)| {
                stored.get(*file).map(String::as_str).filter(|old| old != text && new.contains_key(*file))
            };
            let is_bad = |file: &str| problems_of(&problems, file).errors() > 0;
            // The last good state stays; others may be made of it.
            let goes_back = files.iter().any(|one| is_bad(one.0) && old_of(one).is_some());
            let before = files.len();
            let mut back = Vec::new();
            files.retain(|one| {
                let old = old_of(one);
                let stays = !is_bad(one.0) || (goes_back && old.is_none());
                if !stays {
                    self.refuse(KINDS, one.0, problems_of(&problems, one.0));
                    back.extend(old.map(|old| (one.0, old)));
                }
                stays
            });
            // Errors are always of one of the files; otherwise none of them can be used.
            if files.len() == before {
                files.drain(..).for_each(|(file, _)| self.refuse(KINDS, file, problems.clone()));
            }
            files.splice(0..0, back);
        }
        self.texts.kinds = files.into_iter().map(|(file, text)| (file.to_owned(), text.to_owned())).collect();
    }

    fn refuse(&mut self, folder: &'static str, file: &str, problems: Diagnostics) {
        self.unreadable.push(UnreadablePart { folder, file: file.to_owned(), problems });
    }
}

fn strs<'a>((file, text): (&'a String, &'a String)) -> (&'a str, &'a str) {
    (file, text)
}

/// `effects` with one more. One that replaces another must fit the kinds that come with underfoot.
fn with_effect(effects: &Effects, text: &str, file: &str) -> Result<Effects, Diagnostics> {
    let (effect, _) = parse_effect(text, file, effects)?;
    let (mut all, name) = (effects.clone(), effect.name.clone());
    let replaces = all.get(&name).is_some();
    all.insert(effect);
    if let (true, Err(problems)) = (replaces, Kinds::shipped(all.clone())) {
        let message = format!("kinds that come with underfoot play \"{name}\", and cannot play this one");
        let why = problems.iter().next().map(|first| format!("give it another name; {}", first.message));
        return Err(Diagnostic::of_file(file, message, why).into());
    }
    Ok(all)
}

/// The problems of one file.
fn problems_of(all: &Diagnostics, file: &str) -> Diagnostics {
    let own = all.iter().filter(|problem| problem.path == file).cloned();
    Diagnostics::new(own.collect(), std::iter::empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(kinds: &[(&str, &str)], effects: &[(&str, &str)]) -> SharedLayout {
        let map = |all: &[(&str, &str)]| {
            all.iter().map(|(file, text)| (format!("{file}.ron"), (*text).to_owned())).collect()
        };
        SharedLayout { kinds: map(kinds), effects: map(effects), ..SharedLayout::default() }
    }

    fn read(stored: &SharedLayout, new: &SharedLayout) -> ReadableParts {
        ReadableParts::of(&Effects::builtin(), stored, new)
    }

    /// The files that cannot be read, each with the first line of its problems.
    fn refused(parts: &ReadableParts) -> Vec<String> {
        let first = |part: &UnreadablePart| part.problems.iter().next().map(|problem| problem.line);
        parts
            .unreadable
            .iter()
            .map(|part| format!("{}/{} {:?}", part.folder, part.file, first(part)))
            .collect()
    }

    const THUD: &str = r#"Effect(name: "thud", about: "A low one", plays: Click(level_n: 9, modes: [(hz: 90, decay_ms: 30)]))"#;

    #[test]
    fn a_broken_file_leaves_the_others_and_its_own_last_text() {
        let big = r#"Kind(name: "big", from: "button", feel: (press: "thud"))"#;
        let stored = texts(&[("big", big)], &[("thud", THUD)]);
        assert!(read(&SharedLayout::default(), &stored).unreadable.is_empty());
        // The bracket of the second line has no end; the effect has no name.
        let new = texts(
            &[("big", "Kind(name: \"big\",\nlook: ("), ("bigger", r#"Kind(name: "bigger", from: "big")"#)],
            &[("thud", "Effect(plays: 5)")],
        );
        let parts = read(&stored, &new);
        assert_eq!(refused(&parts), ["effects/thud.ron Some(1)", "widgets/big.ron Some(2)"]);
        assert_eq!(parts.texts.kinds["big.ron"], big);
        assert_eq!(parts.texts.effects["thud.ron"], THUD);
        assert!(parts.kinds.get("bigger").is_some(), "made of the last good one");
    }

    #[test]
    fn kinds_made_of_broken_ones_go_with_them_and_each_says_why() {
        let new = texts(
            &[
                ("a", r#"Kind(name: "a", from: "b")"#),
                ("b", r#"Kind(name: "b", from: "c")"#),
                ("c", r#"Kind(name: "c", from: "button", press_n: "much")"#),
                ("d", r#"Kind(name: "d", from: "button")"#),
            ],
            &[],
        );
        let parts = read(&SharedLayout::default(), &new);
        assert_eq!(refused(&parts), ["c", "b", "a"].map(|file| format!("widgets/{file}.ron Some(1)")));
        assert_eq!(parts.texts.kinds.keys().collect::<Vec<_>>(), ["d.ron"]);
    }

    #[test]
    fn the_later_of_two_kinds_with_one_name_is_refused_whatever_its_file_is_called() {
        let (stored, new) = (
            texts(&[("z", r#"Kind(name: "big", from: "button")"#)], &[]),
            texts(&[("a", r#"Kind(name: "big", from: "slider")"#)], &[]),
        );
        let parts = read(&stored, &new);
        assert_eq!(refused(&parts), ["widgets/a.ron Some(1)"]);
        assert_eq!(parts.texts.kinds.keys().collect::<Vec<_>>(), ["z.ron"]);
    }

    #[test]
    fn an_effect_that_the_shipped_kinds_cannot_play_takes_none_of_them_away() {
        // Shipped buttons play it once a press; friction lasts as long as a foot slides.
        let plays = "Friction(level_n: 6, low_hz: 80, high_hz: 320, full_speed_m_s: 0.6, full_force_n: 200)";
        let wrong = format!("Effect(name: \"crisp_click\", plays: {plays})");
        let parts = read(&SharedLayout::default(), &texts(&[], &[("click", &wrong), ("thud", THUD)]));
        assert_eq!(parts.unreadable.len(), 1, "{:?}", refused(&parts));
        let message = parts.unreadable[0].problems.to_string();
        assert!(message.contains("click.ron"), "{message}");
        assert!(parts.kinds.get("button").is_some() && parts.kinds.effects().get("thud").is_some());
    }
}
