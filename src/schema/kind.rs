//! Kinds of controls, and folders of them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::behaviour::check_guard;
use super::builtin;
use super::diagnostic::{Diagnostic, Diagnostics};
use super::inherit;
use super::node::Node;
use super::problem::Problem;
use super::send::SENDS;
use super::version::{FORMAT_VERSION, VERSION};
use crate::feel::{Effects, Feel, NamedEffect};
use crate::layout::Look;
use crate::messages::Sending;
use crate::widget::Behaviour;
use underfoot_format::codec::Beside;
use underfoot_format::{Flat, Id, Includes, Opt, Rec, Record, Text, record};

record! {
    /// One kind of control: behaviour, feel and look of its widgets, which they may override.
    pub struct Kind = "Kind" with Effects;
    /// Its name in layouts.
    pub name: String = "name", Id;
    /// Its behaviour, with all settings.
    pub behaviour: Behaviour = "behaviour", Beside;
    /// Its haptic feedback.
    pub feel: Feel = "feel", Rec => Feel::default();
    /// Its appearance.
    pub look: Look = "look", Rec => Look::PLAIN;
    /// Its messages to other programs.
    pub send: Vec<Sending> = "send", SENDS => Vec::new();
}

record! {
    /// A kind of control: a file in `widgets/`, or an entry of `kinds` in a layout.
    pub(super) struct KindFile = "Kind" with Effects;
    /// The version of the format.
    version: u32 = "version", VERSION => FORMAT_VERSION;
    /// The kind that it is made from; all fields that are not written come from that one.
    from: Option<String> = "from", Opt(Text(64)) => None;
    /// The kind.
    kind: Kind = "", Flat;
}

/// The kinds available to a layout, by name, and the effects available to both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kinds {
    kinds: BTreeMap<String, Kind>,
    effects: Arc<Effects>,
}

impl Kinds {
    /// Returns the kinds and effects that come with underfoot: the files of `widgets/` and `effects/`, compiled in.
    #[must_use]
    pub fn builtin() -> Self {
        let kinds = Self::shipped(Effects::builtin());
        // A test checks that each is read without a warning.
        debug_assert!(kinds.is_ok(), "{kinds:?}");
        kinds.unwrap_or_default()
    }

    /// Returns the kinds that come with underfoot with the given `effects`, which may replace shipped ones.
    ///
    /// # Errors
    /// An effect that a shipped kind names is missing, or cannot be played there.
    pub fn shipped(effects: Effects) -> Result<Self, Diagnostics> {
        let mut kinds = Self::knowing(effects);
        for (name, text) in builtin::KINDS {
            kinds.add(text, name)?;
        }
        Ok(kinds)
    }

    /// Returns a set without kinds, with effects for later kinds.
    #[must_use]
    pub fn knowing(effects: Effects) -> Self {
        Self { kinds: BTreeMap::new(), effects: Arc::new(effects) }
    }

    /// Adds the kind that `text` describes, replacing any other of the same name; returns warnings.
    ///
    /// The kind may be made from any of these kinds, including the one that it replaces. `name` is the name of the
    /// text in diagnostics, usually a path.
    ///
    /// # Errors
    /// Every problem of the text; these kinds are then unchanged.
    pub fn add(&mut self, text: &str, name: &str) -> Result<Diagnostics, Diagnostics> {
        let (kind, warnings) = inherit::read_one(text, name, self)?;
        self.insert(kind);
        Ok(warnings)
    }

    /// Adds the kinds that these texts describe, replacing others of the same name; returns warnings. Each comes with
    /// its name in diagnostics.
    ///
    /// A kind may be made from another one of the texts or from any of these kinds.
    ///
    /// # Errors
    /// Every problem of any of the texts, or two of them with a kind of the same name; these kinds are then unchanged.
    pub fn add_all(&mut self, texts: &[(&str, &str)]) -> Result<Diagnostics, Diagnostics> {
        let (kinds, warnings) = inherit::read_texts(texts, self)?;
        kinds.into_iter().for_each(|kind| self.insert(kind));
        Ok(warnings)
    }

