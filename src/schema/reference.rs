//! The reference of the format, made from the reader's own descriptions.

use std::fmt::Write;

use super::ground;
use super::send_codecs;
use super::suggest::did_you_mean;
use super::targets;
use crate::feel::{EffectKind, Feel, Manner};
use crate::layout::Look;
use crate::widget::Behaviour;
use underfoot_format::describe::{Description, FieldDescription};
use underfoot_format::{Record, Variants};

/// One kind of content of files, with all possible records.
#[derive(Clone, Debug)]
pub struct Chapter {
    /// Its name.
    pub name: &'static str,
    /// Its place in files.
    pub about: &'static str,
    /// Fields common to all records.
    pub common: Vec<FieldDescription>,
    /// The records, with their other fields.
    pub records: Vec<Description>,
}

impl Chapter {
    /// A chapter of these records; the fields that all of them have become common.
    #[must_use]
    pub fn new(name: &'static str, about: &'static str, mut records: Vec<Description>) -> Self {
        // Fields that all records share are listed once.
        let is_common = |field: &FieldDescription| {
            let has = |record: &Description| {
                record.fields.iter().any(|other| other.name == field.name && other.about == field.about)
            };
            records.len() > 1 && records.iter().all(has)
        };
        let common: Vec<FieldDescription> = records
            .iter()
            .take(1)
            .flat_map(|first| first.fields.iter().filter(|f| is_common(f)).cloned())
            .collect();
        for record in &mut records {
            record.fields.retain(|field| common.iter().all(|common| common.name != field.name));
        }
        Self { name, about, common, records }
    }
}

/// Returns the descriptions of layouts, kinds and effects.
#[must_use]
pub fn reference() -> Vec<Chapter> {
    let mut effects = Chapter::new(
        "effects",
        "A tactile effect: under a name in a file of `effects/` or in `effects` of a layout, or where it is played.",
        EffectKind::describe(),
    );
    effects.common.extend(Manner::describe().fields);
    vec![
        Chapter::new(
            "layouts",
            "A page of controls on a floor: a file in `layouts/`.",
            vec![super::layout_record::LayoutRecord::describe()],
        ),
        Chapter::new(
            "kinds",
            "Kinds of controls: files in `widgets/`, or `kinds` of a layout.",
            vec![super::kind::KindFile::describe()],
        ),
        Chapter::new(
            "controls",
            "Behaviour of a control: `behaviour` of a kind, its settings beside it; a widget overrides the fields that it writes.",
            Behaviour::describe(),
        ),
        Chapter::new("feel", "Haptics of a control: `feel` of a kind or widget.", vec![Feel::describe()]),
        Chapter::new("look", "Appearance of a control: `look` of a kind or widget.", vec![Look::describe()]),
        effects,
        Chapter::new(
            "messages",
            "Messages to other programs: in `send` of a kind or widget; their targets are in `targets` of the layout.",
            send_codecs::describe(),
        ),
        Chapter::new(
            "targets",
            "Programs and devices that messages go to: `to` of an entry in `targets` of the layout.",
            targets::describe(),
        ),
        Chapter::new(
            "grounds",
            "Material that the floor seems to be made of: in `grounds`, each with `at`, `size`, `seed`, `surface` and `deep`.",
            ground::describe(),
        ),
        Chapter::new(
            "floors",
            "A real or simulated floor: a file for `--floor`.",
            vec![super::floor::FloorFileRecord::describe()],
        ),
    ]
}

/// Writes `chapters` as Markdown: all of them, or only the chapter or record called `name`.
///
/// # Errors
/// Says that there is no such name, and suggests similar ones.
pub fn write_reference(chapters: &[Chapter], name: Option<&str>) -> Result<String, String> {
    let is_meant = |other: &str| name.is_none_or(|name| name.eq_ignore_ascii_case(other));
    let mut text = String::new();
    for chapter in chapters {
        let whole = is_meant(chapter.name);
        if whole {
            heading(&mut text, 2, chapter.name, chapter.about, &chapter.common);
        }
        for record in chapter.records.iter().filter(|record| whole || is_meant(record.name)) {
            heading(&mut text, 3, record.name, &record.about, &record.fields);
            parts(&mut text, chapters, record.name, &record.fields);
        }
        if whole {
            parts(&mut text, chapters, chapter.name, &chapter.common);
        }
    }
    if text.is_empty() {
        let names: Vec<&str> = chapters
            .iter()
            .flat_map(|chapter| [chapter.name].into_iter().chain(chapter.records.iter().map(|it| it.name)))
            .collect();
        let name = name.unwrap_or_default();
        let help = did_you_mean(name, &names, '`').unwrap_or_default();
        return Err(format!("nothing is called `{name}`; {help}"));
    }
    Ok(text)
}

/// Writes the records within `fields` of `owner`, recursively, except those with a chapter of their own.
fn parts(text: &mut String, chapters: &[Chapter], owner: &str, fields: &[FieldDescription]) {
    let is_told = |part: &Description| {
        let told = chapters.iter().flat_map(|chapter| &chapter.records);
        told.into_iter().any(|record| (record.name, &record.about) == (part.name, &part.about))
    };
    for field in fields {
        for part in field.shape.parts().iter().filter(|part| !part.fields.is_empty() && !is_told(part)) {
            let name = format!("{} of {owner}: {}", field.name, part.name);
            heading(text, 4, &name, &part.about, &part.fields);
            parts(text, chapters, part.name, &part.fields);
        }
    }
}

fn heading(text: &mut String, level: usize, name: &str, about: &str, fields: &[FieldDescription]) {
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{} {name}\n\n{}\n", "#".repeat(level), plain(about));
    for field in fields {
        let default = match &field.default {
            // Tables are too long to print.
            Some(default) if default == "()" || default.starts_with("[[") => String::new(),
            Some(default) => format!("; {default} where nothing is written"),
            None => "; must be written".to_owned(),
        };
        let _ = writeln!(
            text,
            "- `{}`: {}{default}. {}",
            field.name,
            field.shape.told(field.name),
            plain(&field.about)
        );
    }
    if !fields.is_empty() {
        text.push('\n');
    }
}

/// Removes the brackets of links, and the unit and range of values in code: files have their own, which the reference
/// lists with the field.
fn plain(about: &str) -> String {
    let mut text = about.replace("[`", "`").replace("`]", "`");
    for unit in UNITS {
        let Some(at) = text.find(unit) else { continue };
        let rest = &text[at + unit.len()..];
        let last = rest.strip_suffix('.').unwrap_or(rest).len();
        let end = rest.find(". ").unwrap_or(last);
        let clause = &rest[..end];
        let is_range =
            clause.starts_with("; ") && (clause.contains(" to ") || clause.contains(" in degrees"));
        let kept = if is_range { &rest[end..] } else { rest };
        text = format!("{}{kept}", &text[..at]);
    }
    text
}

/// Endings that give the unit of a value in code.
const UNITS: [&str; 6] =
    [", in seconds", ", in hertz", ", in metres", ", in degrees", ", in radians", ", in decibels"];
