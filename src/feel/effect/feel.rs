use std::sync::Arc;

use super::{Effect, EffectKind};

/// What a control feels like; each part may be absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feel {
    /// Felt when the control engages.
    pub press: Option<Arc<Effect>>,
    /// Felt when it lets go.
    pub release: Option<Arc<Effect>>,
    /// Felt when a foot passes a step, a detent or a choice.
    pub step: Option<Arc<Effect>>,
    /// Felt when its number reaches either end, and while a foot pushes on.
    pub end: Option<Arc<Effect>>,
    /// Felt when a press becomes long or reaches its second stage; the press once more where absent.
    pub stage: Option<Arc<Effect>>,
    /// Felt when a first press has armed it.
    pub arm: Option<Arc<Effect>>,
    /// Felt when it will soon stop by itself, or is locked.
    pub warn: Option<Arc<Effect>>,
    /// Felt when a foot turns it on.
    pub on: Option<Arc<Effect>>,
    /// Felt when a foot turns it off.
    pub off: Option<Arc<Effect>>,
    /// Felt for as long as a foot keeps it pressed.
    pub hold: Option<Arc<Effect>>,
    /// Felt while the foot slides along it.
    pub drag: Option<Arc<Effect>>,
    /// How much of all this is also heard, from the floor's loudspeakers: 0 (not at all) to 1.
    pub sound: f32,
}

/// What plays an effect, which decides which ones fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// An event, once.
    Once,
    /// Each step of a value.
    Step,
    /// The ends of a value.
    End,
    /// A press that lasts.
    Hold,
    /// A foot that slides.
    Drag,
}

impl Use {
    /// Whether an effect of this kind can be played so.
    #[must_use]
    pub fn fits(self, kind: &EffectKind) -> bool {
        use EffectKind as Kind;
        match self {
            Self::Once => matches!(kind, Kind::Click { .. } | Kind::Continuous(_) | Kind::Sequence(_)),
            Self::Step => matches!(kind, Kind::Click { .. } | Kind::Detents(_)),
            Self::End => matches!(kind, Kind::Click { .. } | Kind::EndStop(_)),
            Self::Hold => matches!(kind, Kind::Continuous(_) | Kind::Sequence(_)),
            Self::Drag => {
                matches!(kind, Kind::Friction(_) | Kind::StickSlip(_) | Kind::Texture(_) | Kind::Grains(_))
            }
        }
    }

    /// The kinds that fit, for messages.
    #[must_use]
    pub const fn fitting(self) -> &'static str {
        match self {
            Self::Once => "Click, Continuous or Sequence",
            Self::Step => "Click or Detents",
            Self::End => "Click or EndStop",
            Self::Hold => "Continuous or Sequence",
            Self::Drag => "Friction, StickSlip, Texture or Grains",
        }
    }
}
