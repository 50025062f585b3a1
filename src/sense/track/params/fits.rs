//! Feet that share tiles: the filter, and fits to the loads of one instant.

/// Motion and measurement.
pub(in crate::sense::track) mod model {
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
pub(in crate::sense::track) mod touchdown {
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
pub(in crate::sense::track) mod sole {
    /// Weight of a person from which on soles are grown-up (N), and the least size. Length grows with the cube root of
    /// weight: a child of 20 kg has feet of 17 cm (geometry).
    pub(in crate::sense::track) const ADULT_N: f64 = 700.0;

    pub(in crate::sense::track) const LEAST_SIZE: f64 = 0.65;

    /// Distance between the middles of an adult's heel and forefoot (m): 0.54 of the length of the recorded prints.
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
pub(in crate::sense::track) mod pair {
    /// Headings tried in half a turn: heel and forefoot differ little.
    pub(in crate::sense::track) const HEADINGS: usize = 12;

    /// Shares of the load on the heels tried, for two feet and for one.
    pub(in crate::sense::track) const ON_HEEL: [f64; 2] = [0.3, 0.6];

    pub(in crate::sense::track) const ON_HEEL_ALONE: [f64; 5] = [0.05, 0.25, 0.45, 0.65, 0.9];

    /// Sizes of a single sole tried.
    pub(in crate::sense::track) const SIZES_ALONE: [f64; 4] = [1.15, 1.0, 0.85, 0.7];

    /// Distances tried (m), and shares of the load on one of the feet.
    pub(in crate::sense::track) const APART_M: [f64; 7] = [0.1, 0.14, 0.18, 0.22, 0.27, 0.33, 0.4];

    pub(in crate::sense::track) const FORCE_SHARES: [f64; 5] = [0.3, 0.4, 0.5, 0.6, 0.7];

    /// Error of a place between those tried, as a standard deviation (m).
    pub(in crate::sense::track) const STEP_M: f64 = 0.015;

    /// Likelihood ratio to the best below which a pair does not count.
    pub(in crate::sense::track) const LIKELIHOODS: f64 = 1e-4;

    /// Time from when a contact can be two feet to the first fit (s) (our choice).
    pub(in crate::sense::track) const FIRST_S: f64 = 0.06;

    /// Log odds of two soles that one may reach by its own shape, for a foot that carries an adult and stands, and for
    /// one that does not stand. Recorded prints of five people that stand alone reach 1.8 in one of fifty and at most
    /// 5.7. Pairs of recorded prints that land together are placed worse with lower numbers: weight shifts have 5 % of
    /// wrong places with 5 for both, and 1.9 % with these.
    pub(in crate::sense::track) const ONE_SOLE: f64 = 6.0;

    pub(in crate::sense::track) const ONE_STEP: f64 = 12.0;

    /// The same for a contact that carries less than an adult. A new track takes 10.6 more: of 5,325 moments of
    /// recorded prints at work on a control two have as much.
    pub(in crate::sense::track) const LIGHT: f64 = 3.0;

    /// Standard deviation of their places up to which the feet become two tracks (m).
    pub(in crate::sense::track) const PLACED_M: f64 = 0.06;
}

/// Repeated fits.
pub(in crate::sense::track) mod refits {
    /// Factor by which the time since the beginning grows from one fit to the next (our choice).
    pub(in crate::sense::track) const LATER: f64 = 1.5;
}

/// Two feet that have landed together and stand.
pub(in crate::sense::track) mod stance {
    /// Time from the first fit of two soles to the second (s) (our choice).
    pub(in crate::sense::track) const FIRST_S: f64 = 0.1;

    /// Share of the load below which a foot no longer stands as it landed.
    pub(in crate::sense::track) const LEAST_SHARE: f64 = 0.1;

    /// Movement across the line between the feet up to which both move alike (m).
    pub(in crate::sense::track) const ACROSS_M: f64 = 0.05;
}

/// Feet fitted to the loads of one instant.
pub(in crate::sense::track) mod static_fit {
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

/// Two soles for a touchdown whose loads fit badly ([`soles`](super::super::soles)).
pub(in crate::sense::track) mod soles {
    /// Interval between two comparisons (s) (our choice).
    pub(in crate::sense::track) const EVERY_S: f64 = 0.02;

    /// Misfit of a touchdown above which soles are compared. Recorded weight shifts have 2.4 and 2.9 % of wrong places with
    /// this and without soles, 4 % with 1.8, and 12 % if every foot that has strayed is compared.
    pub(in crate::sense::track) const MISFIT: f64 = 2.5;

    /// Headings of the grid in half a turn, shares of the load on the heels, distances of the feet (m), and shares of the
    /// load on one of them.
    pub(in crate::sense::track) const HEADINGS: usize = 6;

    pub(in crate::sense::track) const ON_HEEL: [f64; 2] = [0.3, 0.7];

    pub(in crate::sense::track) const APART_M: [f64; 4] = [0.12, 0.19, 0.27, 0.37];

    pub(in crate::sense::track) const SHARES: [f64; 5] = [0.12, 0.3, 0.5, 0.7, 0.88];

    /// Shares of the load on the heels tried with both feet at their places.
    pub(in crate::sense::track) const ON_HEEL_HERE: [f64; 5] = [0.05, 0.25, 0.45, 0.65, 0.9];

    /// Number of stances of the grid that are improved (one alone finds fewer pivots), and most steps of each.
    pub(in crate::sense::track) const STARTS: usize = 4;

    pub(in crate::sense::track) const ROUNDS: usize = 12;

    /// Steps of the heading (rad), the share on the heels, the distances aside and ahead (m) and the share of one foot.
    pub(in crate::sense::track) const STEPS: [f64; 5] = [0.13, 0.1, 0.02, 0.03, 0.05];

    /// Distance from its present place within which a foot counts as there (m) (our choice).
    pub(in crate::sense::track) const SETTLE_M: f64 = 0.04;

    /// Standard deviation of the way of a foot from its rest point (m) (our choice).
    pub(in crate::sense::track) const ROLLED_M: f64 = 0.08;

    /// Difference of scores from which on a stance is ahead, and the number of successive comparisons in which it must be
    /// (our choice): a knee that lands has shown its place until then.
    pub(in crate::sense::track) const AHEAD: f64 = 4.0;

    pub(in crate::sense::track) const TIMES: u8 = 3;

    /// Least share of the load on the lighter sole, and least distance of both (m): less is one foot that rolls.
    pub(in crate::sense::track) const LEAST_SHARE: f64 = 0.25;

    pub(in crate::sense::track) const LEAST_APART_M: f64 = 0.16;

    /// Difference of the ways in both orders from which on it is clear which foot is which (m) (our choice).
    pub(in crate::sense::track) const CLEAR_M: f64 = 0.05;

    /// Distance up to which two comparisons have found the same places (m) (our choice).
    pub(in crate::sense::track) const SAME_M: f64 = 0.05;
}

/// Rival explanations of a group's loads.
pub(in crate::sense::track) mod rivals {
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
