//! Patient and day of a series.

use dicom_dictionary_std::tags;

use super::attributes::Attributes;

/// Longest displayed name, in letters.
const LONGEST: usize = 64;

/// A line about a series: patient, number, day; empty if the file has none of them.
pub fn line(file: Attributes) -> String {
    let name = file.text(tags::PATIENT_NAME).and_then(|text| person(&text));
    let number = file.text(tags::PATIENT_ID);
    let days = [tags::STUDY_DATE, tags::SERIES_DATE, tags::ACQUISITION_DATE, tags::CONTENT_DATE];
    let day = days.into_iter().find_map(|tag| day(&file.text(tag)?));
    let parts = [name, number, day].into_iter().flatten().map(|part| clean(&part));
    parts.filter(|part| !part.is_empty()).collect::<Vec<_>>().join("   ")
}

/// The title of the series.
pub fn title(file: Attributes) -> String {
    let modality = file.text(tags::MODALITY).unwrap_or_default();
    let names = [tags::SERIES_DESCRIPTION, tags::STUDY_DESCRIPTION];
    let name = names.into_iter().find_map(|tag| file.text(tag)).unwrap_or_else(|| "Untitled".into());
    clean(&format!("{modality} {name}"))
}

/// A person's name for display: family name, given names. For a name in several scripts, the first non-empty one.
fn person(text: &str) -> Option<String> {
    let group = text.split('=').find(|group| group.chars().any(char::is_alphanumeric))?;
    let parts = group.split('^').map(str::trim).filter(|part| !part.is_empty());
    Some(parts.take(3).collect::<Vec<_>>().join(", "))
}

/// A day as `2024-05-17`; old files separate its parts by dots.
fn day(text: &str) -> Option<String> {
    let digits: String = text.chars().filter(char::is_ascii_digit).collect();
    let (year, month, day) = (digits.get(..4)?, digits.get(4..6)?, digits.get(6..8)?);
    Some(format!("{year}-{month}-{day}"))
}

/// The printable part of a text, without control and direction characters.
fn clean(text: &str) -> String {
    let is_shown = |sign: &char| {
        !sign.is_control()
            && !matches!(*sign, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let text: String = text.chars().filter(is_shown).take(LONGEST).collect();
    text.trim().to_owned()
}
