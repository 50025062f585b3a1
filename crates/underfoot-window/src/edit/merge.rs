//! Merges two changes of one layout: those of the window, and those that another program has saved.

use std::collections::BTreeMap;
use std::ops::Range;

use super::address::Address;
use underfoot_format::outline::Outline;

/// The result of merging two changes of one text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Merge {
    /// This text contains both changes.
    Merged(String),
    /// Both changed the same part; one text cannot hold both. The records in question; empty outside records.
    Conflict(Vec<String>),
}

/// Maximum number of pairs of lines to compare; beyond it, everything between the first and the last change is one
/// change.
const EFFORT: usize = 16_000_000;

/// Merges the changes from `base` to `mine` and to `theirs` line by line. Insertions of both at one place follow each
/// other. A record with two different changes is a conflict, even where the lines do not overlap.
///
/// The result is not parsed: the caller checks whether the layout is valid.
#[must_use]
pub fn merge(base: &str, mine: &str, theirs: &str) -> Merge {
    let twice = changed_by_both(base, mine, theirs);
    if !twice.is_empty() {
        return Merge::Conflict(twice);
    }
    let lines = |text| str::split_inclusive(text, '\n').collect::<Vec<&str>>();
    let (base, mine, theirs) = (lines(base), lines(mine), lines(theirs));
    let mut hunks = hunks(&base, &mine);
    for hunk in self::hunks(&base, &theirs) {
        if !hunks.contains(&hunk) {
            hunks.push(hunk);
        }
    }
    // A stable order: mine before theirs, insertions before replacements.
    hunks.sort_by_key(|hunk| (hunk.old.start, hunk.old.end));
    let mut merged = String::new();
    let mut from = 0;
    for hunk in hunks {
        if hunk.old.start < from {
            return Merge::Conflict(Vec::new());
        }
        merged.extend(base.get(from..hunk.old.start).unwrap_or_default().iter().copied());
        merged.extend(hunk.new.iter().copied());
        from = hunk.old.end;
    }
    merged.extend(base.get(from..).unwrap_or_default().iter().copied());
    Merge::Merged(merged)
}

/// Lines of one text in place of lines of another.
#[derive(Debug, PartialEq)]
struct Hunk<'t> {
    old: Range<usize>,
    new: Vec<&'t str>,
}

