//! All numbers of the tracker, with their units and where they come from.
//!
//! "Recorded steps" are the 294 steps of five people of SpeedPP2DS (Pataky et al. 2008); "geometry" follows from what a
//! shoe or a tile is; "our choice" was tried on recorded and simulated people.
//!
//! What a fifth more or less does was tried for 49 of them, one at a time, on a third of the recorded steps, of the
//! works of a resting foot and of the weight shifts (14), and on recorded walks. No score moves but by these:
//!
//! | number | a fifth | what moves |
//! |---|---|---|
//! | `AROUND_M` | less | 1.0 % of single steps split (0); walks: both found 99.5 % (99.9), 0.3 % extra (0) |
//! | `SHOE_M` | less | a resting foot kept in 93 % of the hardest works (100), 0.7 % extra (0) |
//! | `SWAY_M` | less | 0.4 % extra beside a resting foot (0) |
//! | `ALONG_M` | less | 0.03 % extra (0.01); one shift of 14 fewer renamed |
//! | `AWAY_M` | less | one shift of 14 more lost and renamed |
//! | `SLEEPS` | less, more | one shift of 14 fewer renamed, one more |
//! | `WAKES` | less | one shift of 14 fewer renamed |
//! | `UNKNOWN_SHAPE` | less | walks: both found 99.8 % (99.9) |

/// One foot or two.
pub(super) mod explanation {
    /// Prior log odds of two feet: of a track that began far from all others, and of one that began near another foot.
    pub(in crate::sense::track) const LONE: f64 = -1.1;

    pub(in crate::sense::track) const ACCOMPANIED: f64 = -4.6;

    /// Log odds that are paid before a second track begins: a false one can press something (cost 400 : 1).
    pub(in crate::sense::track) const BIRTH: f64 = 6.0;

    /// The largest spread of tile loads under one foot along and across it, in metres, and by how much it varies. In
    /// 294 recorded steps and their turned, rocked and pressed kin at most 0.095 and 0.024.
    pub(in crate::sense::track) const ALONG_M: f64 = 0.088;

    pub(in crate::sense::track) const ACROSS_M: f64 = 0.021;

    pub(in crate::sense::track) const ALONG_SPREAD_M: f64 = 0.0055;

    pub(in crate::sense::track) const ACROSS_SPREAD_M: f64 = 0.0035;

    /// Force below which spread says nothing, in newtons.
    pub(in crate::sense::track) const SPREAD_N: f64 = 60.0;

    /// Log odds that standing alone adds, in all, and after how long beyond the longest rest of a step, in seconds.
    pub(in crate::sense::track) const STANDING: f64 = 4.0;

    pub(in crate::sense::track) const STANDING_S: f64 = 0.2;

    /// The same of a foot that another one was near to before: who stops walking puts the other foot beside it, and may
    /// have done so where it cannot be told from sway.
    pub(in crate::sense::track) const STOPPED: f64 = 4.8;

    pub(in crate::sense::track) const STOPPED_S: f64 = 0.6;

    /// Sway of somebody who stands on one leg, as a standard deviation in metres.
    pub(in crate::sense::track) const SWAY_M: f64 = 0.010;

    /// Travel of a centre of pressure that two feet do not show together, in metres, and what it takes off.
    pub(in crate::sense::track) const ROLL_M: f64 = 0.08;

    pub(in crate::sense::track) const ROLL: f64 = 4.0;

    /// Half the distance between two feet that stand, from and to, in metres.
    pub(in crate::sense::track) const HALF_STANCE_M: (f64, f64) = (0.06, 0.15);

    /// The largest sum of evidence of each kind.
    pub(in crate::sense::track) const MOST: f64 = 12.0;

    /// Over which time evidence is averaged, in seconds.
    pub(in crate::sense::track) const WINDOW_S: f64 = 0.03;
}

/// New tracks on tiles that others press.
pub(super) mod initiate {
    /// Least distance between the centres of pressure of two feet: side by side, touching.
    pub(in crate::sense::track) const APART_M: f64 = 0.08;

    /// Load that a tile must gain to show a newcomer, in newtons.
    pub(in crate::sense::track) const ADDED_N: f64 = 10.0;

