//! All numbers of the tracker, with their units and where they come from.
//!
//! "Recorded steps" are the 294 steps of five people of SpeedPP2DS (Pataky et al. 2008); "geometry" follows from the
//! size of a shoe or a tile; "our choice" was tried on recorded and simulated people.
//!
//! Sensitivity: 49 of the numbers were changed by a fifth up and down, one at a time, on a third of the recorded
//! steps, of the working movements of a resting foot and of the weight shifts (14), and on recorded walks. Only these
//! changed a score:
//!
//! | number | a fifth | change of the score |
//! |---|---|---|
//! | `AROUND_M` | less | 1.0 % of single steps split (0); walks: both found 99.5 % (99.9), 0.3 % extra (0) |
//! | `SHOE_M` | less | a resting foot kept in 93 % of the hardest works (100), 0.7 % extra (0) |
//! | `SWAY_M` | less | 0.4 % extra beside a resting foot (0) |
//! | `ALONG_M` | less | 0.03 % extra (0.01); one shift of 14 fewer renamed |
//! | `AWAY_M` | less | one shift of 14 more lost and renamed |
//! | `SLEEPS` | less, more | one shift of 14 fewer renamed, one more |
//! | `WAKES` | less | one shift of 14 fewer renamed |
//! | `UNKNOWN_SHAPE` | less | walks: both found 99.8 % (99.9) |

/// Is a track one foot or two?
pub(super) mod explanation {
    /// Prior log odds of two feet: for a track that began far from all others, and for one that began near another
    /// foot.
    pub(in crate::sense::track) const LONE: f64 = -1.1;

    pub(in crate::sense::track) const ACCOMPANIED: f64 = -4.6;

    /// Log odds required before a second track begins: a false track can press something (cost 400 : 1).
    pub(in crate::sense::track) const BIRTH: f64 = 6.0;

    /// Largest spread of tile loads under one foot along and across it, and the standard deviations of both (m). The
    /// 294 recorded steps and their rotated, rocked and pressed variants reach 0.095 and 0.024.
    pub(in crate::sense::track) const ALONG_M: f64 = 0.088;

    pub(in crate::sense::track) const ACROSS_M: f64 = 0.021;

    pub(in crate::sense::track) const ALONG_SPREAD_M: f64 = 0.0055;

    pub(in crate::sense::track) const ACROSS_SPREAD_M: f64 = 0.0035;

    /// Force below which the spread gives no evidence (N).
    pub(in crate::sense::track) const SPREAD_N: f64 = 60.0;

    /// Total log odds that standing alone adds, and the time over which they are added (s). It starts when the foot
    /// has stood longer than the longest rest of a step.
    pub(in crate::sense::track) const STANDING: f64 = 4.0;

    pub(in crate::sense::track) const STANDING_S: f64 = 0.2;

    /// The same for a foot that had another one near it. A person who stops walking puts the other foot beside this
    /// one, possibly where the shift looks like sway.
    pub(in crate::sense::track) const STOPPED: f64 = 4.8;

    pub(in crate::sense::track) const STOPPED_S: f64 = 0.6;

    /// Sway of the centre of pressure of a person on one leg, as a standard deviation (m).
    pub(in crate::sense::track) const SWAY_M: f64 = 0.010;

    /// Travel of the centre of pressure that two feet together do not reach (m), and the most log odds that it
    /// subtracts: min(`ROLL` (travel / `ROLL_M`)², `ROLL`).
    pub(in crate::sense::track) const ROLL_M: f64 = 0.08;

    pub(in crate::sense::track) const ROLL: f64 = 4.0;

    /// Half the distance between two standing feet, smallest and largest (m).
    pub(in crate::sense::track) const HALF_STANCE_M: (f64, f64) = (0.06, 0.15);

    /// Upper bound of each kind of evidence (log odds).
    pub(in crate::sense::track) const MOST: f64 = 12.0;

    /// Time constant of the evidence average (s).
    pub(in crate::sense::track) const WINDOW_S: f64 = 0.03;
}

/// New tracks on tiles that others press.
pub(super) mod initiate {
    /// Minimum distance between the centres of pressure of two feet (m): side by side, touching.
    pub(in crate::sense::track) const APART_M: f64 = 0.08;

