//! Effects in files: by name, or written out, made from another one or on top of an existing one.

use std::collections::BTreeMap;
use std::sync::Arc;

use underfoot_format::ron2::ast::Expr;

use super::{Band, Clicks, Effect, EffectKind, Manner, Use};
use crate::feel::Click;
use underfoot_format::codec::{By, Text};
use underfoot_format::describe::FieldType;
use underfoot_format::node::{Node, Within};
use underfoot_format::number::plain;
use underfoot_format::problem::Problem;
use underfoot_format::suggest::{did_you_mean, listed, nearest};
use underfoot_format::text::{Entry, RonText};
use underfoot_format::{Codec, Id, Includes, Num, Pair, Record, Variants, num, record};

record! {
    /// An effect with a name.
    pub struct NamedEffect = "Effect" with Effects;
    /// Its name in layouts and kinds.
    pub name: String = "name", Id;
    /// Its purpose, in a sentence; may be empty.
    pub about: String = "about", Text(200) => String::new();
    /// The effect itself.
    pub effect: Arc<Effect> = "plays", WRITTEN_OUT;
}

/// An effect that is written out.
const WRITTEN_OUT: By<Arc<Effect>, Effects> = By {
    shape: || FieldType::Variants(EffectKind::describe),
    read: |node, effects| Effect::read(node, effects).map(Arc::new),
    write: |effect| effect.to_ron(),
    stand_in: || Arc::new(Click::default().into()),
};

/// Effects by their names; in a reading, those that may be named.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    effects: BTreeMap<String, NamedEffect>,
}

impl Effects {
    /// Inserts `effect`; replaces any other of its name.
    pub fn insert(&mut self, effect: NamedEffect) {
        self.effects.insert(effect.name.clone(), effect);
    }

    /// The effect named `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&NamedEffect> {
        self.effects.get(name)
    }

    /// All effects, by name.
    pub fn iter(&self) -> impl Iterator<Item = &NamedEffect> {
        self.effects.values()
    }
}

impl Includes<Self> for Effects {
    fn included(&self) -> &Self {
        self
    }
}

/// An effect for this use.
pub(crate) struct Played(pub(crate) Use);

impl Codec<Arc<Effect>> for Played {
    type Context = Effects;

    fn read(&self, node: Node<'_>, base: Option<&Arc<Effect>>, effects: &Effects) -> Option<Arc<Effect>> {
        let effect = match node.expr {
            Expr::String(_) => named(node, effects)?,
            Expr::Struct(_) | Expr::AnonStruct(_) | Expr::Unit(_) => {
                let released = base.filter(|_| node.name == "release").and_then(|base| released(base));
                let base = released.as_ref().or(base.map(|base| &**base));
                Arc::new(effect_at(node, base, self.0, effects)?)
            }
            _ => return node.mismatch("an effect, by its name or written out"),
        };
        if self.0.fits(&effect.kind) {
            return Some(effect);
        }
        let kind = a(effect.kind.name());
        let message = match node.name {
            "plays" => format!("{kind} can't be part of a sequence"),
            part => format!("{kind} can't be played for `{part}`"),
        };
        node.report(
            Problem::error(node.span(), message)
                .expected(format!("expected {}", listed(self.0.kinds(), "or"))),
        );
        None
    }

    fn write(&self, effect: &Arc<Effect>) -> RonText {
        effect.to_ron()
    }

    fn shape(&self) -> FieldType {
        FieldType::Names(self.0.kinds().to_vec())
    }

    fn stand_in(&self) -> Arc<Effect> {
        Arc::new(Click::default().into())
    }
}

/// The release part of a click; an override of a release changes this part.
fn released(effect: &Effect) -> Option<Effect> {
    let EffectKind::Click(Clicks { release: Some(release), .. }) = &effect.kind else { return None };
    let kind = EffectKind::Click(Clicks { press: release.clone(), release: None });
    Some(Effect { kind, manner: effect.manner })
}

/// The effect that `node` names.
fn named(node: Node<'_>, effects: &Effects) -> Option<Arc<Effect>> {
    let name = node.text(64)?;
    effects.get(name).map(|found| Arc::clone(&found.effect)).or_else(|| {
        let known: Vec<&str> = effects.iter().map(|effect| effect.name.as_str()).collect();
        let problem = Problem::error(node.span(), format!("unknown effect \"{name}\""));
        node.report(problem.expected("no effect is called so").help_if(did_you_mean(name, &known, '"')));
        None
    })
}

