//! Kinds made from other kinds: `Kind(name: "big_button", from: "button", press_n: 80)`.
//!
//! Kinds come in layers: those that come with underfoot, those of a folder, those of a layout. A kind may be made
//! from any kind of its own layer or of the layers below. A kind made from its own name extends and replaces the one
//! of a layer below.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::chain::Chains;
use super::diagnostic::Diagnostics;
use super::kind::{self, Kind, KindFile, Kinds};
use super::lists::MAX_WIDGETS;
use super::node::Node;
use super::pairs::Limits;
use super::problem::Problem;
use super::reader::Reader;
use super::source::{Source, read_text};
use super::suggest::did_you_mean;
use super::version;
use crate::feel::Effects;
use underfoot_format::Record;
use underfoot_format::codec::By;
use underfoot_format::describe::FieldType;
use underfoot_format::text::Text;

/// The parent of a kind.
#[derive(Clone, Copy)]
enum Parent<'k> {
    /// No parent.
    None,
    /// A kind of a layer below.
    Below(&'k Kind),
    /// Another kind of this layer.
    Here(usize),
    /// An unusable kind, which has been reported.
    Unusable,
}

/// Reads the kinds at `nodes`, on top of those `below`; `None` for each unusable kind, which has been reported.
pub(super) fn layer(nodes: &[Node<'_>], below: &Kinds) -> Vec<Option<Kind>> {
    let mut here: HashMap<&str, usize> = HashMap::new();
    for (index, node) in nodes.iter().enumerate() {
        let Some(name) = node.peek("Kind", "name") else { continue };
        let Some(text) = name.peek_text() else { continue };
        match here.get(text) {
            Some(&first) => report_twice(name, text, nodes.get(first)),
            None => drop(here.insert(text, index)),
        }
    }
    let parents: Vec<Parent<'_>> = nodes.iter().map(|node| parent(*node, &here, below)).collect();
    let follows: Vec<Option<usize>> = parents
        .iter()
        .map(|parent| match parent {
            Parent::Here(index) => Some(*index),
            Parent::None | Parent::Below(_) | Parent::Unusable => None,
        })
        .collect();
    let chains = Chains::of(&follows);
    for circle in &chains.circles {
        report_circle(circle, nodes);
    }
    let mut kinds: Vec<Option<Kind>> = vec![None; nodes.len()];
    for &index in &chains.order {
        let parent = match parents[index] {
            _ if chains.is_circular(index) => continue,
            Parent::None => None,
            Parent::Below(kind) => Some(Cow::Borrowed(kind)),
            Parent::Here(parent) => match &kinds[parent] {
                Some(kind) => Some(Cow::Owned(kind.clone())),
                None => continue,
            },
            Parent::Unusable => continue,
        };
        kinds[index] = kind::read(nodes[index], parent.as_deref(), below.effects());
    }
    kinds
}

fn parent<'k>(node: Node<'_>, here: &HashMap<&str, usize>, below: &'k Kinds) -> Parent<'k> {
    let Some(from) = node.peek("Kind", "from") else { return Parent::None };
    let Some(wanted) = from.text(64) else { return Parent::Unusable };
    let own = node.peek("Kind", "name").and_then(|name| name.peek_text());
    if own != Some(wanted)
        && let Some(&index) = here.get(wanted)
    {
        return Parent::Here(index);
    }
    if let Some(kind) = below.get(wanted) {
        return Parent::Below(kind);
    }
    let problem = if own == Some(wanted) {
        Problem::error(from.span(), "a kind can't be made from itself")
            .expected("there is no other kind of this name to replace")
    } else {
        let known: Vec<&str> =
            here.keys().copied().filter(|name| own != Some(name)).chain(below.names()).collect();
        Problem::error(from.span(), format!("unknown kind \"{wanted}\""))
            .expected("no kind is called so")
            .help_if(suggestion(wanted, known))
    };
    from.report(problem);
    Parent::Unusable
}

fn suggestion(wanted: &str, mut known: Vec<&str>) -> Option<String> {
    known.sort_unstable();
    known.dedup();
    did_you_mean(wanted, &known, '"')
}

fn report_twice(name: Node<'_>, text: &str, first: Option<&Node<'_>>) {
    let place = first.and_then(|first| first.peek("Kind", "name")).map(|first| {
        let line = first.reader.line(&first.span());
        if std::ptr::eq(first.reader, name.reader) {
            format!("the first is on line {line}")
        } else {
            format!("there is a kind \"{text}\" in {}:{line}", first.reader.name())
        }
    });
    let problem = Problem::error(name.span(), format!("two kinds are called \"{text}\""));
    name.report(problem.expected(place.unwrap_or_default()).help("give one of them another name"));
}

fn report_circle(circle: &[usize], nodes: &[Node<'_>]) {
    let from = |&index: &usize| {
        let node = nodes.get(index)?.peek("Kind", "from")?;
        Some((node, node.peek_text()?))
    };
    let members: Vec<_> = circle.iter().filter_map(from).collect();
    let Some((first, _)) = members.first() else { return };
    let names: Vec<String> = members.iter().take(8).map(|(_, name)| format!("\"{name}\"")).collect();
    let problem = Problem::error(first.span(), "these kinds are made from each other");
    first.report(problem.expected(format!("from {}", names.join(", from "))));
}

/// Reads the kinds in the files at `paths`, on top of those `below`, and returns warnings.
///
/// # Errors
/// Every problem of any of the files.
pub(super) fn read_files<P: AsRef<Path>>(
    paths: &[P],
    below: &Kinds,
) -> Result<(Vec<Kind>, Diagnostics), Diagnostics> {
    let mut problems = Diagnostics::default();
    let mut texts = Vec::new();
    for path in paths {
        let path = path.as_ref();
        match read_text(path) {
            Ok(text) => texts.push((path.display().to_string(), text)),
            Err(unreadable) => problems.append(unreadable),
        }
    }
    let texts: Vec<(&str, &str)> = texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    match read_texts(&texts, below) {
        Ok((kinds, warnings)) => {
            problems.append(warnings);
            if problems.errors() > 0 { Err(problems) } else { Ok((kinds, problems)) }
        }
        Err(errors) => {
            problems.append(errors);
            Err(problems)
        }
    }
}

/// Reads the kind in `text`, which diagnostics call `name`, on top of those `below`, and returns warnings.
///
/// # Errors
/// Every problem of the text.
pub(super) fn read_one(text: &str, name: &str, below: &Kinds) -> Result<(Kind, Diagnostics), Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = reader_of(&source)?;
    let kind = reader.root("kind").and_then(|node| layer(&[node], below).pop().flatten());
    reader.conclude(kind)
}

/// Returns the reader of a kind.
///
/// # Errors
/// The kind is of a newer version.
fn reader_of<'t>(source: &'t Source<'t>) -> Result<Reader<'t>, Diagnostics> {
    let reader = Reader::new(source, Kind::NAME, Limits::LAYOUT);
    version::newer(&reader, Kind::NAME).map_or(Ok(reader), Err)
}

/// Reads the kinds in `texts`, which come with their names in diagnostics, on top of those `below`, and returns
/// warnings.
///
/// # Errors
/// Every problem of any of the texts.
pub(super) fn read_texts(
    texts: &[(&str, &str)],
    below: &Kinds,
) -> Result<(Vec<Kind>, Diagnostics), Diagnostics> {
    let mut problems = Diagnostics::default();
    let mut sources = Vec::new();
    for (name, text) in texts {
        match Source::new(name, text) {
            Ok(source) => sources.push(source),
            Err(too_large) => problems.append(too_large),
        }
    }
    let mut readers = Vec::new();
    for source in &sources {
        match reader_of(source) {
            Ok(reader) => readers.push(reader),
            Err(newer) => problems.append(newer),
        }
    }
    let roots: Vec<Option<Node<'_>>> = readers.iter().map(|reader| reader.root("kind")).collect();
    let nodes: Vec<Node<'_>> = roots.iter().flatten().copied().collect();
    let mut read = layer(&nodes, below).into_iter();
    let kinds: Vec<Option<Kind>> =
        roots.iter().map(|root| root.and_then(|_| read.next().flatten())).collect();
    // A kind without other errors fails because of its parent; the parent's text has the report.
    let several = texts.len() > 1;
    drop(nodes);
    drop(roots);
    let mut good = Vec::new();
    for (reader, kind) in readers.into_iter().zip(kinds) {
        if kind.is_none() && several && reader.is_sound() {
            problems.append(reader.into_diagnostics());
            continue;
        }
        match reader.conclude(kind) {
            Ok((kind, warnings)) => {
                good.push(kind);
                problems.append(warnings);
            }
            Err(errors) => problems.append(errors),
        }
    }
    if problems.errors() > 0 { Err(problems) } else { Ok((good, problems)) }
}

/// The kinds available to the controls of a layout.
pub(super) struct Choice {
    kinds: Kinds,
    /// Names of unusable kinds of the layout itself, which have been reported.
    unusable: HashSet<String>,
}

/// A layout's own kinds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct OwnKinds {
    kinds: Vec<Kind>,
    /// Names of unusable kinds, which have been reported.
    unusable: HashSet<String>,
}