    /// Load that a tile must gain to indicate a new foot (N).
    pub(in crate::sense::track) const ADDED_N: f64 = 10.0;

    /// Standard deviation of the place of a new foot that no tile shows by itself (m).
    pub(in crate::sense::track) const GUESSED_M: f64 = 0.08;

    /// Speed above which a foot that carries no person may slide onto other tiles (m/s).
    pub(in crate::sense::track) const SLIDES_M_S: f64 = 0.1;

    /// Standard deviation of the places of two feet that have landed together (m).
    pub(in crate::sense::track) const APART_GUESS_M: f64 = 0.06;

    /// Assumed distance between two standing feet (m), before any measurement.
    pub(in crate::sense::track) const STANCE_M: f64 = 0.2;
}

/// Tiles to tracks.
pub(super) mod associate {
    /// Maximum distance between the feet of a standing person (m).
    pub(in crate::sense::track) const ASTRIDE_M: f64 = 0.5;

    /// Time for which a load beyond a foot is observed before it becomes another foot (s).
    pub(in crate::sense::track) const PENDING_S: f64 = 0.006;

    /// Arm of the noise (m): 1 N of noise per sensor moves the centroid of a load of 1 N by this much. It is twice
    /// the distance of the sensors from the tile's centre.
    pub(in crate::sense::track) const NOISE_ARM_M: f64 = 0.264;
}

/// The loads that can belong to a foot.
pub(super) mod reach {
    use crate::sense::track::outline::ShoeSize;

    /// Radius about the centre of pressure within which a flat foot presses (m): a foot that carries a person, and a
    /// light one.
    pub(in crate::sense::track) const AROUND_M: f64 = 0.17;

    pub(in crate::sense::track) const AROUND_LIGHT_M: f64 = 0.26;

    /// Area of one shoe: its length, and its breadth with an allowance for a small rotation.
    pub(in crate::sense::track) const SHOE: ShoeSize =
        ShoeSize { length: super::state::SHOE_M, breadth: 0.13 };

    /// Minimum share of the foot's force on a tile for its centroid to enter the outline. A foot that shares tiles
    /// enters up to this standard deviation of its place (m). A load must exceed this multiple of its sensors' noise.
    pub(in crate::sense::track) const NOTED: f64 = 0.15;

    pub(in crate::sense::track) const NOTED_M: f64 = 0.02;

    pub(in crate::sense::track) const NOTED_PER_NOISE: f64 = 26.0;

    /// Time constant of the outline (s): of a foot that carries a person, and of a light one.
    pub(in crate::sense::track) const MEMORY_S: f64 = 1.0;

    pub(in crate::sense::track) const MEMORY_LIGHT_S: f64 = 0.08;

    /// Maximum share of the foot's force at its rim, and maximum distance of the rim from the centre of pressure (m):
    /// for a foot that stands alone, for one that slides onto the next tile, and for one that shares its tiles and is
    /// known only roughly (our choice).
    pub(in crate::sense::track) const RIM: (f64, f64) = (0.02, 0.22);

    pub(in crate::sense::track) const RIM_AHEAD: (f64, f64) = (0.1, 0.24);

    pub(in crate::sense::track) const RIM_OF_SHARED: (f64, f64) = (0.08, 0.25);

    /// Reach of a patch: this many half widths plus this many metres.
    pub(in crate::sense::track) const HALVES: f64 = 1.1;

    pub(in crate::sense::track) const BEYOND_M: f64 = 0.02;

    /// Minimum weight of a foot's shape residuals, and minimum share of the foot on a strip, for the strip's tiles to
    /// be listed.
    pub(in crate::sense::track) const KNOWN: f64 = 0.3;

    pub(in crate::sense::track) const BORNE: f64 = 0.008;

    /// Speed towards a place above which a foot slides there (m/s).
    pub(in crate::sense::track) const AHEAD_M_S: f64 = 0.02;
}

/// Feet that have lost their load.
pub(super) mod dormant {
    /// Share of the load of two feet below which the lighter one becomes dormant, and above which it is active again.
    pub(in crate::sense::track) const SLEEPS: f64 = 0.15;