    /// How well the place of a newcomer is guessed that no tile shows by itself, as a standard deviation in metres.
    pub(in crate::sense::track) const GUESSED_M: f64 = 0.08;

    /// Speed from which on a foot that nobody stands on may slide onto other tiles, in metres per second.
    pub(in crate::sense::track) const SLIDES_M_S: f64 = 0.1;

    /// How well the places of two feet are known that have landed together, in metres.
    pub(in crate::sense::track) const APART_GUESS_M: f64 = 0.06;

    /// Distance between two feet that stand, before anything is known of it, in metres.
    pub(in crate::sense::track) const STANCE_M: f64 = 0.2;
}

/// Tiles to tracks.
pub(super) mod associate {
    /// Largest distance between the feet of somebody who stands, in metres.
    pub(in crate::sense::track) const ASTRIDE_M: f64 = 0.5;

    /// For how long a load beyond a foot is looked at before it is taken for another foot, in seconds.
    pub(in crate::sense::track) const PENDING_S: f64 = 0.006;

    /// By how much noise of one newton per sensor moves the centroid of one newton, in metres: twice the sensors'
    /// reach.
    pub(in crate::sense::track) const NOISE_ARM_M: f64 = 0.264;
}

/// What can belong to a foot.
pub(super) mod reach {
    use crate::sense::track::outline::Shoe;

    /// How far from its centre of pressure a foot that has come down flat presses, in metres.
    pub(in crate::sense::track) const AROUND_M: f64 = 0.17;

    pub(in crate::sense::track) const AROUND_LIGHT_M: f64 = 0.26;

    /// Room of one shoe: its length, and its breadth with what turning it a little takes.
    pub(in crate::sense::track) const SHOE: Shoe = Shoe { length: super::state::SHOE_M, breadth: 0.13 };

    /// Least share of a foot that a tile carries that tells where it presses.
    pub(in crate::sense::track) const NOTED: f64 = 0.15;

    pub(in crate::sense::track) const NOTED_M: f64 = 0.02;

    pub(in crate::sense::track) const NOTED_PER_NOISE: f64 = 26.0;

    /// How long what it has pressed is remembered, in seconds.
    pub(in crate::sense::track) const MEMORY_S: f64 = 1.0;

    pub(in crate::sense::track) const MEMORY_LIGHT_S: f64 = 0.08;

    /// What share of a foot's force its rim presses with at most, and how far from its centre of pressure, in metres:
    /// of one that stands alone, of one that slides on and comes onto the next tile with its rim, and of one that
    /// shares its tiles and is itself known only roughly (our choice).
    pub(in crate::sense::track) const RIM: (f64, f64) = (0.02, 0.22);

    pub(in crate::sense::track) const RIM_AHEAD: (f64, f64) = (0.1, 0.24);

    pub(in crate::sense::track) const RIM_OF_SHARED: (f64, f64) = (0.08, 0.25);

    /// How far a patch is taken to reach, in half widths and, beyond that, in metres.
    pub(in crate::sense::track) const HALVES: f64 = 1.1;

    pub(in crate::sense::track) const BEYOND_M: f64 = 0.02;

    /// How well a foot's habits must be known, and which share of it a line must have borne, for its tiles to be
    /// listed.
    pub(in crate::sense::track) const KNOWN: f64 = 0.3;

    pub(in crate::sense::track) const BORNE: f64 = 0.008;

    /// Speed towards a place from which on a foot slides there, in metres per second.
    pub(in crate::sense::track) const AHEAD_M_S: f64 = 0.02;
}

/// Feet that have given up their weight.
pub(super) mod dormant {
    /// Share of the load of two feet below which the lighter one is no longer needed, and from which on it is again.
    pub(in crate::sense::track) const SLEEPS: f64 = 0.15;

    pub(in crate::sense::track) const WAKES: f64 = 0.2;

    /// For how long one foot must have been enough, in seconds.
    pub(in crate::sense::track) const ENOUGH_S: f64 = 0.04;

