//! Fitted figures of the roll of walking people's feet; [`super::rolling`] draws its steps from them.
//!
//! # Source
//! Fitted to SpeedPP2DS (Pataky et al. 2008, plantar pressure of single steps at three walking
//! speeds): 294 barefoot steps of five people at 0.7 to 2.2 m/s, 500 pressure frames a second.
//!
//! Method of the fit. The centre of pressure never moves far backwards, so the fit takes the time at which it first
//! crosses each of [`DWELL_STEPS`] equal parts of its path. The logarithm of the dwell times (as shares of the
//! contact) and the force (as a share of its peak, at equal shares of the contact, with threefold weight) make one
//! vector per step. A least-squares quadratic in the walking speed minus 1.4 m/s is subtracted, and the first six
//! principal components of the residual are kept (74 % of the variance). The fit uses dwell times rather than
//! positions because the centre of pressure rests on the ball and jumps when the heel lifts: a mean over time would
//! remove the jumps. Sideways positions and both root mean square radii are fitted in the same way, as functions of
//! the completed share of the path (86, 92 and 50 % of the variance).
//!
//! A mode is scaled to one standard deviation. Next to each set of modes is the share of that variance between
//! people; five people give only a rough estimate of it.

/// Number of equal parts of the path of the centre of pressure.
pub(super) const DWELL_STEPS: usize = 24;

/// Number of points on the path with a sideways position and radii.
pub(super) const PLACES: usize = 13;

/// Walking speed at which the first rows of [`DWELL_MEAN`], [`FORCE_MEAN`] and [`RADIUS_ALONG_MEAN`] apply, in metres
/// per second.
pub(super) const MIDDLE_SPEED_M_S: f32 = 1.4;

/// Range of the recorded walking speeds, in metres per second; there are no data outside it.
pub(super) const SPEEDS_M_S: [f32; 2] = [0.75, 2.15];

/// Contact time at 1 m/s, in seconds, and the exponent of the speed.
pub(super) const CONTACT_S: [f32; 2] = [0.749, -0.543];

/// Standard deviation of the logarithm of the contact time between people, and between steps of one person.
pub(super) const CONTACT_SPREAD: [f32; 2] = [0.033, 0.032];

/// Start and end of the path of the centre of pressure, in foot lengths from the centre of the foot, each with its
/// standard deviation.
pub(super) const WAY: [[f32; 2]; 2] = [[-0.434, 0.013], [0.471, 0.008]];

/// Breadth of the contact area divided by the foot's length, and its standard deviation between people.
pub(super) const BREADTH: [f32; 2] = [0.339, 0.025];

/// Outward angle of the foot from the walking direction, in radians: mean, and standard deviation between people.
pub(super) const TURN_OUT: [f32; 2] = [0.095, 0.081];

/// Logarithm of each dwell time as a share of the contact: at the middle speed, per m/s, per (m/s)2.
pub(super) const DWELL_MEAN: [[f32; 24]; 3] = [
    [
        -3.344, -2.975, -3.337, -3.384, -3.213, -3.047, -3.130, -3.223, -3.377, -3.561, -3.738, -3.852,
        -3.982, -4.057, -3.986, -3.731, -3.185, -2.376, -2.222, -3.130, -4.319, -4.450, -3.419, -3.370,
    ],
    [
        -0.115, -0.299, -0.695, -0.678, -0.191, 0.156, 0.185, -0.224, -0.540, -0.673, -0.676, -0.631, -0.557,
        -0.395, -0.239, -0.223, 0.212, 0.139, 0.224, 0.249, 0.148, 0.343, 0.213, 0.060,
    ],
    [
        0.241, 0.115, 0.151, -0.133, -0.120, 0.220, 0.613, -0.192, -0.796, -0.782, -0.771, -0.784, -0.823,
        -0.787, -0.868, -0.243, 0.400, -0.216, -0.637, -0.570, 0.110, 0.379, 0.146, 0.003,
    ],
];

