//! Records as RON text: copied, pasted, duplicated.

use glam::{DVec2, Vec2};

use super::address::{Address, RecordList, list_of};
use super::change::{Edit, quoted};
use super::document::Document;
use super::group::{place_of, placed_piece};
use super::item::Item;
use super::place::pair;
use super::refusal::EditRefusal;
use super::rename::{NEIGHBOURS, referring};
use super::splice::{LayoutLines, RecordText, spliced};
use underfoot_format::outline::Outline;
use underfoot_format::source::MAX_BYTES;

impl Document {
    /// The text of these records with their comments, one below the other, for a clipboard; ignores records that do
    /// not exist.
    #[must_use]
    pub fn copy(&self, records: &[Address]) -> String {
        records.iter().filter_map(|record| Some(self.piece(record)?.listed(""))).collect()
    }

    /// The text of a record with its comments.
    fn piece(&self, record: &Address) -> Option<RecordText> {
        let (parent, list, index) = record.split()?;
        LayoutLines(self.text()).piece(list_of(parent.find(self.root())?, list)?, index)
    }

    /// As [`Document::copy`] without comments; a record beside a neighbour that is not copied gets a place of its
    /// own.
    fn placed_text(&self, records: &[Address], items: &[Item]) -> Result<String, EditRefusal> {
        let names: Vec<String> =
            records.iter().filter_map(|record| Some(quoted(self.id_of(record)?))).collect();
        let mut text = String::new();
        for record in records {
            let neighbour = NEIGHBOURS.iter().find_map(|side| self.written(record, side));
            let is_alone = neighbour.is_some_and(|id| !names.iter().any(|name| name == id));
            let item = items.iter().find(|item| item.record == *record).filter(|_| is_alone);
            let piece = match item {
                Some(item) => Some(placed_piece(self, item, place_of(self, item)?)?),
                None => self.piece(record),
            };
            text.push_str(&piece.map_or_else(String::new, |piece| RecordText::new(piece.text).listed("")));
        }
        Ok(text)
    }

    /// The edits that paste the records in `text` onto the page with index `page`, moved by `by` metres, and their
    /// future addresses: controls and grounds go onto the page, regions and places to stand into the layout.
    ///
    /// # Errors
    /// As [`Document::pasting`].
    pub fn pasting_on(
        &self,
        text: &str,
        page: usize,
        by: Vec2,
    ) -> Result<(Vec<Edit>, Vec<Address>), EditRefusal> {
        let pages = self.layout().pages.len();
        let on_page = if page < pages { Address::of(RecordList::Pages, page) } else { Address::LAYOUT };
        self.pasted(text, by, |record| match list_for(record) {
            list @ (RecordList::Widgets | RecordList::Grounds) => (on_page.clone(), list),
            list => (Address::LAYOUT, list),
        })
    }

    /// The edits that paste the records in `text` into `list` of `parent`, moved by `by` metres, and their future
    /// addresses.
    ///
    /// `text` comes from [`Document::copy`] or from a file: records with commas between them. Ids that are already in
    /// use get numbers.
    ///
    /// # Errors
    /// [`EditRefusal::NotARecord`], [`EditRefusal::TooLong`].
    pub fn pasting(
        &self,
        text: &str,
        parent: &Address,
        list: RecordList,
        by: Vec2,
    ) -> Result<(Vec<Edit>, Vec<Address>), EditRefusal> {
        self.pasted(text, by, |_| (parent.clone(), list))
    }

    /// As [`Document::pasting`], but `home` selects the list for each record.
    fn pasted(
        &self,
        text: &str,
        by: Vec2,
        home: impl Fn(&Outline) -> (Address, RecordList),
    ) -> Result<(Vec<Edit>, Vec<Address>), EditRefusal> {
        if text.len() > MAX_BYTES {
            return Err(EditRefusal::TooLong);
        }
        // A comment at the end of the text must not hide the bracket.
        let text = format!("[\n{}\n]", text.trim());
        let entries = Outline::parse(&text).ok_or(EditRefusal::NotARecord)?;
        let (mut pieces, mut ids) = (Vec::new(), Vec::new());
        for (number, element) in entries.elements.iter().enumerate() {
            if !super::change::is_record(&element.value) {
                return Err(EditRefusal::NotARecord);
            }
            let mut piece = LayoutLines(&text).piece(&entries, number).ok_or(EditRefusal::NotARecord)?;
            self.renew(&mut piece.text, by, &mut ids).ok_or(EditRefusal::NotARecord)?;
            pieces.push((piece, home(&element.value)));
        }
        let (mut edits, mut places) = (Vec::new(), Vec::<Address>::new());
        for (mut piece, (parent, list)) in pieces {
            piece.text = referring(&piece.text, &ids);
            let is_here = |place: &&Address| place.split().is_some_and(|it| (&it.0, it.1) == (&parent, list));
            let before = places.iter().filter(is_here).count();
            let at = parent.entry(list, self.count(&parent, list) + before);
            edits.push(Edit::Insert { at: at.clone(), text: piece.listed("") });
            places.push(at);
        }
        if edits.is_empty() { Err(EditRefusal::NotARecord) } else { Ok((edits, places)) }
    }

