//! Effects as written: `Click(level_n: 12, modes: [...])` where it is felt, or in a file of its own by its name.

mod curves;
mod lasting;
mod library;
mod once;
mod stops;
mod write;

use std::sync::Arc;

use ron2::ast::Expr;

use super::behaviour::single;
use super::fields::Fields;
use super::node::Node;
use super::number::plain;
use super::problem::Problem;
use super::suggest::{did_you_mean, nearest};
use crate::feel::{Band, Effect, EffectKind, Manner, Use};

pub(super) use library::list;
pub use library::{Effects, NamedEffect, parse_effect};
pub use write::{write_effect, write_named_effect};

/// What the floor's actuators move and a foot can feel, in hertz.
const HERTZ: std::ops::RangeInclusive<f64> = 20.0..=1000.0;

/// Force at the plate; actuators give 40 N and more.
const LEVEL_N: std::ops::RangeInclusive<f64> = 0.0..=200.0;

/// The kinds of effects by the names they have in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Click,
    Continuous,
    Sequence,
    Friction,
    StickSlip,
    Texture,
    Grains,
    Detents,
    EndStop,
}

impl Form {
    const ALL: [(&'static str, Self); 9] = [
        ("Click", Self::Click),
        ("Continuous", Self::Continuous),
        ("Sequence", Self::Sequence),
        ("Friction", Self::Friction),
        ("StickSlip", Self::StickSlip),
        ("Texture", Self::Texture),
        ("Grains", Self::Grains),
        ("Detents", Self::Detents),
        ("EndStop", Self::EndStop),
    ];

    fn named(name: &str) -> Option<(&'static str, Self)> {
        Self::ALL.into_iter().find(|(known, _)| *known == name)
    }

    /// What is meant by fields without a name.
    const fn usual(of: Use) -> (&'static str, Self) {
        match of {
            Use::Once | Use::Step | Use::End => ("Click", Self::Click),
            Use::Hold => ("Continuous", Self::Continuous),
            Use::Drag => ("Friction", Self::Friction),
        }
    }
}

/// What a control feels when it is `used` so: an effect by name or written out, on top of `base`; `None` for none.
pub(super) fn read(node: Node<'_>, base: Option<&Arc<Effect>>, used: Use) -> Option<Option<Arc<Effect>>> {
    if node.is_none() {
        return Some(None);
    }
    let effect = match node.peek_text() {
        Some(_) => named(node)?,
        None => {
            let released = base.filter(|_| node.what == "release").and_then(|base| released(base));
            let base = released.as_ref().or(base.map(|base| &**base));
            Arc::new(written(node, base, Form::usual(used))?)
        }
    };
    if !used.fits(&effect.kind) {
        let message = format!("a {} can't be played for `{}`", effect.kind.name(), node.what);
        node.report(Problem::error(node.span(), message).expected(format!("expected {}", used.fitting())));
        return None;
    }
    Some(Some(effect))
}

/// What of a click is felt for a release, so that it is what an override of it changes.
fn released(effect: &Effect) -> Option<Effect> {
    let EffectKind::Click { release: Some(release), .. } = &effect.kind else { return None };
    let kind = EffectKind::Click { press: release.clone(), release: None };
    Some(Effect { kind, manner: effect.manner })
}

/// The effect that `node` names.
fn named(node: Node<'_>) -> Option<Arc<Effect>> {
    let name = node.text(64)?;
    let effects = node.reader.effects();
    effects.get(name).map(|found| Arc::clone(&found.effect)).or_else(|| {
        let known: Vec<&str> = effects.iter().map(|effect| effect.name.as_str()).collect();
        let problem = Problem::error(node.span(), format!("unknown effect \"{name}\""));
        node.report(problem.expected("no effect is called so").help_if(did_you_mean(name, &known, '"')));
        None
    })
}

/// The effect that is written out at `node`; what it leaves out is `base`'s if that is of the same kind.
fn written(node: Node<'_>, base: Option<&Effect>, usual: (&'static str, Form)) -> Option<Effect> {
    let (name, form) = match node.expr {
        Expr::Struct(variant) => {
            let written = &*variant.name.name;
            let Some(known) = Form::named(written) else {
                let names: Vec<&str> = Form::ALL.iter().map(|(name, _)| *name).collect();
                let help = nearest(written, names.iter().copied()).map_or_else(
                    || did_you_mean(written, &names, '`'),
                    |name| Some(format!("did you mean {name}?")),
                );
                let problem = Problem::error(
                    node.span().start..node.span().start + written.len(),
                    format!("no effect is a {written}"),
                );
                node.report(problem.expected(format!("expected {}(...)", usual.0)).help_if(help));
                return None;
            };
            known
        }
        // Without a name it is what it was before.
        _ => base.and_then(|base| Form::named(base.kind.name())).unwrap_or(usual),
    };
    let mut fields = node.fields(name)?;
    let from = match fields.take("from") {
        Some(node) => {
            let from = named(node)?;
            if from.kind.name() != name {
                let message =
                    format!("this is a {name}, \"{}\" is a {}", node.peek_text()?, from.kind.name());
                node.report(Problem::error(node.span(), message).expected("expected one of the same kind"));
                return None;
            }
            Some(from)
        }
        None => None,
    };
    let base = from.as_deref().or(base).filter(|base| base.kind.name() == name);
    let effect = merge(&mut fields, form, base);
    fields.finish();
    effect
}

