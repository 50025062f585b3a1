//! Descriptions of an unexpected value, and advice on how to correct it.

use ron2::ast::Expr;

use super::number::parse_number;

/// Expected form where a `Name(field: value, ...)` should stand.
pub(crate) const NAMED_FIELDS: &str = "named fields in round brackets";

/// Describes the value found, in the words of layout authors.
pub(crate) fn describe(expr: &Expr<'_>) -> String {
    match expr {
        Expr::Unit(_) => "empty brackets".into(),
        Expr::Bool(flag) => flag.value.to_string(),
        Expr::Number(_) => "a number".into(),
        Expr::String(_) => "text".into(),
        Expr::Char(_) | Expr::Byte(_) | Expr::Bytes(_) => "something else in quotes".into(),
        Expr::Option(_) => "None".into(),
        Expr::Seq(_) => "a list".into(),
        Expr::Map(_) => "curly brackets".into(),
        Expr::Tuple(tuple) if tuple.elements.len() == 1 => "one value in round brackets".into(),
        Expr::Tuple(tuple) => format!("{} values in round brackets", tuple.elements.len()),
        Expr::AnonStruct(_) => "fields in round brackets".into(),
        Expr::Struct(node) if node.body.is_none() => format!("the name {}", node.name.name),
        Expr::Struct(node) => format!("{}(...)", node.name.name),
        Expr::Error(_) => "an error".into(),
    }
}

/// Advice on how to turn the value found into the expected one, where that is clear.
pub(crate) fn remedy(found: &Expr<'_>, expected: &str) -> Option<String> {
    match found {
        Expr::String(text) if expected == "a number" && parse_number(&text.value).is_ok() => {
            Some(format!("numbers stand without quotes: {}", text.value))
        }
        Expr::String(text) if expected == "true or false" => truth(&text.value),
        Expr::Struct(node) if expected == "true or false" => truth(&node.name.name),
        Expr::Number(number) if expected == "true or false" => truth(&number.raw),
        Expr::String(text) if expected.contains(" or ") || expected.starts_with("one of ") => {
            Some(format!("names stand without quotes: {}", text.value))
        }
        Expr::Struct(node) if expected == "text" && node.body.is_none() => {
            Some(format!("text stands in quotes: \"{}\"", node.name.name))
        }
        Expr::Number(number) if expected == "text" => {
            Some(format!("text stands in quotes: \"{}\"", number.raw))
        }
        Expr::AnonStruct(_) | Expr::Tuple(_) | Expr::Unit(_) if expected == "a list" => {
            Some("lists stand in square brackets: [ ... ]".into())
        }
        Expr::Seq(list) if expected.starts_with('(') && list.items.len() == 2 => {
            Some("places and sizes stand in round brackets: (2, 3)".into())
        }
        Expr::AnonStruct(_) if expected.starts_with('(') => Some("leave out the names: (2, 3)".into()),
        Expr::Number(number) if expected.starts_with('(') => {
            Some(format!("write both: ({0}, {0})", number.raw))
        }
        Expr::Tuple(_) if expected == NAMED_FIELDS => {
            Some("each value needs its name: (id: \"home\", at: (1, 2))".into())
        }
        _ => None,
    }
}

/// The boolean that a word stands for.
fn truth(word: &str) -> Option<String> {
    match word.to_lowercase().as_str() {
        "true" | "on" | "yes" | "1" => Some("write true".into()),
        "false" | "off" | "no" | "0" => Some("write false".into()),
        _ => None,
    }
}
