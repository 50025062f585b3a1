//! Every number of an effect by its name, for adjustment by hand.

use super::{Effect, EffectKind, Knob};
use underfoot_format::{Record, Variants, hand::Hand};

impl Effect {
    /// Passes every number of the effect to `visit`, which may change it within its range; then balances models to
    /// their level again.
    ///
    /// The order is the same each time.
    pub fn turn(&mut self, visit: &mut dyn FnMut(&Knob, &mut f32)) {
        let mut hand = Hand::new(visit);
        hand.within = Some(self.manner.band.as_bounds());
        self.kind.turn_fields(&mut hand);
        hand.part("manners", |hand| self.manner.turn_fields(hand));
        match &mut self.kind {
            EffectKind::Friction(friction) => friction.high_hz = friction.high_hz.max(friction.low_hz),
            EffectKind::StickSlip(stick) => stick.glide = stick.glide.min(stick.grip),
            _ => {}
        }
        self.balance();
    }

    /// Balances the model of a rubbed material to its level.
    pub(super) fn balance(&mut self) {
        let Some(lasting) = self.kind.lasting() else { return };
        let balanced = lasting.balanced(self.manner.band);
        if let (Some(own), Some(balanced)) = (self.kind.material_mut(), balanced.material()) {
            own.trim = balanced.trim;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::schema::{Effects, NamedEffect, parse_effect, write_named_effect};

    #[test]
    fn looking_changes_nothing_and_every_number_can_be_turned() {
        for named in Effects::builtin().iter() {
            let mut effect = (*named.effect).clone();
            let mut count = 0;
            effect.turn(&mut |_, _| count += 1);
            assert_eq!(effect, *named.effect, "{}", named.name);
            assert!(count >= 5, "{}: {count}", named.name);
            for wanted in 0..count {
                let mut turned = effect.clone();
                let (mut number, mut name) = (0, "");
                turned.turn(&mut |knob, value| {
                    if number == wanted {
                        name = knob.name;
                        // To the far end of the range.
                        let middle = 0.5 * (knob.range.0 + knob.range.1);
                        *value = if *value * knob.scale < middle { knob.range.1 } else { knob.range.0 }
                            / knob.scale;
                    }
                    number += 1;
                });
                assert_ne!(turned, effect, "{}: {name}", named.name);
                // Every adjusted effect can be saved and read again.
                let saved = NamedEffect { effect: Arc::new(turned), ..named.clone() };
                let text = write_named_effect(&saved);
                let read = parse_effect(&text, "turned.ron", &Effects::default());
                assert!(
                    read.is_ok(),
                    "{}: {name}\n{text}\n{}",
                    named.name,
                    read.err().map_or(String::new(), |e| e.to_string())
                );
            }
        }
    }

    #[test]
    fn nonsense_from_a_hand_is_kept_out() {
        let effects = Effects::builtin();
        let Some(named) = effects.get("crisp_click") else { panic!("a click") };
        let mut effect = (*named.effect).clone();
        effect.turn(&mut |_, value| *value = f32::NAN);
        assert_eq!(effect, *named.effect);
        effect.turn(&mut |_, value| *value = 1e9);
        effect.turn(&mut |knob, value| {
            assert!(*value * knob.scale <= knob.range.1 * 1.0001, "{knob:?}: {value}");
        });
    }
}
