//! Every number of an effect by its name, for those who turn it by hand.

use std::sync::Arc;

use super::{Beat, Effect, EffectKind, Hum, Material, Tone};
use crate::feel::{Click, Lasting};

/// What is known of one number of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knob {
    /// What it belongs to: empty for the effect itself, or `mode 1`, `release`, `part 3`.
    pub part: &'static str,
    /// Number of the part, from 1; 0 where there is only one.
    pub number: usize,
    /// What files call it.
    pub name: &'static str,
    /// Least and greatest, in the unit of its name.
    pub range: (f32, f32),
    /// What its value is multiplied with to be in the unit of its name.
    pub scale: f32,
    /// Whether equal ways of the hand should be equal ratios.
    pub by_ratio: bool,
}

/// What is done with each number in turn.
type Visit<'a> = dyn FnMut(&Knob, &mut f32) + 'a;

impl Effect {
    /// Shows every number of the effect to `visit`, which may change it within its range; then brings models to
    /// their level anew.
    ///
    /// The order is the same each time.
    pub fn turn(&mut self, visit: &mut Visit<'_>) {
        let hertz = (self.manner.band.low_hz, self.manner.band.high_hz);
        let mut at = At { visit, part: "", number: 0, hertz };
        match &mut self.kind {
            EffectKind::Click { press, release } => {
                at.click(press);
                if let Some(release) = release {
                    at.of("release", 0).click(release);
                }
            }
            EffectKind::Continuous(tone) => at.tone(tone),
            EffectKind::Sequence(sequence) => {
                for (number, part) in Arc::make_mut(&mut sequence.parts).iter_mut().enumerate() {
                    let mut at = at.of("part", number + 1);
                    at.ms("at_ms", (0.0, 3000.0), &mut part.at_s);
                    match &mut part.beat {
                        Beat::Click(click) => at.click(click),
                        Beat::Tone(tone) => at.tone(tone),
                    }
                }
            }
            EffectKind::Friction(friction) => {
                at.newtons(&mut friction.level.0);
                at.hz("low_hz", &mut friction.low_hz);
                at.hz("high_hz", &mut friction.high_hz);
                friction.high_hz = friction.high_hz.max(friction.low_hz);
                at.full(&mut friction.full_speed_m_s, &mut friction.full_force.0);
            }
            EffectKind::StickSlip(stick) => {
                at.material(&mut stick.material);
                at.ratio("grip", (0.1, 2.0), &mut stick.grip);
                at.ratio("glide", (0.05, 2.0), &mut stick.glide);
                stick.glide = stick.glide.min(stick.grip);
                at.ratio("let_go_m_s", (0.001, 1.0), &mut stick.let_go_m_s);
                at.ratio("stretch_m", (0.0002, 0.05), &mut stick.stretch_m);
                at.ratio("sole_hz", (20.0, 500.0), &mut stick.sole_hz);
                at.even("rough", (0.0, 1.0), &mut stick.rough);
            }
            EffectKind::Texture(texture) => {
                at.material(&mut texture.material);
                at.ratio("spacing_m", (0.0003, 0.2), &mut texture.spacing_m);
                at.ms("width_ms", (0.3, 10.0), &mut texture.width_s);
                at.even("uneven", (0.0, 1.0), &mut texture.uneven);
            }
            EffectKind::Grains(grains) => {
                at.material(&mut grains.material);
                at.ratio("spacing_m", (0.0003, 0.2), &mut grains.spacing_m);
                at.ms("width_ms", (0.3, 10.0), &mut grains.width_s);
                at.even("spread", (0.0, 1.0), &mut grains.spread);
            }
            EffectKind::Detents(detents) => {
                at.click(&mut detents.click);
                at.even("every", (0.0, 0.5), &mut detents.every);
                at.even("falling", (0.0, 2.0), &mut detents.falling);
                at.pitch(&mut detents.pitch);
                at.even("mark", (0.0, 4.0), &mut detents.mark);
            }
            EffectKind::EndStop(end) => {
                at.click(&mut end.click);
                at.pitch(&mut end.pitch);
                if let Some(push) = &mut end.push {
                    let mut at = at.of("push", 0);
                    at.hum(&mut push.hum);
                    at.ratio("full_m", (0.001, 0.2), &mut push.full_m);
                }
            }
        }
        let mut at = at.of("manners", 0);
        at.even("duck_db", (0.0, 40.0), &mut self.manner.duck_db);
        let mut priority = f32::from(self.manner.priority);
        at.even("priority", (0.0, 9.0), &mut priority);
        self.manner.priority = priority.round().clamp(0.0, 9.0) as u8;
        self.balance();
    }

    /// Brings a model of something rubbed to the level it says.
    fn balance(&mut self) {
        let Some(lasting) = self.kind.lasting() else { return };
        self.kind = match lasting.balanced(self.manner.band) {
            Lasting::Friction(friction) => EffectKind::Friction(friction),
            Lasting::StickSlip(stick) => EffectKind::StickSlip(stick),
            Lasting::Texture(texture) => EffectKind::Texture(texture),
            Lasting::Grains(grains) => EffectKind::Grains(grains),
            Lasting::Hum(_) => return,
        };
    }
}

