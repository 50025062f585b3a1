//! Effects that a sliding foot drives: friction, stick-slip, texture, grains; and held tones.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use super::click::{HZ, LEVEL, SHARE};
use crate::units::Newtons;
use underfoot_format::describe::FieldType;
use underfoot_format::hand::Hand;
use underfoot_format::node::Node;
use underfoot_format::text::RonText;
use underfoot_format::{Codec, Flat, List, Num, Own, Rec, list, num, record};

/// Range of slip speeds in files, in metres per second.
const SPEED: Num = num(0.01..=5.0);

/// Range of normal forces in files.
const FORCE: Num = num(1.0..=2000.0);

/// Range of distances between ridges or grains, in metres.
const SPACING: Num = num(0.0003..=0.2);

/// Range of the duration of a ridge's or a grain's push.
const PUSH: Num = num(0.3..=10.0).milli();

/// Default slip speed and normal force of the full level, as of a fast and heavy foot.
const FULL_SPEED_M_S: f32 = 0.6;
const FULL_FORCE: Newtons = Newtons(200.0);

/// An effect that is felt for as long as its cause lasts.
///
/// The level of each is a root mean square at full slip speed and normal force (for stick-slip, at the speed of the
/// highest level): an effect of 2 N is as strong as a sine of 2 N.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Lasting {
    /// Noise whose band follows the slip speed.
    Friction(Friction),
    /// Sticking and slipping.
    StickSlip(StickSlip),
    /// Ridges at even distances.
    Texture(Texture),
    /// Grains that crunch at random.
    Grains(Grains),
    /// A tone or noise with a level set by the sender.
    Hum(Hum),
}

impl Default for Lasting {
    fn default() -> Self {
        Self::Hum(Hum::default())
    }
}

impl From<Friction> for Lasting {
    fn from(friction: Friction) -> Self {
        Self::Friction(friction)
    }
}

record! {
    /// A rubbing texture: noise whose band follows the slip speed and whose level follows speed and force.
    pub struct Friction = "Friction", Copy, Serialize, Deserialize => |it, faults| {
        faults.not_below(&["high_hz", "low_hz"], [it.high_hz, it.low_hz]);
    };
    /// Force at the plate at full slip speed and full normal force.
    pub level: Newtons = "level_n", LEVEL;
    /// Centre of the noise band at very low slip speed, in hertz; 20 to 1000.
    pub low_hz: f32 = "low_hz", num(20.0..=1000.0);
    /// Centre of the noise band at full slip speed, in hertz; `low_hz` to 1000.
    pub high_hz: f32 = "high_hz", num(20.0..=1000.0);
    /// Slip speed at which level and band reach their upper end, in metres per second.
    pub full_speed_m_s: f32 = "full_speed_m_s", SPEED => FULL_SPEED_M_S;
    /// Normal force at which the level reaches its upper end.
    pub full_force: Newtons = "full_force_n", FORCE => FULL_FORCE;
}

record! {
    /// A continuous tone or noise.
    pub struct Hum = "Hum", Copy, Default, Serialize, Deserialize;
    /// Force at the plate.
    pub level: Newtons = "level_n", LEVEL;
    /// Its pitch, or the centre of its noise, in hertz; 20 to 1000.
    pub hz: f32 = "hz", HZ;
    /// From a pure tone (0) to a band of noise (1).
    pub noise: f32 = "noise", SHARE => 0.0;
}

record! {
    /// One resonance of a rubbed material.
    pub struct Resonance = "Resonance", Copy, Serialize, Deserialize;
    /// Frequency, in hertz; 20 to 1000.
    pub hz: f32 = "hz", HZ;
    /// Time in which it decays by a factor of 1/e, in seconds; 0.001 to 0.2.
    pub decay_s: f32 = "decay_ms", num(1.0..=200.0).milli();
    /// Share of the whole, 0 to 1.
    pub amplitude: f32 = "amplitude", SHARE => 1.0;
}

impl Resonance {
    /// No resonance.
    pub const NONE: Self = Self { hz: 200.0, decay_s: 0.005, amplitude: 0.0 };
}

record! {
    /// The common part of all rubbed materials: level and resonances of the plate.
    pub struct Material = "Material", Copy, Serialize, Deserialize;
    /// Force at the plate at full slip speed and full normal force.
    pub level: Newtons = "level_n", LEVEL;
    /// The two resonances of the plate.
    pub resonances: [Resonance; 2] = "resonances", Resonances;
    /// Share of the exciting force itself, beside the resonances, 0 to 1.
    pub bare: f32 = "bare", SHARE => 0.0;
    /// Slip speed of the full level, in metres per second.
    pub full_speed_m_s: f32 = "full_speed_m_s", SPEED => FULL_SPEED_M_S;
    /// Normal force of the full level.
    pub full_force: Newtons = "full_force_n", FORCE => FULL_FORCE;
    /// Factor that brings the model to its level; [`Lasting::balanced`] computes it.
    pub trim: f32 = "", Own(1.0);
}

/// One or two resonances; a missing one has no amplitude.
struct Resonances;

const RESONANCES: List<Rec> = list("resonance", 2, Rec).at_least(1, "a material needs a resonance");

