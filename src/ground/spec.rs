//! The materials of grounds, as layouts describe them.

use super::{Body, CrackRules, EnergyLaw, Ring};
use crate::floor::Rect;
use crate::units::Newtons;
use crate::widget::Axis;
use underfoot_format::{Name, Opt, Own, Rec, num, record};

/// The area and material of a ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundSpec {
    /// Its area.
    pub area: Rect,
    /// Index of the layout's page; `None` if it is on all pages.
    pub page: Option<usize>,
    /// Start of the random numbers: the same seed and the same feet give the same ground.
    pub seed: u32,
    /// Its material.
    pub material: GroundMaterial,
}

impl GroundSpec {
    /// Whether it is on the page numbered `page` (0 without pages).
    #[must_use]
    pub fn is_on(&self, page: usize) -> bool {
        self.page.is_none_or(|own| own == page)
    }
}

/// The material of a ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroundMaterial {
    /// A frozen pond that cracks.
    Ice(IceSpec),
    /// Many small grains.
    Grain(GrainSpec),
    /// Planks that creak.
    Wood(WoodSpec),
}

impl GroundMaterial {
    /// Its name in layouts.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Ice(_) => "Ice",
            Self::Grain(spec) => spec.grain.name(),
            Self::Wood(_) => "Wood",
        }
    }

    /// Share of its haptic events that is also heard, 0 to 1.
    #[must_use]
    pub const fn sound(&self) -> f32 {
        match self {
            Self::Ice(spec) => spec.sound,
            Self::Grain(spec) => spec.sound,
            Self::Wood(spec) => spec.sound,
        }
    }

    /// The elastic sheet of its tiles.
    #[must_use]
    pub const fn body(&self) -> Body {
        match self {
            Self::Ice(spec) => spec.body,
            Self::Grain(spec) => spec.body,
            Self::Wood(spec) => spec.body,
        }
    }
}

record! {
    /// A frozen pond.
    pub struct IceSpec = "Ice", Copy => |it, _| it.cracks.refreeze_s = it.sheet.refreeze_s;
    /// The elastic sheet.
    pub body: Body = "body", Rec;
    /// Crack events per second and joule of one-sided kinetic energy above `calm_j`.
    pub onsets_per_j_s: f32 = "onsets_per_j_s", num(0.0..=10_000_000.0);
    /// Kinetic energy below which the ice does not crack, in joules; none in the paper.
    pub calm_j: f32 = "calm_j", num(0.0..=1000.0);
    /// The energies of single events.
    pub energy: EnergyLaw = "energy", Rec;
    /// The resonances of single events.
    pub ring: Ring = "ring", Rec;
    /// The growth of cracks.
    pub cracks: CrackRules = "cracks", Rec;
    /// The wear of the sheet.
    pub sheet: Sheet = "sheet", Rec;
    /// Share of each crack that is also heard, from the loudspeakers nearest to it: 0 (not at all) to 1.
    pub sound: f32 = "sound", num(0.0..=1.0) => 0.0;
}

impl IceSpec {
    /// Crack events per second for the one-sided kinetic energy `kinetic_j` and the wear `depth` (0 to 1):
    /// `onsets_per_j_s * max(kinetic_j - calm_j, 0) * (1 + weakening * depth)`.
    ///
    /// # Source
    /// A Poisson process with the one-sided kinetic energy as its rate (paper, section 4.1.1); the threshold and the
    /// weakness of broken ice are ours, and with both at zero it is the paper's.
    #[must_use]
    pub fn onsets_per_s(&self, kinetic_j: f64, depth: f32) -> f64 {
        let beyond = (kinetic_j - f64::from(self.calm_j)).max(0.0);
        f64::from(self.onsets_per_j_s) * beyond * f64::from(1.0 + self.sheet.weakening * depth)
    }
}