/// What `$base` holds if it is of this kind.
macro_rules! of {
    ($base:expr, $variant:ident) => {
        match $base.map(|base| &base.kind) {
            Some(EffectKind::$variant(of)) => Some(of),
            _ => None,
        }
    };
}

fn merge(fields: &mut Fields<'_>, form: Form, base: Option<&Effect>) -> Option<Effect> {
    let manner = manner(fields, base.map_or(Manner::PLAIN, |base| base.manner));
    // A band that can't be used is told of; what else is wrong is looked for within the usual one.
    let band = manner.map_or(Manner::PLAIN.band, |manner| manner.band);
    let kind = match form {
        Form::Click => once::click_effect(fields, base.map(|base| &base.kind), band),
        Form::Continuous => once::tone(fields, of!(base, Continuous), band).map(EffectKind::Continuous),
        Form::Sequence => once::sequence(fields, of!(base, Sequence), band).map(EffectKind::Sequence),
        Form::Friction => lasting::friction(fields, of!(base, Friction)).map(EffectKind::Friction),
        Form::StickSlip => lasting::stick_slip(fields, of!(base, StickSlip), band).map(EffectKind::StickSlip),
        Form::Texture => lasting::texture(fields, of!(base, Texture), band).map(EffectKind::Texture),
        Form::Grains => lasting::grains(fields, of!(base, Grains), band).map(EffectKind::Grains),
        Form::Detents => stops::detents(fields, of!(base, Detents), band).map(EffectKind::Detents),
        Form::EndStop => stops::end_stop(fields, of!(base, EndStop), band).map(EffectKind::EndStop),
    };
    Some(Effect { kind: kind?, manner: manner? })
}

fn manner(fields: &mut Fields<'_>, base: Manner) -> Option<Manner> {
    let band = fields.read("band_hz", Some(base.band), |node| {
        let [low, high] = node.tuple("(lowest, highest)")?;
        let (low, high) = (single(low, HERTZ), single(high, HERTZ));
        let band = Band { low_hz: low?, high_hz: high? };
        if band.high_hz < 1.5 * band.low_hz {
            let found = format!("{} to {} Hz", plain(band.low_hz.into()), plain(band.high_hz.into()));
            let problem = Problem::error(node.span(), "this band is too narrow");
            node.report(
                problem.expected(format!("expected 1.5 times the lowest as the highest, found {found}")),
            );
            return None;
        }
        Some(band)
    });
    let duck_db = fields.read("duck_db", Some(base.duck_db), |node| single(node, 0.0..=60.0));
    let priority =
        fields.read("priority", Some(base.priority), |node| node.whole(0..=9).map(|whole| whole as u8));
    Some(Manner { band: band?, duck_db: duck_db?, priority: priority? })
}

/// A frequency within an effect's band.
fn within(node: Node<'_>, band: Band) -> Option<f32> {
    let hz = single(node, HERTZ)?;
    if band.contains(hz) {
        return Some(hz);
    }
    let problem = Problem::error(node.span(), format!("`{}` is outside of the effect's band", node.what));
    let bounds = format!("{} to {}", plain(band.low_hz.into()), plain(band.high_hz.into()));
    let wider = (plain(band.low_hz.min(hz).into()), plain(band.high_hz.max(hz).into()));
    node.report(
        problem
            .expected(format!("expected {bounds} Hz, found {} Hz", plain(hz.into())))
            .help(format!("or widen the band: band_hz: ({}, {})", wider.0, wider.1)),
    );
    None
}

/// A field in milliseconds within `range`, in seconds.
fn millis(
    fields: &mut Fields<'_>,
    name: &'static str,
    base: Option<f32>,
    range: std::ops::RangeInclusive<f64>,
) -> Option<f32> {
    // What a base holds is not turned to milliseconds and back, which would round it.
    match fields.take(name) {
        Some(node) => single(node, range).map(|ms| ms / 1000.0),
        None if base.is_some() => base,
        None => fields.read(name, None, |_| None),
    }
}

/// A share within 0 to 1.
fn share(fields: &mut Fields<'_>, name: &'static str, base: Option<f32>) -> Option<f32> {
    fields.read(name, base, |node| single(node, 0.0..=1.0))
}
