//! Eight voices of one model, computed side by side.

use super::chain::Chain;
use super::hiss::{self, Hiss};
use super::impacts::{self, Impacts, Nature};
use super::stick::{self, Stick};
use super::{LANES, Row, within};
use crate::feel::{Band, Lasting, Material};

/// The model of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Model {
    Hiss,
    Impacts,
    Stick,
}

impl Model {
    pub(super) fn of(effect: &Lasting) -> Self {
        match effect {
            Lasting::Friction(_) | Lasting::Hum(_) => Self::Hiss,
            Lasting::Texture(_) | Lasting::Grains(_) => Self::Impacts,
            Lasting::StickSlip(_) => Self::Stick,
        }
    }
}

/// The present input of one voice.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VoiceInput {
    /// Slip speed, in metres per second.
    pub(super) speed: f32,
    /// Normal force as a share of the full one, 0 to 1.
    pub(super) force: f32,
    /// Pitch of a hum or centre of a friction, in hertz.
    pub(super) hz: f32,
}

/// Eight voices of one model.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// The model; undefined while no lane is used.
    model: Model,
    used: [bool; LANES],
    chain: Chain,
    hiss: Hiss,
    impacts: Impacts,
    stick: Stick,
}

impl Group {
    pub(super) fn new(number: usize) -> Self {
        Self {
            model: Model::Hiss,
            used: [false; LANES],
            chain: Chain::SILENT,
            hiss: Hiss::new(number),
            impacts: Impacts::new(number),
            stick: Stick::new(number),
        }
    }

    pub(super) fn is_silent(&self) -> bool {
        !self.used.contains(&true)
    }

    /// A lane for this model; `None` if none is left, or if the group has another model.
    pub(super) fn claim(&mut self, model: Model) -> Option<usize> {
        if self.is_silent() {
            self.model = model;
        }
        let lane = self.used.iter().position(|used| !used).filter(|_| self.model == model)?;
        self.used[lane] = true;
        Some(lane)
    }

    /// Frees a lane.
    pub(super) fn release(&mut self, lane: usize) {
        self.used[lane] = false;
        self.chain.rest(lane);
        self.hiss.rest(lane);
        self.impacts.rest(lane);
        self.stick.rest(lane);
    }

    /// Sets the constants of a voice.
    pub(super) fn prepare(&mut self, lane: usize, effect: &Lasting, band: Band, rate: f32) {
        if let Some(Material { resonances, bare, .. }) = effect.material() {
            // The bare push of an impact has an area of 1; its height is that over its length.
            let height = match effect {
                Lasting::Texture(texture) => 0.5 * texture.width_s * rate,
                Lasting::Grains(grains) => 0.5 * grains.width_s * rate,
                _ => 1.0,
            };
            self.chain.material(lane, resonances, bare * height, band, rate);
        }
    }

    /// Sets the present input of a voice.
    pub(super) fn tune(&mut self, lane: usize, effect: &Lasting, drive: VoiceInput, band: Band, rate: f32) {
        match effect {
            Lasting::Friction(_) => self.hiss.tune(lane, &mut self.chain, drive.hz, 1.0, band, rate),
            Lasting::Hum(hum) => self.hiss.tune(lane, &mut self.chain, drive.hz, hum.noise, band, rate),
            Lasting::Texture(texture) => {
                let per_sample = drive.speed / (within(texture.spacing_m, 1e-4, 1.0) * rate);
                let nature = Nature::Ridges(within(texture.uneven, 0.0, 1.0));
                self.impacts.tune(lane, nature, per_sample, texture.width_s * rate);
            }
            Lasting::Grains(grains) => {
                let per_sample = drive.speed / (within(grains.spacing_m, 1e-4, 1.0) * rate);
                let nature = Nature::Grains(within(grains.spread, 0.0, 1.0));
                self.impacts.tune(lane, nature, per_sample, grains.width_s * rate);
            }
            Lasting::StickSlip(stick) => self.stick.tune(lane, stick, drive.speed, drive.force, rate),
        }
    }

    /// Fills `out` with the next samples.
    pub(super) fn render(&mut self, out: &mut [Row]) {
        match self.model {
            Model::Hiss => hiss::render(&mut self.hiss, &mut self.chain, out),
            Model::Impacts => {
                impacts::render(&mut self.impacts, &mut self.chain, out);
                self.impacts.settle();
            }
            Model::Stick => {
                stick::render(&mut self.stick, &mut self.chain, out);
                self.stick.settle();
            }
        }
        self.chain.settle();
    }
}