    /// Gives the record `text` and the records of its group free ids, and moves it; adds the old and new ids to `ids`.
    fn renew(&self, text: &mut String, by: Vec2, ids: &mut Vec<(String, String)>) -> Option<()> {
        let count = Address::all(&Outline::parse(text)?).len();
        for number in 0..count {
            let root = Outline::parse(text)?;
            let (_, record) = Address::all(&root).into_iter().nth(number)?;
            let Some(old) = record.field("id").and_then(|field| field.value.says.clone()) else { continue };
            let taken: Vec<String> = ids.iter().map(|(_, new)| new.clone()).collect();
            let new =
                if old.contains('{') { old.replacen('{', "copy_{", 1) } else { self.free_id(&old, &taken) };
            let splices = LayoutLines(text).set(record, &["id"], &quoted(&new));
            *text = spliced(text, splices);
            ids.push((old, new));
        }
        let root = Outline::parse(text)?;
        let numbers: Option<Vec<f64>> = root.field("at").map(|at| {
            let values = at.value.elements.iter();
            values.filter_map(|value| text.get(value.value.span.clone())?.trim().parse().ok()).collect()
        });
        if let Some([east, north]) = numbers.as_deref() {
            let by = by.as_dvec2() / self.unit_m();
            let value = pair(DVec2::new(*east, *north) + by).inline();
            *text = spliced(text, LayoutLines(text).set(&root, &["at"], &value));
        }
        Some(())
    }

    /// The edits that add a copy of each of `records`, without comments, at the end of its list, moved by `by`
    /// metres, and the future addresses of the copies.
    ///
    /// # Errors
    /// As [`Document::pasting`].
    pub fn duplicating(
        &self,
        records: &[Address],
        by: Vec2,
    ) -> Result<(Vec<Edit>, Vec<Address>), EditRefusal> {
        let mut lists: Vec<(Address, RecordList)> = Vec::new();
        for record in records {
            let home = record.split().map(|(parent, list, _)| (parent, list));
            lists.extend(home.filter(|home| !lists.contains(home)));
        }
        let items = self.items();
        let (mut edits, mut places) = (Vec::new(), Vec::new());
        for (parent, list) in lists {
            let is_here =
                |record: &&Address| record.split().is_some_and(|it| (&it.0, it.1) == (&parent, list));
            let own: Vec<Address> = records.iter().filter(is_here).cloned().collect();
            let (more, at) = self.pasting(&self.placed_text(&own, &items)?, &parent, list, by)?;
            edits.extend(more);
            places.extend(at);
        }
        Ok((edits, places))
    }

    /// The edits that delete `records` and their contents; the last of a list comes first, so that addresses stay
    /// valid.
    #[must_use]
    pub fn deleting(&self, records: &[Address]) -> Vec<Edit> {
        let records = last_first(records).into_iter();
        records.map(|record| Edit::Delete { record: record.clone() }).collect()
    }

    /// The edits that delete `records` with their comments, which [`Document::copy`] includes: for cutting.
    #[must_use]
    pub fn taking(&self, records: &[Address]) -> Vec<Edit> {
        let records = last_first(records).into_iter();
        records.map(|record| Edit::Take { record: record.clone() }).collect()
    }
}

/// The records outside all others of the list, the last one first.
fn last_first(records: &[Address]) -> Vec<&Address> {
    let is_inner = |one: &Address| records.iter().any(|other| other != one && one.is_within(other));
    let mut outer: Vec<&Address> = records.iter().filter(|one| !is_inner(one)).collect();
    outer.sort_unstable_by(|a, b| b.cmp(a));
    outer.dedup();
    outer
}

/// The list for a record, judging by its fields.
fn list_for(record: &Outline) -> RecordList {
    let has = |field: &str| record.field(field).is_some();
    match record.name.as_deref() {
        Some("Group") => RecordList::Widgets,
        Some(_) => RecordList::Grounds,
        None if has("kind") => RecordList::Widgets,
        None if has("widgets") || has("grounds") => RecordList::Pages,
        // A place to stand has no id, a region no label.
        None if has("id") => RecordList::Regions,
        None => RecordList::Stances,
    }
}
