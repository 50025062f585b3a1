//! Beginning, course and end of tracks.

/// The tracker.
pub(in crate::sense::track) mod tracker {
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

/// Tiles to tracks.
pub(in crate::sense::track) mod associate {
    /// Maximum distance between the feet of a standing person (m).
    pub(in crate::sense::track) const ASTRIDE_M: f64 = 0.5;

    /// Time for which a load beyond a foot is observed before it becomes another foot (s).
    pub(in crate::sense::track) const PENDING_S: f64 = 0.006;

    /// Arm of the noise (m): 1 N of noise per sensor moves the centroid of a load of 1 N by this much. It is twice
    /// the distance of the sensors from the tile's centre.
    pub(in crate::sense::track) const NOISE_ARM_M: f64 = 0.264;
}

/// The loads that can belong to a foot.
pub(in crate::sense::track) mod reach {
    use crate::sense::track::outline::ShoeSize;

    /// Radius about the centre of pressure within which a flat foot presses (m): a foot that carries a person, and a
    /// light one.
    pub(in crate::sense::track) const AROUND_M: f64 = 0.17;

    pub(in crate::sense::track) const AROUND_LIGHT_M: f64 = 0.26;

    /// Area of one shoe: its length, and its breadth with an allowance for a small rotation.
    pub(in crate::sense::track) const SHOE: ShoeSize =
        ShoeSize { length: super::super::state::SHOE_M, breadth: 0.13 };

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

/// New tracks on tiles that others press.
pub(in crate::sense::track) mod initiate {
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

/// Is a track one foot or two?
pub(in crate::sense::track) mod explanation {
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

/// Feet that have lost their load.
pub(in crate::sense::track) mod dormant {
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
pub(in crate::sense::track) mod delete {
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
