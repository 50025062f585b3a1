//! Layouts as texts in a recording.

use crate::floor::Geometry;
use crate::layout::Layout;
use crate::schema::{self, Diagnostics};
use crate::source::log::read_layout;

/// The text of `layout`, and the layout that results from parsing it.
pub(super) fn as_kept(layout: &Layout, geometry: &Geometry) -> Result<(String, Layout), Diagnostics> {
    let text = schema::write_layout(layout);
    let layout = read_layout(&text, geometry)?;
    Ok((text, layout))
}
