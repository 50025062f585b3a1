//! One entry of a layout's `widgets`: a control, or a grid of similar ones.

use std::ops::Range;

use super::area::Placed;
use super::behaviour;
use super::context::LayoutContext;
use super::fields::Fields;
use super::kind::Kind;
use super::node::{Node, is_id};
use super::place::Placing;
use super::problem::Problem;
use super::repeat::{self, Cell, RepeatRecord};
use super::send::{self, Fill};
use super::units::Units;
use crate::feel::Effects;
use crate::layout::Icon;
use crate::messages::Sending;
use underfoot_format::codec::{At, Written};
use underfoot_format::{Codec, Id};

/// One control. A field that could not be read is `None` and has been reported.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WrittenControl {
    pub(super) id: Option<String>,
    pub(super) place: Option<Placed>,
    pub(super) label: Option<String>,
    /// The index of its page; `None` if it is on all pages.
    pub(super) page: Option<usize>,
    /// The id of the page that it switches to.
    pub(super) goto: Option<Written<String>>,
    /// Its kind, with all overridden fields.
    pub(super) kind: Option<Kind>,
    /// Its messages, with their places.
    pub(super) send: Vec<Written<Sending>>,
    pub(super) written: ControlSpans,
}

/// Places of a control's fields in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ControlSpans {
    pub(super) id: Range<usize>,
    /// `at`, or the field in its place.
    pub(super) at: Range<usize>,
    pub(super) size: Option<Range<usize>>,
    pub(super) press: Option<Range<usize>>,
    pub(super) step: Option<Range<usize>>,
    pub(super) label: Option<Range<usize>>,
    pub(super) look: Option<Range<usize>>,
    pub(super) kind: Range<usize>,
    /// Place of the `repeat` field of its grid.
    pub(super) repeat: Option<Range<usize>>,
}

/// Size of a control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Size {
    Fixed([f64; 2]),
    /// The size of the neighbour.
    Neighbours,
}

/// An entry of `widgets` that describes one control or a grid of controls.
pub(super) struct Grid<'r> {
    pub(super) placing: Placing<'r>,
    pub(super) size: Option<Size>,
    /// Gaps between columns and between rows.
    pub(super) gap: [f64; 2],
    pub(super) rows: u32,
    pub(super) columns: u32,
    /// The controls, without places so far.
    pub(super) controls: Vec<(Cell, WrittenControl)>,
}

impl<'r> Grid<'r> {
    /// Reads the entry at `node`, with at most `room` controls.
    pub(super) fn read(node: Node<'r>, context: &LayoutContext, room: usize) -> Option<Self> {
        let LayoutContext { units, kinds, .. } = context;
        let mut fields = node.fields("Widget")?;
        let repeat =
            fields.read("repeat", Some(Some(None)), |node| Some(RepeatRecord::read(node, *units).map(Some)));
        let base = fields.read("kind", None, |node| kinds.named(node));
        let placing = Placing::read(&mut fields, *units);
        let size = size(&mut fields, placing.is_relative, *units);
        let goto: Option<Written<String>> = fields.take("goto").and_then(|node| At(Id).read(node, None, &()));
        let send = fields.take("send");
        let repeat_at = fields.value_span("repeat");
        // If the grid is unreadable, its ids are not checked, since they may be patterns.
        let names = match &repeat {
            Some(Some(Some(repeat))) => names_of_grid(&mut fields, repeat, room),
            Some(Some(None)) => {
                let id = fields.read("id", None, |node| node.id().map(str::to_owned));
                let label = fields.read("label", Some(""), |node| node.text(64));
                let cell = Cell { index: 0, column: 0, row: 0 };
                vec![(cell, id, label.map(str::to_owned))]
            }
            _ => {
                let _ = (fields.take("id"), fields.take("label"));
                Vec::new()
            }
        };
        let span_of = |field| fields.value_span(field);
        let id_at = span_of("id").or_else(|| span_of("repeat")).unwrap_or_else(|| fields.start());
        let written = ControlSpans {
            id: id_at,
            at: placing.at.clone(),
            size: span_of("size"),
            press: span_of("press_n"),
            step: span_of("step"),
            label: span_of("label"),
            look: span_of("look"),
            kind: fields.span("kind"),
            repeat: repeat_at,
        };
        let kind = match base {
            Some(base) => {
                fields.set_noun(format!("widget of the kind \"{}\"", base.name));
                let kind = overridden(&mut fields, base, kinds.effects());
                fields.finish();
                kind
            }
            // Only the kind could tell which other fields are valid.
            None => {
                fields.allow_unknown();
                fields.finish();
                None
            }
        };
        let sends = base.map(|base| (send, base.send.as_slice(), node));
        let mut sound = true;
        let control = |(cell, id, label): (Cell, Option<String>, Option<String>)| {
            let (kind, goto, written) = (kind.clone(), goto.clone(), written.clone());
            // Problems of a message are reported for the first control of a grid.
            let send = sends.filter(|_| sound).map(|sends| messages(sends, cell, label.as_deref()));
            sound &= send.as_ref().is_none_or(Option::is_some);
            let (kind, send) = (kind.filter(|_| sound), send.flatten().unwrap_or_default());
            (cell, WrittenControl { id, label, place: None, page: None, goto, kind, send, written })
        };
        let controls = names.into_iter().map(control).collect();
        let repeat = repeat.flatten().flatten().unwrap_or_else(RepeatRecord::single);
        Some(Self { placing, size, gap: repeat.gap, rows: repeat.rows, columns: repeat.columns, controls })
    }
}

