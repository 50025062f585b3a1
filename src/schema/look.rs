use super::node::Node;
use super::problem::Problem;
use crate::layout::{Colour, Icon, Look, Shape};

/// The look of kinds that don't say: a calm grey blue.
pub(super) const PLAIN: Look = Look {
    shape: Shape::Box,
    face: Colour::rgb(0xdd, 0xe4, 0xec),
    lit: Colour::rgb(0x8f, 0xb6, 0xe0),
    ink: Colour::rgb(0x1f, 0x2a, 0x36),
    icon: None,
};

/// `base` with what is written.
pub(super) fn read_over(node: Node<'_>, base: Look) -> Option<Look> {
    let mut fields = node.fields("Look")?;
    let shape = fields
        .read("shape", Some(base.shape), |node| node.choice(&[("Box", Shape::Box), ("Round", Shape::Round)]));
    let face = fields.read("face", Some(base.face), colour);
    let lit = fields.read("lit", Some(base.lit), colour);
    let ink = fields.read("ink", Some(base.ink), colour);
    let icon = fields.read("icon", Some(base.icon), |node| {
        if node.is_none() { Some(None) } else { node.choice(&Icon::ALL).map(Some) }
    });
    fields.finish();
    Some(Look { shape: shape?, face: face?, lit: lit?, ink: ink?, icon: icon? })
}

pub(super) fn colour(node: Node<'_>) -> Option<Colour> {
    let text = node.text(64)?;
    if let Ok(colour) = text.parse() {
        return Some(colour);
    }
    let digits = text.trim().trim_start_matches('#');
    let help = match digits.len() {
        3 if is_hex(digits) => {
            let doubled: String = digits.chars().flat_map(|digit| [digit, digit]).collect();
            Some(format!("write all six digits: \"#{doubled}\""))
        }
        6 if is_hex(digits) => Some(format!("write \"#{digits}\"")),
        8 if is_hex(digits) => Some("colours are opaque: leave out the last two digits".to_owned()),
        _ => None,
    };
    let message = format!("`{}` must be a colour", node.what);
    let expected = "expected \"#rrggbb\" with six hexadecimal digits";
    node.report(Problem::error(node.span(), message).expected(expected).help_if(help));
    None
}

fn is_hex(digits: &str) -> bool {
    digits.bytes().all(|byte| byte.is_ascii_hexdigit())
}
