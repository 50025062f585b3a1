//! Whether a person on the floor stands still, by the outputs of sensors whose laws are unknown.

/// Share of a new value in the smoothed outputs at each moment of 5 ms: a time constant of 50 ms, which takes noise
/// away.
const SMOOTH: f32 = 0.1;

/// Share of a new value in mean and variance: a time constant of 0.1 s. Half a second after a step the person counts as
/// still.
const SPREAD: f32 = 0.05;

/// Motion below which a person stands: three times that of recorded quiet standing (our choice).
const STILL: f32 = 0.03;

/// Motion above which a person moves (our choice).
const MOVING: f32 = 0.08;

/// Change of an output that counts as a load (V), and in standard deviations of the empty floor.
const LOADED_V: f32 = 0.01;
const LOADED_SIGMAS: f32 = 6.0;

/// The changes of all outputs from the empty floor, and how much they vary.
#[derive(Clone, Debug, Default)]
pub(super) struct FloorMotion {
    sensors: Vec<SensorMotion>,
}

/// One sensor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SensorMotion {
    pub(super) empty_v: f32,
    /// Least change that counts as a load (V).
    loaded_v: f32,
    /// Present change from the empty floor (V).
    pub(super) change_v: f32,
    smooth: f32,
    mean: f32,
    variance: f32,
}

impl FloorMotion {
    /// Sensors with these means and standard deviations on the empty floor (V).
    pub(super) fn new(empty: impl IntoIterator<Item = (f32, f32)>) -> Self {
        let sensor = |(empty_v, deviation): (f32, f32)| SensorMotion {
            empty_v,
            loaded_v: LOADED_V.max(LOADED_SIGMAS * deviation),
            ..SensorMotion::default()
        };
        Self { sensors: empty.into_iter().map(sensor).collect() }
    }

    /// Adds a moment of 5 ms with these outputs (V).
    pub(super) fn add(&mut self, volts: impl IntoIterator<Item = f32>) {
        for (sensor, volts) in self.sensors.iter_mut().zip(volts) {
            sensor.change_v = volts - sensor.empty_v;
            sensor.smooth += SMOOTH * (sensor.change_v - sensor.smooth);
            let off = sensor.smooth - sensor.mean;
            sensor.mean += SPREAD * off;
            sensor.variance += SPREAD * (off * off - sensor.variance);
        }
    }

    /// The sensors that carry a load, with their positions.
    pub(super) fn loaded(&self) -> impl Iterator<Item = (usize, &SensorMotion)> {
        self.sensors.iter().enumerate().filter(|(_, sensor)| sensor.smooth.abs() > sensor.loaded_v)
    }

    /// Whether something is on the floor.
    pub(super) fn bears(&self) -> bool {
        self.loaded().next().is_some()
    }

    /// Standard deviation of the outputs over 0.1 s as a share of their change, over the sensors that carry a load.
    fn share(&self) -> f32 {
        let (varying, change) = self.loaded().fold((0.0, 0.0), |(varying, change), (_, sensor)| {
            (varying + sensor.variance, change + sensor.mean * sensor.mean)
        });
        (varying / change).sqrt()
    }

    /// Whether somebody stands still on the floor.
    pub(super) fn is_still(&self) -> bool {
        self.bears() && self.share() < STILL
    }

    /// Whether somebody moves, comes or goes.
    pub(super) fn is_moving(&self) -> bool {
        !self.bears() || self.share() > MOVING
    }
}
