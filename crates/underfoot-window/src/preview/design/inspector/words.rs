//! Plain words for the fields of layouts, and the part of their range that feet use.

/// The words for a field, for an inspector.
struct FieldWords {
    /// Its name in files; with the record before it where another record has a field of the same name.
    name: &'static str,
    label: &'static str,
    /// The part of the valid range that feet use: slider ends. Values beyond them are typed.
    usual: Option<(f64, f64)>,
    /// The value of an optional field that is switched on, as the file writes it.
    start: &'static str,
}

const fn plain(name: &'static str, label: &'static str) -> FieldWords {
    FieldWords { name, label, usual: None, start: "" }
}

const fn usual(name: &'static str, label: &'static str, low: f64, high: f64) -> FieldWords {
    FieldWords { name, label, usual: Some((low, high)), start: "" }
}

impl FieldWords {
    const fn from(self, start: &'static str) -> Self {
        Self { start, ..self }
    }
}

// A standing person puts 300 to 400 N on each foot, and a resting working foot some 20 N. Times follow the shipped
// kinds, whose values all lie within these ranges.
const WORDS: [FieldWords; 76] = [
    plain("id", "Name for apps"),
    plain("kind", "Kind"),
    plain("label", "Text on it"),
    plain("at", "Place"),
    plain("size", "Size"),
    plain("goto", "Opens the page"),
    plain("title", "Title"),
    plain("cursor", "Worked by"),
    usual("press_n", "Takes", 20.0, 250.0),
    usual("release_n", "Lets go below", 5.0, 200.0),
    usual("dwell_ms", "Held for", 0.0, 400.0),
    usual("lockout_ms", "Then waits", 0.0, 400.0),
    usual("press_share", "Takes of weight", 0.05, 0.8).from("0.15"),
    usual("release_share", "Lets go at share", 0.02, 0.6).from("0.1"),
    plain("guard", "Guard"),
    usual("within_s", "Second press in", 1.0, 10.0).from("3"),
    usual("max_s", "Stops after", 5.0, 300.0).from("60"),
    usual("warn_s", "Warns before", 1.0, 60.0).from("10"),
    plain("acts_on", "Acts on"),
    usual("double_tap_ms", "Double tap in", 150.0, 600.0).from("350"),
    usual("long_press_ms", "Long press from", 300.0, 2000.0).from("600"),
    usual("swipe_m", "Swipe from", 0.05, 0.4).from("0.12"),
    usual("hard_n", "Hard press from", 100.0, 500.0).from("200"),
    usual("hard_release_n", "Hard until", 50.0, 400.0).from("150"),
    plain("initial", "Starts at"),
    plain("axis", "Grows to the"),
    plain("options", "Options"),
    usual("angle_deg", "At an angle of", -180.0, 180.0).from("45"),
    plain("arc_deg", "Along an arc").from("(180, 0)"),
    plain("mapping", "Foot sets"),
    usual("gain", "Gain", 0.1, 4.0).from("1"),
    usual("full_per_s", "At most per second", 0.05, 5.0).from("0.5"),
    plain("min", "Least"),
    plain("max", "Greatest"),
    plain("step", "Step"),
    plain("detent", "Catches every"),
    usual("deadband_n", "Begins above", 0.0, 200.0).from("60"),
    usual("full_n", "Full at", 50.0, 600.0),
    usual("curve", "Curve", 0.5, 3.0),
    usual("turn_deg", "Turns through", 90.0, 1080.0),
    usual("repeat_after_ms", "Repeats after", 200.0, 1500.0).from("600"),
    usual("repeat_every_ms", "Then every", 50.0, 1000.0),
    usual("fastest_ms", "Down to every", 20.0, 300.0),
    usual("settle_ms", "Settles for", 0.0, 600.0),
    usual("deadband_m", "Begins beyond", 0.0, 0.03),
    usual("full_m", "Full at", 0.01, 0.08),
    plain("look.shape", "Outline"),
    plain("look.face", "Face"),
    plain("look.lit", "While pressed"),
    plain("look.ink", "Text and icon"),
    plain("look.icon", "Icon"),
    plain("feel.press", "At the press"),
    plain("feel.release", "At the release"),
    plain("feel.step", "At each step"),
    plain("feel.end", "At an end"),
    plain("feel.stage", "At the next stage"),
    plain("feel.arm", "When armed"),
    plain("feel.warn", "As a warning"),
    plain("feel.on", "Turned on"),
    plain("feel.off", "Turned off"),
    plain("feel.hold", "While held"),
    plain("feel.drag", "While sliding"),
    usual("sound", "Also heard", 0.0, 1.0),
    plain("seed", "Pattern"),
    plain("surface", "Surface"),
    plain("deep", "In the depth"),
    plain("body", "Elastic body"),
    plain("energy", "Energies"),
    plain("ring", "Resonances"),
    plain("cracks", "Cracks"),
    plain("sheet", "Wear"),
    usual("reach_m", "Reaches", 0.05, 0.5),
    usual("settle_s", "Settles for", 10.0, 500.0),
    usual("plank_m", "Plank width", 0.06, 0.3),
    plain("along", "Planks run"),
    usual("stick_n", "Joints slip at", 20.0, 600.0),
];