/// Reads the messages of one control of a grid: its own, or those of its kind.
fn messages(
    (own, inherited, entry): (Option<Node<'_>>, &[Sending], Node<'_>),
    cell: Cell,
    label: Option<&str>,
) -> Option<Vec<Written<Sending>>> {
    let fill: &Fill<'_> = &|node, pattern| fill(node, pattern, cell, label);
    match own {
        Some(node) => send::read_all(node, fill),
        None => send::inherited(inherited, entry, fill),
    }
}

fn size(fields: &mut Fields<'_>, is_relative: bool, units: Units) -> Option<Size> {
    let (least, most) = (units.shortest(), units.furthest());
    fields.read("size", is_relative.then_some(Size::Neighbours), |node| {
        node.pair(least..=most).map(Size::Fixed)
    })
}

type Names = Vec<(Cell, Option<String>, Option<String>)>;

/// Returns the ids and labels of all cells of a grid; none if there are more than `room`.
fn names_of_grid(fields: &mut Fields<'_>, repeat: &RepeatRecord<'_>, room: usize) -> Names {
    let label = match fields.take("label") {
        Some(node) if repeat.has_labels() => {
            twice(node, "labels");
            None
        }
        Some(node) => node.text(64).map(|text| (node, text)),
        None => None,
    };
    let id = match fields.take("id") {
        Some(node) if repeat.has_ids() => {
            twice(node, "ids");
            None
        }
        Some(node) => node.text(64).map(|text| (node, text)),
        None if repeat.has_ids() => None,
        // This reports the missing field.
        None => fields.read("id", None, |_| None),
    };
    let cells: Vec<Cell> = repeat.cells().collect();
    if cells.len() > room {
        let problem = Problem::error(fields.span("repeat"), "too many controls");
        let expected = format!("{} more, with room for {room} of {}", cells.len(), super::lists::MAX_WIDGETS);
        fields.report(problem.expected(expected));
        return Names::new();
    }
    // An invalid pattern is reported first.
    let first = cells.first().copied();
    let sound = |(node, pattern): (Node<'_>, &str)| {
        first.is_none_or(|cell| fill(node, pattern, cell, Some("")).is_some())
    };
    if !id.is_none_or(sound) {
        return Names::new();
    }
    if let Some((node, pattern)) = id
        && cells.len() > 1
        && !repeat::varies(pattern)
    {
        let message = format!("all {} controls would have the id \"{pattern}\"", cells.len());
        let problem = Problem::error(node.span(), message).expected("expected a pattern");
        node.report(problem.help(format!("number them: \"{pattern}_{{n}}\"")));
        return Names::new();
    }
    let mut sound = true;
    let mut names = Names::new();
    for cell in cells {
        // Problems of a pattern are reported once.
        if !sound {
            names.push((cell, None, None));
            continue;
        }
        let label = match (repeat.label(cell), label) {
            (Some(node), _) => node.text(64).map(str::to_owned),
            (None, Some((node, pattern))) => fill(node, pattern, cell, None),
            (None, None) => Some(String::new()),
        };
        sound &= label.is_some() || repeat.has_labels();
        let id = match (repeat.id(cell), id) {
            (Some(node), _) => node.id().map(str::to_owned),
            (None, Some((node, pattern))) => {
                let id = fill(node, pattern, cell, label.as_deref()).filter(|id| is_fit(node, id));
                sound &= id.is_some() || label.is_none();
                id
            }
            (None, None) => None,
        };
        names.push((cell, id, label));
    }
    names
}

fn twice(node: Node<'_>, list: &str) {
    let message = format!("`{}` is given twice", node.name);
    let problem = Problem::error(node.span(), message).expected(format!("`{list}` of `repeat` gives it"));
    node.report(problem.help(format!("leave out `{}` or `{list}`", node.name)));
}

fn fill(node: Node<'_>, pattern: &str, cell: Cell, label: Option<&str>) -> Option<String> {
    match repeat::filled(pattern, cell, label) {
        Ok(text) => Some(text),
        Err((message, help)) => {
            node.report(Problem::error(node.span(), message).expected("in this pattern").help_if(help));
            None
        }
    }
}

/// Whether an id made from a pattern is valid; reports it if not.
fn is_fit(node: Node<'_>, id: &str) -> bool {
    let fits = is_id(id);
    if !fits {
        let problem = Problem::error(node.span(), format!("this pattern gives the id \"{id}\""));
        node.report(problem.expected("expected 1 to 64 of the characters a-z, 0-9 and _"));
    }
    fits
}

/// Reads the fields that this widget overrides, over `base`; its feel may name `effects`.
fn overridden(fields: &mut Fields<'_>, base: &Kind, effects: &Effects) -> Option<Kind> {
    let behaviour = behaviour::read_over(fields, &base.behaviour);
    let look = fields.read("look", Some(base.look), |node| node.record(Some(&base.look), &()));
    if let (Some(behaviour), Some(look), Some(span)) = (&behaviour, &look, fields.value_span("look"))
        && look.icon.is_some()
        && base.look.icon != look.icon
        && !Icon::is_shown_on(behaviour)
    {
        let problem = Problem::warning(span, "no icon is shown on this control");
        fields.report(
            problem.expected("its face shows its value").help("buttons, holds and switches show icons"),
        );
    }
    let feel = fields.read("feel", Some(base.feel.clone()), |node| node.record(Some(&base.feel), effects));
    let (name, send) = (base.name.clone(), base.send.clone());
    Some(Kind { name, behaviour: behaviour?, look: look?, feel: feel?, send })
}
