//! Effects that play clicks and tones at their times.

use std::borrow::Cow;

use super::{Clicks, Part, PartKind, Tone};

/// An effect of clicks and tones that begin one after the other, or at once.
///
/// # Real-time
/// No method allocates.
pub(crate) trait EffectTimeline {
    /// Part number `index`, in order of time, before [`EffectTimeline::share_at`] scales it; `None` if there is no such
    /// part.
    fn written(&self, index: usize) -> Option<Cow<'_, Part>>;

    /// Factor of the level `t` seconds from the start.
    fn share_at(&self, _t: f32) -> f32 {
        1.0
    }

    /// Part number `index` as it plays once; `None` if there is no such part.
    fn part(&self, index: usize) -> Option<Part> {
        self.written(index).map(Cow::into_owned)
    }
}

impl dyn EffectTimeline + '_ {
    /// The parts as they play once, in order of time.
    pub(crate) fn parts(&self) -> impl Iterator<Item = Part> {
        (0..).map_while(|index| self.part(index))
    }

    /// The parts as written, in order of time.
    pub(crate) fn all_written(&self) -> impl Iterator<Item = Cow<'_, Part>> {
        (0..).map_while(|index| self.written(index))
    }

    /// End time of the last part, in seconds from the start.
    pub(crate) fn end_s(&self) -> f32 {
        let end = |part: Cow<'_, Part>| match &part.kind {
            PartKind::Click(click) => part.at_s + click.length_s(),
            PartKind::Tone(tone) => part.at_s + tone.whole_s(),
        };
        self.all_written().map(end).fold(0.0, f32::max)
    }
}

/// The only part of an effect, at its start.
fn only(index: usize, kind: impl FnOnce() -> PartKind) -> Option<Cow<'static, Part>> {
    (index == 0).then(|| Cow::Owned(Part { at_s: 0.0, kind: kind() }))
}

impl EffectTimeline for Clicks {
    fn written(&self, index: usize) -> Option<Cow<'_, Part>> {
        only(index, || PartKind::Click(self.press.clone()))
    }
}

impl EffectTimeline for Tone {
    fn written(&self, index: usize) -> Option<Cow<'_, Part>> {
        only(index, || PartKind::Tone(self.clone()))
    }
}