    pub(in crate::sense::track) const WAKES: f64 = 0.2;

    /// Time for which one foot must explain the loads alone (s).
    pub(in crate::sense::track) const ENOUGH_S: f64 = 0.04;

    /// Maximum distance of the standing foot's centre of pressure from the line between the two feet (m).
    pub(in crate::sense::track) const ASIDE_M: f64 = 0.04;

    /// Maximum movement of that centre of pressure away from the other foot (m): beyond, the foot rolls on as in
    /// walking.
    pub(in crate::sense::track) const AWAY_M: f64 = 0.05;

    /// Maximum time for which a foot without load stays dormant (s).
    pub(in crate::sense::track) const MOST_S: f64 = 5.0;

    /// Share of the load reported for a dormant foot: between zero and [`SLEEPS`], by how often the foot is still
    /// there.
    pub(in crate::sense::track) const REPORTED: f64 = 0.02;

    /// Standard deviation of its place (m).
    pub(in crate::sense::track) const PLACE_M: f64 = 0.06;

    /// Maximum distance between the places of a foot before and after its dormancy (m).
    pub(in crate::sense::track) const SAME_M: f64 = 0.12;

    /// Evidence of two feet in the spread of their loads (log odds) up to which one foot may explain it.
    pub(in crate::sense::track) const OPEN: f64 = 0.5;
}

/// Feet that have left.
pub(super) mod delete {
    /// Maximum force at which a foot that shares its tiles counts as gone (N): below the force that makes a tile
    /// count.
    pub(in crate::sense::track) const EMPTY_N: f64 = 8.0;

    /// Required margin below that force, in standard deviations of the foot's force.
    pub(in crate::sense::track) const SURE: f64 = 2.0;

    /// Minimum detectable load of a tile (N).
    pub(in crate::sense::track) const NOTICED_N: f64 = 6.0;

    /// Shares of the group's load: below the first a foot may be gone; a foot that is still there carries at least
    /// the second.
    pub(in crate::sense::track) const LIGHT_SHARE: f64 = 0.2;

    pub(in crate::sense::track) const GONE_SHARE: f64 = 0.08;

    /// Share of the patch that may lie elsewhere than estimated.
    pub(in crate::sense::track) const MISPLACED: f64 = 0.2;

    /// Force that is indistinguishable from zero if most of the foot's tiles are unloaded (N).
    pub(in crate::sense::track) const LIGHT_N: f64 = 30.0;

    /// Time for which a foot must appear gone before it is deleted (s).
    pub(in crate::sense::track) const FAINT_S: f64 = 0.01;

    /// Rate at which that time decreases again (s/s): a rim load that comes and goes proves nothing.
    pub(in crate::sense::track) const RECOVERS: f64 = 0.2;

    /// Distance from the other feet's centres of pressure beyond which a loaded tile proves that a foot is there (m).
    pub(in crate::sense::track) const OWN_M: f64 = 0.23;

    /// A load below this share of a foot and within this distance of it (m) may be that foot's rim.
    pub(in crate::sense::track) const RIM_SHARE: f64 = 0.08;

    pub(in crate::sense::track) const RIM_M: f64 = 0.22;

    /// Movement that no centre of pressure makes by itself while its load decreases (m).
    pub(in crate::sense::track) const FAR_M: f64 = 0.12;
}

/// The state of a foot.
pub(super) mod state {
    /// Bounds of the half widths of the patch (m): the tip of a toe, and a long foot without its ends, which carry
    /// little.
    pub(in crate::sense::track) const HALF_LEAST: f64 = 0.015;

    pub(in crate::sense::track) const HALF_MOST: f64 = 0.11;

    /// Assumed half width before any measurement (m): half a forefoot, or heel and arch (our choice).
    pub(in crate::sense::track) const HALF_REST: f64 = 0.075;

    /// Its standard deviation (m) (our choice).
    pub(in crate::sense::track) const UNKNOWN_HALF_M: f64 = 0.04;

    /// Maximum distance between two points under one shoe that carry noticeable load (m).
    pub(in crate::sense::track) const SHOE_M: f64 = 0.33;