/// Modes of the dwell times.
pub(super) const DWELL_MODES: [[f32; 24]; 6] = [
    [
        -0.076, 0.113, 0.434, 0.353, 0.180, 0.019, -0.307, -0.303, -0.194, -0.181, -0.165, -0.159, -0.153,
        -0.190, -0.203, -0.284, -0.419, -0.429, 0.024, 0.542, 0.742, 0.623, 0.275, 0.165,
    ],
    [
        -0.042, 0.062, -0.061, -0.241, -0.331, -0.376, 0.052, 0.298, 0.297, 0.278, 0.277, 0.266, 0.208,
        0.202, 0.137, 0.024, -0.149, -0.153, 0.016, 0.304, 0.178, 0.135, 0.053, 0.042,
    ],
    [
        -0.029, -0.078, 0.064, -0.092, -0.211, -0.100, 0.042, 0.023, -0.047, -0.055, -0.084, -0.081, -0.050,
        -0.037, 0.032, 0.231, 0.448, 0.162, -0.204, -0.156, 0.136, 0.408, 0.187, 0.018,
    ],
    [
        -0.051, -0.101, 0.123, 0.154, 0.253, 0.224, 0.033, 0.077, 0.153, 0.135, 0.133, 0.065, 0.068, 0.064,
        0.128, 0.164, 0.163, -0.104, -0.195, -0.023, 0.029, -0.081, 0.0, 0.041,
    ],
    [
        0.026, 0.041, -0.083, 0.157, 0.045, -0.283, -0.064, 0.063, 0.012, 0.007, -0.002, -0.027, -0.044,
        -0.062, -0.018, -0.036, -0.038, 0.082, 0.005, -0.203, -0.128, 0.130, 0.080, 0.030,
    ],
    [
        -0.017, 0.095, 0.235, 0.173, 0.130, -0.181, -0.146, -0.020, 0.029, 0.048, 0.049, 0.028, 0.044, 0.043,
        0.106, 0.091, -0.058, 0.065, -0.038, -0.059, -0.099, 0.057, -0.075, -0.126,
    ],
];

/// Standard deviation of the residual of each dwell time after the modes.
pub(super) const DWELL_REST: [f32; 24] = [
    0.198, 0.213, 0.291, 0.267, 0.305, 0.253, 0.483, 0.352, 0.226, 0.182, 0.191, 0.200, 0.196, 0.213, 0.256,
    0.298, 0.247, 0.363, 0.274, 0.240, 0.196, 0.247, 0.243, 0.211,
];

/// Force at 1/20, 2/20 ... 19/20 of the contact as a share of its peak: at the middle speed, per m/s, per (m/s)2.
pub(super) const FORCE_MEAN: [[f32; 19]; 3] = [
    [
        0.534, 0.620, 0.841, 0.942, 0.923, 0.822, 0.714, 0.626, 0.577, 0.567, 0.601, 0.683, 0.800, 0.921,
        0.986, 0.960, 0.806, 0.467, 0.115,
    ],
    [
        0.296, 0.231, 0.224, 0.097, -0.035, -0.156, -0.265, -0.343, -0.396, -0.421, -0.400, -0.338, -0.265,
        -0.204, -0.163, -0.133, -0.103, -0.068, 0.0,
    ],
    [
        -0.231, -0.242, -0.329, -0.243, -0.186, -0.116, -0.095, -0.117, -0.139, -0.155, -0.191, -0.262,
        -0.337, -0.376, -0.359, -0.313, -0.236, -0.056, 0.046,
    ],
];

