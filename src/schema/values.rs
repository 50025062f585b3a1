//! Values that apps read and write by serde: effects, feels, looks, kinds, floors; layouts can only be written.
//!
//! A layout depends on a floor and on kinds, which serde cannot pass to it: [`super::parse_layout`] reads layouts.

use serde::{Serialize, Serializer};

use super::diagnostic::Diagnostics;
use super::effect::{EffectFile, parse_effect};
use super::floor::{FloorFileRecord, parse_floor};
use super::inherit;
use super::kind::{Kind, Kinds};
use super::layout_record::LayoutRecord;
use super::pairs::Limits;
use super::reader::Reader;
use super::source::Source;
use super::write;
use crate::feel::{Effect, Effects, Feel, NamedEffect};
use crate::floor::{Floor, FloorFile};
use crate::layout::{Layout, Look};
use underfoot_format::filed::{Filed, read_record};
use underfoot_format::text::Text;
use underfoot_format::{Codec, Rec, Record, filed};

filed!(Effect, NamedEffect, Feel, Look, Kind, Floor);

/// An effect that is written out; it may be made `from` one that comes with underfoot.
impl Filed for Effect {
    fn written(&self) -> Text {
        self.to_ron()
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        let source = Source::new(EffectFile::NAME, text)?;
        let reader = Reader::new(&source, EffectFile::NAME, Limits::LAYOUT);
        let effect = reader.root("effect").and_then(|node| Self::read(node, &Effects::builtin()));
        reader.conclude(effect).map(|(effect, _)| effect)
    }
}

/// A file of `effects/`.
impl Filed for NamedEffect {
    fn written(&self) -> Text {
        Rec.write(self)
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        parse_effect(text, Self::NAME, &Effects::builtin()).map(|(effect, _)| effect)
    }
}

/// The field `feel` of a kind; it may name effects that come with underfoot.
impl Filed for Feel {
    fn written(&self) -> Text {
        Rec.write(self)
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        read_record(text, &Effects::builtin())
    }
}

/// The field `look` of a kind.
impl Filed for Look {
    fn written(&self) -> Text {
        Rec.write(self)
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        read_record(text, &())
    }
}

/// A file of `widgets/`; it may be made `from` a kind that comes with underfoot, and name effects that do.
impl Filed for Kind {
    fn written(&self) -> Text {
        Rec.write(self)
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        inherit::read_one(text, Self::NAME, &Kinds::builtin()).map(|(kind, _)| kind)
    }
}

/// A floor file. A floor that an app has read has no file ([`FloorFile::NONE`]).
impl Filed for Floor {
    fn written(&self) -> Text {
        Text::Record(FloorFileRecord::NAME, FloorFileRecord::of(self).written())
    }

    fn read(text: &str) -> Result<Self, Diagnostics> {
        parse_floor(text, FloorFileRecord::NAME).map(|floor| Self { file: FloorFile::NONE, ..floor })
    }
}

/// As [`super::write_layout`] writes it.
impl Serialize for Layout {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Text::Record(LayoutRecord::NAME, write::written(self)).serialize(serializer)
    }
}
