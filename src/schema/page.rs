//! Layout files, from the text to the checked layout.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::area::{Area, Place, Placed};
use super::arrange::WIDGETS;
use super::checks;
use super::control::Control;
use super::diagnostic::Diagnostics;
use super::effect::OWN_EFFECTS;
use super::ground::{GROUNDS, GroundDefinition};
use super::inherit::{Choice, OWN_KINDS};
use super::kind::Kinds;
use super::lists::{MAX_WIDGETS, Room};
use super::node::Node;
use super::pages::{self, PAGES, PageRecord};
use super::pairs::Limits;
use super::places::Places;
use super::reader::Reader;
use super::send_checks;
use super::source::{Source, read_text};
use super::targets::{TARGETS, TargetRecord};
use super::units::{UNITS, Units};
use super::version::{self, VERSION};
use crate::feel::Effects;
use crate::floor::Geometry;
use crate::layout::{CursorRule, Layout, Region, Stance, Widget};
use crate::widget::WidgetId;
use underfoot_format::codec::{At, Distinct, Written};
use underfoot_format::{Id, Name, Record, Text, record};

/// A valid layout, with its warnings.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The layout, in floor metres.
    pub layout: Layout,
    /// Warnings; no errors.
    pub warnings: Diagnostics,
    /// The places of its parts in the text.
    pub places: Places,
}

impl Loaded {
    /// Logs the warnings and returns the layout.
    #[must_use]
    pub fn log_warnings(self) -> Layout {
        if !self.warnings.is_empty() {
            tracing::warn!("{}", self.warnings);
        }
        self.layout
    }
}

/// Reads the layout in the file at `path` as [`load_layout`] does, made of [`kinds_beside`] it.
///
/// # Errors
/// Every problem of the file, of its kinds and of its effects. The layout is never partial.
pub fn load_layout_and_kinds(path: &Path, geometry: &Geometry) -> Result<Loaded, Diagnostics> {
    load_layout(path, &kinds_beside(path)?, geometry)
}

/// Reads the layout in the file at `path`, made of `kinds` and placed on a floor of this `geometry`.
///
/// # Errors
/// Every problem of the file, or that it cannot be read. The layout is never partial.
pub fn load_layout(path: &Path, kinds: &Kinds, geometry: &Geometry) -> Result<Loaded, Diagnostics> {
    let text = read_text(path)?;
    parse_layout(&text, &path.display().to_string(), kinds, geometry)
}

/// Returns the folder called `name` next to the file `path` or next to its folder; it holds a layout's own kinds and
/// effects.
#[must_use]
pub fn folder_beside(path: &Path, name: &str) -> Option<PathBuf> {
    let home = std::path::absolute(path).ok()?;
    home.ancestors().skip(1).take(2).map(|folder| folder.join(name)).find(|folder| folder.is_dir())
}

/// Returns the shipped kinds and effects, and those in folders `widgets` and `effects` next to the file `path` or
/// next to its folder.
///
/// # Errors
/// Every problem of the files in these folders, or that a folder cannot be read.
pub fn kinds_beside(path: &Path) -> Result<Kinds, Diagnostics> {
    let mut effects = Effects::builtin();
    if let Some(folder) = folder_beside(path, "effects") {
        effects.read_folder(&folder)?;
    }
    let mut kinds = Kinds::shipped(effects)?;
    if let Some(folder) = folder_beside(path, "widgets") {
        kinds.read_folder(&folder)?;
    }
    Ok(kinds)
}

/// Reads the layout that `text` describes, made of `kinds` and placed on a floor of this `geometry`.
///
/// `name` is the name of the text in diagnostics, usually a path.
///
/// # Errors
/// Every problem of the text. The layout is never partial.
pub fn parse_layout(
    text: &str,
    name: &str,
    kinds: &Kinds,
    geometry: &Geometry,
) -> Result<Loaded, Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = Reader::new(&source, "Layout", Limits::LAYOUT);
    reader.know(Arc::clone(kinds.effects()));
    if let Some(newer) = version::newer(&reader, "Layout") {
        return Err(newer);
    }
    reader.know(Arc::new(Choice::of(kinds)));
    reader.know(Arc::new(Room::default()));
    let layout = reader.root("layout").and_then(Page::read).and_then(|(page, good)| {
        checks::check(&reader, &page, geometry);
        send_checks::check(&reader, &page);
        let layout = page.placed_on(geometry).filter(|_| good)?;
        Some((layout, page.controls.into_iter().map(|control| control.written).collect()))
    });
    let ((layout, written), warnings) = reader.conclude(layout)?;
    Ok(Loaded { layout, warnings, places: Places::new(name, text, written) })
}

record! {
    /// A page of controls placed on the floor: a file in `layouts/`.
    pub(super) struct LayoutRecord = "Layout";
    /// The version of the format.
    version: u32 = "version", VERSION;
    /// The unit of places, sizes and gaps.
    units: Units = "units", UNITS => Units::Tiles;
    /// Its title for people.
    title: String = "title", Text(200) => String::new();
    /// The active parts of the floor, each with a cursor of its own.
    regions: Vec<RegionRecord> = "regions", REGIONS => Vec::new();
    /// The places of people while they use the controls.
    stances: Vec<StanceRecord> = "stances", STANCES => Vec::new();
    /// The programs and devices that messages of controls go to.
    targets: Vec<TargetRecord> = "targets", TARGETS => Vec::new();
    /// The layout's own effects.
    effects: () = "effects", OWN_EFFECTS => ();
    /// The layout's own kinds.
    kinds: () = "kinds", OWN_KINDS => ();
    /// The controls that are on every page.
    widgets: Vec<Control> = "widgets", WIDGETS => Vec::new();
    /// The simulated grounds on every page.
    grounds: Vec<GroundDefinition> = "grounds", GROUNDS => Vec::new();
    /// The pages, of which one is shown at a time.
    pages: Vec<PageRecord> = "pages", PAGES => Vec::new();
}