    /// How far the centre of pressure of the foot that stands may be off the line between the two, in metres.
    pub(in crate::sense::track) const ASIDE_M: f64 = 0.04;

    /// How far it may move away from the other, in metres: it rolls on, as in walking.
    pub(in crate::sense::track) const AWAY_M: f64 = 0.05;

    /// For how long at most a foot may be thought to rest without weight, in seconds.
    pub(in crate::sense::track) const MOST_S: f64 = 5.0;

    /// Share of the load that such a foot is reported with: between nothing and [`SLEEPS`], by how often it is still
    /// there.
    pub(in crate::sense::track) const REPORTED: f64 = 0.02;

    /// Standard deviation of its place, in metres.
    pub(in crate::sense::track) const PLACE_M: f64 = 0.06;

    /// Largest distance between where a foot was and where it is again, in metres.
    pub(in crate::sense::track) const SAME_M: f64 = 0.12;

    /// Evidence of two feet in how their loads lie, as log odds, up to which one may be enough.
    pub(in crate::sense::track) const OPEN: f64 = 0.5;
}

/// Feet that have left.
pub(super) mod delete {
    /// Largest force, in newtons, with which a foot that shares its tiles counts as gone: below what makes a tile
    /// count.
    pub(in crate::sense::track) const EMPTY_N: f64 = 8.0;

    /// How many standard deviations its force must be below that.
    pub(in crate::sense::track) const SURE: f64 = 2.0;

    /// The least load of a tile that is noticed, in newtons.
    pub(in crate::sense::track) const NOTICED_N: f64 = 6.0;

    /// Shares of all below which a foot may be gone, and that one which is still there carries at least.
    pub(in crate::sense::track) const LIGHT_SHARE: f64 = 0.2;

    pub(in crate::sense::track) const GONE_SHARE: f64 = 0.08;

    /// How much of its patch may lie elsewhere than is thought, as a share.
    pub(in crate::sense::track) const MISPLACED: f64 = 0.2;

    /// Force that cannot be told from none where most of its tiles carry nothing, in newtons.
    pub(in crate::sense::track) const LIGHT_N: f64 = 30.0;

    /// How long a foot must have seemed to be gone before it is, in seconds.
    pub(in crate::sense::track) const FAINT_S: f64 = 0.01;

    /// How fast it then is no longer taken to be, in seconds per second: a rim that comes and goes proves nothing.
    pub(in crate::sense::track) const RECOVERS: f64 = 0.2;

    /// How far beyond the other feet's centres of pressure a loaded tile is proof that a foot is there, in metres.
    pub(in crate::sense::track) const OWN_M: f64 = 0.23;

    /// A light load this near to a heavy foot, as a share of it, may be that foot's rim.
    pub(in crate::sense::track) const RIM_SHARE: f64 = 0.08;

    pub(in crate::sense::track) const RIM_M: f64 = 0.22;

    /// How far no foot's centre of pressure moves by itself as its load goes, in metres.
    pub(in crate::sense::track) const FAR_M: f64 = 0.12;
}

/// Feet.
pub(super) mod state {
    /// Half widths of the pressed patch, in metres: a toe's tip, and all of a long foot but its ends, which press
    /// little.
    pub(in crate::sense::track) const HALF_LEAST: f64 = 0.015;

    pub(in crate::sense::track) const HALF_MOST: f64 = 0.11;

    /// What one expects before anything is seen: half a forefoot or heel-and-arch (our choice).
    pub(in crate::sense::track) const HALF_REST: f64 = 0.075;

    /// Longest distance between two points under one shoe that carry noticeable load.
    pub(in crate::sense::track) const SHOE_M: f64 = 0.33;

    /// Time constant of a lone foot's rates, in seconds: they are differences of frames (our choice).
    pub(in crate::sense::track) const RATE_S: f64 = 0.015;

    /// After which time a foot has come down flat, in seconds.
    pub(in crate::sense::track) const FLAT_S: f64 = 0.3;

    /// How long a foot takes to land: until then more of it may touch the floor anywhere under its shoe, in seconds.
    pub(in crate::sense::track) const LANDS_S: f64 = 0.25;

