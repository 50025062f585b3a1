//! Files of effects, and lists of them in layouts.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;

use super::builtin;
use super::diagnostic::{Diagnostic, Diagnostics};
use super::kind::ron_files;
use super::lists::MAX_WIDGETS;
use super::node::is_id;
use super::pairs::Limits;
use super::problem::Problem;
use super::reader::Reader;
use super::source::{Source, read_text};
use super::version::{self, FORMAT_VERSION, VERSION};
use crate::feel::{Effects, NamedEffect};
use underfoot_format::codec::By;
use underfoot_format::describe::FieldType;
use underfoot_format::text::RonText;
use underfoot_format::{Flat, Record, record};

/// The shipped effects, read once, since normalising each takes a while.
static BUILTIN: LazyLock<Effects> = LazyLock::new(|| {
    let mut effects = Effects::default();
    for (name, text) in builtin::EFFECTS {
        // A test checks that each is read without a warning.
        let added = effects.add(text, name);
        debug_assert!(added.is_ok(), "{added:?}");
    }
    effects
});

impl Effects {
    /// Returns the effects that come with underfoot: the files of `effects/`, compiled in.
    #[must_use]
    pub fn builtin() -> Self {
        BUILTIN.clone()
    }

    /// Adds the effect that `text` describes, replacing any other of the same name; returns warnings.
    ///
    /// The effect may be made of these effects, including the one that it replaces. `name` is the name of the text in
    /// diagnostics, usually a path.
    ///
    /// # Errors
    /// Every problem of the text; these effects are then unchanged.
    pub fn add(&mut self, text: &str, name: &str) -> Result<Diagnostics, Diagnostics> {
        let (effect, warnings) = parse_effect(text, name, self)?;
        self.insert(effect);
        Ok(warnings)
    }

    /// Adds the effects of all files named `*.ron` in `folder`, replacing others of the same name; returns warnings.
    ///
    /// Effects may be made of these effects, and of those in files that come earlier in alphabetical order.
    ///
    /// # Errors
    /// Every problem of any of the files, two files with an effect of the same name, or a folder that cannot be read;
    /// these effects are then unchanged.
    pub fn read_folder(&mut self, folder: &Path) -> Result<Diagnostics, Diagnostics> {
        let mut problems = Diagnostics::default();
        let mut all = self.clone();
        let mut read: BTreeMap<String, String> = BTreeMap::new();
        for path in ron_files(folder, "effects")? {
            let file = path.display().to_string();
            let text = match read_text(&path) {
                Ok(text) => text,
                Err(unreadable) => {
                    problems.append(unreadable);
                    continue;
                }
            };
            match parse_effect(&text, &file, &all) {
                Ok((effect, warnings)) => {
                    problems.append(warnings);
                    if let Some(first) = read.insert(effect.name.clone(), file.clone()) {
                        let message = format!("two effects are called \"{}\"", effect.name);
                        let help =
                            Some(format!("the other one is in {first}; give one of them another name"));
                        problems.append(Diagnostic::of_file(&file, message, help).into());
                    }
                    all.insert(effect);
                }
                Err(errors) => problems.append(errors),
            }
        }
        if problems.errors() > 0 {
            return Err(problems);
        }
        *self = all;
        Ok(problems)
    }
}

/// Whether `name` is a valid effect name: 1 to 64 of the characters a-z, 0-9 and _.
#[must_use]
pub fn is_effect_name(name: &str) -> bool {
    is_id(name)
}

/// Reads the effect that `text` describes, made of those in `effects`, and returns warnings.
///
/// `name` is the name of the text in diagnostics, usually a path.
///
/// # Errors
/// Every problem of the text.
pub fn parse_effect(
    text: &str,
    name: &str,
    effects: &Effects,
) -> Result<(NamedEffect, Diagnostics), Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = Reader::new(&source, "Effect", Limits::LAYOUT);
    if let Some(newer) = version::newer(&reader, "Effect") {
        return Err(newer);
    }
    let read: Option<EffectFile> = reader.root("effect").and_then(|node| node.record(None, effects));
    reader.conclude(read.map(|read| read.effect))
}

record! {
    /// An effect with a name: a file in `effects/`, or an entry of `effects` in a layout.
    pub(super) struct EffectFile = "Effect" with Effects;
    /// The version of the format.
    version: u32 = "version", VERSION => FORMAT_VERSION;
    /// The effect.
    effect: NamedEffect = "", Flat;
}

/// A layout's own effects; each may be made of the ones before it.
pub(super) const OWN_EFFECTS: By<Vec<NamedEffect>, Effects> = By {
    shape: || FieldType::List {
        count: (0, MAX_WIDGETS),
        each: Box::new(FieldType::Record(EffectFile::describe)),
    },
    read: |node, effects| {
        let mut known = effects.clone();
        let mut own = Vec::new();
        let mut here: BTreeMap<String, usize> = BTreeMap::new();
        for node in node.list("effect", MAX_WIDGETS).unwrap_or_default() {
            let Some(EffectFile { effect, .. }) = node.record(None, &known) else { continue };
            let line = node.reader.line(&node.span());
            if let Some(first) = here.insert(effect.name.clone(), line) {
                let span = node.peek("Effect", "name").map_or(node.span(), |name| name.span());
                let problem = Problem::error(span, format!("two effects are called \"{}\"", effect.name));
                node.report(problem.expected(format!("the first is on line {first}")));
            }
            known.insert(effect.clone());
            own.push(effect);
        }
        Some(own)
    },
    write: |_| RonText::List(Vec::new()),
    stand_in: Vec::new,
};

/// Writes the file that describes `effect`; [`parse_effect`] reads the same effect from it.
#[must_use]
pub fn write_named_effect(effect: &NamedEffect) -> String {
    let mut text = format!("{}(\n", NamedEffect::NAME);
    let mut entries = Vec::new();
    effect.write_fields(&mut entries);
    for (name, value) in entries {
        text.push_str(&format!("    {name}: {},\n", value.lay_out(1, name.len() + 6)));
    }
    text + ")\n"
}