/// Shows the numbers of one part.
struct At<'v, 'a> {
    visit: &'v mut Visit<'a>,
    part: &'static str,
    number: usize,
    hertz: (f32, f32),
}

impl<'a> At<'_, 'a> {
    fn of(&mut self, part: &'static str, number: usize) -> At<'_, 'a> {
        At { visit: self.visit, part, number, hertz: self.hertz }
    }

    fn show(&mut self, name: &'static str, range: (f32, f32), scale: f32, by_ratio: bool, value: &mut f32) {
        let knob = Knob { part: self.part, number: self.number, name, range, scale, by_ratio };
        let before = *value;
        (self.visit)(&knob, value);
        if *value != before {
            let (low, high) = (range.0 / scale, range.1 / scale);
            *value = if value.is_nan() { before } else { value.clamp(low, high) };
        }
    }

    fn even(&mut self, name: &'static str, range: (f32, f32), value: &mut f32) {
        self.show(name, range, 1.0, false, value);
    }

    fn ratio(&mut self, name: &'static str, range: (f32, f32), value: &mut f32) {
        self.show(name, range, 1.0, true, value);
    }

    fn ms(&mut self, name: &'static str, range: (f32, f32), value: &mut f32) {
        // What can be nothing at all has no ratios.
        self.show(name, range, 1000.0, range.0 > 0.0, value);
    }

    fn hz(&mut self, name: &'static str, value: &mut f32) {
        let hertz = self.hertz;
        self.ratio(name, hertz, value);
    }

    fn newtons(&mut self, value: &mut f32) {
        self.even("level_n", (0.0, 40.0_f32.max(*value)), value);
    }

    fn full(&mut self, speed: &mut f32, force: &mut f32) {
        self.ratio("full_speed_m_s", (0.01, 5.0), speed);
        self.ratio("full_force_n", (1.0, 2000.0), force);
    }

    fn pitch(&mut self, pitch: &mut [f32; 2]) {
        self.of("pitch, low end", 0).ratio("pitch", (0.5, 2.0), &mut pitch[0]);
        self.of("pitch, high end", 0).ratio("pitch", (0.5, 2.0), &mut pitch[1]);
    }

    fn click(&mut self, click: &mut Click) {
        self.newtons(&mut click.level.0);
        for (number, mode) in click.modes.iter_mut().enumerate() {
            let part = MODES.get(number).copied().unwrap_or("mode");
            let number = self.number;
            let part = if self.part.is_empty() { part } else { self.part };
            let mut at = self.of(part, number);
            at.hz("hz", &mut mode.frequency_hz);
            at.ms("decay_ms", (1.0, 2000.0), &mut mode.decay_s);
            at.even("amplitude", (-1.0, 1.0), &mut mode.amplitude);
        }
        let number = self.number;
        let part = if self.part.is_empty() { "impulse" } else { self.part };
        let mut at = self.of(part, number);
        at.ms("width_ms", (0.0, 10.0), &mut click.impulse.width_s);
        at.even("round", (0.0, 1.0), &mut click.impulse.round);
    }

    fn tone(&mut self, tone: &mut Tone) {
        self.newtons(&mut tone.level.0);
        self.hz("hz", &mut tone.hz);
        self.even("noise", (0.0, 1.0), &mut tone.noise);
        self.ms("length_ms", (1.0, 5000.0), &mut tone.length_s);
        self.ms("attack_ms", (0.0, 1000.0), &mut tone.attack_s);
        self.ms("decay_ms", (0.0, 1000.0), &mut tone.decay_s);
        self.even("sustain", (0.0, 1.0), &mut tone.sustain);
        self.ms("release_ms", (0.0, 1000.0), &mut tone.release_s);
    }

    fn hum(&mut self, hum: &mut Hum) {
        self.newtons(&mut hum.level.0);
        self.hz("hz", &mut hum.hz);
        self.even("noise", (0.0, 1.0), &mut hum.noise);
    }

    fn material(&mut self, material: &mut Material) {
        self.newtons(&mut material.level.0);
        for (part, resonance) in ["resonance 1", "resonance 2"].into_iter().zip(&mut material.resonances) {
            let mut at = self.of(part, 0);
            at.hz("hz", &mut resonance.hz);
            at.ms("decay_ms", (1.0, 200.0), &mut resonance.decay_s);
            at.even("amplitude", (0.0, 1.0), &mut resonance.amplitude);
        }
        self.even("bare", (0.0, 1.0), &mut material.bare);
        self.full(&mut material.full_speed_m_s, &mut material.full_force.0);
    }
}

const MODES: [&str; 8] = ["mode 1", "mode 2", "mode 3", "mode 4", "mode 5", "mode 6", "mode 7", "mode 8"];

#[cfg(test)]
mod tests {
    use super::*;
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
                // Whatever the hand does can be saved and read again.
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
