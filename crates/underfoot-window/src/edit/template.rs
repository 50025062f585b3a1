//! Templates of layouts.

use underfoot::floor::Geometry;
use underfoot_format::text::RonText;

/// A template for a new layout on the given floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Template {
    /// A region and a place to stand.
    Empty,
    /// Four buttons in a row.
    FourButtons,
    /// Two pages and the buttons that switch them.
    TwoPages,
}

impl Template {
    /// All templates.
    pub const ALL: [Self; 3] = [Self::Empty, Self::FourButtons, Self::TwoPages];

    /// Its name for users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Empty => "Empty floor",
            Self::FourButtons => "Four buttons",
            Self::TwoPages => "Two pages",
        }
    }

    /// Its text on a floor of this `geometry`.
    #[must_use]
    pub fn text(self, geometry: &Geometry) -> String {
        let (columns, rows) = (geometry.columns(), geometry.rows());
        // People use a small floor from beside it.
        let has_stance = rows >= 3 && columns >= 2;
        // A free row keeps a foot that stands and one that works apart.
        let south = if has_stance { 1 + u16::from(rows > 3) } else { 0 };
        // Without one, a foot that stands at the edge of its zone reaches into the region.
        let cursor = if south == 1 { ", cursor: Working" } else { "" };
        let stance = match has_stance {
            true => format!(
                "    // Where people stand: a foot here works nothing.\n    \
                 stances: [(at: ({}, 0), size: (2, 1), label: \"Stand here\")],\n\n",
                plain(f64::from(columns) / 2.0 - 1.0)
            ),
            false => String::new(),
        };
        let north = f64::from(south) + 0.2;
        let button = |id: &str, label: &str, east: f64, more: &str| {
            format!(
                "(id: \"{id}\", kind: \"button\", at: ({}, {}), size: (0.6, 0.5), label: \"{label}\"{more}),\n",
                plain(east),
                plain(north)
            )
        };
        let middle = f64::from(columns) / 2.0;
        let (widgets, pages) = match self {
            Self::Empty => (String::new(), String::new()),
            Self::FourButtons => {
                let room = f64::from(columns).min(3.6) / 4.0;
                let east = |number: f64| middle + (number - 1.5) * room - 0.3;
                let labels = [("back", "Back"), ("up", "Up"), ("down", "Down"), ("next", "Next")];
                let rows = (0..4_u8).zip(labels).map(|(number, (id, label))| {
                    format!("        {}", button(id, label, east(f64::from(number)), ""))
                });
                (rows.collect(), String::new())
            }
            Self::TwoPages => {
                let page = |id: &str, title: &str, control: String| {
                    format!(
                        "        (id: \"{id}\", title: \"{title}\", widgets: [\n            {control}        ]),\n"
                    )
                };
                let more = button("more", "More", middle - 0.3, ", goto: \"settings\"");
                let back = button("back", "Back", middle - 0.3, ", goto: \"start\"");
                let pages = page("start", "Start", more) + &page("settings", "Settings", back);
                (
                    String::new(),
                    format!("\n    // Pages take turns on the floor.\n    pages: [\n{pages}    ],\n"),
                )
            }
        };
        format!(
            "// A layout for a floor of {columns} x {rows} tiles. Places and sizes are in tiles, `at` is a \
             south-west corner.\nLayout(\n    version: 1,\n    title: \"New layout\",\n\n    \
             // The active area: a foot that presses in it works its controls.\n    \
             regions: [(id: \"main\", at: (0, {south}), size: ({columns}, {}){cursor})],\n\n{stance}    \
             widgets: [\n{widgets}    ],\n{pages})\n",
            rows - south
        )
    }
}

fn plain(value: f64) -> String {
    RonText::double((value * 1e3).round() / 1e3).inline()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::edit::Document;
    use underfoot::floor::Floor;
    use underfoot::schema::Kinds;

    #[test]
    fn every_template_can_be_used_on_floors_of_any_size() {
        let kinds = Arc::new(Kinds::builtin());
        for (columns, rows) in [(6, 6), (4, 1), (3, 3), (24, 16), (5, 2)] {
            let floor = Floor::of(Geometry::of_paper_tiles(columns, rows).unwrap());
            for template in Template::ALL {
                let text = template.text(&floor.geometry);
                let read = Document::read("new.ron", &text, &kinds, &Arc::new(floor.clone()));
                let read = read.unwrap_or_else(|problems| panic!("{text}\n{problems}"));
                let warnings = read.warnings().to_string();
                assert!(read.warnings().is_empty() || warnings.contains("no controls"), "{warnings}");
            }
        }
    }
}
