//! Layout files, from the text to the checked layout.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::area::{Placed, WrittenArea};
use super::checks;
use super::control::WrittenControl;
use super::diagnostic::Diagnostics;
use super::ground::GroundDefinition;
use super::kind::Kinds;
use super::layout_record::{ControlsRecord, LayoutHeadRecord, LayoutRecord, ZonesRecord};
use super::node::Node;
use super::pages::{self, LayoutPageRecord};
use super::pairs::Limits;
use super::places::Places;
use super::reader::Reader;
use super::send_checks;
use super::source::{Source, read_text};
use super::targets::TargetRecord;
use super::units::Units;
use super::version;
use crate::feel::Effects;
use crate::floor::Geometry;
use crate::layout::{CursorRule, Layout, Region, Stance, Widget};
use crate::messages::ContactSending;
use crate::widget::WidgetId;
use underfoot_format::codec::Written;

/// A valid layout, with its warnings.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The layout, in floor metres.
    pub layout: Layout,
    /// Warnings; no errors.
    pub warnings: Diagnostics,
    /// The places of its parts in the text.
    pub places: Places,
    /// The kinds of which its controls can be made, and the effects that these can play: the known ones and its own.
    pub kinds: Kinds,
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
    if let Some(newer) = version::newer(&reader, "Layout") {
        return Err(newer);
    }
    let page = reader.root("layout").and_then(|node| WrittenPage::read(node, kinds));
    let layout = page.and_then(|(page, good)| {
        checks::check(&reader, &page, geometry);
        send_checks::check(&reader, &page);
        let layout = page.placed_on(geometry).filter(|_| good)?;
        let written = page.controls.into_iter().map(|control| control.written).collect();
        Some((layout, written, page.kinds))
    });
    let ((layout, written, kinds), warnings) = reader.conclude(layout)?;
    Ok(Loaded { layout, warnings, places: Places::new(name, text, written), kinds })
}

/// A layout as written; its problems have been reported.
pub(super) struct WrittenPage {
    pub(super) version: u32,
    title: String,
    pub(super) units: Units,
    pub(super) regions: Vec<WrittenZone>,
    pub(super) stances: Vec<WrittenZone>,
    pub(super) pages: Vec<LayoutPageRecord>,
    /// The kinds of which its controls can be made.
    kinds: Kinds,
    pub(super) targets: Vec<TargetRecord>,
    /// Whether all targets could be read.
    pub(super) targets_known: bool,
    /// The grounds of all pages.
    pub(super) grounds: Vec<GroundDefinition>,
    /// The controls of all pages.
    pub(super) controls: Vec<WrittenControl>,
    /// Whether all regions could be read.
    pub(super) regions_known: bool,
    /// Place of the list of controls in the text.
    pub(super) widgets_at: Range<usize>,
}

/// A region (named by its id) or a stance zone (named by its label).
pub(super) struct WrittenZone {
    pub(super) name: Written<String>,
    pub(super) place: Option<Placed>,
    cursor: CursorRule,
    /// Its messages of feet, with their places.
    pub(super) send: Vec<Written<ContactSending>>,
}

impl WrittenPage {
    /// Reads the layout at `node`, made of `kinds`; the flag says whether all of it could be read.
    fn read(node: Node<'_>, kinds: &Kinds) -> Option<(Self, bool)> {
        let mut fields = node.fields(LayoutRecord::NAME)?;
        let record = LayoutRecord::read(&mut fields, kinds);
        let good = fields.are_read();
        let targets_known = !fields.have_failed(&["targets"]);
        let regions_at = fields.value_span("regions").unwrap_or_else(|| node.span());
        let widgets_at = fields.span("widgets");
        fields.finish();
        let LayoutRecord { head, zones, controls, mut pages, kinds } = record;
        let LayoutHeadRecord { version, units, title, targets } = head;
        let ZonesRecord { regions, stances } = zones;
        let ControlsRecord { widgets: mut controls, mut grounds } = controls;
        let regions_known =
            regions.iter().all(|region| region.place.is_some()) && !node.reader.is_broken(&regions_at);
        for (number, page) in pages.iter_mut().enumerate() {
            let own = page.widgets.drain(..);
            controls.extend(own.map(|control| WrittenControl { page: Some(number), ..control }));
            let own = page.grounds.drain(..);
            grounds.extend(own.map(|ground| ground.on_page(number)));
        }
        let zone = |name, place, cursor, send| WrittenZone { name, place, cursor, send };
        let regions = regions.into_iter().map(|it| zone(it.id, it.place, it.cursor, it.send)).collect();
        let stances = stances.into_iter();
        let stances = stances.map(|it| zone(it.label, it.place, CursorRule::default(), Vec::new())).collect();
        let page = Self {
            version,
            title,
            units,
            regions,
            stances,
            pages,
            kinds,
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
    pub(super) fn region_of(&self, area: &WrittenArea) -> Option<usize> {
        let holds =
            |zone: &WrittenZone| zone.place.as_ref().is_some_and(|place| place.area.contains(area.middle()));
        self.regions.iter().position(holds)
    }

    /// Makes the checked layout; `None` if any part is missing.
    fn placed_on(&self, geometry: &Geometry) -> Option<Layout> {
        let units = self.units;
        let regions = self.regions.iter().map(|zone| {
            let area = zone.place.as_ref()?.area.in_metres(geometry, units);
            let send = zone.send.iter().map(|sending| sending.value.clone()).collect();
            Some(Region { id: zone.name.value.clone(), area, cursor: zone.cursor, send })
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
            pages: self.pages.iter().map(LayoutPageRecord::checked).collect(),
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
