use std::path::Path;

use super::area::{Area, Placed};
use super::behaviour;
use super::checks;
use super::diagnostic::Diagnostics;
use super::feel;
use super::fields::Fields;
use super::kind::{Kind, Kinds};
use super::look;
use super::node::Node;
use super::pages::{self, Goto, Sheet};
use super::pairs::Limits;
use super::problem::Problem;
use super::reader::Reader;
use super::region;
use super::source::{Source, read_text};
use super::version;
use crate::floor::Geometry;
use crate::layout::{CursorRule, Layout, Region, Stance, Widget};
use crate::widget::WidgetId;

/// Most controls, regions or stance zones of one layout.
pub const MAX_WIDGETS: usize = 4096;

/// A layout that can be used, and what is odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The layout, in floor metres.
    pub layout: Layout,
    /// Warnings; no errors.
    pub warnings: Diagnostics,
}

/// The layout in the file at `path`, made of `kinds` and placed on a floor of this `geometry`.
///
/// # Errors
/// Everything wrong with the file, or that it cannot be read. There is no part of a layout then.
pub fn load_layout(path: &Path, kinds: &Kinds, geometry: &Geometry) -> Result<Loaded, Diagnostics> {
    let text = read_text(path)?;
    parse_layout(&text, &path.display().to_string(), kinds, geometry)
}

/// The layout that `text` describes, made of `kinds` and placed on a floor of this `geometry`.
///
/// `name` is what diagnostics call the text, usually a path.
///
/// # Errors
/// Everything wrong with the text. There is no part of a layout then.
pub fn parse_layout(
    text: &str,
    name: &str,
    kinds: &Kinds,
    geometry: &Geometry,
) -> Result<Loaded, Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = Reader::new(&source, "Layout", Limits::LAYOUT);
    if let Some(newer) = version::newer(&reader, "Layout") {
        return Err(newer);
    }
    let page = reader.root("layout").and_then(|node| Page::read(node, kinds));
    let layout = page.and_then(|page| {
        checks::check(&reader, &page, geometry);
        page.placed_on(geometry)
    });
    let (layout, warnings) = reader.conclude(layout)?;
    Ok(Loaded { layout, warnings })
}

/// A layout as written. What could not be read is `None` and has been reported.
pub(super) struct Page<'r> {
    title: Option<&'r str>,
    pub(super) regions: Vec<Zone<'r>>,
    pub(super) stances: Vec<Zone<'r>>,
    pub(super) pages: Vec<Sheet<'r>>,
    /// Those of all pages.
    pub(super) controls: Vec<Control<'r>>,
    /// Whether all regions could be read.
    pub(super) regions_known: bool,
    /// Where the list of controls is written.
    pub(super) widgets_at: std::ops::Range<usize>,
}

/// A region (named by its id) or a stance zone (named by its label).
pub(super) struct Zone<'r> {
    pub(super) name: Option<&'r str>,
    pub(super) name_at: std::ops::Range<usize>,
    pub(super) place: Option<Placed>,
    cursor: Option<CursorRule>,
}

/// One control.
pub(super) struct Control<'r> {
    pub(super) id: Option<&'r str>,
    pub(super) id_at: std::ops::Range<usize>,
    pub(super) place: Option<Placed>,
    /// The number of its page; `None` if it is on all of them.
    pub(super) page: Option<usize>,
    pub(super) goto: Option<Goto<'r>>,
    label: Option<&'r str>,
    /// Its kind with everything that it overrides.
    pub(super) kind: Option<Kind>,
}

