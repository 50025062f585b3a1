//! Simulated grounds.
//!
//! ```ron
//! grounds: [
//!     Ice(at: (0, 0), size: (6, 4), seed: 7, cracks: (turn: 0.3), sheet: (refreeze_s: 60)),
//!     Snow(at: (0, 4), size: (6, 2)),
//! ]
//! ```

use std::ops::Range;

use super::area::{Placed, WrittenArea};
use super::node::Node;
use super::number::plain;
use super::problem::Problem;
use super::units::Units;
use crate::floor::Geometry;
use crate::ground::{GrainSpec, GroundMaterial, GroundSpec, IceSpec, WoodSpec};
use crate::layout::{Colour, Ground, HEX};
use underfoot_format::codec::By;
use underfoot_format::describe::{Description, FieldDescription, FieldType};
use underfoot_format::text::Text;
use underfoot_format::{Codec, Record};

/// Maximum number of grounds of one layout: each has state for every tile.
const MOST: usize = 16;

const NAMES: [&str; 5] = ["Ice", "Snow", "Gravel", "Sand", "Wood"];

/// One ground as written. A field that could not be read is `None` and has been reported.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GroundDefinition {
    /// The inner `None` stands for the whole floor.
    place: Option<Option<Placed>>,
    page: Option<usize>,
    seed: Option<u32>,
    material: Option<GroundMaterial>,
    colours: Option<[Colour; 2]>,
    pub(super) at: Range<usize>,
}

/// The grounds of a layout or of one of its pages.
pub(super) const GROUNDS: By<Vec<GroundDefinition>, Units> = By {
    shape: || FieldType::Variants(describe),
    read: |node, units| Some(read(node, *units)),
    write: |_| Text::List(Vec::new()),
    stand_in: Vec::new,
};

fn read(node: Node<'_>, units: Units) -> Vec<GroundDefinition> {
    let Some(nodes) = node.list("ground", MOST) else { return Vec::new() };
    // A ground that could not be read has been reported; its stand-in keeps the layout incomplete.
    let unreadable = || GroundDefinition::unreadable(node.span());
    nodes.into_iter().map(|node| GroundDefinition::read(node, units).unwrap_or_else(unreadable)).collect()
}

impl GroundDefinition {
    fn read(node: Node<'_>, units: Units) -> Option<Self> {
        let (name, mut fields) = node.variant(&NAMES)?;
        let standard = standard(name);
        let (surface, deep) = colours(name);
        let at = node.span();
        let place = if fields.value_span("at").is_none() && fields.value_span("size").is_none() {
            let _ = (fields.take("at"), fields.take("size"));
            Some(None)
        } else {
            Placed::read(&mut fields, units).map(Some)
        };
        let seed = fields.read("seed", Some(1), |node| node.whole(0..=u32::MAX));
        let surface = fields.read("surface", Some(surface), |node| HEX.read(node, None, &()));
        let deep = fields.read("deep", Some(deep), |node| HEX.read(node, None, &()));
        let material = match standard {
            GroundMaterial::Ice(base) => {
                GroundMaterial::Ice(IceSpec::read_fields(&mut fields, Some(&base), &()))
            }
            GroundMaterial::Grain(base) => {
                GroundMaterial::Grain(GrainSpec::read_fields(&mut fields, Some(&base), &()))
            }
            GroundMaterial::Wood(base) => {
                GroundMaterial::Wood(WoodSpec::read_fields(&mut fields, Some(&base), &()))
            }
        };
        let material = fields.are_read().then_some(material);
        fields.finish();
        let colours = surface.zip(deep).map(|(surface, deep)| [surface, deep]);
        Some(Self { place, page: None, seed, material, colours, at })
    }

    fn unreadable(at: Range<usize>) -> Self {
        Self { place: None, page: None, seed: None, material: None, colours: None, at }
    }

    /// Returns the ground restricted to the page with this number.
    pub(super) fn on_page(self, number: usize) -> Self {
        Self { page: Some(number), ..self }
    }

    /// Returns its area on the floor with area `floor`; `None` if the area could not be read.
    pub(super) fn area(&self, floor: &WrittenArea) -> Option<WrittenArea> {
        Some(self.place.as_ref()?.as_ref().map_or(*floor, |place| place.area))
    }

    /// Returns its place in the text, if the place is written.
    pub(super) fn placed(&self) -> Option<&Placed> {
        self.place.as_ref()?.as_ref()
    }