fn words(name: &str) -> Option<&'static FieldWords> {
    let short = name.rsplit('.').next().unwrap_or_default();
    WORDS.iter().find(|words| words.name == name).or_else(|| WORDS.iter().find(|words| words.name == short))
}

/// The plain name of the field called `name` in files, which may be dotted; for an unknown field its name with
/// spaces.
pub(in crate::preview::design) fn label(name: &str) -> String {
    let short = name.rsplit('.').next().unwrap_or_default();
    words(name).map_or_else(|| capital(&short.replace('_', " ")), |words| words.label.into())
}

/// The part of the range of the field called `name` that feet use.
pub(super) fn usual_range(name: &str) -> Option<(f64, f64)> {
    words(name)?.usual
}

/// The value with which an optional field is switched on, as the file writes it.
pub(super) fn start(name: &str) -> Option<&'static str> {
    words(name).map(|words| words.start).filter(|start| !start.is_empty())
}

/// Choices in plain words, by their names in files.
const CHOICES: [(&str, &str); 20] = [
    ("Free", "none"),
    ("Confirm", "a second press"),
    ("HoldToRun", "only while held"),
    ("Press", "the press"),
    ("Release", "the release"),
    ("Largest", "the heaviest foot"),
    ("Working", "the working foot"),
    ("Each", "every foot"),
    ("East", "east"),
    ("North", "north"),
    ("Box", "rectangle"),
    ("Round", "ellipse"),
    ("Absolute", "the value"),
    ("Relative", "a change of it"),
    ("Rate", "its speed"),
    ("None", "none"),
    ("true", "yes"),
    ("false", "no"),
    ("Up", "up"),
    ("Down", "down"),
];

/// The choice called `name` in files, in plain words: quotes go, and the names of kinds and effects get spaces.
pub(super) fn choice(name: &str) -> String {
    let bare = name.trim_matches('"');
    let known = CHOICES.iter().find(|(known, _)| *known == name);
    known.map_or_else(|| bare.replace('_', " "), |(_, words)| (*words).into())
}

/// `text` with a capital letter.
pub(in crate::preview::design) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::edit::Document;
    use underfoot::feel::Feel;
    use underfoot::layout::Look;
    use underfoot::schema::Kinds;
    use underfoot::widget::Behaviour;
    use underfoot_format::describe::{FieldDescription, FieldType};
    use underfoot_format::{Record, Variants};

    fn with_parts(prefix: &str, fields: &[FieldDescription], all: &mut Vec<(String, FieldType)>) {
        for field in fields {
            all.push((format!("{prefix}{}", field.name), field.shape.clone()));
            if matches!(field.shape, FieldType::Variants(_)) {
                let parts = field.shape.parts();
                parts.iter().for_each(|part| with_parts(&format!("{}.", field.name), &part.fields, all));
            }
        }
    }

    fn fields_of_controls() -> Vec<(String, FieldType)> {
        let mut all = Vec::new();
        Behaviour::describe().iter().for_each(|record| with_parts("", &record.fields, &mut all));
        with_parts("look.", &Look::describe().fields, &mut all);
        for field in Feel::describe().fields {
            all.push((format!("feel.{}", field.name), field.shape));
        }
        all
    }

    #[test]
    fn every_field_of_a_control_has_plain_words_and_its_usual_values_are_valid() {
        for (name, shape) in fields_of_controls() {
            let known = words(&name).unwrap_or_else(|| panic!("no plain words for {name}"));
            assert!(known.label.chars().count() <= 18, "{name}: {}", known.label);
            let number = match &shape {
                FieldType::Optional(inner) => inner,
                other => other,
            };
            if let (Some((low, high)), FieldType::Number { range, .. }) = (known.usual, number) {
                assert!(range.0 <= low && low < high && high <= range.1, "{name}: {low} to {high}");
            }
            if matches!(&shape, FieldType::Optional(inner) if matches!(**inner, FieldType::Number { .. })) {
                assert!(!known.start.is_empty(), "{name} can't be switched on");
            }
        }
        let names: BTreeSet<_> = WORDS.iter().map(|words| words.name).collect();
        assert_eq!(names.len(), WORDS.len(), "one entry per field");
    }

    #[test]
    fn the_values_of_all_shipped_kinds_lie_in_the_range_that_feet_use() {
        for kind in Kinds::builtin().iter() {
            for property in Document::fields_of_kind(kind).iter().flat_map(|part| &part.properties) {
                let value = property.value.parse::<f64>();
                if let (Some((low, high)), Ok(value)) = (usual_range(&property.name), value) {
                    assert!(low <= value && value <= high, "{}: {} {value}", kind.name, property.name);
                }
            }
        }
    }
}
