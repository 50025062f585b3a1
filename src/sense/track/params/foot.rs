//! One foot: its state, its shape and its contact.

/// The state of a foot.
pub(in crate::sense::track) mod state {
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
pub(in crate::sense::track) mod stillness {
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
pub(in crate::sense::track) mod smoothed {
    /// Time constant of the smoothed state (s): longer than a heel strike, shorter than a roll-over.
    pub(in crate::sense::track) const SMOOTHED_S: f64 = 0.05;
}

/// Shape residuals.
pub(in crate::sense::track) mod residual {
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

/// Contents of contacts.
pub(in crate::sense::track) mod output {
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
