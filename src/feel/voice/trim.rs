//! Balances every model to the level set by its author, by measuring its output.

use super::group::{Group, Model, VoiceInput};
use super::{LANES, LOW_HZ};
use crate::feel::{Band, Lasting};

/// Length of the measurement, in samples of the low rate, and of the run-in before it.
const LISTEN: usize = 4000;
const RUN_IN: usize = 600;

/// Range of plausible trims; a silent model can't be brought to a level.
const TRIMS: (f32, f32) = (1e-3, 1e4);

impl Lasting {
    /// This model with a [`crate::feel::Material::trim`] that gives its nominal level within `band`.
    ///
    /// It is measured from a third of a second at full force, stick-slip at the speed of its highest level and all
    /// others at full speed, which takes about half a millisecond; not for the audio callback. Frictions and hums
    /// need none.
    #[must_use]
    pub fn balanced(mut self, band: Band) -> Self {
        let Some(material) = self.material() else { return self };
        let full = material.full_speed_m_s;
        let mut group = Group::new(0);
        let band = band.sound();
        let mut lanes = [0; LANES];
        for (number, lane) in lanes.iter_mut().enumerate() {
            *lane = group.claim(Model::of(&self)).unwrap_or(number);
            // A sole is loudest while it sticks and slips, not at its highest speed; all other models are loudest
            // there.
            let slower = if matches!(self, Self::StickSlip(_)) { number as f32 / LANES as f32 } else { 0.0 };
            let drive = VoiceInput { speed: full * (1.0 - slower), force: 1.0, hz: 0.0 };
            group.prepare(*lane, &self, band, LOW_HZ);
            group.tune(*lane, &self, drive, band, LOW_HZ);
        }
        let mut samples = vec![[0.0; LANES]; RUN_IN + LISTEN];
        samples.chunks_mut(64).for_each(|part| group.render(part));
        let rms = |lane: &usize| {
            let square: f32 = samples[RUN_IN..].iter().map(|row| row[*lane] * row[*lane]).sum();
            (square / LISTEN as f32).sqrt()
        };
        let levels = lanes.iter().map(rms);
        let rms = if matches!(self, Self::StickSlip(_)) {
            levels.fold(0.0, f32::max)
        } else {
            // Eight times as long, as far as random variation is concerned.
            levels.sum::<f32>() / LANES as f32
        };
        // A sine's root mean square is its amplitude over the root of two.
        let trim = (std::f32::consts::FRAC_1_SQRT_2 / rms).clamp(TRIMS.0, TRIMS.1);
        let trim = if trim.is_finite() { trim } else { 1.0 };
        if let Some(material) = self.material_mut() {
            material.trim = trim;
        }
        self
    }
}
