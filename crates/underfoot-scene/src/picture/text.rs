//! Lines of text in an SVG document: as outlines, so that they look the same in every viewer.

use std::fmt::{self, Write};
use std::sync::Arc;

use glam::Vec2;
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree, WriteOptions};

use crate::letters::{OutlineStep, Sign};

/// The placement of a line on the page, in the page's units with y downwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinePlacing {
    /// The start of its base line.
    pub(super) start: Vec2,
    /// The length of an em.
    pub(super) em: f32,
}

impl LinePlacing {
    fn place(self, point: Vec2) -> Vec2 {
        self.start + Vec2::new(point.x, -point.y) * self.em
    }

    /// Appends one step of a path in the syntax of the attribute `d`.
    pub(super) fn step(self, out: &mut String, step: OutlineStep) -> fmt::Result {
        let (letter, points) = match step {
            OutlineStep::Move(to) => ('M', [Some(to), None, None]),
            OutlineStep::Line(to) => ('L', [Some(to), None, None]),
            OutlineStep::Quadratic(by, to) => ('Q', [Some(by), Some(to), None]),
            OutlineStep::Cubic(by, then, to) => ('C', [Some(by), Some(then), Some(to)]),
            OutlineStep::Close => ('Z', [None; 3]),
        };
        out.write_char(letter)?;
        for (number, point) in points.into_iter().flatten().enumerate() {
            let at = self.place(point);
            write!(out, "{}{:.2} {:.2}", if number == 0 { "" } else { " " }, at.x, at.y)?;
        }
        Ok(())
    }

    /// Appends a sign with its own colours as an element; nothing if it cannot be drawn. `number` makes the names
    /// inside unique among signs.
    pub(super) fn sign(self, out: &mut String, sign: &Sign, number: usize) -> fmt::Result {
        let Some(drawn) = drawn(sign, number) else { return Ok(()) };
        // The drawing is 3 em wide and high, and the sign starts in its middle.
        let corner = self.place(sign.at) - Vec2::splat(1.5 * self.em);
        let head = format!(
            "<svg xmlns:xlink=\"http://www.w3.org/1999/xlink\" x=\"{:.2}\" y=\"{:.2}\"",
            corner.x, corner.y
        );
        let size = format!(" width=\"{0:.2}\" height=\"{0:.2}\" viewBox=\"0 0 3 3\"", 3.0 * self.em);
        let inside = drawn.split_once('>').map(|(_, inside)| inside).unwrap_or_default();
        writeln!(out, "{head}{size}>{}", inside.trim())
    }
}

/// The sign as a separate document, with one unit per em.
fn drawn(sign: &Sign, number: usize) -> Option<String> {
    let mut fonts = Database::new();
    let (file, index) = sign.font();
    let loaded = fonts.load_font_source(Source::Binary(Arc::new(Bytes(file))));
    let family = loaded.get(index as usize).or(loaded.first()).and_then(|id| fonts.face(*id))?;
    let family = family.families.first()?.0.clone();
    let mut text = String::new();
    escape(&mut text, &sign.text).ok()?;
    // A font's bitmaps are some hundred pixels high; for very small letters usvg would choose the smallest ones.
    let page = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"3\" height=\"3\" viewBox=\"0 0 300 300\">\
         <text x=\"150\" y=\"150\" font-size=\"100\" font-family=\"'{family}'\">{text}</text></svg>"
    );
    let options = Options { fontdb: Arc::new(fonts), font_family: family, ..Options::default() };
    let tree = Tree::from_str(&page, &options).ok()?;
    let id_prefix = Some(format!("sign{number}-"));
    Some(tree.to_string(&WriteOptions { id_prefix, ..WriteOptions::default() }))
}

/// A font's file, in the form for the font database.
struct Bytes(Arc<dyn AsRef<[u8]> + Send + Sync>);

impl AsRef<[u8]> for Bytes {
    fn as_ref(&self) -> &[u8] {
        (*self.0).as_ref()
    }
}

/// Appends `text` with the special characters of XML escaped.
pub(super) fn escape(out: &mut String, text: &str) -> fmt::Result {
    for letter in text.chars() {
        match letter {
            '&' => out.write_str("&amp;")?,
            '<' => out.write_str("&lt;")?,
            '>' => out.write_str("&gt;")?,
            '"' => out.write_str("&quot;")?,
            other => out.write_char(other)?,
        }
    }
    Ok(())
}