/// Modes of the force, with the same scores as those of the dwell times.
pub(super) const FORCE_MODES: [[f32; 19]; 6] = [
    [
        -0.013, 0.002, 0.027, 0.028, 0.043, 0.058, 0.061, 0.056, 0.043, 0.030, 0.016, 0.002, -0.009, -0.011,
        -0.007, -0.002, 0.001, 0.016, 0.023,
    ],
    [
        0.003, -0.021, 0.001, 0.007, 0.012, 0.015, 0.016, 0.019, 0.019, 0.015, 0.007, -0.004, -0.009, -0.008,
        -0.004, -0.002, -0.002, -0.006, -0.001,
    ],
    [
        0.003, 0.008, 0.016, 0.023, 0.029, 0.025, 0.010, -0.008, -0.021, -0.025, -0.027, -0.026, -0.022,
        -0.018, -0.014, -0.012, -0.012, -0.012, 0.005,
    ],
    [
        0.014, 0.025, 0.015, 0.029, 0.038, 0.045, 0.052, 0.047, 0.037, 0.029, 0.025, 0.020, 0.015, 0.013,
        0.017, 0.020, 0.024, 0.027, 0.008,
    ],
    [
        -0.023, 0.002, 0.008, -0.005, -0.009, 0.003, 0.021, 0.036, 0.048, 0.057, 0.063, 0.063, 0.052, 0.035,
        0.020, 0.007, -0.013, -0.036, -0.016,
    ],
    [
        0.001, -0.035, -0.035, -0.028, -0.015, -0.008, -0.005, -0.007, -0.013, -0.021, -0.033, -0.041,
        -0.038, -0.027, -0.016, -0.006, 0.003, 0.012, -0.001,
    ],
];

/// Share of the variance of the modes of dwell and force between people.
pub(super) const TIMING_OF_PERSON: [f32; 6] = [0.769, 0.368, 0.413, 0.405, 0.467, 0.206];

/// Sideways position of the centre of pressure along its path, in foot breadths from the middle line, outwards.
pub(super) const ACROSS_MEAN: [[f32; 13]; 1] =
    [[-0.086, -0.109, -0.077, -0.058, -0.035, -0.017, -0.001, 0.014, 0.017, -0.050, -0.184, -0.260, -0.262]];

/// Modes of the sideways position.
pub(super) const ACROSS_MODES: [[f32; 13]; 2] = [
    [-0.028, -0.030, -0.036, -0.043, -0.054, -0.062, -0.067, -0.070, -0.060, -0.022, -0.012, 0.009, 0.014],
    [-0.013, -0.011, -0.010, -0.007, -0.002, 0.003, 0.007, 0.012, 0.011, -0.002, 0.039, 0.043, 0.054],
];

/// Share of the variance of these modes between people.
pub(super) const ACROSS_OF_PERSON: [f32; 2] = [0.454, 0.632];

/// Root mean square radius of the pressure along the foot, in foot lengths: at the middle speed, per m/s.
pub(super) const RADIUS_ALONG_MEAN: [[f32; 13]; 2] = [
    [0.027, 0.058, 0.163, 0.222, 0.250, 0.257, 0.244, 0.209, 0.137, 0.091, 0.084, 0.039, 0.013],
    [0.001, -0.005, -0.012, -0.010, -0.010, -0.010, -0.014, -0.022, -0.039, -0.003, -0.002, -0.006, 0.0],
];

/// Modes of the radius along the foot.
pub(super) const RADIUS_ALONG_MODES: [[f32; 13]; 2] = [
    [0.001, -0.001, -0.012, -0.014, -0.018, -0.022, -0.027, -0.034, -0.045, -0.009, -0.001, 0.0, 0.0],
    [0.001, -0.007, -0.016, -0.013, -0.010, -0.007, -0.003, 0.003, 0.014, 0.009, 0.002, 0.001, 0.0],
];

/// Share of the variance of these modes between people.
pub(super) const RADIUS_ALONG_OF_PERSON: [f32; 2] = [0.703, 0.711];

/// Root mean square radius across the foot, in foot breadths.
pub(super) const RADIUS_ACROSS_MEAN: [[f32; 13]; 1] =
    [[0.081, 0.127, 0.159, 0.173, 0.184, 0.193, 0.199, 0.206, 0.215, 0.225, 0.174, 0.132, 0.037]];

/// Mode of the radius across the foot.
pub(super) const RADIUS_ACROSS_MODES: [[f32; 13]; 1] = [[
    -0.007, -0.006, -0.008, -0.007, -0.006, -0.005, -0.004, -0.002, -0.001, -0.003, -0.027, -0.044, -0.011,
]];

/// Share of the variance of this mode between people.
pub(super) const RADIUS_ACROSS_OF_PERSON: [f32; 1] = [0.630];
