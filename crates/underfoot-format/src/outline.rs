//! Places of the values in a text, for editors that change a text in place and leave the rest as it is.

use std::ops::Range;

use ron2::ast::{Expr, StructBody, StructField};

use super::pairs::Limits;
use super::reader::bytes;
use super::syntax;

/// One value of a text and its place. Places count in bytes of the text without a byte-order mark.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Its bytes.
    pub span: Range<usize>,
    /// Its written form.
    pub shape: OutlineShape,
    /// The name before the brackets of a record.
    pub name: Option<String>,
    /// Bytes between its brackets; `None` without brackets.
    pub inside: Option<Range<usize>>,
    /// Fields of a record, entries of a list, values of a tuple.
    pub elements: Vec<Element>,
    /// The content of a text in quotes.
    pub says: Option<String>,
}

/// The written form of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutlineShape {
    /// Named fields in round brackets, or a name alone.
    Record,
    /// Values in square brackets.
    List,
    /// Values in round brackets.
    Tuple,
    /// A value that holds no other values.
    Leaf,
}

/// A field of a record, an entry of a list or a value of a tuple.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The name of a field, and where it is written.
    pub field: Option<(String, Range<usize>)>,
    /// The value.
    pub value: Outline,
    /// The comma behind it, if there is one.
    pub comma: Option<Range<usize>>,
}

impl Element {
    fn new(value: &Expr<'_>, comma: Option<&ron2::Span>) -> Self {
        Self { field: None, value: Outline::of(value), comma: comma.map(bytes) }
    }

    /// Returns the start of the element; that of a field is the start of its name.
    pub fn start(&self) -> usize {
        self.field.as_ref().map_or(self.value.span.start, |(_, at)| at.start)
    }

    /// Returns the end of the element, its comma included.
    pub fn end(&self) -> usize {
        self.comma.as_ref().map_or(self.value.span.end, |comma| comma.end)
    }
}

impl Outline {
    /// Parses `text` into its outline; `None` if it is not RON.
    pub fn parse(text: &str) -> Option<Self> {
        let syntax = syntax::parse(text, "value", Limits::LAYOUT);
        let whole = syntax.holes.is_empty();
        syntax.root.filter(|_| whole).map(|root| Self::of(&root))
    }

    fn of(expr: &Expr<'_>) -> Self {
        let span = bytes(expr.span());
        let between = |open: &ron2::Span, close: &ron2::Span| Some(open.end_offset..close.start_offset);
        let outline = |shape, name, inside, elements| Self {
            span: span.clone(),
            shape,
            name,
            inside,
            elements,
            says: None,
        };
        let fields = |fields: &[StructField<'_>]| {
            let element = |field: &StructField<'_>| Element {
                field: Some((field.name.name.to_string(), bytes(&field.name.span))),
                ..Element::new(&field.value, field.comma.as_ref())
            };
            fields.iter().map(element).collect::<Vec<_>>()
        };
        match expr {
            Expr::Option(option) => match &option.value {
                Some(some) => Self::of(&some.expr),
                None => outline(OutlineShape::Leaf, None, None, Vec::new()),
            },
            Expr::Unit(_) => {
                outline(OutlineShape::Record, None, Some(span.start + 1..span.end - 1), Vec::new())
            }
            Expr::AnonStruct(node) => outline(
                OutlineShape::Record,
                None,
                between(&node.open_paren, &node.close_paren),
                fields(&node.fields),
            ),
            Expr::Struct(node) => {
                let name = Some(node.name.name.to_string());
                let (inside, elements) = match &node.body {
                    None => (None, Vec::new()),
                    Some(StructBody::Fields(body)) => {
                        (between(&body.open_brace, &body.close_brace), fields(&body.fields))
                    }
                    Some(StructBody::Tuple(body)) => {
                        let elements = body.elements.iter();
                        let elements = elements.map(|one| Element::new(&one.expr, one.comma.as_ref()));
                        (between(&body.open_paren, &body.close_paren), elements.collect())
                    }
                };
                outline(OutlineShape::Record, name, inside, elements)
            }
            Expr::Seq(node) => {
                let elements = node.items.iter().map(|one| Element::new(&one.expr, one.comma.as_ref()));
                let inside = between(&node.open_bracket, &node.close_bracket);
                outline(OutlineShape::List, None, inside, elements.collect())
            }
            Expr::Tuple(node) => {
                let elements = node.elements.iter().map(|one| Element::new(&one.expr, one.comma.as_ref()));
                let inside = between(&node.open_paren, &node.close_paren);
                outline(OutlineShape::Tuple, None, inside, elements.collect())
            }
            Expr::String(text) => {
                Self { says: Some(text.value.clone()), ..outline(OutlineShape::Leaf, None, None, Vec::new()) }
            }
            _ => outline(OutlineShape::Leaf, None, None, Vec::new()),
        }
    }

    /// Returns the field called `name`.
    pub fn field(&self, name: &str) -> Option<&Element> {
        let is_called = |element: &&Element| element.field.as_ref().is_some_and(|(own, _)| own == name);
        self.elements.iter().find(is_called)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_found_where_it_is_written() {
        let text = "Layout(a: [(id: \"x\", at: (1, 2.5)), Snow], b: Some(3), // end\n c: ())";
        let root = Outline::parse(text).unwrap();
        let of = |outline: &Outline| text[outline.span.clone()].to_owned();
        assert_eq!(root.name.as_deref(), Some("Layout"));
        let list = &root.field("a").unwrap().value;
        assert_eq!(list.shape, OutlineShape::List);
        let control = &list.elements[0].value;
        assert_eq!(of(control), "(id: \"x\", at: (1, 2.5))");
        assert_eq!(control.field("id").unwrap().value.says.as_deref(), Some("x"));
        assert_eq!(of(&control.field("at").unwrap().value.elements[1].value), "2.5");
        assert_eq!((of(&list.elements[1].value).as_str(), list.elements[1].comma.clone()), ("Snow", None));
        assert_eq!(of(&root.field("b").unwrap().value), "3");
        assert_eq!(root.field("c").unwrap().value.inside.clone().map(|inside| inside.len()), Some(0));
        assert_eq!(Outline::parse("(a: [)"), None);
    }
}
