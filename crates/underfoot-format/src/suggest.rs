//! The nearest valid name.

use strsim::{jaro_winkler, osa_distance};

/// Returns the name among `valid` that resembles `written` most; `None` if none is close.
pub fn nearest<'v>(written: &str, valid: impl IntoIterator<Item = &'v str>) -> Option<&'v str> {
    let plain = written.to_lowercase().replace(['-', ' '], "_");
    // A typo changes at most a third of a name; a suggestion beyond that is a guess.
    let most = (plain.chars().count() / 3).max(1);
    valid
        .into_iter()
        .filter_map(|name| {
            let lower = name.to_lowercase();
            let distance = osa_distance(&plain, &lower);
            // `press` for `press_n`: the unit is missing.
            let unfinished = plain.len() >= 3
                && lower.strip_prefix(plain.as_str()).is_some_and(|end| end.starts_with('_'));
            (distance <= most || unfinished).then(|| (name, distance, jaro_winkler(&plain, &lower)))
        })
        .min_by(|a, b| a.1.cmp(&b.1).then(b.2.total_cmp(&a.2)))
        .map(|(name, ..)| name)
}

/// Advice about a name that is not among `valid`: the nearest one, or all of them.
pub fn did_you_mean(written: &str, valid: &[&str], quote: char) -> Option<String> {
    let quoted = |name: &str| format!("{quote}{name}{quote}");
    match nearest(written, valid.iter().copied()) {
        Some(name) => Some(format!("did you mean {}?", quoted(name))),
        None if valid.is_empty() => None,
        None => {
            let all: Vec<String> = valid.iter().map(|name| quoted(name)).collect();
            Some(format!("there is {}", listed(&all, "and")))
        }
    }
}

/// Names in a sentence: a, b and c.
pub fn listed<S: AsRef<str>>(names: &[S], joint: &str) -> String {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    match names.as_slice() {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [rest @ .., last] => format!("{} {joint} {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typos_cases_and_forgotten_units_find_their_name() {
        let valid = ["press_n", "release_n", "dwell_ms", "label", "at", "size"];
        let near = |written| nearest(written, valid);
        assert_eq!(near("prss_n"), Some("press_n"));
        assert_eq!(near("Label"), Some("label"));
        assert_eq!(near("dwell"), Some("dwell_ms"));
        assert_eq!(near("press-n"), Some("press_n"));
        assert_eq!(near("colour"), None);
        assert_eq!(near("x"), None);
    }

    #[test]
    fn without_a_near_name_all_are_listed() {
        let help = did_you_mean("zzz", &["map", "tools", "side"], '"');
        assert_eq!(help.as_deref(), Some("there is \"map\", \"tools\" and \"side\""));
    }
}
