//! Descriptions of records for people: the reference of the format, inspectors.

use super::number::plain;
use super::words::unit;

/// Description of one record.
#[derive(Clone, Debug)]
pub struct Description {
    /// Its name in files.
    pub name: &'static str,
    /// Its meaning.
    pub about: String,
    /// Its fields, in the order in which they are usually written.
    pub fields: Vec<FieldDescription>,
}

/// Description of one field of a record.
#[derive(Clone, Debug)]
pub struct FieldDescription {
    /// Its name in files.
    pub name: &'static str,
    /// Its meaning.
    pub about: String,
    /// The form of its value.
    pub shape: FieldType,
    /// Its default as a file would write it; `None` if the field must be written.
    pub default: Option<String>,
}

/// The form of a field's value.
#[derive(Clone, Debug)]
pub enum FieldType {
    /// A number.
    Number {
        /// Minimum and maximum.
        range: (f64, f64),
        /// Whether only whole numbers are valid.
        whole: bool,
    },
    /// `true` or `false`.
    Flag,
    /// Text in quotes; describes the valid texts.
    Text(String),
    /// One of these names.
    Names(Vec<&'static str>),
    /// Values in square brackets.
    List {
        /// Minimum and maximum number of values.
        count: (usize, usize),
        /// The form of each value.
        each: Box<FieldType>,
    },
    /// Two values in round brackets, such as `(low end, high end)`.
    Pair(&'static str, Box<FieldType>),
    /// The shape, or `None`.
    Optional(Box<FieldType>),
    /// Named fields in round brackets.
    Record(fn() -> Description),
    /// One of several names, with named fields in round brackets.
    Variants(fn() -> Vec<Description>),
    /// One of several names; the fields of the named record stand beside it.
    Beside(fn() -> Vec<Description>),
    /// A form described in words.
    Words(&'static str),
}

impl Description {
    /// Describes the record `name` by the lines of its documentation and by its `fields`.
    #[must_use]
    pub fn new(name: &'static str, about: &[&str], fields: Vec<FieldDescription>) -> Self {
        Self { name, about: first_paragraph(about), fields }
    }
}

/// Joins the lines of a documentation comment up to the first empty one.
pub fn first_paragraph(lines: &[&str]) -> String {
    let lines = lines.iter().map(|line| line.trim()).take_while(|line| !line.is_empty());
    lines.collect::<Vec<_>>().join(" ")
}

impl FieldType {
    /// Describes in words the value of the field called `name`; records by their names.
    #[must_use]
    pub fn told(&self, name: &str) -> String {
        match self {
            Self::Number { range: (low, high), whole } => {
                let noun = if *whole { "a whole number" } else { "a number" };
                let unit = if *whole { "" } else { unit(name) };
                format!("{noun} from {} to {}{unit}", plain(*low), plain(*high))
            }
            Self::Flag => "true or false".to_owned(),
            Self::Text(what) => what.clone(),
            Self::Names(names) => names.join(" | "),
            Self::List { count: (least, most), each } => {
                let count =
                    if *least == 0 { format!("at most {most}") } else { format!("{least} to {most}") };
                format!("a list of {count}, each {}", each.told(""))
            }
            Self::Pair(pattern, each) => format!("{pattern}, each {}", each.told(name)),
            Self::Optional(shape) => format!("{}, or None", shape.told(name)),
            Self::Record(describe) => format!("({}: ...)", describe().name),
            Self::Variants(describe) => {
                let all = describe();
                let names = all.iter().map(|variant| match variant.fields.as_slice() {
                    [] => variant.name.to_owned(),
                    _ => format!("{}(...)", variant.name),
                });
                names.collect::<Vec<_>>().join(" | ")
            }
            Self::Beside(describe) => {
                let names: Vec<&str> = describe().iter().map(|variant| variant.name).collect();
                format!("{}, its fields beside it", names.join(" | "))
            }
            Self::Words(words) => (*words).to_owned(),
        }
    }

    /// Returns the records that are part of this form.
    #[must_use]
    pub fn parts(&self) -> Vec<Description> {
        match self {
            Self::Record(describe) => vec![describe()],
            Self::Variants(describe) | Self::Beside(describe) => describe(),
            Self::List { each, .. } | Self::Pair(_, each) | Self::Optional(each) => each.parts(),
            Self::Number { .. } | Self::Flag | Self::Text(_) | Self::Names(_) | Self::Words(_) => Vec::new(),
        }
    }
}
