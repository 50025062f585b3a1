//! Records as RON text: copied, pasted, duplicated.

use glam::Vec2;

use super::address::{Address, List};
use super::change::Edit;
use super::document::Document;
use super::refusal::Refusal;
use super::splice::{Lines, spliced};
use crate::format::outline::Outline;

impl Document {
    /// What puts the records that `text` holds into `list` of `parent`, moved by `by` metres, and where they will be.
    ///
    /// `text` is what [`Document::copy`] gave, or what a person copied out of a file: records with commas between
    /// them. Ids that are taken get numbers.
    ///
    /// # Errors
    /// [`Refusal::NotARecord`].
    pub fn pasting(
        &self,
        text: &str,
        parent: &Address,
        list: List,
        by: Vec2,
    ) -> Result<(Vec<Edit>, Vec<Address>), Refusal> {
        let text = format!("[{}]", text.trim().trim_end_matches(','));
        let entries = Outline::parse(&text).ok_or(Refusal::NotARecord)?;
        let begin = parent.find(self.root()).and_then(|parent| super::address::list_of(parent, list));
        let begin = begin.map_or(0, |list| list.elements.len());
        let (mut edits, mut places, mut taken) = (Vec::new(), Vec::new(), Vec::new());
        for element in &entries.elements {
            if !super::change::is_record(&element.value) {
                return Err(Refusal::NotARecord);
            }
            let mut record = Lines(&text).piece(element).text;
            self.renew(&mut record, by, &mut taken).ok_or(Refusal::NotARecord)?;
            let at = parent.entry(list, begin + places.len());
            edits.push(Edit::Insert { at: at.clone(), text: record });
            places.push(at);
        }
        if edits.is_empty() { Err(Refusal::NotARecord) } else { Ok((edits, places)) }
    }

    /// Gives the record `text` free ids, also those within a group, and moves it.
    fn renew(&self, text: &mut String, by: Vec2, taken: &mut Vec<String>) -> Option<()> {
        let count = Address::all(&Outline::parse(text)?).len();
        for number in 0..count {
            let root = Outline::parse(text)?;
            let (_, record) = Address::all(&root).into_iter().nth(number)?;
            let Some(old) = record.field("id").and_then(|field| field.value.says.clone()) else { continue };
            let new =
                if old.contains('{') { old.replacen('{', "copy_{", 1) } else { self.free_id(&old, taken) };
            taken.push(new.clone());
            let splices = Lines(text).set(record, &["id"], &format!("\"{new}\""));
            *text = spliced(text, splices);
        }
        let root = Outline::parse(text)?;
        let numbers: Option<Vec<f64>> = root.field("at").map(|at| {
            let values = at.value.elements.iter();
            values.filter_map(|value| text.get(value.value.span.clone())?.trim().parse().ok()).collect()
        });
        if let Some([east, north]) = numbers.as_deref() {
            let by = by.as_dvec2() / self.unit_m();
            let moved = [east + by.x, north + by.y].map(|value| (value * 1e4).round() / 1e4);
            let value = format!("({}, {})", moved[0], moved[1]);
            *text = spliced(text, Lines(text).set(&root, &["at"], &value));
        }
        Some(())
    }

    /// What puts a copy of each of `records` behind the last one of its list, moved by `by` metres, and where those
    /// will be.
    ///
    /// # Errors
    /// As [`Document::pasting`].
    pub fn duplicating(&self, records: &[Address], by: Vec2) -> Result<(Vec<Edit>, Vec<Address>), Refusal> {
        let mut lists: Vec<(Address, List)> = Vec::new();
        for record in records {
            let home = record.split().map(|(parent, list, _)| (parent, list));
            lists.extend(home.filter(|home| !lists.contains(home)));
        }
        let (mut edits, mut places) = (Vec::new(), Vec::new());
        for (parent, list) in lists {
            let is_here =
                |record: &&Address| record.split().is_some_and(|it| (&it.0, it.1) == (&parent, list));
            let own: Vec<Address> = records.iter().filter(is_here).cloned().collect();
            let (more, at) = self.pasting(&self.copy(&own), &parent, list, by)?;
            edits.extend(more);
            places.extend(at);
        }
        Ok((edits, places))
    }

    /// What takes `records` out, and what is in them; the last of a list first, so that addresses stay true.
    #[must_use]
    pub fn deleting(&self, records: &[Address]) -> Vec<Edit> {
        let mut records: Vec<&Address> = records
            .iter()
            .filter(|one| !records.iter().any(|other| other != *one && one.is_within(other)))
            .collect();
        records.sort_unstable_by(|a, b| b.cmp(a));
        records.dedup();
        records.into_iter().map(|record| Edit::Delete { record: record.clone() }).collect()
    }
}