    /// Adds the kinds of all files named `*.ron` in `folder`, replacing others of the same name; returns warnings.
    ///
    /// # Errors
    /// Every problem of any of the files, two files with a kind of the same name, or a folder that cannot be read;
    /// these kinds are then unchanged.
    ///
    /// A kind may be made from another one of the folder or from any of these kinds.
    pub fn read_folder(&mut self, folder: &Path) -> Result<Diagnostics, Diagnostics> {
        let (kinds, warnings) = inherit::read_files(&ron_files(folder, "control kinds")?, self)?;
        kinds.into_iter().for_each(|kind| self.insert(kind));
        Ok(warnings)
    }

    /// Returns the effects that kinds and layouts may name.
    #[must_use]
    pub fn effects(&self) -> &Arc<Effects> {
        &self.effects
    }

    /// Returns these kinds, with `own` among the effects in place of any others of their names.
    pub(super) fn with_effects(&self, own: Vec<NamedEffect>) -> Self {
        let mut all = self.clone();
        if !own.is_empty() {
            let effects = Arc::make_mut(&mut all.effects);
            own.into_iter().for_each(|effect| effects.insert(effect));
        }
        all
    }

    /// Adds `kind`, replacing any other of the same name.
    pub(super) fn insert(&mut self, kind: Kind) {
        self.kinds.insert(kind.name.clone(), kind);
    }

    /// Returns the kind called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Kind> {
        self.kinds.get(name)
    }

    /// Returns all kinds, by name.
    pub fn iter(&self) -> impl Iterator<Item = &Kind> {
        self.kinds.values()
    }

    /// Returns the names of all kinds, sorted.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.kinds.keys().map(String::as_str)
    }
}

impl Includes<Self> for Kinds {
    fn included(&self) -> &Self {
        self
    }
}

/// Reads the kind at `node`, which may name `effects`; with a `parent`, fields that are not written come from the parent.
pub(super) fn read(node: Node<'_>, parent: Option<&Kind>, effects: &Effects) -> Option<Kind> {
    let mut fields = node.fields(KindFile::NAME)?;
    let base = parent.map(|kind| KindFile { version: FORMAT_VERSION, from: None, kind: kind.clone() });
    if let (Some(parent), Some(span)) = (parent, fields.value_span("behaviour")) {
        let message = format!("what this kind does comes from \"{}\"", parent.name);
        let expected = format!("that one is a {}", parent.behaviour.name());
        let help = "leave out `behaviour`, or `from`";
        fields.report(Problem::error(span, message).expected(expected).help(help));
        fields.refuse("behaviour");
    }
    // The name is the only field not inherited from a parent.
    if parent.is_some() && fields.value_span("name").is_none() {
        fields.lack("name");
        fields.fail("name");
    }
    let read = KindFile::read_fields(&mut fields, base.as_ref(), effects);
    if !fields.have_failed(&["behaviour"]) {
        check_guard(&fields, &read.kind.behaviour);
    }
    let good = fields.are_read();
    fields.finish();
    good.then_some(read.kind)
}

/// Maximum number of kinds in one folder.
const MAX_FILES: usize = 4096;

/// Returns the files named `*.ron` in `folder`, sorted; messages call their contents `what`.
pub(super) fn ron_files(folder: &Path, what: &str) -> Result<Vec<std::path::PathBuf>, Diagnostics> {
    let unreadable = |error: std::io::Error| {
        let message = format!("the folder of {what} cannot be read: {error}");
        Diagnostic::of_file(&folder.display().to_string(), message, None)
    };
    let mut files = Vec::new();
    for entry in folder.read_dir().map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            files.push(path);
        }
        if files.len() > MAX_FILES {
            let message = format!("the folder holds more than {MAX_FILES} {what}");
            let help = Some("is this the right folder?".into());
            return Err(Diagnostic::of_file(&folder.display().to_string(), message, help).into());
        }
    }
    files.sort();
    Ok(files)
}
