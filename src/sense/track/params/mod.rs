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

mod fits;
mod foot;
mod tracks;

pub(super) use fits::{model, pair, refits, rivals, sole, soles, stance, static_fit, touchdown};
pub(super) use foot::{output, residual, smoothed, state, stillness};
pub(super) use tracks::{associate, delete, dormant, explanation, initiate, reach, tracker};