    /// Time constant of a lone foot's rates, in seconds: they are differences of frames (our choice).
    pub(in crate::sense::track) const RATE_S: f64 = 0.015;

    /// Time after which a foot is flat on the floor (s).
    pub(in crate::sense::track) const FLAT_S: f64 = 0.3;

    /// Duration of a touchdown (s): until then the foot may touch the floor anywhere under its shoe.
    pub(in crate::sense::track) const LANDS_S: f64 = 0.25;

    /// Time without new tracks after a neighbouring foot has gone or a sensor was lost (s): the foot's own sway must
    /// not count as a new foot.
    pub(in crate::sense::track) const CALM_S: f64 = 0.25;

    /// Time for which a foot keeps its partner (s): the duration of a slow step.
    pub(in crate::sense::track) const PARTNER_S: f64 = 1.2;

    /// Maximum force on a sliding foot (N).
    pub(in crate::sense::track) const SLIDING_N: f64 = 200.0;

    /// Minimum force on a foot that carries a standing person (N): more than one leg of a seated person.
    pub(in crate::sense::track) const BODY_N: f64 = 350.0;

    /// Share of the peak force of a person's step that separates a standing body from a foot that operates a control:
    /// a standing body reaches nine tenths of it (recorded steps). Children walk with less than [`BODY_N`], but with
    /// at least this many newtons (six years, our choice).
    pub(in crate::sense::track) const BODY_SHARE: f64 = 0.75;

    pub(in crate::sense::track) const LEAST_BODY_N: f64 = 140.0;
}

/// Standing and swaying.
pub(super) mod stillness {
    /// Stray of the centre of pressure of a foot that stands still, and of one that rolls while another foot lands
    /// (m).
    pub(in crate::sense::track) const SWAY_LEAST_M: f64 = 0.01;

    pub(in crate::sense::track) const SWAY_MOST_M: f64 = 0.06;

    /// Stray per speed (s): the double support time of a walk.
    pub(in crate::sense::track) const SWAY_PER_SPEED_S: f64 = 0.15;

    /// Time constant of the rest point of a foot that shares tiles (s).
    pub(in crate::sense::track) const REST_POINT_S: f64 = 1.0;

    /// Time constant of the rest point of a foot that stands still alone (s).
    pub(in crate::sense::track) const STILL_REST_POINT_S: f64 = 0.03;

    /// Expected speed of the centre of pressure of a foot that shares tiles (m/s).
    pub(in crate::sense::track) const SHARED_SPEED_M_S: f64 = 0.03;

    /// Mean speed of the centre of pressure below which a foot hardly rolls (m/s).
    pub(in crate::sense::track) const SLOW_M_S: f64 = 0.15;

    /// Time constant of a foot's mean speed, in seconds (our choice).
    pub(in crate::sense::track) const MEAN_SPEED_S: f64 = 0.25;

    /// Maximum increase of the mean speed of a foot that stood still (m/s²).
    pub(in crate::sense::track) const SPEED_RISE_M_S2: f64 = 0.2;

    /// Speed of the centre of pressure below which a foot stands still (m/s).
    pub(in crate::sense::track) const STILL_M_S: f64 = 0.12;

    /// Time at that speed before the foot counts as still, and time of movement before it counts as rolling (s).
    pub(in crate::sense::track) const STILL_S: f64 = 0.08;

    pub(in crate::sense::track) const AWAY_S: f64 = 0.15;

    /// Radius within which a foot stands still (m), time until it counts as standing (s), time constant of the anchor
    /// (s), and maximum time outside the radius (s). No recorded step stays within a centimetre for more than 0.17 s.
    pub(in crate::sense::track) const ANCHOR_M: f64 = 0.012;

    pub(in crate::sense::track) const STANDS_S: f64 = 0.3;

    pub(in crate::sense::track) const ANCHOR_S: f64 = 1.0;

    pub(in crate::sense::track) const ASTRAY_S: f64 = 1.5;
}

/// Smoothing.
pub(super) mod smoothed {
    /// Time constant of the smoothed state (s): longer than a heel strike, shorter than a roll-over.
    pub(in crate::sense::track) const SMOOTHED_S: f64 = 0.05;
}

