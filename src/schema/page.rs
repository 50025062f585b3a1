//! Layout files, from the text to the checked layout.

use std::path::{Path, PathBuf};

use super::area::{Area, Placed};
use super::arrange;
use super::checks;
use super::control::Control;
use super::diagnostic::Diagnostics;
use super::effect;
use super::ground::{self, GroundDefinition};
use super::inherit::Choice;
use super::kind::Kinds;
use super::lists::{MAX_WIDGETS, list};
use super::node::Node;
use super::pages::{self, PageDefinition};
use super::pairs::Limits;
use super::places::Places;
use super::reader::Reader;
use super::source::{Source, read_text};
use super::units::Units;
use super::version;
use crate::floor::Geometry;
use crate::format::{Codec, Name};
use crate::layout::{CursorRule, Layout, Region, Stance, Widget};
use crate::widget::WidgetId;

/// A layout that can be used, and what is odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The layout, in floor metres.
    pub layout: Layout,
    /// Warnings; no errors.
    pub warnings: Diagnostics,
    /// Where its parts are written.
    pub places: Places,
}

/// The layout in the file at `path`, made of `kinds` and placed on a floor of this `geometry`.
///
/// # Errors
/// Everything wrong with the file, or that it cannot be read. There is no part of a layout then.
pub fn load_layout(path: &Path, kinds: &Kinds, geometry: &Geometry) -> Result<Loaded, Diagnostics> {
    let text = read_text(path)?;
    parse_layout(&text, &path.display().to_string(), kinds, geometry)
}

/// The folder called `name` beside the file `path` or beside its folder, where a layout's own kinds and effects are.
#[must_use]
pub fn folder_beside(path: &Path, name: &str) -> Option<PathBuf> {
    let home = std::path::absolute(path).ok()?;
    home.ancestors().skip(1).take(2).map(|folder| folder.join(name)).find(|folder| folder.is_dir())
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
    reader.know(std::sync::Arc::clone(kinds.effects()));
    if let Some(newer) = version::newer(&reader, "Layout") {
        return Err(newer);
    }
    let page = reader.root("layout").and_then(|node| Page::read(node, kinds));
    let layout = page.and_then(|page| {
        checks::check(&reader, &page, geometry);
        let layout = page.placed_on(geometry)?;
        Some((layout, page.controls.into_iter().map(|control| control.written).collect()))
    });
    let ((layout, written), warnings) = reader.conclude(layout)?;
    Ok(Loaded { layout, warnings, places: Places::new(name, text, written) })
}

/// A layout as written. What could not be read is `None` and has been reported.
pub(super) struct Page<'r> {
    title: Option<&'r str>,
    pub(super) units: Units,
    pub(super) regions: Vec<Zone<'r>>,
    pub(super) stances: Vec<Zone<'r>>,
    pub(super) pages: Vec<PageDefinition<'r>>,
    /// Those of all pages.
    pub(super) grounds: Vec<GroundDefinition>,
    /// Those of all pages.
    pub(super) controls: Vec<Control>,
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

impl<'r> Page<'r> {
    fn read(node: Node<'r>, kinds: &Kinds) -> Option<Self> {
        let mut fields = node.fields("Layout")?;
        fields.read("version", None, version::read);
        if let Some(units) = fields.read("units", Some(Units::Tiles), Units::read) {
            node.reader.count_in(units);
        }
        let title = fields.read("title", Some(""), |node| node.text(200));
        let (regions, regions_known) =
            list(&mut fields, "regions", "region", |node| Zone::read(node, "Region"));
        let (stances, _) = list(&mut fields, "stances", "stance", |node| Zone::read(node, "Stance"));
        if let Some(node) = fields.take("effects") {
            effect::list(node);
        }
        let kinds = Choice::new(kinds, fields.take("kinds"));
        let mut room = MAX_WIDGETS;
        let widgets = fields.take("widgets");
        let mut controls = widgets.map(|node| arrange::read(node, &kinds, &mut room)).unwrap_or_default();
        let mut grounds = ground::read(&mut fields, None);
        let pages = pages::read(&mut fields, &kinds, &mut room, &mut controls, &mut grounds);
        let widgets_at = fields.span("widgets");
        fields.finish();
        let regions_known = regions_known && regions.iter().all(|region: &Zone<'_>| region.place.is_some());
        let units = node.reader.units();
        Some(Self { title, units, regions, stances, pages, grounds, controls, regions_known, widgets_at })
    }

    /// The region whose area holds the middle of `area`.
    pub(super) fn region_of(&self, area: &Area) -> Option<usize> {
        let holds =
            |zone: &Zone<'_>| zone.place.as_ref().is_some_and(|place| place.area.contains(area.middle()));
        self.regions.iter().position(holds)
    }

    /// The checked layout; `None` if anything of it is missing.
    fn placed_on(&self, geometry: &Geometry) -> Option<Layout> {
        let units = self.units;
        let regions = self.regions.iter().map(|zone| {
            let area = zone.place.as_ref()?.area.in_metres(geometry, units);
            Some(Region { id: zone.name?.to_owned(), area, cursor: zone.cursor? })
        });
        let stances = self.stances.iter().map(|zone| {
            Some(Stance {
                label: zone.name?.to_owned(),
                area: zone.place.as_ref()?.area.in_metres(geometry, units),
            })
        });
        let widgets = self.controls.iter().map(|control| {
            let area = &control.place.as_ref()?.area;
            let kind = control.kind.clone()?;
            Some(Widget {
                id: WidgetId::new(control.id.as_deref()?),
                kind: kind.name,
                region: self.region_of(area)?,
                page: control.page,
                goto: control.goto.as_ref().and_then(|goto| pages::number_of(goto, &self.pages)),
                area: area.in_metres(geometry, units),
                label: control.label.clone()?,
                behaviour: kind.behaviour,
                feel: kind.feel,
                look: kind.look,
            })
        });
        Some(Layout {
            title: self.title?.to_owned(),
            regions: regions.collect::<Option<_>>()?,
            stances: stances.collect::<Option<_>>()?,
            pages: self.pages.iter().map(PageDefinition::checked).collect::<Option<_>>()?,
            grounds: self
                .grounds
                .iter()
                .map(|ground| ground.checked(geometry, units))
                .collect::<Option<_>>()?,
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
        let cursor = if field == "id" {
            fields.read("cursor", Some(CursorRule::default()), |node| Name.read(node, None))
        } else {
            Some(CursorRule::default())
        };
        fields.finish();
        Some(Self { name, name_at, place, cursor })
    }
}