/// A layout's own kinds, made of those below.
pub(super) const OWN_KINDS: By<OwnKinds, Kinds> = By {
    shape: || FieldType::List {
        count: (0, MAX_WIDGETS),
        each: Box::new(FieldType::Record(KindFile::describe)),
    },
    read: |node, below| {
        let mut own = OwnKinds::default();
        let nodes = node.list("kind", MAX_WIDGETS).unwrap_or_default();
        for (node, kind) in nodes.iter().zip(layer(&nodes, below)) {
            match kind {
                Some(kind) => own.kinds.push(kind),
                None => own
                    .unusable
                    .extend(node.peek("Kind", "name").and_then(|name| name.peek_text()).map(str::to_owned)),
            }
        }
        Some(own)
    },
    write: |_| Text::List(Vec::new()),
    stand_in: OwnKinds::default,
};

impl Choice {
    /// Makes a choice of the kinds `below` and a layout's `own`, which replace others of their names.
    pub(super) fn of(below: Kinds, own: OwnKinds) -> Self {
        let mut kinds = below;
        own.kinds.into_iter().for_each(|kind| kinds.insert(kind));
        Self { kinds, unusable: own.unusable }
    }

    /// Returns the effects that controls may name.
    pub(super) fn effects(&self) -> &Effects {
        self.kinds.effects()
    }

    /// Returns the usable kinds, with the effects that controls may name.
    pub(super) fn usable(&self) -> &Kinds {
        &self.kinds
    }

    /// Returns the kind that `node` names; `None` if it is unusable, which has been reported.
    pub(super) fn named(&self, node: Node<'_>) -> Option<&Kind> {
        let name = node.text(64)?;
        if self.unusable.contains(name) {
            return None;
        }
        self.kinds.get(name).or_else(|| {
            let known = self.kinds.names().chain(self.unusable.iter().map(String::as_str)).collect();
            let problem = Problem::error(node.span(), format!("unknown kind \"{name}\""));
            node.report(problem.expected("no kind is called so").help_if(suggestion(name, known)));
            None
        })
    }
}
