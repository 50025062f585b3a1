//! Writing of layouts made in code.

use super::layout_record::LayoutRecord;
use super::send;
use super::send_contacts;
use super::targets;
use super::units::Units;
use super::version::{FIRST_VERSION, WITH_MESSAGES, version_with};
use crate::floor::Rect;
use crate::ground::GroundMaterial;
use crate::layout::{Ground, HEX, Layout, Widget};
use underfoot_format::text::{Entry, Text};
use underfoot_format::{Codec, Name, Rec, Record, Variants};

/// Writes the file that describes `layout`, in metres; [`super::parse_layout`] reads it.
///
/// The version is the lowest one that holds the layout. Places are rounded to a ten thousandth of a millimetre. Behaviour, feel and look of widgets are written once, in
/// kinds of the layout's own. Reading puts the controls of all pages before those of the first page and so on, each
/// group in its order here.
#[must_use]
pub fn write_layout(layout: &Layout) -> String {
    format!("{}\n", Text::Variant(LayoutRecord::NAME, written(layout)).lay_out(0, 0))
}

/// Returns the fields of the file that describes `layout`.
pub(super) fn written(layout: &Layout) -> Vec<Entry> {
    let mut kinds: Vec<(String, &Widget)> = Vec::new();
    let names: Vec<String> = layout.widgets.iter().map(|widget| kind_of(widget, &mut kinds)).collect();
    let kinds = kinds.iter().map(|(name, widget)| {
        let mut entries = vec![("name", quoted(name)), ("behaviour", Text::Name(widget.behaviour.variant()))];
        widget.behaviour.write_fields(&mut entries);
        entries.push(("feel", Rec.write(&widget.feel)));
        entries.push(("look", Rec.write(&widget.look)));
        Text::Record("Kind", entries)
    });
    let regions = layout.regions.iter().map(|region| {
        let mut entries = vec![("id", quoted(&region.id))];
        place(region.area, &mut entries);
        entries.push(("cursor", Name.write(&region.cursor)));
        if !region.send.is_empty() {
            entries.push(("send", send_contacts::write_all(&region.send)));
        }
        Text::Record("Region", entries)
    });
    let stances = layout.stances.iter().map(|stance| {
        let mut entries = vec![("label", quoted(&stance.label))];
        place(stance.area, &mut entries);
        Text::Record("Stance", entries)
    });
    let sends = !layout.targets.is_empty() || layout.sends();
    let least = if sends { WITH_MESSAGES } else { FIRST_VERSION };
    let of_targets = layout.targets.iter().map(|target| version_with(target.to.sort()));
    let version = of_targets.max().map_or(least, |newest| newest.max(least));
    let mut entries = vec![
        ("version", Text::Whole(version.into())),
        ("units", Name.write(&Units::Metres)),
        ("title", quoted(&layout.title)),
        ("regions", Text::List(regions.collect())),
        ("stances", Text::List(stances.collect())),
        ("targets", targets::write_all(&layout.targets)),
        ("kinds", Text::List(kinds.collect())),
    ];
    of_page(layout, &names, None, &mut entries);
    let pages = layout.pages.iter().enumerate().map(|(number, page)| {
        let mut entries = vec![("id", quoted(page.id.as_str())), ("title", quoted(&page.title))];
        of_page(layout, &names, Some(number), &mut entries);
        Text::Record("Page", entries)
    });
    entries.push(("pages", Text::List(pages.collect())));
    entries.retain(|(_, value)| *value != Text::List(Vec::new()));
    entries
}

/// Returns the name of the kind of `widget` in `kinds`; adds the kind if there is none.
fn kind_of<'l>(widget: &'l Widget, kinds: &mut Vec<(String, &'l Widget)>) -> String {
    let is_like = |other: &Widget| {
        (&other.behaviour, &other.feel, &other.look) == (&widget.behaviour, &widget.feel, &widget.look)
    };
    if let Some((name, _)) = kinds.iter().find(|(_, other)| other.kind == widget.kind && is_like(other)) {
        return name.clone();
    }
    let is_free = |name: &String| kinds.iter().all(|(known, _)| known != name);
    let numbered = (2..).map(|number| format!("{}_{number}", widget.kind));
    let name = std::iter::once(widget.kind.clone()).chain(numbered).find(is_free).unwrap_or_default();
    kinds.push((name.clone(), widget));
    name
}