/// Shape residuals.
pub(super) mod residual {
    /// Time constant of a foot's shape residuals (s).
    pub(in crate::sense::track) const RESIDUAL_S: f64 = 0.08;

    /// Time for which a foot must be alone before its shape is known (s).
    pub(in crate::sense::track) const KNOWN_S: f64 = 0.1;

    /// Interval between updates of the shape (s): short beside [`RESIDUAL_S`]. Updates in every frame took a fifth of
    /// the tracker's work on a crowd (our choice).
    pub(in crate::sense::track) const LEARN_EVERY_S: f64 = 0.004;

    /// Time for which the heel alone may be down (s): it reveals nothing about the rest of the foot.
    pub(in crate::sense::track) const TOUCHES_S: f64 = 0.1;
}

/// Motion and measurement.
pub(super) mod model {
    /// Time constant of the rate of a force (s), and its standard deviation (N/s): a heel strikes within 20 to 40 ms
    /// (recorded steps).
    pub(in crate::sense::track) const FORCE_FADE_S: f64 = 0.03;
    pub(in crate::sense::track) const FORCE_RATE_N_S: f64 = 5000.0;

    /// Time constant of the velocity of a centre of pressure (s), and bounds of its standard deviation (m/s): feet
    /// that share tiles are slower than at their fastest (our choice).
    pub(in crate::sense::track) const PLACE_FADE_S: f64 = 0.08;
    pub(in crate::sense::track) const SPEED_M_S: f64 = 0.4;
    pub(in crate::sense::track) const SPEED_LEAST_M_S: f64 = 0.05;

    /// Time constant of a half width (s), and its standard deviation (m) (our choice).
    pub(in crate::sense::track) const HALF_FADE_S: f64 = 0.3;
    pub(in crate::sense::track) const HALF_SPREAD_M: f64 = 0.03;

    /// Standard deviation, along a seam, of the force that the model puts on the wrong side of it (m).
    pub(in crate::sense::track) const SPREAD_M: f64 = 0.05;

    /// Factor of the stray at which the oldest foot of a group is held at its rest point: a pull beyond that is due
    /// to the other feet.
    pub(in crate::sense::track) const HELD: f64 = 1.5;

    /// Error of the patch model in dividing a foot over two tiles, as a share of its force: for a foot whose shape
    /// was measured there alone, and the addition for one that was not.
    pub(in crate::sense::track) const KNOWN_SHAPE: f64 = 0.01;

    pub(in crate::sense::track) const UNKNOWN_SHAPE: f64 = 0.08;
}

/// A foot put down beside a standing one.
pub(super) mod touchdown {
    /// Distances tried (m): nearest, step and number of steps, from touching feet to a wide stance.
    pub(in crate::sense::track) const NEAREST_M: f64 = 0.09;

    pub(in crate::sense::track) const STEP_M: f64 = 0.02;

    pub(in crate::sense::track) const TRIED: usize = 22;

    /// Twice the log likelihood ratio beyond which a distance is skipped: its weight vanishes in the sum to the last
    /// bit (53-bit arithmetic). A fifth more or less changes only the run time.
    pub(in crate::sense::track) const OUT_OF_QUESTION: f64 = 100.0;

    /// Prior distance between the feet (m), and the standard deviation of its logarithm.
    pub(in crate::sense::track) const USUAL_M: f64 = 0.22;

    pub(in crate::sense::track) const USUAL_SPREAD: f64 = 0.5;

    /// Share of the displacement of the common centre of pressure that tiles under the new foot alone must explain
    /// for the filter to measure it better. The rest is lost in the standing foot's sway.
    pub(in crate::sense::track) const MOSTLY: f64 = 0.8;

    /// Share of the standing foot below which it does not press a tile.
    pub(in crate::sense::track) const NOT_ITS_OWN: f64 = 0.02;

    /// Distance below which shoes side by side would touch, and the scale of its penalty (m).
    pub(in crate::sense::track) const SIDE_BY_SIDE_M: f64 = 0.13;

    pub(in crate::sense::track) const TIGHT_M: f64 = 0.01;