record! {
    /// Wear and recovery of a sheet of ice.
    pub struct Sheet = "Sheet", Copy;
    /// Share of its thickness that breaks per joule, at the place of the event.
    pub depth_per_j: f32 = "depth_per_j", num(0.0..=100.0);
    /// Distance at which the wear falls to 1/e, in metres.
    pub reach_m: f32 = "reach_m", num(0.01..=2.0);
    /// Relative increase of the crack rate where the ice is broken through.
    pub weakening: f32 = "weakening", num(0.0..=100.0);
    /// Time in which broken ice becomes whole again, in seconds; `None`: never.
    pub refreeze_s: Option<f32> = "refreeze_s", Opt(num(1.0..=1_000_000.0));
}

/// The kind of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grain {
    /// Dry snow, packed by feet.
    Snow,
    /// Gravel, which stays loose.
    Gravel,
    /// Sand, which flows aside.
    Sand,
}

impl Grain {
    /// Its name in layouts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Snow => "Snow",
            Self::Gravel => "Gravel",
            Self::Sand => "Sand",
        }
    }
}

record! {
    /// Many small grains.
    pub struct GrainSpec = "Grain", Copy;
    /// The kind of grains, which sets their look.
    pub grain: Grain = "", Own(Grain::Snow);
    /// The elastic bed that moves them.
    pub body: Body = "body", Rec;
    /// Collisions per second at `full_j`; the rate follows the root of the energy.
    pub collisions_per_s: f32 = "collisions_per_s", num(1.0..=10_000.0);
    /// Energy of the moving grains under one tile at which collisions have their full rate and force, in joules.
    pub full_j: f32 = "full_j", num(0.0001..=1000.0);
    /// Time in which the energy of moving grains decays to 1/e, in seconds.
    pub settle_s: f32 = "settle_ms", num(1.0..=5000.0).milli();
    /// The energies of single collisions: only the shape of the law counts, since `ring` sets the maximum.
    pub energy: EnergyLaw = "energy", Rec;
    /// The resonances of single collisions.
    pub ring: Ring = "ring", Rec;
    /// Share of the looseness that a joule of work packs, at the place of the load.
    pub packing_per_j: f32 = "packing_per_j", num(0.0..=100.0);
    /// Distance at which the packing falls to 1/e, in metres.
    pub reach_m: f32 = "reach_m", num(0.01..=2.0);
    /// Motion of packed grains, as a share of that of loose ones, 0 to 1.
    pub packed: f32 = "packed", num(0.0..=1.0);
    /// Time in which the ground becomes loose again, in seconds; `None`: never.
    pub renew_s: Option<f32> = "renew_s", Opt(num(1.0..=1_000_000.0));
    /// Share of each collision that is also heard, from the loudspeakers nearest to it: 0 (not at all) to 1.
    pub sound: f32 = "sound", num(0.0..=1.0) => 0.0;
}

record! {
    /// Planks.
    pub struct WoodSpec = "Wood", Copy;
    /// The elastic plank.
    pub body: Body = "body", Rec;
    /// Width of a plank, in metres.
    pub plank_m: f32 = "plank_m", num(0.02..=5.0);
    /// Direction of the planks.
    pub along: Axis = "along", Name;
    /// Mean force at which a joint slips.
    pub stick: Newtons = "stick_n", num(1.0..=2000.0);
    /// Variation of that force from slip to slip, as a share of it, 0 to 0.9.
    pub scatter: f32 = "scatter", num(0.0..=0.9);
    /// Share of its strain that a joint loses when it slips, 0 to 1.
    pub slip: f32 = "slip", num(0.05..=1.0);
    /// The resonances of slips.
    pub ring: Ring = "ring", Rec;
    /// Share of each slip that is also heard, from the loudspeakers nearest to it: 0 (not at all) to 1.
    pub sound: f32 = "sound", num(0.0..=1.0) => 0.0;
}

const WHITE_SPRUCE: Ring =
    Ring { level: Newtons(9.0), modes: 5, low_hz: 70.0, high_hz: 420.0, shortest_s: 0.006, longest_s: 0.045 };