impl Codec<[Resonance; 2]> for Resonances {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&[Resonance; 2]>, context: &()) -> Option<[Resonance; 2]> {
        let read: ArrayVec<Resonance, 2> = RESONANCES.read(node, None, context)?;
        let mut both = [Resonance::NONE; 2];
        both.iter_mut().zip(read).for_each(|(resonance, read)| *resonance = read);
        Some(both)
    }

    fn write(&self, both: &[Resonance; 2]) -> RonText {
        let mut written = ArrayVec::from(*both);
        written.truncate(if both[1].amplitude > 0.0 { 2 } else { 1 });
        RESONANCES.write(&written)
    }

    fn shape(&self) -> FieldType {
        Codec::<ArrayVec<Resonance, 2>>::shape(&RESONANCES)
    }

    fn stand_in(&self) -> [Resonance; 2] {
        [Resonance::NONE; 2]
    }

    fn turn(&self, both: &mut [Resonance; 2], _: &'static str, hand: &mut Hand<'_>) {
        let mut all = ArrayVec::from(*both);
        RESONANCES.turn(&mut all, "", hand);
        both.copy_from_slice(&all);
    }
}

record! {
    /// Ridges: the foot strikes one after another, so that the pitch is the speed over their distance.
    pub struct Texture = "Texture", Copy, Serialize, Deserialize;
    /// Level and resonances.
    pub material: Material = "", Flat;
    /// Distance between two ridges, in metres; 0.0003 to 0.2.
    pub spacing_m: f32 = "spacing_m", SPACING;
    /// Duration of each ridge's push, in seconds; 0.0003 to 0.01.
    pub width_s: f32 = "width_ms", PUSH => 0.0015;
    /// Random variation of their distance and height, 0 to 1.
    pub uneven: f32 = "uneven", SHARE => 0.0;
}

record! {
    /// Grains: the foot crunches them at random, at a mean rate per metre.
    pub struct Grains = "Grains", Copy, Serialize, Deserialize;
    /// Level and resonances.
    pub material: Material = "", Flat;
    /// Mean distance between two grains, in metres; 0.0003 to 0.2.
    pub spacing_m: f32 = "spacing_m", SPACING;
    /// Duration of each grain's push, in seconds; 0.0003 to 0.01.
    pub width_s: f32 = "width_ms", PUSH => 0.001;
    /// From grains of one size (0) to few large ones among many small ones (1).
    pub spread: f32 = "spread", SHARE => 0.5;
}

record! {
    /// Stick-slip: a sole on a spring that sticks to the plate, breaks away, slips and sticks again.
    ///
    /// # Source
    /// Friction as bristles that bend elastically up to a breakaway and then creep: P. Dupont, V. Hayward,
    /// B. Armstrong, F. Altpeter, "Single state elastoplastic friction models", IEEE Trans. Automatic Control 47(5),
    /// 2002. With no elastic part it is the LuGre model: C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky,
    /// "A new model for control of systems with friction", IEEE Trans. Automatic Control 40(3), 1995.
    pub struct StickSlip = "StickSlip", Copy, Serialize, Deserialize => |it, faults| {
        faults.not_above(&["glide", "grip"], [it.glide, it.grip]);
    };
    /// Level and resonances.
    pub material: Material = "", Flat;
    /// Coefficient of friction at rest, 0.1 to 2.
    pub grip: f32 = "grip", num(0.1..=2.0);
    /// Coefficient of friction of a fast slip, 0.05 to `grip`.
    pub glide: f32 = "glide", num(0.05..=2.0);
    /// Slip speed at which the friction has dropped by half of the difference (Stribeck's), in metres per second;
    /// 0.001 to 1.
    pub let_go_m_s: f32 = "let_go_m_s", num(0.001..=1.0) => 0.05;
    /// Distance over which the foot drags the sole before it breaks away, at full force, in metres; 0.0002 to 0.05.
    pub stretch_m: f32 = "stretch_m", num(0.0002..=0.05);
    /// Natural frequency of the sole on its spring, in hertz; 20 to 500.
    pub sole_hz: f32 = "sole_hz", num(20.0..=500.0) => 150.0;
    /// Roughness of the surface: share of the friction that varies at random, 0 to 1.
    pub rough: f32 = "rough", SHARE => 0.1;
}

impl Lasting {
    /// The common part of rubbed materials; `None` for friction noise and hums.
    #[must_use]
    pub fn material(&self) -> Option<&Material> {
        match self {
            Self::StickSlip(stick) => Some(&stick.material),
            Self::Texture(texture) => Some(&texture.material),
            Self::Grains(grains) => Some(&grains.material),
            Self::Friction(_) | Self::Hum(_) => None,
        }
    }

    /// The common part of rubbed materials, for changes; `None` for friction noise and hums.
    pub(crate) fn material_mut(&mut self) -> Option<&mut Material> {
        match self {
            Self::StickSlip(stick) => Some(&mut stick.material),
            Self::Texture(texture) => Some(&mut texture.material),
            Self::Grains(grains) => Some(&mut grains.material),
            Self::Friction(_) | Self::Hum(_) => None,
        }
    }

    /// Slip speed (m/s) and normal force of its full level; `None` for hums, whose sender sets the level.
    pub(crate) fn full(&self) -> Option<(f32, Newtons)> {
        match self {
            Self::Friction(friction) => Some((friction.full_speed_m_s, friction.full_force)),
            _ => self.material().map(|material| (material.full_speed_m_s, material.full_force)),
        }
    }
}