    /// How long its own sway is not taken for a newcomer after a companion has gone or a sensor was lost, in seconds.
    pub(in crate::sense::track) const CALM_S: f64 = 0.25;

    /// How long a foot remembers its partner, in seconds: as long as a slow step takes.
    pub(in crate::sense::track) const PARTNER_S: f64 = 1.2;

    /// The force on a foot that slides, in newtons, at most.
    pub(in crate::sense::track) const SLIDING_N: f64 = 200.0;

    /// The least that a foot bears that somebody stands on, in newtons: more than a leg of somebody who sits.
    pub(in crate::sense::track) const BODY_N: f64 = 350.0;

    /// Which share of what somebody's foot has borne in a step tells their body from a foot that works a control: a
    /// body that stands bears nine tenths of it (recorded steps). Children walk with less than [`BODY_N`], at the least
    /// so many newtons (six years, our choice).
    pub(in crate::sense::track) const BODY_SHARE: f64 = 0.75;

    pub(in crate::sense::track) const LEAST_BODY_N: f64 = 140.0;
}

/// Standing and swaying.
pub(super) mod stillness {
    /// How far the centre of pressure of a foot that stands still strays, and that of one that rolls
    /// while another one lands, in metres.
    pub(in crate::sense::track) const SWAY_LEAST_M: f64 = 0.01;

    pub(in crate::sense::track) const SWAY_MOST_M: f64 = 0.06;

    /// How far it strays per speed, in seconds: as long as two feet are down while one walks.
    pub(in crate::sense::track) const SWAY_PER_SPEED_S: f64 = 0.15;

    /// How soon a foot that shares tiles has another home, in seconds.
    pub(in crate::sense::track) const REST_POINT_S: f64 = 1.0;

    /// How soon one that stands still alone has.
    pub(in crate::sense::track) const STILL_REST_POINT_S: f64 = 0.03;

    /// How fast the centre of pressure of a foot that shares tiles is expected to move, in metres per second.
    pub(in crate::sense::track) const SHARED_SPEED_M_S: f64 = 0.03;

    /// Mean speed of its centre of pressure below which a foot hardly rolls, in metres per second.
    pub(in crate::sense::track) const SLOW_M_S: f64 = 0.15;

    /// Time constant of a foot's mean speed, in seconds (our choice).
    pub(in crate::sense::track) const MEAN_SPEED_S: f64 = 0.25;

    /// How soon a foot that stood still is taken to roll, in metres per second squared.
    pub(in crate::sense::track) const SPEED_RISE_M_S2: f64 = 0.2;

    /// Speed of its centre of pressure below which a foot stands still, in metres per second.
    pub(in crate::sense::track) const STILL_M_S: f64 = 0.12;

    /// How long it must have done so, and how long it may then move before it rolls, in seconds.
    pub(in crate::sense::track) const STILL_S: f64 = 0.08;

    pub(in crate::sense::track) const AWAY_S: f64 = 0.15;

    /// Radius within which a foot stands still, in metres, for how long it then stands, how soon it stands elsewhere,
    /// and how long it may be away, in seconds. No recorded step stays within a centimetre for more than 0.17 s.
    pub(in crate::sense::track) const ANCHOR_M: f64 = 0.012;

    pub(in crate::sense::track) const STANDS_S: f64 = 0.3;

    pub(in crate::sense::track) const ANCHOR_S: f64 = 1.0;

    pub(in crate::sense::track) const ASTRAY_S: f64 = 1.5;
}

/// Smoothing.
pub(super) mod smoothed {
    /// Time constant of the slow past, in seconds: longer than a heel takes to strike, shorter than a roll-over.
    pub(in crate::sense::track) const SMOOTHED_S: f64 = 0.05;
}

/// Shape residuals.
pub(super) mod residual {
    /// Time constant of a foot's habits, in seconds.
    pub(in crate::sense::track) const RESIDUAL_S: f64 = 0.08;

    /// How long a foot must be alone for its shape to be known, in seconds.
    pub(in crate::sense::track) const KNOWN_S: f64 = 0.1;