/// Writes the controls and grounds of one page, or those on all pages.
fn of_page(layout: &Layout, kinds: &[String], page: Option<usize>, entries: &mut Vec<Entry>) {
    let widgets = layout.widgets.iter().zip(kinds).filter(|(widget, _)| widget.page == page);
    let widgets = widgets.map(|(widget, kind)| {
        let mut entries = vec![("id", quoted(widget.id.as_str())), ("kind", quoted(kind))];
        place(widget.area, &mut entries);
        if !widget.label.is_empty() {
            entries.push(("label", quoted(&widget.label)));
        }
        if let Some(page) = widget.goto.and_then(|goto| layout.pages.get(goto)) {
            entries.push(("goto", quoted(page.id.as_str())));
        }
        if !widget.send.is_empty() {
            entries.push(("send", send::write_all(&widget.send)));
        }
        Text::Record("Widget", entries)
    });
    entries.push(("widgets", Text::List(widgets.collect())));
    let grounds = layout.grounds.iter().filter(|ground| ground.spec.page == page).map(ground);
    entries.push(("grounds", Text::List(grounds.collect())));
}

fn ground(ground: &Ground) -> Text {
    let mut entries = Vec::new();
    place(ground.spec.area, &mut entries);
    entries.push(("seed", Text::Whole(ground.spec.seed.into())));
    entries.push(("surface", HEX.write(&ground.surface)));
    entries.push(("deep", HEX.write(&ground.deep)));
    match &ground.spec.material {
        GroundMaterial::Ice(spec) => spec.write_fields(&mut entries),
        GroundMaterial::Grain(spec) => spec.write_fields(&mut entries),
        GroundMaterial::Wood(spec) => spec.write_fields(&mut entries),
    }
    Text::Variant(ground.spec.material.name(), entries)
}

fn place(area: Rect, entries: &mut Vec<Entry>) {
    let rounded = |metres: f64| (metres * 1e7).round() / 1e7;
    let [min, max] = [area.min, area.max].map(|corner| corner.as_dvec2());
    let pair = |x: f64, y: f64| Text::pair([rounded(x), rounded(y)]);
    entries.push(("at", pair(min.x, min.y)));
    entries.push(("size", pair(max.x - min.x, max.y - min.y)));
}

fn quoted(text: &str) -> Text {
    Text::quoted(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;
    use crate::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};

    #[test]
    fn every_shipped_layout_is_written_and_read_again() {
        for name in builtin_layouts() {
            let read = |text: &str| {
                let kinds = Kinds::builtin();
                let loaded = parse_layout(text, name, &kinds, &Geometry::default());
                loaded.unwrap_or_else(|problems| panic!("{text}\n{problems}")).layout
            };
            let layout = read(builtin_layout(name).unwrap());
            let mut again = read(&write_layout(&layout));
            assert_eq!(again.widgets.len(), layout.widgets.len(), "{name}");
            let near = |a: Rect, b: Rect| {
                (a.min - b.min).abs().max_element() < 1e-6 && (a.max - b.max).abs().max_element() < 1e-6
            };
            for (again, before) in again.widgets.iter_mut().zip(&layout.widgets) {
                assert!(near(again.area, before.area), "{name}: {}", before.id);
                (again.area, again.kind) = (before.area, before.kind.clone());
            }
            for (again, before) in again.regions.iter_mut().zip(&layout.regions) {
                assert!(near(again.area, before.area), "{name}: {}", before.id);
                again.area = before.area;
            }
            for (again, before) in again.stances.iter_mut().zip(&layout.stances) {
                again.area = before.area;
            }
            for (again, before) in again.grounds.iter_mut().zip(&layout.grounds) {
                assert!(near(again.spec.area, before.spec.area), "{name}");
                again.spec.area = before.spec.area;
            }
            assert_eq!(again, layout, "{name}");
        }
    }
}
