//! The attributes of a file's pictures: of all of them, or of one frame.

use dicom_core::Tag;
use dicom_core::value::Value;
use dicom_dictionary_std::tags;
use dicom_object::InMemDicomObject;
use dicom_object::mem::InMemElement;

use super::guard::Encoding;
use super::unfit::{Unfit, chain};

/// The elements of a file, or of an item in it.
#[derive(Clone, Copy, Debug)]
pub struct Attributes<'a>(&'a InMemDicomObject);

/// Reads the elements that a [guard](super::guard) has let pass.
///
/// # Errors
/// They are contradictory.
pub fn parse(known: &[u8], encoding: Encoding) -> Result<InMemDicomObject, Unfit> {
    let read = InMemDicomObject::read_dataset_with_ts(known, &encoding.transfer_syntax());
    read.map_err(|error| Unfit::Damaged(chain(&error)))
}

impl<'a> Attributes<'a> {
    pub fn of(object: &'a InMemDicomObject) -> Self {
        Self(object)
    }

    fn element(self, tag: Tag) -> Option<&'a InMemElement> {
        self.0.get(tag)
    }

    pub fn has(self, tag: Tag) -> bool {
        self.element(tag).is_some()
    }

    /// A text without blanks around it; `None` if it is empty.
    pub fn text(self, tag: Tag) -> Option<String> {
        let text = self.element(tag)?.to_str().ok()?;
        let text = text.trim_matches(|sign: char| sign.is_whitespace() || sign == '\0').to_owned();
        (!text.is_empty()).then_some(text)
    }

    /// Numbers, if all of them are finite.
    pub fn numbers(self, tag: Tag) -> Option<Vec<f64>> {
        let numbers = self.element(tag)?.to_multi_float64().ok()?;
        (!numbers.is_empty() && numbers.iter().all(|number| number.is_finite())).then_some(numbers)
    }

    pub fn number(self, tag: Tag) -> Option<f64> {
        self.numbers(tag)?.first().copied()
    }

    /// A count.
    pub fn count(self, tag: Tag) -> Option<usize> {
        let number = self.number(tag)?;
        // No count here exceeds 32 bits.
        (0.0..=f64::from(u32::MAX)).contains(&number).then_some(number as usize)
    }

    /// Words of 16 bits.
    pub fn words(self, tag: Tag) -> Option<Vec<u16>> {
        self.element(tag)?.to_multi_int::<u16>().ok()
    }

    /// The items of a sequence.
    pub fn items(self, tag: Tag) -> &'a [InMemDicomObject] {
        match self.element(tag).map(InMemElement::value) {
            Some(Value::Sequence(sequence)) => sequence.items(),
            _ => &[],
        }
    }

    pub fn item(self, tag: Tag, index: usize) -> Option<Self> {
        self.items(tag).get(index).map(Self)
    }

    /// The places that describe a frame: its own group of the macro `group`, the shared one, the file itself.
    pub fn of_frame(self, frame: usize, group: Tag) -> impl Iterator<Item = Self> {
        let own = self.item(tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE, frame);
        let shared = self.item(tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, 0);
        let groups = [own, shared].into_iter().flatten().filter_map(move |all| all.item(group, 0));
        groups.chain(std::iter::once(self))
    }

    /// Offsets of frames among pieces of pixels, if the file has a table of its own for them.
    pub fn offsets(self) -> Vec<u64> {
        self.element(tags::EXTENDED_OFFSET_TABLE)
            .and_then(|element| element.to_multi_int().ok())
            .unwrap_or_default()
    }
}