    /// How often its shape is learnt, in seconds: often beside [`RESIDUAL_S`]. In every frame, it took a fifth of the tracker's
    /// work on a crowd (our choice).
    pub(in crate::sense::track) const LEARN_EVERY_S: f64 = 0.004;

    /// How long only its heel may be down, which tells nothing of the rest, in seconds.
    pub(in crate::sense::track) const TOUCHES_S: f64 = 0.1;
}

/// Motion and measurement.
pub(super) mod model {
    /// How soon the rate of a force decays, in seconds, and its standard deviation, in newtons per second: a heel
    /// strikes within 20 to 40 ms (recorded steps).
    pub(in crate::sense::track) const FORCE_FADE_S: f64 = 0.03;
    pub(in crate::sense::track) const FORCE_RATE_N_S: f64 = 5000.0;

    /// How soon the speed of a centre of pressure decays, in seconds, and its bounds as a standard deviation, in metres
    /// per second: feet that share tiles are past their fastest (our choice).
    pub(in crate::sense::track) const PLACE_FADE_S: f64 = 0.08;
    pub(in crate::sense::track) const SPEED_M_S: f64 = 0.4;
    pub(in crate::sense::track) const SPEED_LEAST_M_S: f64 = 0.05;

    /// How soon a half width may be another one, in seconds, and by how much it varies, in metres (our choice).
    pub(in crate::sense::track) const HALF_FADE_S: f64 = 0.3;
    pub(in crate::sense::track) const HALF_SPREAD_M: f64 = 0.03;

    /// How far force that strays over a seam is spread along it, as a standard deviation.
    pub(in crate::sense::track) const SPREAD_M: f64 = 0.05;

    /// How many times as far from its home as it is expected to stray a foot is held that stood before the others came:
    /// what draws it farther is theirs.
    pub(in crate::sense::track) const HELD: f64 = 1.5;

    /// What a patch may divide otherwise over two tiles than a foot does, as a share of its force: one seen
    /// standing there alone, and in addition one that was not.
    pub(in crate::sense::track) const KNOWN_SHAPE: f64 = 0.01;

    pub(in crate::sense::track) const UNKNOWN_SHAPE: f64 = 0.08;
}

/// A foot put down beside a standing one.
pub(super) mod touchdown {
    /// Distances that are tried, in metres: from feet that touch to a wide stance.
    pub(in crate::sense::track) const NEAREST_M: f64 = 0.09;

    pub(in crate::sense::track) const STEP_M: f64 = 0.02;

    pub(in crate::sense::track) const TRIED: usize = 22;

    /// Twice the logarithm of how many times likelier another distance must be for one not to count: its weight vanishes
    /// in the sum of all, to the last bit (arithmetic of 53 bits). A fifth more or less changes nothing but the time.
    pub(in crate::sense::track) const OUT_OF_QUESTION: f64 = 100.0;

    /// Distance one expects before anything is seen, and how much it varies (as a factor).
    pub(in crate::sense::track) const USUAL_M: f64 = 0.22;

    pub(in crate::sense::track) const USUAL_SPREAD: f64 = 0.5;

    /// Share of the way of the common centre of pressure that tiles which only the new foot presses account for, when
    /// it is better measured there: the rest of that way is lost in the standing foot's sway.
    pub(in crate::sense::track) const MOSTLY: f64 = 0.8;

    /// Share of the standing foot below which a tile is none of its own.
    pub(in crate::sense::track) const NOT_ITS_OWN: f64 = 0.02;

    /// Distance below which shoes side by side would touch, and how sharply that counts, in metres.
    pub(in crate::sense::track) const SIDE_BY_SIDE_M: f64 = 0.13;

    pub(in crate::sense::track) const TIGHT_M: f64 = 0.01;

    /// Share of all weight from which on the new foot is where the common centre of pressure is.
    pub(in crate::sense::track) const TAKEN_OVER: f64 = 0.8;

    /// Half widths that the new foot's patch may have along an axis, likeliest first, and the widest, in metres, and
    /// how much they vary.
    pub(in crate::sense::track) const HALVES: [f64; 4] = [0.075, 0.105, 0.045, WIDEST_M];