impl IceSpec {
    /// A pond of clear ice that carries a person with a careful gait. Tuned so that a step of ordinary walking opens
    /// some ten cracks, and slow loading of a foot almost none.
    pub const POND: Self = Self {
        body: Body { mass_kg: 60.0, damping_n_s_m: 5000.0, stiffness_n_m: 200_000.0 },
        onsets_per_j_s: 6500.0,
        calm_j: 0.012,
        energy: EnergyLaw { gamma: -1.5, least_j: 0.1, most_j: 2.5 },
        ring: Ring {
            level: Newtons(16.0),
            modes: 6,
            low_hz: 70.0,
            high_hz: 720.0,
            shortest_s: 0.003,
            longest_s: 0.07,
        },
        cracks: CrackRules {
            apart_m: 0.15,
            per_j_m: 0.045,
            turn: 0.28,
            branch: 0.16,
            branch_rad: 0.65,
            most: 2400,
            refreeze_s: Some(90.0),
        },
        sheet: Sheet { depth_per_j: 0.035, reach_m: 0.11, weakening: 0.6, refreeze_s: Some(90.0) },
        sound: 0.0,
    };
}

impl GrainSpec {
    /// Dry snow: crunches while it is packed, and is quieter the second time.
    pub(crate) const SNOW: Self = Self {
        grain: Grain::Snow,
        body: Body { mass_kg: 20.0, damping_n_s_m: 9000.0, stiffness_n_m: 90_000.0 },
        collisions_per_s: 420.0,
        full_j: 0.6,
        settle_s: 0.03,
        energy: EnergyLaw { gamma: -1.6, least_j: 0.02, most_j: 1.0 },
        ring: Ring {
            level: Newtons(7.0),
            modes: 3,
            low_hz: 110.0,
            high_hz: 600.0,
            shortest_s: 0.002,
            longest_s: 0.010,
        },
        packing_per_j: 0.09,
        reach_m: 0.075,
        packed: 0.25,
        renew_s: Some(240.0),
        sound: 0.0,
    };

    /// Gravel: few hard knocks, always loose.
    pub(crate) const GRAVEL: Self = Self {
        grain: Grain::Gravel,
        body: Body { mass_kg: 30.0, damping_n_s_m: 7000.0, stiffness_n_m: 160_000.0 },
        collisions_per_s: 260.0,
        full_j: 0.35,
        settle_s: 0.045,
        energy: EnergyLaw { gamma: -1.3, least_j: 0.02, most_j: 1.0 },
        ring: Ring {
            level: Newtons(14.0),
            modes: 2,
            low_hz: 180.0,
            high_hz: 740.0,
            shortest_s: 0.002,
            longest_s: 0.012,
        },
        packing_per_j: 0.03,
        reach_m: 0.07,
        packed: 0.85,
        renew_s: Some(600.0),
        sound: 0.0,
    };

    /// Sand: a hiss of very many small grains that soon lie still.
    pub(crate) const SAND: Self = Self {
        grain: Grain::Sand,
        body: Body { mass_kg: 25.0, damping_n_s_m: 12_000.0, stiffness_n_m: 120_000.0 },
        collisions_per_s: 900.0,
        full_j: 0.5,
        settle_s: 0.02,
        energy: EnergyLaw { gamma: -1.0, least_j: 0.05, most_j: 1.0 },
        ring: Ring {
            level: Newtons(3.0),
            modes: 1,
            low_hz: 240.0,
            high_hz: 740.0,
            shortest_s: 0.0015,
            longest_s: 0.004,
        },
        packing_per_j: 0.07,
        reach_m: 0.08,
        packed: 0.6,
        renew_s: Some(300.0),
        sound: 0.0,
    };
}

impl WoodSpec {
    /// Old floor boards.
    pub(crate) const PLANKS: Self = Self {
        body: Body { mass_kg: 15.0, damping_n_s_m: 3000.0, stiffness_n_m: 250_000.0 },
        plank_m: 0.152,
        along: Axis::East,
        stick: Newtons(70.0),
        scatter: 0.5,
        slip: 0.4,
        ring: WHITE_SPRUCE,
        sound: 0.0,
    };
}
