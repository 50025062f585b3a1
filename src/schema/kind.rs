use std::collections::BTreeMap;
use std::path::Path;

use super::behaviour::{self, Form};
use super::builtin;
use super::diagnostic::{Diagnostic, Diagnostics};
use super::feel;
use super::look;
use super::node::Node;
use super::pairs::Limits;
use super::reader::Reader;
use super::source::{Source, read_text};
use super::suggest::did_you_mean;
use super::version;
use crate::feel::Feel;
use crate::layout::Look;
use crate::widget::Behaviour;

/// One kind of control: what its widgets do, feel and look like unless they say otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// What layouts call it.
    pub name: String,
    /// What it does, with all settings.
    pub behaviour: Behaviour,
    /// What it feels like.
    pub feel: Feel,
    /// What it looks like.
    pub look: Look,
}

/// The kinds that a layout may use, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kinds {
    kinds: BTreeMap<String, Kind>,
}

impl Kinds {
    /// The kinds that come with underfoot: the files of `widgets/`, compiled in.
    #[must_use]
    pub fn builtin() -> Self {
        let mut kinds = Self::default();
        for (name, text) in builtin::KINDS {
            // That each of them reads without a warning is tested.
            let added = kinds.add(text, name);
            debug_assert!(added.is_ok(), "{added:?}");
        }
        kinds
    }

    /// Adds the kind that `text` describes, in place of any other of its name; gives back warnings.
    ///
    /// `name` is what diagnostics call the text, usually a path.
    ///
    /// # Errors
    /// Everything wrong with the text; these kinds then stay as they were.
    pub fn add(&mut self, text: &str, name: &str) -> Result<Diagnostics, Diagnostics> {
        let (kind, warnings) = parse_kind(text, name)?;
        self.kinds.insert(kind.name.clone(), kind);
        Ok(warnings)
    }

    /// Adds the kinds of all files named `*.ron` in `folder`, in place of others of their names; gives back warnings.
    ///
    /// # Errors
    /// Everything wrong with any of the files, two files that describe a kind
    /// of the same name, or a folder that cannot be read; these kinds then stay as they were.
    pub fn read_folder(&mut self, folder: &Path) -> Result<Diagnostics, Diagnostics> {
        let mut problems = Diagnostics::default();
        let mut read: BTreeMap<String, (Kind, String)> = BTreeMap::new();
        for path in ron_files(folder)? {
            let name = path.display().to_string();
            match read_text(&path).and_then(|text| parse_kind(&text, &name)) {
                Ok((kind, warnings)) => {
                    problems.append(warnings);
                    if let Some((_, first)) = read.get(&kind.name) {
                        let message = format!("there is a kind \"{}\" in {first} already", kind.name);
                        let help = Some("give one of them another name".into());
                        problems.append(Diagnostic::of_file(&name, message, help).into());
                    }
                    read.insert(kind.name.clone(), (kind, name));
                }
                Err(errors) => problems.append(errors),
            }
        }
        if problems.errors() > 0 {
            return Err(problems);
        }
        self.kinds.extend(read.into_iter().map(|(name, (kind, _))| (name, kind)));
        Ok(problems)
    }

    /// The kind called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Kind> {
        self.kinds.get(name)
    }

    /// All kinds, by name.
    pub fn iter(&self) -> impl Iterator<Item = &Kind> {
        self.kinds.values()
    }

    /// What to say to those who asked for a kind that isn't there.
    pub(super) fn suggestion(&self, name: &str) -> Option<String> {
        let names: Vec<&str> = self.kinds.keys().map(String::as_str).collect();
        did_you_mean(name, &names, '"')
    }
}

fn parse_kind(text: &str, name: &str) -> Result<(Kind, Diagnostics), Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = Reader::new(&source, "Kind", Limits::LAYOUT);
    if let Some(newer) = version::newer(&reader, "Kind") {
        return Err(newer);
    }
    let kind = reader.root("kind").and_then(kind);
    reader.conclude(kind)
}

fn kind(node: Node<'_>) -> Option<Kind> {
    let mut fields = node.fields("Kind")?;
    fields.read("version", Some(1), version::read);
    let name = fields.read("name", None, |node| node.id());
    let form = fields.read("behaviour", None, Form::read);
    let behaviour = form.and_then(|form| behaviour::read(&mut fields, form));
    let look = fields.read("look", Some(look::PLAIN), |node| look::read_over(node, look::PLAIN));
    let silent = Feel::default();
    let feel = fields.read("feel", Some(silent.clone()), |node| feel::read_over(node, &silent));
    match form {
        Some(_) => fields.finish(),
        None => fields.finish_leniently(),
    }
    Some(Kind { name: name?.to_owned(), behaviour: behaviour?, feel: feel?, look: look? })
}

/// The files named `*.ron` in `folder`, sorted.
fn ron_files(folder: &Path) -> Result<Vec<std::path::PathBuf>, Diagnostics> {
    let unreadable = |error: std::io::Error| {
        let message = format!("the folder of control kinds cannot be read: {error}");
        Diagnostic::of_file(&folder.display().to_string(), message, None)
    };
    let mut files = Vec::new();
    for entry in folder.read_dir().map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