    pub(in crate::sense::track) const WIDEST_M: f64 = 0.135;

    pub(in crate::sense::track) const HALF_SPREAD_M: f64 = 0.03;

    /// Least moment that shows where a new foot lies, in newton metres, and as a way of the common
    /// centre of pressure, in metres: more than a standing foot sways in a moment.
    pub(in crate::sense::track) const LEAST_MOMENT: f64 = 1.0;

    pub(in crate::sense::track) const LEAST_WAY_M: f64 = 0.006;

    /// What is not known of how a foot divides over two tiles, as a share of its force.
    pub(in crate::sense::track) const UNLIKE: f64 = 0.1;

    /// The least of it, as a share of a foot that lies on one tile.
    pub(in crate::sense::track) const UNLIKE_LEAST: f64 = 0.02;

    /// How far the standing foot sways meanwhile, and how well the new one is known across the way, in metres.
    pub(in crate::sense::track) const SWAY_M: f64 = 0.025;

    pub(in crate::sense::track) const PLACE_M: f64 = 0.012;

    /// What forces are misread by, in newtons.
    pub(in crate::sense::track) const MISREAD_N: f64 = 2.0;
}

/// What contacts say.
pub(super) mod output {
    /// How much more a joint position is doubted per unit of surprise.
    pub(in crate::sense::track) const INFLATION: f64 = 4000.0;

    /// How badly two feet of which one stands still fit the loads without doubt, as a mean square of deviations (our
    /// choice): of simulated people who shift their weight, step aside and walk, nine in ten fit by 0.3, 0.6 and 1.4.
    pub(in crate::sense::track) const FITS: f64 = 0.9;

    /// How far both are off if they fit worse by one, as a standard deviation in metres; it grows with the fourth root
    /// of what is above [`FITS`]. In simulated scenes 95 in 100 of the feet are within 12 cm where they fit by 0.9 to
    /// 1.9, 14 cm up to 3.5, 17 cm up to 7.6, and 21 cm beyond.
    pub(in crate::sense::track) const STRAYED_M: f64 = 0.045;

    /// Which part of the gain errors under other feet falls on a foot that shares their tiles.
    pub(in crate::sense::track) const OTHERS_MISREAD: f32 = 0.25;

    /// Standard deviation above which the place of a foot counts as a guess, in metres.
    pub(in crate::sense::track) const AMBIGUOUS_M: f64 = 0.04;

    /// How well two feet are known that have landed together, beyond what the filter says, in metres.
    pub(in crate::sense::track) const TOGETHER_M: f32 = 0.035;

    /// The largest standard deviation that inflation may lead to: it is in this group of tiles, no more is known.
    pub(in crate::sense::track) const LOST_M: f64 = 0.3;

    /// The least force of a contact all of which may be residual load, in newtons: as much as can be placed.
    pub(in crate::sense::track) const LEAST_N: f32 = 2.0;
}

/// The tracker.
pub(super) mod tracker {
    /// Largest force a foot can have of what its group's tiles carry, as a share, and in newtons beyond it.
    pub(in crate::sense::track) const MOST_SHARE: f64 = 1.3;

    pub(in crate::sense::track) const MOST_MORE_N: f64 = 50.0;

    /// How far from where a foot was first seen the filter's first step may put it, in metres: half a shoe.
    pub(in crate::sense::track) const FIRST_STEP_M: f64 = 0.15;

    /// How little is known of the place of a foot that the filter has thrown about, as a standard deviation in metres.
    pub(in crate::sense::track) const THROWN_M: f64 = 0.05;

    /// How long a foot that lands beside another one learns whose it is, in seconds: until the other one lifts off.
    pub(in crate::sense::track) const LANDING_S: f64 = 0.05;

    /// How long a foot must have been down to be somebody's partner, in seconds.
    pub(in crate::sense::track) const SEEN_S: f64 = 0.03;

    /// Largest distance between the feet of one person, in metres.
    pub(in crate::sense::track) const STRIDE_M: f64 = 1.0;

    /// Over which time surprise is averaged, in seconds.
    pub(in crate::sense::track) const NIS_S: f64 = 0.05;
}