    /// Returns its name in messages.
    pub(super) fn name(&self) -> &'static str {
        self.material.map_or("ground", |material| material.name())
    }

    /// Whether both can be present at the same time.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.page.is_none() || other.page.is_none() || self.page == other.page
    }

    /// Makes the ground for the engine; `None` if any part is missing.
    pub(super) fn checked(&self, geometry: &Geometry, units: Units) -> Option<Ground> {
        let area = self.area(&WrittenArea::of_floor(geometry, units))?.in_metres(geometry, units);
        let [surface, deep] = self.colours?;
        let spec = GroundSpec { area, page: self.page, seed: self.seed?, material: self.material? };
        Some(Ground { spec, surface, deep })
    }
}

/// Reports conflicts between grounds, and between them and the floor.
pub(super) fn check(
    grounds: &[GroundDefinition],
    units: Units,
    floor: &WrittenArea,
    report: impl Fn(Problem),
) {
    for (index, definition) in grounds.iter().enumerate() {
        let Some(area) = definition.area(floor) else { continue };
        let at = definition.placed().map_or(definition.at.clone(), |place| place.at.clone());
        if !area.within(floor) {
            let problem = Problem::error(at, format!("this {} reaches beyond the floor", definition.name()));
            let help = format!("places count in {} from the floor's south-west corner", units.name());
            report(problem.expected(format!("it spans {area}, the floor {floor}")).help(help));
            continue;
        }
        let under = grounds[..index].iter().filter(|other| definition.overlaps(other)).find_map(|other| {
            let shared = area.shared(&other.area(floor)?)?;
            Some((other, shared))
        });
        if let Some((other, [width, depth])) = under {
            let message = format!("this {} lies on {}", definition.name(), other.name());
            let shared = format!("{} x {}{}", plain(width), plain(depth), units.suffix());
            report(Problem::warning(at, message).expected(format!("both answer a foot on these {shared}")));
        }
    }
}

fn standard(name: &str) -> GroundMaterial {
    match name {
        "Snow" => GroundMaterial::Grain(GrainSpec::SNOW),
        "Gravel" => GroundMaterial::Grain(GrainSpec::GRAVEL),
        "Sand" => GroundMaterial::Grain(GrainSpec::SAND),
        "Wood" => GroundMaterial::Wood(WoodSpec::PLANKS),
        _ => GroundMaterial::Ice(IceSpec::POND),
    }
}

/// Returns the fields of a ground with this name; empty if there is no such ground.
#[must_use]
pub fn ground_fields(name: &str) -> Vec<FieldDescription> {
    let described = describe().into_iter().find(|description| description.name == name);
    described.map(|description| description.fields).unwrap_or_default()
}

/// Describes each ground; the defaults are those of the standard ground of its name.
pub(super) fn describe() -> Vec<Description> {
    let described = NAMES.map(|name| {
        let mut usual = Vec::new();
        let description = match standard(name) {
            GroundMaterial::Ice(spec) => {
                spec.write_fields(&mut usual);
                IceSpec::describe()
            }
            GroundMaterial::Grain(spec) => {
                spec.write_fields(&mut usual);
                GrainSpec::describe()
            }
            GroundMaterial::Wood(spec) => {
                spec.write_fields(&mut usual);
                WoodSpec::describe()
            }
        };
        let mut fields = description.fields;
        for field in &mut fields {
            let usual = usual.iter().find(|(name, _)| *name == field.name);
            field.default = usual.map(|(_, text)| text.inline());
        }
        Description { name, fields, ..description }
    });
    described.into()
}

/// Returns the colours of surface and depth.
fn colours(name: &str) -> (Colour, Colour) {
    match name {
        "Snow" => (Colour::rgb(0xf4, 0xf8, 0xfc), Colour::rgb(0x8f, 0xa9, 0xc4)),
        "Gravel" => (Colour::rgb(0xb4, 0xad, 0xa2), Colour::rgb(0x5a, 0x54, 0x4b)),
        "Sand" => (Colour::rgb(0xe6, 0xd2, 0xa8), Colour::rgb(0xa9, 0x85, 0x52)),
        "Wood" => (Colour::rgb(0xc9, 0x9b, 0x66), Colour::rgb(0x4a, 0x2f, 0x1b)),
        _ => (Colour::rgb(0x9f, 0xd3, 0xd6), Colour::rgb(0x0b, 0x3a, 0x47)),
    }
}

#[cfg(test)]
mod tests {
    use crate::floor::Geometry;
    use crate::ground::GroundMaterial;
    use crate::schema::{Kinds, parse_layout};