impl<'r> Page<'r> {
    fn read(node: Node<'r>, kinds: &Kinds) -> Option<Self> {
        let mut fields = node.fields("Layout")?;
        fields.read("version", None, version::read);
        let title = fields.read("title", Some(""), |node| node.text(200));
        let (regions, regions_known) =
            list(&mut fields, "regions", "region", |node| Zone::read(node, "Region"));
        let (stances, _) = list(&mut fields, "stances", "stance", |node| Zone::read(node, "Stance"));
        let (mut controls, _) = list(&mut fields, "widgets", "widget", |node| Control::read(node, kinds));
        let pages = pages::read(&mut fields, kinds, &mut controls);
        let widgets_at = fields.span("widgets");
        fields.finish();
        let regions_known = regions_known && regions.iter().all(|region: &Zone<'_>| region.place.is_some());
        Some(Self { title, regions, stances, pages, controls, regions_known, widgets_at })
    }

    /// The region whose area holds the middle of `area`.
    pub(super) fn region_of(&self, area: &Area) -> Option<usize> {
        let holds =
            |zone: &Zone<'_>| zone.place.as_ref().is_some_and(|place| place.area.contains(area.middle()));
        self.regions.iter().position(holds)
    }

    /// The checked layout; `None` if anything of it is missing.
    fn placed_on(&self, geometry: &Geometry) -> Option<Layout> {
        let regions = self.regions.iter().map(|zone| {
            let area = zone.place.as_ref()?.area.in_metres(geometry);
            Some(Region { id: zone.name?.to_owned(), area, cursor: zone.cursor? })
        });
        let stances = self.stances.iter().map(|zone| {
            Some(Stance { label: zone.name?.to_owned(), area: zone.place.as_ref()?.area.in_metres(geometry) })
        });
        let widgets = self.controls.iter().map(|control| {
            let area = &control.place.as_ref()?.area;
            let kind = control.kind.clone()?;
            Some(Widget {
                id: WidgetId::new(control.id?),
                kind: kind.name,
                region: self.region_of(area)?,
                page: control.page,
                goto: control.goto.as_ref().and_then(|goto| goto.number(&self.pages)),
                area: area.in_metres(geometry),
                label: control.label?.to_owned(),
                behaviour: kind.behaviour,
                feel: kind.feel,
                look: kind.look,
            })
        });
        Some(Layout {
            title: self.title?.to_owned(),
            regions: regions.collect::<Option<_>>()?,
            stances: stances.collect::<Option<_>>()?,
            pages: self.pages.iter().map(Sheet::checked).collect::<Option<_>>()?,
            widgets: widgets.collect::<Option<_>>()?,
        })
    }
}

impl<'r> Zone<'r> {
    fn read(node: Node<'r>, owner: &'static str) -> Option<Self> {
        let mut fields = node.fields(owner)?;
        let (field, name) = match owner {
            "Region" => ("id", fields.read("id", None, |node| node.id())),
            _ => ("label", fields.read("label", Some(""), |node| node.text(64))),
        };
        let place = Placed::read(&mut fields);
        let name_at = fields.span(field);
        let cursor =
            if field == "id" { region::read_cursor(&mut fields) } else { Some(CursorRule::default()) };
        fields.finish();
        Some(Self { name, name_at, place, cursor })
    }
}

impl<'r> Control<'r> {
    pub(super) fn read(node: Node<'r>, kinds: &Kinds) -> Option<Self> {
        let mut fields = node.fields("Widget")?;
        let id = fields.read("id", None, |node| node.id());
        let base = fields.read("kind", None, |node| named_kind(node, kinds));
        let place = Placed::read(&mut fields);
        let label = fields.read("label", Some(""), |node| node.text(64));
        let goto = Goto::read(&mut fields);
        let id_at = fields.span("id");
        let kind = match base {
            Some(base) => {
                fields.call(format!("widget of the kind \"{}\"", base.name));
                let kind = overridden(&mut fields, base);
                fields.finish();
                kind
            }
            // Which other fields it may have, only its kind could tell.
            None => {
                fields.finish_leniently();
                None
            }
        };
        Some(Self { id, id_at, place, page: None, goto, label, kind })
    }
}

fn named_kind<'k>(node: Node<'_>, kinds: &'k Kinds) -> Option<&'k Kind> {
    let name = node.text(64)?;
    kinds.get(name).or_else(|| {
        let problem = Problem::error(node.span(), format!("unknown kind \"{name}\""));
        node.report(problem.expected("no kind is called so").help_if(kinds.suggestion(name)));
        None
    })
}

/// `base` with the fields that this widget overrides.
fn overridden(fields: &mut Fields<'_>, base: &Kind) -> Option<Kind> {
    let behaviour = behaviour::read_over(fields, &base.behaviour);
    let look = fields.read("look", Some(base.look), |node| look::read_over(node, base.look));
    let feel = fields.read("feel", Some(base.feel.clone()), |node| feel::read_over(node, &base.feel));
    Some(Kind { name: base.name.clone(), behaviour: behaviour?, look: look?, feel: feel? })
}

/// What `read` makes of the entries of the list `name`, which may be left out, and whether that is all of them.
pub(super) fn list<'r, T>(
    fields: &mut Fields<'r>,
    name: &'static str,
    entry: &'static str,
    read: impl Fn(Node<'r>) -> Option<T>,
) -> (Vec<T>, bool) {
    let Some(node) = fields.take(name) else { return (Vec::new(), !fields.are_broken()) };
    let Some(nodes) = node.list(entry, MAX_WIDGETS) else { return (Vec::new(), false) };
    let count = nodes.len();
    let read: Vec<T> = nodes.into_iter().filter_map(read).collect();
    let all = read.len() == count && !node.reader.is_broken(&node.span());
    (read, all)
}