    /// Share of the weight above which the new foot is at the common centre of pressure.
    pub(in crate::sense::track) const TAKEN_OVER: f64 = 0.8;

    /// Half widths tried for the new foot's patch along an axis, likeliest first, the widest, and their standard
    /// deviation (m).
    pub(in crate::sense::track) const HALVES: [f64; 4] = [0.075, 0.105, 0.045, WIDEST_M];

    pub(in crate::sense::track) const WIDEST_M: f64 = 0.135;

    pub(in crate::sense::track) const HALF_SPREAD_M: f64 = 0.03;

    /// Minimum moment that shows the place of a new foot (N m), and minimum displacement of the common centre of
    /// pressure (m): more than the sway of a standing foot in a short time.
    pub(in crate::sense::track) const LEAST_MOMENT: f64 = 1.0;

    pub(in crate::sense::track) const LEAST_WAY_M: f64 = 0.006;

    /// Error in dividing a foot over two tiles, as a share of its force.
    pub(in crate::sense::track) const UNLIKE: f64 = 0.1;

    /// Minimum of that error, as a share of a foot that lies on one tile.
    pub(in crate::sense::track) const UNLIKE_LEAST: f64 = 0.02;

    /// Sway of the standing foot meanwhile, and standard deviation of the new foot's place across the direction of
    /// displacement (m).
    pub(in crate::sense::track) const SWAY_M: f64 = 0.025;

    pub(in crate::sense::track) const PLACE_M: f64 = 0.012;

    /// Measurement error of a force (N).
    pub(in crate::sense::track) const MISREAD_N: f64 = 2.0;
}

/// The sole of a standing foot.
pub(super) mod sole {
    /// Distance between the middles of heel and forefoot (m): 0.54 of the length of the recorded prints.
    pub(in crate::sense::track) const LENGTH_M: f64 = 0.145;

    /// Half widths of both (m) (recorded prints).
    pub(in crate::sense::track) const HEEL_HALF_M: f64 = 0.038;

    pub(in crate::sense::track) const FOREFOOT_HALF_M: f64 = 0.052;

    /// Error in dividing heel or forefoot over two tiles, as a share of its force, and the minimum of its square for
    /// one that lies on a single tile (recorded prints).
    pub(in crate::sense::track) const BLOTCH: f64 = 0.15;

    pub(in crate::sense::track) const BLOTCH_LEAST: f64 = 0.06;

    /// Error of the place of the load of a tile (m), and of a force (N) (our choice).
    pub(in crate::sense::track) const SWAY_M: f64 = 0.012;

    pub(in crate::sense::track) const NOISE_N: f64 = 3.0;
}

/// Two feet that have landed together.
pub(super) mod pair {
    /// Headings tried in half a turn: heel and forefoot differ little.
    pub(in crate::sense::track) const HEADINGS: usize = 12;

    /// Shares of the load on the heels tried, for two feet and for one.
    pub(in crate::sense::track) const ON_HEEL: [f64; 2] = [0.3, 0.6];

    pub(in crate::sense::track) const ON_HEEL_ALONE: [f64; 5] = [0.05, 0.25, 0.45, 0.65, 0.9];

    /// Distances tried (m), and shares of the load on one of the feet.
    pub(in crate::sense::track) const APART_M: [f64; 7] = [0.1, 0.14, 0.18, 0.22, 0.27, 0.33, 0.4];

    pub(in crate::sense::track) const FORCE_SHARES: [f64; 5] = [0.3, 0.4, 0.5, 0.6, 0.7];

    /// Error of a place between those tried, as a standard deviation (m).
    pub(in crate::sense::track) const STEP_M: f64 = 0.015;

    /// Likelihood ratio to the best below which a pair does not count.
    pub(in crate::sense::track) const LIKELIHOODS: f64 = 1e-4;

    /// Time from when a contact can be two feet to the first fit (s) (our choice).
    pub(in crate::sense::track) const FIRST_S: f64 = 0.06;

    /// Log odds of two soles that one may reach by its own shape: recorded prints of five people that stand alone reach
    /// 7 in one of ten and 10 in one of fifty; two of them side by side reach 9 in four of ten at 12 and 16 cm, and in
    /// nine of ten at 20 cm.
    pub(in crate::sense::track) const ONE_SOLE: f64 = 6.0;

