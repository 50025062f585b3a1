//! Ids and the references to them.

use super::address::{Address, RecordList};
use super::change::{find, in_list, quoted};
use super::refusal::EditRefusal;
use super::splice::{Splice, spliced};
use underfoot_format::outline::Outline;

/// Fields by which one entry of a list refers to another.
pub(super) const NEIGHBOURS: [&str; 4] = ["right_of", "left_of", "above", "below"];

/// The changes that give `record` another id, with all references to it.
pub(super) fn renaming(root: &Outline, record: &Address, id: &str) -> Result<Vec<Splice>, EditRefusal> {
    let named = find(root, record)?.field("id").map(|field| &field.value);
    let named = named.ok_or_else(|| EditRefusal::Missing(record.clone()))?;
    let mut splices = vec![Splice::new(named.span.clone(), quoted(id))];
    let Some(old) = named.says.as_deref() else { return Ok(splices) };
    let follow = |value: &str| followed(old, id, value);
    match record.list() {
        Some(RecordList::Widgets) => {
            let (list, _) = in_list(root, record)?;
            list.elements
                .iter()
                .for_each(|other| splices.extend(references(&other.value, &NEIGHBOURS, follow)));
        }
        Some(RecordList::Pages) => {
            let controls =
                Address::all(root).into_iter().filter(|(at, _)| at.list() == Some(RecordList::Widgets));
            controls.for_each(|(_, control)| splices.extend(references(control, &["goto"], follow)));
        }
        _ => {}
    }
    Ok(splices)
}

/// `text`, one record, with the references between it and its neighbours passed through `ids`: pairs of an old and a
/// new id.
pub(super) fn referring(text: &str, ids: &[(String, String)]) -> String {
    let Some(root) = Outline::parse(text) else { return text.to_owned() };
    let follow = |value: &str| ids.iter().find_map(|(old, new)| followed(old, new, value));
    let all = Address::all(&root);
    spliced(text, all.iter().flat_map(|(_, record)| references(record, &NEIGHBOURS, follow)).collect())
}

/// The changes of those of `fields` of `record` for whose value `follow` has another one.
fn references(record: &Outline, fields: &[&str], follow: impl Fn(&str) -> Option<String>) -> Vec<Splice> {
    let fields = fields.iter().filter_map(|name| record.field(name));
    let changed = fields.filter_map(|field| {
        let new = follow(field.value.says.as_deref()?)?;
        Some(Splice::new(field.value.span.clone(), quoted(&new)))
    });
    changed.collect()
}

/// The new value of a reference to the id `old`, or to one of the ids that the pattern `old` of a grid gives, such as
/// `key_{n}`; `None` for a reference to something else.
fn followed(old: &str, new: &str, value: &str) -> Option<String> {
    if !old.contains('{') {
        return (old == value).then(|| new.to_owned());
    }
    let mut words = Vec::new();
    matched(old, value, &mut words).then_some(())?;
    let mut filled = new.to_owned();
    for (word, text) in words {
        filled = filled.replace(&word, &text);
    }
    (!filled.contains('{')).then_some(filled)
}

/// Whether the grid's `pattern` can give `value`; appends each word in braces with its text.
fn matched(pattern: &str, value: &str, words: &mut Vec<(String, String)>) -> bool {
    let Some((plain, rest)) = pattern.split_once('{') else { return pattern == value };
    let (Some(value), Some((word, rest))) = (value.strip_prefix(plain), rest.split_once('}')) else {
        return false;
    };
    let is_number = word != "label";
    for (at, letter) in value.char_indices() {
        if is_number && !letter.is_ascii_digit() {
            return false;
        }
        let (text, left) = value.split_at(at + letter.len_utf8());
        let count = words.len();
        words.push((format!("{{{word}}}"), text.to_owned()));
        if matched(rest, left, words) {
            return true;
        }
        words.truncate(count);
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_to_a_cell_of_a_grid_follows_its_pattern() {
        for (old, new, value, then) in [
            ("key_{n}", "digit_{n}", "key_12", Some("digit_12")),
            ("k{row}_{column}", "c{column}r{row}", "k3_10", Some("c10r3")),
            ("key_{n}", "digit_{n}", "key_a", None),
            ("key_{n}", "digit_{n}", "other_1", None),
            ("b_{label}", "{label}_b", "b_up", Some("up_b")),
            ("key_{n}", "digit_{row}", "key_1", None),
            ("a", "b", "a", Some("b")),
            ("a", "b", "ab", None),
        ] {
            assert_eq!(followed(old, new, value).as_deref(), then, "{old} {value}");
        }
    }

    #[test]
    fn records_that_are_copied_together_refer_to_the_copies() {
        let ids = [("a".to_owned(), "a_2".to_owned())];
        let text = "(id: \"b_2\", right_of: \"a\", // a\n gap: 0.2)";
        assert_eq!(referring(text, &ids), text.replace("\"a\"", "\"a_2\""));
        assert_eq!(referring("(id: \"c\", above: \"z\")", &ids), "(id: \"c\", above: \"z\")");
    }
}