/// The effect that is written out at `node`; missing fields come from `base` if that is of the same kind.
///
/// Fields without a kind's name belong to the kind of the base, or to the most common kind for `used`.
fn effect_at(node: Node<'_>, base: Option<&Effect>, used: Use, effects: &Effects) -> Option<Effect> {
    let name = match node.expr {
        Expr::Struct(variant) => {
            let written = &*variant.name.name;
            let Some(known) = EffectKind::NAMES.iter().find(|name| **name == written) else {
                let is_named = variant.body.is_none() && effects.get(written).is_some();
                report_unknown(node, written, is_named, used);
                return None;
            };
            known
        }
        _ => base.map_or(used.kinds()[0], |base| base.kind.name()),
    };
    let releases = node.name == "release";
    let mut fields = node.fields(name)?;
    let from = match fields.take("from") {
        Some(node) => {
            let from = named(node, effects)?;
            if from.kind.name() != name {
                let message = format!("\"{}\" is {}", node.peek_text()?, a(from.kind.name()));
                let problem = Problem::error(node.span(), message);
                node.report(problem.expected(format!("expected the name of {}", a(name))));
                return None;
            }
            if releases { released(&from).map(Arc::new).or(Some(from)) } else { Some(from) }
        }
        None => None,
    };
    let base = from.as_deref().or(base).filter(|base| base.kind.name() == name);
    let manner = Manner::read_fields(&mut fields, base.map(|base| &base.manner), &());
    // An unusable band is reported; the search for other faults uses the usual band.
    fields.keep_within(manner.band.as_bounds());
    let kind = EffectKind::read_fields(name, &mut fields, base.map(|base| &base.kind), effects);
    let all = fields.are_read();
    fields.finish();
    let mut effect = Effect { kind: kind?, manner };
    if all {
        effect.balance();
    }
    all.then_some(effect)
}

fn report_unknown(node: Node<'_>, written: &str, is_named: bool, used: Use) {
    let help = if is_named {
        Some(format!("names of effects stand in quotes: \"{written}\""))
    } else {
        let near = nearest(written, EffectKind::NAMES.iter().copied());
        let near = near.map(|name| format!("did you mean {name}?"));
        near.or_else(|| did_you_mean(written, EffectKind::NAMES, '`'))
    };
    let start = node.span().start;
    let problem = Problem::error(start..start + written.len(), format!("no effect is a {written}"));
    node.report(problem.expected(format!("expected {}(...)", used.kinds()[0])).help_if(help));
}

/// The name of a kind with its article.
fn a(name: &str) -> String {
    format!("{} {name}", if name.starts_with('E') { "an" } else { "a" })
}

impl Effect {
    /// The effect that is written out at `node`, made of those in `effects`.
    pub(crate) fn read(node: Node<'_>, effects: &Effects) -> Option<Self> {
        effect_at(node, None, Use::Once, effects)
    }

    /// Its text at the place of use.
    pub(crate) fn to_ron(&self) -> RonText {
        let mut entries: Vec<Entry> = Vec::new();
        self.kind.write_fields(&mut entries);
        self.manner.write_fields(&mut entries);
        RonText::Variant(self.kind.name(), entries)
    }
}

/// A band of frequencies, in hertz.
pub(super) struct BandFields;

const BAND: Pair = Pair { each: HERTZ, pattern: "(lowest, highest)", parts: ["lowest", "highest"] };

const HERTZ: Num = num(20.0..=1000.0);

impl Codec<Band> for BandFields {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Band>, context: &()) -> Option<Band> {
        let [low_hz, high_hz] = BAND.read(node, None, context)?;
        if high_hz < 1.5 * low_hz {
            let found = format!("{} to {} Hz", plain(low_hz.into()), plain(high_hz.into()));
            let expected = format!("expected 1.5 times the lowest as the highest, found {found}");
            node.report(Problem::error(node.span(), "this band is too narrow").expected(expected));
            return None;
        }
        Some(Band { low_hz, high_hz })
    }

    fn write(&self, band: &Band) -> RonText {
        BAND.write(&[band.low_hz, band.high_hz])
    }

    fn shape(&self) -> FieldType {
        Codec::<[f32; 2]>::shape(&BAND)
    }

    fn stand_in(&self) -> Band {
        Band::USEFUL
    }
}

impl Band {
    pub(super) fn as_bounds(self) -> Within {
        let (low, high) = (f64::from(self.low_hz), f64::from(self.high_hz));
        Within { low, high, noun: "the effect's band", wider: "widen the band: band_hz" }
    }
}