    fn read(grounds: &str) -> Result<crate::schema::Loaded, String> {
        let text = format!("Layout(version: 1, grounds: [{grounds}])");
        parse_layout(&text, "pond.ron", &Kinds::builtin(), &Geometry::default()).map_err(|it| it.to_string())
    }

    #[test]
    fn a_ground_without_a_place_is_the_whole_floor() {
        for name in super::NAMES {
            for text in [name.to_owned(), format!("{name}()"), format!("{name}(seed: 3)")] {
                let loaded = read(&text).unwrap();
                let ground = &loaded.layout.grounds[0];
                assert_eq!(ground.spec.material.name(), name);
                assert_eq!(ground.spec.area, Geometry::default().bounds());
                assert_eq!(loaded.warnings.to_string(), "", "no controls are needed");
            }
        }
    }

    #[test]
    fn everything_of_ice_can_be_written() {
        let text = "Ice(at: (1, 1), size: (4, 3), seed: 9, surface: \"#a0d0d0\", deep: \"#103040\",
            body: (mass_kg: 50, damping_n_s_m: 4000, stiffness_n_m: 150000),
            onsets_per_j_s: 3000, calm_j: 0,
            energy: (gamma: -2, least_j: 0.05, most_j: 5),
            ring: (level_n: 10, modes: 4, low_hz: 60, high_hz: 500, shortest_ms: 4, longest_ms: 90),
            cracks: (apart_m: 0.3, growth_m_per_j: 0.02, turn: 0.1, branch: 0, branch_deg: 30, pieces: 500),
            sheet: (depth_per_j: 0.1, reach_m: 0.2, weakening: 0, refreeze_s: None))";
        let layout = read(text).unwrap().layout;
        let GroundMaterial::Ice(ice) = layout.grounds[0].spec.material else { panic!("ice") };
        assert_eq!((ice.body.mass_kg, ice.calm_j, ice.energy.gamma), (50.0, 0.0, -2.0));
        assert_eq!((ice.ring.modes, ice.ring.longest_s), (4, 0.09));
        assert_eq!((ice.cracks.per_j_m, ice.cracks.most, ice.cracks.refreeze_s), (0.02, 500, None));
        assert!((ice.cracks.branch_rad - 30.0_f32.to_radians()).abs() < 1e-6);
        assert!((layout.grounds[0].spec.area.size().x - 4.0 * 0.304).abs() < 1e-5);
    }

    #[test]
    fn mistakes_are_told_with_their_place_and_what_was_meant() {
        let cases = [
            ("Ise(seed: 1)", "did you mean Ice?"),
            ("Ice(sed: 1)", "did you mean `seed`?"),
            ("Ice(cracks: (turnn: 1))", "did you mean `turn`?"),
            ("Ice(body: (mass_kg: 0))", "expected 0.01 to 10000 kg, found 0 kg"),
            ("Ice(ring: (low_hz: 800, high_hz: 100))", "`high_hz` must not be below `low_hz`"),
            ("Ice(energy: (least_j: 3))", "`most_j` must not be below `least_j`"),
            ("Ice(at: (4, 0), size: (4, 2))", "this Ice reaches beyond the floor"),
            ("Ice(at: (4, 0))", "lacks `size`"),
            ("Sand(cracks: (turn: 1))", "unknown field `cracks`"),
            ("Ice(sheet: (refreeze_s: 0))", "expected 1 to 1000000 s, found 0 s"),
            ("Wood(along: Up)", "expected East or North"),
            ("\"Ice\"", "names stand without quotes"),
        ];
        for (text, wanted) in cases {
            let problems = read(text).unwrap_err();
            assert!(problems.contains(wanted), "{text}:\n{problems}");
            assert!(problems.contains("pond.ron:1:"), "{problems}");
        }
    }

    #[test]
    fn grounds_of_one_page_that_overlap_are_warned_of() {
        let loaded = read("Ice(), Snow(at: (0, 0), size: (2, 2))").unwrap();
        let warning = loaded.warnings.to_string();
        assert!(warning.contains("this Snow lies on Ice") && warning.contains("2 x 2 tiles"), "{warning}");
        let text = "Layout(version: 1, pages: [(id: \"a\", grounds: [Ice]), (id: \"b\", grounds: [Snow])])";
        let loaded = parse_layout(text, "pages", &Kinds::builtin(), &Geometry::default()).unwrap();
        assert_eq!(loaded.warnings.to_string(), "");
        let pages: Vec<_> = loaded.layout.grounds.iter().map(|ground| ground.spec.page).collect();
        assert_eq!(pages, [Some(0), Some(1)]);
    }
}
