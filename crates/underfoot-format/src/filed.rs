//! Values of files for apps: serde's traits, so that `ron` reads and writes them.

use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, Error};

use super::diagnostic::Diagnostics;
use super::pairs::Limits;
use super::reader::Reader;
use super::record::Record;
use super::source::Source;
use super::text::RonText;

/// A value that files hold and that can be read alone.
///
/// [`filed!`](crate::filed!) derives serde's traits from this one. `Serialize` passes on the written form: names and
/// units of the file format, and only the fields that differ from their defaults. `Deserialize` works with `ron`
/// alone: it takes the RON text of the value and gives it to the reader of files. So an app may read a file by `ron`,
/// also within a record of its own, and gets the ranges, defaults and messages of every other reading; a value of
/// another format has no text with places to report.
pub trait Filed: Sized {
    /// Returns the value as files hold it.
    fn written(&self) -> RonText;

    /// Reads the value from `text`.
    ///
    /// # Errors
    /// Every problem of the text.
    fn read(text: &str) -> Result<Self, Diagnostics>;
}

/// Reads the record that `text` holds; `context` holds the values that the text may refer to.
///
/// # Errors
/// Every problem of the text.
pub fn read_record<T: Record>(text: &str, context: &T::Context) -> Result<T, Diagnostics> {
    let source = Source::new(T::NAME, text)?;
    let reader = Reader::new(&source, T::NAME, Limits::LAYOUT);
    let record = reader.root(T::NAME).and_then(|node| node.record(None, context));
    reader.conclude(record).map(|(record, _)| record)
}

/// Reads a value as [`Filed::read`] does, from the text that `deserializer` has for it.
///
/// # Errors
/// Every problem of the text, in one message; for a deserializer other than that of `ron`, that there is no such
/// text.
pub fn deserialize<'de, T: Filed, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let text = Box::<RawValue>::deserialize(deserializer)?;
    T::read(text.get_ron()).map_err(D::Error::custom)
}

/// Implements serde's traits for types that are [`Filed`].
#[macro_export]
macro_rules! filed {
    ($($Type:ty),* $(,)?) => {$(
        impl $crate::serde::Serialize for $Type {
            fn serialize<S: $crate::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $crate::serde::Serialize::serialize(&$crate::filed::Filed::written(self), serializer)
            }
        }

        impl<'de> $crate::serde::Deserialize<'de> for $Type {
            fn deserialize<D: $crate::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::filed::deserialize(deserializer)
            }
        }
    )*};
}

#[cfg(test)]
mod tests {
    use ron::ser::PrettyConfig;

    use super::*;
    use crate::codec::{Codec, Name, Named, Opt, Rec, Text, list, num};
    use crate::record;

    record! {
        /// A shelf.
        struct Shelf = "Shelf";
        /// Its title.
        title: String = "title", Text(20);
        /// Its width.
        width_s: f32 = "width_ms", num(1.0..=100.0).milli() => 0.01;
        /// Its side.
        side: Option<Side> = "side", Opt(Name) => None;
        /// Its books.
        books: Vec<Book> = "books", list("book", 3, Rec) => Vec::new();
    }

    record! {
        /// A book.
        struct Book = "Book", Copy;
        /// Its pages.
        pages: u32 = "pages", num(1.0..=5000.0);
    }

    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Side {
        Left,
        Right,
    }

    impl Named for Side {
        const ALL: &'static [(&'static str, Self)] = &[("Left", Self::Left), ("Right", Self::Right)];
    }

    impl Filed for Shelf {
        fn written(&self) -> RonText {
            Rec.write(self)
        }

        fn read(text: &str) -> Result<Self, Diagnostics> {
            read_record(text, &())
        }
    }

    filed!(Shelf);

    fn shelf() -> Shelf {
        let books = vec![Book { pages: 120 }, Book { pages: 7 }];
        Shelf { title: "it's \"mine\"".into(), width_s: 0.0125, side: Some(Side::Right), books }
    }

    #[test]
    fn what_ron_writes_the_reader_reads_and_the_other_way_round() {
        let plain = Shelf { title: String::new(), width_s: 0.01, side: None, books: Vec::new() };
        for shelf in [shelf(), Shelf { side: Some(Side::Left), ..shelf() }, plain] {
            let styles = [PrettyConfig::new(), PrettyConfig::new().struct_names(true)];
            let pretty = styles.map(|style| ron::ser::to_string_pretty(&shelf, style).unwrap());
            for text in [ron::to_string(&shelf).unwrap(), shelf.written().inline()].iter().chain(&pretty) {
                assert_eq!(Shelf::read(text).as_ref(), Ok(&shelf), "{text}");
                assert_eq!(ron::from_str::<Shelf>(text).as_ref(), Ok(&shelf), "{text}");
            }
        }
        let json =
            r#"{"title":"it's \"mine\"","width_ms":12.5,"side":"Right","books":[{"pages":120},{"pages":7}]}"#;
        assert_eq!(serde_json::to_string(&shelf()).unwrap(), json);
    }

    #[test]
    fn a_value_stands_within_others_and_every_problem_is_told() {
        let text = "[Some((title: \"a\", /* wide */ width_ms: 20)), None]";
        let shelves: Vec<Option<Shelf>> = ron::from_str(text).unwrap();
        assert_eq!(shelves.first().and_then(|shelf| Some(shelf.as_ref()?.width_s)), Some(0.02));
        let problems = ron::from_str::<Shelf>("(width_ms: 500, syde: Left)").unwrap_err().to_string();
        for message in ["this shelf lacks `title`", "`width_ms` is out of range", "did you mean `side`?"] {
            assert!(problems.contains(message), "{problems}");
        }
    }
}