/// The hunks that turn `old` into `new`.
fn hunks<'t>(old: &[&'t str], new: &[&'t str]) -> Vec<Hunk<'t>> {
    let head = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let tail = old[head..].iter().rev().zip(new[head..].iter().rev()).take_while(|(a, b)| a == b).count();
    let (old, new) = (&old[head..old.len() - tail], &new[head..new.len() - tail]);
    let (rows, columns) = (old.len() + 1, new.len() + 1);
    if rows * columns > EFFORT {
        return vec![Hunk { old: head..head + old.len(), new: new.to_vec() }];
    }
    // Length of the longest common subsequence of the remaining lines of both.
    let mut common = vec![0_u32; rows * columns];
    for at in (0..old.len()).rev() {
        for other in (0..new.len()).rev() {
            common[at * columns + other] = if old[at] == new[other] {
                common[(at + 1) * columns + other + 1] + 1
            } else {
                common[(at + 1) * columns + other].max(common[at * columns + other + 1])
            };
        }
    }
    let mut hunks: Vec<Hunk<'t>> = Vec::new();
    let (mut at, mut other) = (0, 0);
    let mut is_open = false;
    while at < old.len() || other < new.len() {
        if at < old.len() && other < new.len() && old[at] == new[other] {
            (at, other, is_open) = (at + 1, other + 1, false);
            continue;
        }
        if !is_open {
            hunks.push(Hunk { old: head + at..head + at, new: Vec::new() });
            is_open = true;
        }
        let Some(hunk) = hunks.last_mut() else { break };
        let drops = other == new.len()
            || (at < old.len() && common[(at + 1) * columns + other] >= common[at * columns + other + 1]);
        if drops {
            at += 1;
            hunk.old.end += 1;
        } else {
            hunk.new.push(new[other]);
            other += 1;
        }
    }
    hunks
}

/// The records that both have changed in different ways.
fn changed_by_both(base: &str, mine: &str, theirs: &str) -> Vec<String> {
    let [base, mine, theirs] = [base, mine, theirs].map(records);
    let differs = |name: &&String| {
        let (was, my, their) = (base.get(*name), mine.get(*name), theirs.get(*name));
        was != my && was != their && my != their
    };
    let both = mine.keys().chain(base.keys().filter(|name| !mine.contains_key(*name)));
    both.filter(differs).cloned().collect()
}

/// The innermost records of `text` by name: the id if there is one, otherwise the address.
fn records(text: &str) -> BTreeMap<String, String> {
    let Some(root) = Outline::parse(text) else { return BTreeMap::new() };
    let all = Address::all(&root);
    let is_innermost = |record: &Outline| {
        ["widgets", "grounds", "regions", "stances", "pages"].iter().all(|list| record.field(list).is_none())
    };
    let innermost = all.iter().skip(1).filter(|(_, record)| is_innermost(record));
    let named = innermost.map(|(address, record)| {
        let id = record.field("id").and_then(|id| id.value.says.clone());
        let name = id.map_or_else(|| address.to_string(), |id| format!("\"{id}\""));
        (name, text[record.span.clone()].to_owned())
    });
    named.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: &str = "Layout(\n  widgets: [\n    // One.\n    (id: \"a\", at: 1),\n    (id: \"b\", at: 2),\n    \
                        (id: \"c\", at: 3),\n  ],\n)\n";

    fn merged(mine: &str, theirs: &str) -> String {
        match merge(BASE, mine, theirs) {
            Merge::Merged(text) => text,
            Merge::Conflict(records) => panic!("{records:?}"),
        }
    }

    #[test]
    fn changes_of_different_records_are_put_together_also_side_by_side() {
        let mine = BASE.replace("at: 1", "at: 7");
        let theirs = BASE.replace("at: 2", "at: 8").replace("One", "First");
        let both = BASE.replace("at: 1", "at: 7").replace("at: 2", "at: 8").replace("One", "First");
        assert_eq!(merged(&mine, &theirs), both);
        assert_eq!(merged(&theirs, &mine), both);
        assert_eq!(merged(&mine, BASE), mine);
        assert_eq!(merged(BASE, &mine), mine);
        assert_eq!(merged(&mine, &mine), mine, "the same twice is done once");
    }

    #[test]
    fn what_both_put_in_at_one_place_is_all_there() {
        let new = |id: &str| BASE.replace("at: 3),\n", &format!("at: 3),\n    (id: \"{id}\", at: 5),\n"));
        let both = BASE.replace("at: 3),\n", "at: 3),\n    (id: \"x\", at: 5),\n    (id: \"y\", at: 5),\n");
        assert_eq!(merged(&new("x"), &new("y")), both);
        let without = BASE.replace("    (id: \"b\", at: 2),\n", "");
        assert_eq!(merged(&without, &new("x")), new("x").replace("    (id: \"b\", at: 2),\n", ""));
    }

    #[test]
    fn one_record_changed_by_both_is_asked_about() {
        let (mine, theirs) = (BASE.replace("at: 2", "at: 7"), BASE.replace("at: 2", "at: 8"));
        assert_eq!(merge(BASE, &mine, &theirs), Merge::Conflict(vec!["\"b\"".into()]));
        let gone = BASE.replace("    (id: \"b\", at: 2),\n", "");
        assert_eq!(merge(BASE, &gone, &theirs), Merge::Conflict(vec!["\"b\"".into()]));
        // This conflict is outside records.
        let (mine, theirs) = (BASE.replace("One", "Uno"), BASE.replace("One", "Un"));
        assert_eq!(merge(BASE, &mine, &theirs), Merge::Conflict(vec![]));
    }
}
