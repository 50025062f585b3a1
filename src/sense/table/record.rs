//! One line of a table as fields.

/// The fields of one line.
#[derive(Clone, Debug, Default)]
pub(super) struct LineFields {
    bytes: Vec<u8>,
    ends: Vec<usize>,
}

/// Splits lines into fields. Each line is independent: a quotation mark that is never closed ends with it.
#[derive(Debug)]
pub(super) struct Splitter {
    reader: csv_core::Reader,
    separator: u8,
    line: Vec<u8>,
}

impl Splitter {
    pub(super) fn new(separator: u8) -> Self {
        let reader = csv_core::ReaderBuilder::new().delimiter(separator).build();
        Self { reader, separator, line: Vec::new() }
    }

    /// The character between fields.
    pub(super) const fn separator(&self) -> u8 {
        self.separator
    }

    /// Splits `line`, which holds no line end, into `record`. A blank line has no fields.
    pub(super) fn split(&mut self, line: &[u8], record: &mut LineFields) {
        self.line.clear();
        self.line.extend_from_slice(line);
        self.line.push(b'\n');
        // Fields are never longer than their text, and there is one more than separators.
        let most = 1 + line.iter().filter(|byte| **byte == self.separator).count();
        record.bytes.clear();
        record.bytes.resize(self.line.len(), 0);
        record.ends.clear();
        record.ends.resize(most, 0);
        self.reader.reset();
        let (mut read, mut written, mut fields) = (0, 0, 0);
        loop {
            let rest = self.line.get(read..).unwrap_or_default();
            let bytes = record.bytes.get_mut(written..).unwrap_or_default();
            let ends = record.ends.get_mut(fields..).unwrap_or_default();
            let (result, took, wrote, ended) = self.reader.read_record(rest, bytes, ends);
            (read, written, fields) = (read + took, written + wrote, fields + ended);
            // An open field ends with the line: the reader asks for more input and receives none.
            if !matches!(result, csv_core::ReadRecordResult::InputEmpty) {
                break;
            }
        }
        record.bytes.truncate(written);
        record.ends.truncate(fields);
    }
}

impl LineFields {
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn get(&self, index: usize) -> Option<&[u8]> {
        let begin = match index.checked_sub(1) {
            Some(before) => *self.ends.get(before)?,
            None => 0,
        };
        self.bytes.get(begin..*self.ends.get(index)?)
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.len()).filter_map(|index| self.get(index))
    }

    /// Number of fields up to the last that is not empty.
    pub(super) fn filled(&self) -> usize {
        (1..=self.len())
            .rev()
            .find(|count| self.get(count - 1).is_some_and(|field| !field.trim_ascii().is_empty()))
            .unwrap_or(0)
    }
}
