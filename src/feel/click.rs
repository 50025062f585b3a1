//! A click on one channel: its modes struck by its impulse.

use arrayvec::ArrayVec;

use super::push::Pushes;
use super::{Click, MODE_HZ, ModalBank, Mode};

/// The result of a click on one channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Struck {
    /// Modes that the click struck.
    pub(super) modes: u32,
    /// Modes that cannot be played: not finite, or outside the ranges of [`super::Mode`].
    pub(super) refused: u32,
    /// Ringing modes stolen for this click.
    pub(super) stolen: u32,
}

/// Maximum amplitude of a struck mode, in full scales: far above the range of the limiter.
const LOUDEST: f32 = 16.0;

/// Minimum amplitude of a struck mode, in full scales: -180 dB.
const FAINTEST: f32 = 1e-9;

/// Strikes `click` on `bank`; the very next sample is the first to move.
///
/// `gain` is full scales per unit of mode amplitude: the click's level times the spot's weight over the actuator's
/// newtons at full scale. Modes start as sines, at zero, so that there is no step. A mode of negligible amplitude is
/// left out without being counted; a mode above 16 full scales is struck at 16.
///
/// # Real-time
/// No allocation.
pub(super) fn strike((bank, pushes): (&mut ModalBank, &mut Pushes), click: &Click, gain: f32) -> Struck {
    let mut struck = Struck::default();
    let mut modes: ArrayVec<Mode, { super::MAX_MODES }> = ArrayVec::new();
    for mode in &click.modes {
        let amplitude = mode.amplitude * gain;
        let playable = MODE_HZ.contains(&mode.frequency_hz)
            && (0.001..=2.0).contains(&mode.decay_s)
            && (-1.0..=1.0).contains(&mode.amplitude)
            && !amplitude.is_nan();
        if !playable {
            struck.refused += 1;
        } else if amplitude.abs() >= FAINTEST {
            modes.push(Mode { amplitude: amplitude.clamp(-LOUDEST, LOUDEST), ..*mode });
        }
    }
    struck.modes = modes.len() as u32;
    if struck.modes > 0 {
        struck.stolen = pushes.strike(bank, &modes, click.impulse);
    }
    struck
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Newtons;

    fn click(modes: &[(f32, f32, f32)]) -> Click {
        let modes = modes
            .iter()
            .map(|&(frequency_hz, decay_s, amplitude)| Mode { frequency_hz, decay_s, amplitude })
            .collect();
        Click { modes, level: Newtons(4.0), ..Click::default() }
    }

    #[test]
    fn modes_outside_their_ranges_are_refused_one_by_one() {
        let (mut bank, mut pushes) = (ModalBank::new(48_000.0, 8), Pushes::new(48_000.0));
        let mixed = click(&[
            (150.0, 0.02, 1.0),
            (f32::NAN, 0.02, 1.0),
            (150.0, 0.0, 1.0),
            (5000.0, 0.02, 1.0),
            (150.0, 0.02, f32::INFINITY),
            (250.0, 0.02, 0.0),
        ]);
        assert_eq!(strike((&mut bank, &mut pushes), &mixed, 0.1), Struck { modes: 1, refused: 4, stolen: 0 });
        assert_eq!(
            strike((&mut bank, &mut pushes), &mixed, f32::NAN),
            Struck { modes: 0, refused: 6, stolen: 0 }
        );
        assert!(!bank.is_silent());
    }

    #[test]
    fn an_absurd_level_is_struck_at_the_loudest() {
        let (mut bank, mut pushes) = (ModalBank::new(48_000.0, 8), Pushes::new(48_000.0));
        strike((&mut bank, &mut pushes), &click(&[(250.0, 0.02, 1.0)]), 1e30);
        let mut out = [0.0; 480];
        bank.render(&mut out);
        assert!(out.iter().all(|x| x.abs() <= LOUDEST));
    }
}