    /// The same for a foot that does not stand: of 238 recorded steps, pressed anywhere, one in a hundred reaches 12.5
    /// at some moment and the worst 15.4.
    pub(in crate::sense::track) const ONE_STEP: f64 = 12.0;

    /// Standard deviation of their places up to which the feet become two tracks (m).
    pub(in crate::sense::track) const PLACED_M: f64 = 0.06;
}

/// Repeated fits.
pub(super) mod refits {
    /// Factor by which the time since the beginning grows from one fit to the next (our choice).
    pub(in crate::sense::track) const LATER: f64 = 1.5;
}

/// Two feet that have landed together and stand.
pub(super) mod stance {
    /// Time from the first fit of two soles to the second (s) (our choice).
    pub(in crate::sense::track) const FIRST_S: f64 = 0.1;

    /// Share of the load below which a foot no longer stands as it landed.
    pub(in crate::sense::track) const LEAST_SHARE: f64 = 0.1;

    /// Movement across the line between the feet up to which both move alike (m).
    pub(in crate::sense::track) const ACROSS_M: f64 = 0.05;
}

/// Feet fitted to the loads of one instant.
pub(super) mod static_fit {
    /// Standard deviation of a foot's share of a strip with a seam under its centre of pressure: where its shape was
    /// measured, and the addition where it was not. Recorded steps of three people reach 0.04 within a centimetre of
    /// that place, 0.12 at 3 to 6 cm and 0.15 beyond; those of two others 0.02, 0.12 and 0.14.
    pub(in crate::sense::track) const KNOWN: f64 = 0.03;

    pub(in crate::sense::track) const UNKNOWN: f64 = 0.155;

    /// Scale of the decrease of that deviation with the distance of the seam (m). Recorded: 0.15 to 0.2 at 4 cm, 0.08
    /// at 6 cm, 0.03 at 10 cm, 0.003 at 14 cm.
    pub(in crate::sense::track) const SEAM_M: f64 = 0.07;

    /// Share of it in the moment across the strip (recorded steps: 0.3 to 0.5).
    pub(in crate::sense::track) const ASIDE: f64 = 0.4;
}

/// Rival explanations of a group's loads.
pub(super) mod rivals {
    /// Interval between two comparisons (s) (our choice).
    pub(in crate::sense::track) const EVERY_S: f64 = 0.008;

    /// Distance from its rest point from which on a foot has to compete (m): farther than it sways.
    pub(in crate::sense::track) const STRAYED_M: f64 = 0.05;

    /// Standard deviation of the way of a standing foot's centre of pressure that rolls (m) (our choice).
    pub(in crate::sense::track) const ROLLED_M: f64 = 0.05;

    /// Steps of the grid around a rest point, in each direction, and their length (m).
    pub(in crate::sense::track) const STEPS_AROUND: i32 = 3;

    pub(in crate::sense::track) const AROUND_STEP_M: f64 = 0.04;

    /// Step of the grid over the tiles for a further foot (m).
    pub(in crate::sense::track) const OVER_STEP_M: f64 = 0.05;

    /// Half widths tried for a further foot (m).
    pub(in crate::sense::track) const HALVES: [f64; 2] = [0.045, 0.08];

    /// Least share of the load on a further foot.
    pub(in crate::sense::track) const LEAST_SHARE: f64 = 0.1;

    /// Cost of a further foot (twice the negative log odds).
    pub(in crate::sense::track) const FURTHER: f64 = 8.0;

    /// Step by which a foot may lie off the filter's place in the comparison (m).
    pub(in crate::sense::track) const SETTLE_M: f64 = 0.02;

    /// Cost of feet that roll alike, beyond that of one of them.
    pub(in crate::sense::track) const TOGETHER: f64 = 2.0;

    /// Cost of a track that was split from another foot and has shown no load of its own.
    pub(in crate::sense::track) const SPLIT: f64 = 2.0;

