//! Layouts as texts in a recording.

use crate::floor::Geometry;
use crate::layout::Layout;
use crate::schema::{self, Diagnostics, Kinds};

/// The text of `layout`, and the layout that results from parsing it.
#[cfg(feature = "record")]
pub(super) fn as_kept(layout: &Layout, geometry: &Geometry) -> Result<(String, Layout), Diagnostics> {
    let text = schema::write_layout(layout);
    let layout = read_layout(&text, geometry)?;
    Ok((text, layout))
}

/// The layout in a text of a recording.
pub(crate) fn read_layout(text: &str, geometry: &Geometry) -> Result<Layout, Diagnostics> {
    Ok(schema::parse_layout(text, super::LAYOUT, &Kinds::builtin(), geometry)?.layout)
}
