//! The fields of layout files. Some of them are the context of later ones, so that they are read in this order:
//!
//! ```text
//! head (units) -> zones    head -> own effects -> own kinds -> controls -> pages
//! ```

use std::sync::Arc;

use super::area::{Place, Placed};
use super::arrange::WIDGETS;
use super::context::LayoutContext;
use super::control::WrittenControl;
use super::effect::OWN_EFFECTS;
use super::fields::Fields;
use super::ground::{GROUNDS, GroundDefinition};
use super::inherit::{Choice, OWN_KINDS, OwnKinds};
use super::kind::Kinds;
use super::lists::MAX_WIDGETS;
use super::pages::{LayoutPageRecord, PAGES};
use super::send_contacts::CONTACTS;
use super::targets::{TARGETS, TargetRecord};
use super::units::Units;
use super::version::VERSION;
use crate::feel::{Effects, NamedEffect};
use crate::layout::CursorRule;
use crate::messages::ContactSending;
use underfoot_format::codec::{At, Distinct, Written};
use underfoot_format::describe::Description;
use underfoot_format::{Codec, Id, Name, Record, Text, record};

/// A layout as written.
pub(super) struct LayoutRecord {
    pub(super) head: LayoutHeadRecord,
    pub(super) zones: ZonesRecord,
    pub(super) controls: ControlsRecord,
    pub(super) pages: Vec<LayoutPageRecord>,
    /// The kinds of which its controls can be made, with the effects that they may name.
    pub(super) kinds: Kinds,
}

record! {
    /// A page of controls placed on the floor: a file in `layouts/`.
    pub(super) struct LayoutHeadRecord = "Layout";
    /// The version of the format.
    pub(super) version: u32 = "version", VERSION;
    /// The unit of places, sizes and gaps.
    pub(super) units: Units = "units", Name => Units::Tiles;
    /// Its title for people.
    pub(super) title: String = "title", Text(200) => String::new();
    /// The programs and devices that messages of controls go to.
    pub(super) targets: Vec<TargetRecord> = "targets", TARGETS => Vec::new();
}

record! {
    /// The parts of the floor that a layout names.
    pub(super) struct ZonesRecord = "Zones" with Units;
    /// The active parts of the floor, each with a cursor of its own.
    pub(super) regions: Vec<RegionRecord> = "regions", REGIONS => Vec::new();
    /// The places of people while they use the controls.
    pub(super) stances: Vec<StanceRecord> = "stances", STANCES => Vec::new();
}

record! {
    /// Effects that only one layout has.
    struct OwnEffectsRecord = "OwnEffects" with Effects;
    /// The layout's own effects.
    effects: Vec<NamedEffect> = "effects", OWN_EFFECTS => Vec::new();
}

record! {
    /// Kinds that only one layout has.
    struct OwnKindsRecord = "OwnKinds" with Kinds;
    /// The layout's own kinds.
    kinds: OwnKinds = "kinds", OWN_KINDS => OwnKinds::default();
}

record! {
    /// The content of a layout besides its pages.
    pub(super) struct ControlsRecord = "Controls" with LayoutContext;
    /// The controls that are on every page.
    pub(super) widgets: Vec<WrittenControl> = "widgets", WIDGETS => Vec::new();
    /// The simulated grounds on every page.
    pub(super) grounds: Vec<GroundDefinition> = "grounds", GROUNDS => Vec::new();
}

record! {
    /// An active part of the floor.
    pub(super) struct RegionRecord = "Region" with Units;
    /// Unique among the layout's regions.
    pub(super) id: Written<String> = "id", At(Id);
    /// Its place.
    pub(super) place: Option<Placed> = "at", Place;
    /// The contacts in it that operate its controls.
    pub(super) cursor: CursorRule = "cursor", Name => CursorRule::default();
    /// The messages of the feet on its free floor.
    pub(super) send: Vec<Written<ContactSending>> = "send", CONTACTS => Vec::new();
}

record! {
    /// A place to stand while using the controls.
    pub(super) struct StanceRecord = "Stance" with Units;
    /// The text on it.
    pub(super) label: Written<String> = "label", At(Text(64)) => Written::default();
    /// Its place.
    pub(super) place: Option<Placed> = "at", Place;
}

const REGIONS: Distinct<RegionRecord> =
    Distinct { entry: "region", most: MAX_WIDGETS, about: |_, _, _, _| {} };

const STANCES: Distinct<StanceRecord> =
    Distinct { entry: "stance", most: MAX_WIDGETS, about: |_, _, _, _| {} };

impl LayoutRecord {
    /// Its name in files.
    pub(super) const NAME: &'static str = LayoutHeadRecord::NAME;

    /// Reads the layout from `fields`, made of its own kinds and effects and of those in `below`.
    ///
    /// As in [`Record::read_fields`], a stand-in replaces an unreadable field.
    pub(super) fn read(fields: &mut Fields<'_>, below: &Kinds) -> Self {
        let head = LayoutHeadRecord::read_fields(fields, None, &());
        let units = head.units;
        fields.show_lengths_in(units.suffix());
        let zones = ZonesRecord::read_fields(fields, None, &units);
        let own = OwnEffectsRecord::read_fields(fields, None, below.effects());
        let below = below.with_effects(own.effects);
        let own = OwnKindsRecord::read_fields(fields, None, &below);
        let kinds = Arc::new(Choice::of(below, own.kinds));
        let context = LayoutContext { units, kinds, room: MAX_WIDGETS };
        let controls = ControlsRecord::read_fields(fields, None, &context);
        let mut context = context.after(controls.widgets.len());
        let pages = PAGES.read_by(fields, "pages", |fields| {
            let page = LayoutPageRecord::read_fields(fields, None, &context);
            context = context.after(page.widgets.len());
            page
        });
        let kinds = context.kinds.usable().clone();
        Self { head, zones, controls, pages: pages.unwrap_or_default(), kinds }
    }

    /// Describes a layout and its fields.
    pub(super) fn describe() -> Description {
        let mut layout = LayoutHeadRecord::describe();
        let later = [
            ZonesRecord::describe(),
            OwnEffectsRecord::describe(),
            OwnKindsRecord::describe(),
            ControlsRecord::describe(),
        ];
        layout.fields.extend(later.into_iter().flat_map(|part| part.fields));
        let about = ["The pages, of which one is shown at a time."];
        PAGES.describe_field("pages", &about, Some(Vec::new()), &mut layout.fields);
        layout
    }
}