record! {
    /// An active part of the floor.
    struct RegionRecord = "Region";
    /// Unique among the layout's regions.
    id: Written<String> = "id", At(Id);
    /// Its place.
    place: Option<Placed> = "at", Place;
    /// The contacts in it that operate its controls.
    cursor: CursorRule = "cursor", Name => CursorRule::default();
}

record! {
    /// A place to stand while using the controls.
    struct StanceRecord = "Stance";
    /// The text on it.
    label: Written<String> = "label", At(Text(64)) => Written::default();
    /// Its place.
    place: Option<Placed> = "at", Place;
}

const REGIONS: Distinct<RegionRecord> =
    Distinct { entry: "region", most: MAX_WIDGETS, about: |_, _, _, _| {} };

const STANCES: Distinct<StanceRecord> =
    Distinct { entry: "stance", most: MAX_WIDGETS, about: |_, _, _, _| {} };

/// A layout as written; its problems have been reported.
pub(super) struct Page {
    pub(super) version: u32,
    title: String,
    pub(super) units: Units,
    pub(super) regions: Vec<Zone>,
    pub(super) stances: Vec<Zone>,
    pub(super) pages: Vec<PageRecord>,
    pub(super) targets: Vec<TargetRecord>,
    /// Whether all targets could be read.
    pub(super) targets_known: bool,
    /// The grounds of all pages.
    pub(super) grounds: Vec<GroundDefinition>,
    /// The controls of all pages.
    pub(super) controls: Vec<Control>,
    /// Whether all regions could be read.
    pub(super) regions_known: bool,
    /// Place of the list of controls in the text.
    pub(super) widgets_at: Range<usize>,
}

/// A region (named by its id) or a stance zone (named by its label).
pub(super) struct Zone {
    pub(super) name: Written<String>,
    pub(super) place: Option<Placed>,
    cursor: CursorRule,
}

impl Page {
    /// Reads the layout at `node`; the flag says whether all of it could be read.
    fn read(node: Node<'_>) -> Option<(Self, bool)> {
        let mut fields = node.fields(LayoutRecord::NAME)?;
        Units::default().apply_to(node.reader);
        let record = LayoutRecord::read_fields(&mut fields, None);
        let good = fields.are_read();
        let targets_known = !fields.have_failed(&["targets"]);
        let regions_at = fields.value_span("regions").unwrap_or_else(|| node.span());
        let widgets_at = fields.span("widgets");
        fields.finish();
        let LayoutRecord { version, title, units, regions, stances, targets, mut pages, mut grounds, .. } =
            record;
        let regions_known =
            regions.iter().all(|region| region.place.is_some()) && !node.reader.is_broken(&regions_at);
        let mut controls = record.widgets;
        for (number, page) in pages.iter_mut().enumerate() {
            let own = page.widgets.drain(..);
            controls.extend(own.map(|control| Control { page: Some(number), ..control }));
            let own = page.grounds.drain(..);
            grounds.extend(own.map(|ground| ground.on_page(number)));
        }
        let zone = |name, place, cursor| Zone { name, place, cursor };
        let regions = regions.into_iter().map(|it| zone(it.id, it.place, it.cursor)).collect();
        let stances = stances.into_iter().map(|it| zone(it.label, it.place, CursorRule::default())).collect();
        let page = Self {
            version,
            title,
            units,
            regions,
            stances,
            pages,
            targets,
            targets_known,
            grounds,
            controls,
            regions_known,
            widgets_at,
        };
        Some((page, good))
    }

    /// Returns the region that contains the middle of `area`.
    pub(super) fn region_of(&self, area: &Area) -> Option<usize> {
        let holds = |zone: &Zone| zone.place.as_ref().is_some_and(|place| place.area.contains(area.middle()));
        self.regions.iter().position(holds)
    }

    /// Makes the checked layout; `None` if any part is missing.
    fn placed_on(&self, geometry: &Geometry) -> Option<Layout> {
        let units = self.units;
        let regions = self.regions.iter().map(|zone| {
            let area = zone.place.as_ref()?.area.in_metres(geometry, units);
            Some(Region { id: zone.name.value.clone(), area, cursor: zone.cursor })
        });
        let stances = self.stances.iter().map(|zone| {
            Some(Stance {
                label: zone.name.value.clone(),
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
                goto: control.goto.as_ref().and_then(|goto| pages::number_of(&goto.value, &self.pages)),
                area: area.in_metres(geometry, units),
                label: control.label.clone()?,
                behaviour: kind.behaviour,
                feel: kind.feel,
                look: kind.look,
                send: control.send.iter().map(|sending| sending.value.clone()).collect(),
            })
        });
        Some(Layout {
            title: self.title.clone(),
            regions: regions.collect::<Option<_>>()?,
            stances: stances.collect::<Option<_>>()?,
            pages: self.pages.iter().map(PageRecord::checked).collect(),
            targets: self.targets.iter().map(TargetRecord::checked).collect(),
            grounds: self
                .grounds
                .iter()
                .map(|ground| ground.checked(geometry, units))
                .collect::<Option<_>>()?,
            widgets: widgets.collect::<Option<_>>()?,
        })
    }
}
