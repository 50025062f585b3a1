use crate::units::Newtons;

/// What is felt for as long as something lasts.
///
/// The level of each is a root mean square at full slip speed and normal
/// force: one of 2 N is as strong as a sine of 2 N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lasting {
    /// Noise whose band follows the slip speed.
    Friction(Friction),
    /// Sticking and slipping.
    StickSlip(StickSlip),
    /// Ridges at even distances.
    Texture(Texture),
    /// Grains that crunch by chance.
    Grains(Grains),
    /// A tone or noise at a level that whoever sends it gives.
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

/// A rubbing texture: noise whose band follows the slip speed and whose level follows speed and force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Force at the plate at full slip speed and full normal force.
    pub level: Newtons,
    /// Centre of the noise band when barely moving, in hertz; 20 to 1000.
    pub low_hz: f32,
    /// Centre of the noise band at full slip speed, in hertz; `low_hz` to 1000.
    pub high_hz: f32,
    /// Slip speed at which level and band reach their upper end, in metres per second.
    pub full_speed_m_s: f32,
    /// Normal force at which the level reaches its upper end.
    pub full_force: Newtons,
}

/// A tone or noise that goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hum {
    /// Force at the plate.
    pub level: Newtons,
    /// Its pitch, or the centre of its noise, in hertz; 20 to 1000.
    pub hz: f32,
    /// From a pure tone (0) to a band of noise (1).
    pub noise: f32,
}

/// One resonance of what is rubbed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    /// Frequency, in hertz; 20 to 1000.
    pub hz: f32,
    /// Time after which a factor 1/e is left, in seconds; 0.001 to 0.2.
    pub decay_s: f32,
    /// Share of the whole, 0 to 1.
    pub amplitude: f32,
}

impl Resonance {
    /// None.
    pub const NONE: Self = Self { hz: 200.0, decay_s: 0.005, amplitude: 0.0 };
}

/// What every rubbed material has: how strong it is, and how its plate rings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Force at the plate at full slip speed and full normal force.
    pub level: Newtons,
    /// The two resonances that it excites.
    pub resonances: [Resonance; 2],
    /// Share of the bare exciting force, beside the resonances, 0 to 1.
    pub bare: f32,
    /// Slip speed of the full level, in metres per second.
    pub full_speed_m_s: f32,
    /// Normal force of the full level.
    pub full_force: Newtons,
    /// What brings the model to its level; [`Lasting::balanced`] finds it.
    pub trim: f32,
}

/// Ridges: the foot strikes one after another, so that the pitch is the speed over their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// How strong it is and how it rings.
    pub material: Material,
    /// Distance between two ridges, in metres; 0.0003 to 0.2.
    pub spacing_m: f32,
    /// How long each ridge pushes, in seconds; 0.0003 to 0.01.
    pub width_s: f32,
    /// How uneven they are in distance and height, 0 to 1.
    pub uneven: f32,
}

/// Grains: the foot crunches them by chance, so many to the metre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grains {
    /// How strong it is and how it rings.
    pub material: Material,
    /// Mean distance between two grains, in metres; 0.0003 to 0.2.
    pub spacing_m: f32,
    /// How long each grain pushes, in seconds; 0.0003 to 0.01.
    pub width_s: f32,
    /// From grains of one size (0) to few large ones among many small ones (1).
    pub spread: f32,
}

/// Stick-slip: a sole on its spring that sticks to the plate, lets go, slips and sticks again.
///
/// # Source
/// Friction as bristles that bend elastically up to a breakaway and then creep: P. Dupont, V. Hayward,
/// B. Armstrong, F. Altpeter, "Single state elastoplastic friction models", IEEE Trans. Automatic Control 47(5),
/// 2002. With no elastic part it is the LuGre model: C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky,
/// "A new model for control of systems with friction", IEEE Trans. Automatic Control 40(3), 1995.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StickSlip {
    /// How strong it is and how it rings.
    pub material: Material,
    /// Coefficient of friction at rest, 0.1 to 2.
    pub grip: f32,
    /// Coefficient of friction of a fast slip, 0.05 to `grip`.
    pub glide: f32,
    /// Slip speed at which half of the difference is lost (Stribeck's), in metres per second; 0.001 to 1.
    pub let_go_m_s: f32,
    /// How far the sole is drawn along before it lets go, at full force, in metres; 0.0002 to 0.05.
    pub stretch_m: f32,
    /// How fast the sole swings on its spring, in hertz; 20 to 600.
    pub sole_hz: f32,
    /// How rough the surface is: share of the friction that varies by chance, 0 to 1.
    pub rough: f32,
}

impl Lasting {
    /// What is common to rubbed materials; `None` for friction noise and hums.
    #[must_use]
    pub fn material(&self) -> Option<&Material> {
        match self {
            Self::StickSlip(stick) => Some(&stick.material),
            Self::Texture(texture) => Some(&texture.material),
            Self::Grains(grains) => Some(&grains.material),
            Self::Friction(_) | Self::Hum(_) => None,
        }
    }
}