    /// Mean squared deviation of the loads, in standard deviations, up to which a further foot explains them (our choice):
    /// a knee beside feet that stay fits well, a foot that rolls while another one lands does not.
    pub(in crate::sense::track) const FITS: f64 = 0.3;

    /// Minimum distance between the rest points of two feet that stand there (m): shoes, pressed together.
    pub(in crate::sense::track) const APART_M: f64 = 0.11;

    /// Difference in cost from which on a rival is ahead, and the number of successive comparisons in which it must
    /// be. Simulated scenes lose 0.2 % of their places with 12 and 5.
    pub(in crate::sense::track) const AHEAD: f64 = 5.0;

    pub(in crate::sense::track) const TIMES: u8 = 5;

    /// Time for which a foot stays ambiguous after a rival elsewhere was ahead (s) (our choice).
    pub(in crate::sense::track) const CONTESTED_S: f64 = 0.3;

    /// Number of comparisons after a change in which there is no other one (our choice).
    pub(in crate::sense::track) const PAUSE: u8 = 12;

    /// Scale of the penalty for shoes that would overlap (m).
    pub(in crate::sense::track) const OVERLAP_M: f64 = 0.02;

    /// Time without load of a track that is no foot (s): enough for its deletion.
    pub(in crate::sense::track) const GONE_S: f64 = 1.0;
}

/// Contents of contacts.
pub(super) mod output {
    /// Covariance inflation of a joint position per unit of NIS.
    pub(in crate::sense::track) const INFLATION: f64 = 4000.0;

    /// Mean square deviation up to which two feet, one of them still, fit the loads (our choice): of simulated people
    /// who shift their weight, step aside and walk, nine in ten fit by 0.3, 0.6 and 1.4.
    pub(in crate::sense::track) const FITS: f64 = 0.9;

    /// Offset of both feet if the misfit is larger by one, as a standard deviation (m). It grows with the fourth root
    /// of the misfit above [`FITS`]. In simulated scenes 95 of 100 feet are within 12 cm at a misfit of 0.9 to 1.9,
    /// 14 cm up to 3.5, 17 cm up to 7.6, and 21 cm beyond.
    pub(in crate::sense::track) const STRAYED_M: f64 = 0.045;

    /// Share of the gain errors under other feet that affects a foot that shares their tiles.
    pub(in crate::sense::track) const OTHERS_MISREAD: f32 = 0.25;

    /// Standard deviation above which the place of a foot is ambiguous (m).
    pub(in crate::sense::track) const AMBIGUOUS_M: f64 = 0.04;

    /// Additional standard deviation of two feet that have landed together, beyond the filter's own (m).
    pub(in crate::sense::track) const TOGETHER_M: f32 = 0.035;

    /// Maximum standard deviation after inflation (m): the foot is somewhere in this group of tiles.
    pub(in crate::sense::track) const LOST_M: f64 = 0.3;

    /// Minimum force of a contact that may consist entirely of residual load (N): the most load that can be located.
    pub(in crate::sense::track) const LEAST_N: f32 = 2.0;
}

/// The tracker.
pub(super) mod tracker {
    /// Maximum force of a foot: this share of the load of its group's tiles plus this many newtons.
    pub(in crate::sense::track) const MOST_SHARE: f64 = 1.3;

    pub(in crate::sense::track) const MOST_MORE_N: f64 = 50.0;

    /// Maximum first step of the filter from the place where a foot was first measured (m): half a shoe.
    pub(in crate::sense::track) const FIRST_STEP_M: f64 = 0.15;

    /// Standard deviation of the place of a foot after the filter has diverged (m).
    pub(in crate::sense::track) const THROWN_M: f64 = 0.05;

    /// Time after a touchdown for which the foot takes over the body threshold of its partner (s): the partner lifts
    /// off later.
    pub(in crate::sense::track) const LANDING_S: f64 = 0.05;

    /// Minimum age of a partner (s).
    pub(in crate::sense::track) const SEEN_S: f64 = 0.03;

    /// Maximum distance between the feet of one person (m).
    pub(in crate::sense::track) const STRIDE_M: f64 = 1.0;

    /// Time constant of the NIS average (s).
    pub(in crate::sense::track) const NIS_S: f64 = 0.05;
}
