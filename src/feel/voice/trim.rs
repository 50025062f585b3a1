//! Brings every model to the level that its author asked for, by listening to it.

use super::group::{Drive, Group, Model};
use super::{LANES, LOW_HZ};
use crate::feel::{Band, Lasting};

/// How long a model is listened to, in samples of the low rate, and how long it runs in before.
const LISTEN: usize = 4000;
const RUN_IN: usize = 600;

/// The trims that are believed; a model that is silent can't be brought to a level.
const TRIMS: (f32, f32) = (1e-3, 1e4);

impl Lasting {
    /// The same, its [`crate::feel::Material::trim`] such that its level is what it says, within `band`.
    ///
    /// It is measured from a third of a second at full speed and force, which
    /// takes about half a millisecond; not for the audio callback. Frictions
    /// and hums need none.
    #[must_use]
    pub fn balanced(mut self, band: Band) -> Self {
        let Some(material) = self.material() else { return self };
        let drive = Drive { speed: material.full_speed_m_s, force: 1.0, hz: 0.0 };
        let mut group = Group::new(0);
        let band = band.sound();
        let Some(lane) = group.claim(Model::of(&self)) else { return self };
        group.prepare(lane, &self, band, LOW_HZ);
        group.tune(lane, &self, drive, band, LOW_HZ);
        let mut samples = vec![[0.0; LANES]; RUN_IN + LISTEN];
        samples.chunks_mut(64).for_each(|part| group.render(part));
        let square: f32 = samples[RUN_IN..].iter().map(|row| row[lane] * row[lane]).sum();
        let rms = (square / LISTEN as f32).sqrt();
        // A sine's root mean square is its amplitude over the root of two.
        let trim = (std::f32::consts::FRAC_1_SQRT_2 / rms).clamp(TRIMS.0, TRIMS.1);
        let trim = if trim.is_finite() { trim } else { 1.0 };
        match &mut self {
            Self::StickSlip(stick) => stick.material.trim = trim,
            Self::Texture(texture) => texture.material.trim = trim,
            Self::Grains(grains) => grains.material.trim = trim,
            Self::Friction(_) | Self::Hum(_) => {}
        }
        self
    }
}
