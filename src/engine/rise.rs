//! Distinguishes a press from the creep of a sensor.

use arrayvec::ArrayVec;

use crate::sense::{Contact, ContactId};
use crate::units::{Instant, Newtons};

/// Length of one interval of the history, in microseconds. The minimum force of a foot is known over the last three
/// to four intervals: longer than the longest dwell time of a control (2 s).
const BUCKET_US: u64 = 1_000_000;

/// Constant part of the rise in force that counts as a press, in newtons: more than noise, and more than the drift of
/// a zero by 10 N a minute adds on a tile (our choice).
const GAIN_N: f32 = 2.0;

/// Part of the rise that is proportional to the force: a press rises by more than `GAIN_N + GAIN_SHARE * force`.
///
/// # Source
/// A force-sensing resistor under a steady load creeps by 5 % per decade of time (Interlink,
/// FSR integration guide): by 3.5 % in the four seconds from one second after the foot has come
/// down, and ever less later. Drift of a zero is slower by far.
const GAIN_SHARE: f32 = 0.04;

/// Maximum number of feet tracked at once; more than can stand on a floor with controls.
const FEET: usize = 64;

/// The minimum force of each foot over the last seconds.
///
/// A foot may rest on a control below its threshold for hours while the sensors creep: at some time the reading
/// passes the threshold without a press.
#[derive(Clone, Debug, Default)]
pub(super) struct Rises {
    feet: ArrayVec<RecentLeast, FEET>,
}

#[derive(Clone, Copy, Debug)]
struct RecentLeast {
    id: ContactId,
    bucket: u64,
    /// Minimum force in this interval and the three before, the latest first.
    least: [f32; 4],
}

impl Rises {
    /// Processes the contacts of one frame.
    pub(super) fn update(&mut self, contacts: &[Contact], now: Instant) {
        let bucket = now.micros() / BUCKET_US;
        self.feet.retain(|foot| contacts.iter().any(|contact| contact.id == foot.id));
        for contact in contacts {
            match self.feet.iter_mut().find(|foot| foot.id == contact.id) {
                Some(foot) => foot.add(bucket, contact.force.0),
                None => {
                    // A foot lands from zero force.
                    let _ = self.feet.try_push(RecentLeast { id: contact.id, bucket, least: [0.0; 4] });
                }
            }
        }
    }

    /// Whether the force of `contact` has risen within the last three to four seconds by more than its sensors creep;
    /// false for a foot that is not tracked.
    pub(super) fn has_risen(&self, contact: &Contact) -> bool {
        let Some(foot) = self.feet.iter().find(|foot| foot.id == contact.id) else { return false };
        let least = foot.least.into_iter().fold(f32::INFINITY, f32::min);
        contact.force > Newtons(least + GAIN_N + GAIN_SHARE * contact.force.0)
    }
}

impl RecentLeast {
    fn add(&mut self, bucket: u64, force: f32) {
        let [latest, before, third, last] = self.least;
        self.least = match bucket.saturating_sub(self.bucket) {
            0 => [latest.min(force), before, third, last],
            1 => [force, latest, before, third],
            2 => [force, force, latest, before],
            3 => [force, force, force, latest],
            _ => [force; 4],
        };
        self.bucket = bucket;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the foot has risen at each tenth of a second; `force` gives its force at a time in seconds.
    fn risen(seconds: f32, force: impl Fn(f32) -> f32) -> Vec<bool> {
        let mut rises = Rises::default();
        let tenths = (seconds * 10.0) as u64;
        (0..tenths)
            .map(|tenth| {
                let force = Newtons(force(tenth as f32 / 10.0));
                let foot = Contact { id: ContactId(1), force, ..Contact::default() };
                rises.update(std::slice::from_ref(&foot), Instant::from_millis(tenth * 100));
                rises.has_risen(&foot)
            })
            .collect()
    }

    #[test]
    fn a_foot_that_comes_down_has_risen_for_three_to_four_seconds() {
        let risen = risen(5.0, |_| 80.0);
        assert!(risen[..30].iter().all(|&risen| risen));
        assert!(!risen[40..].iter().any(|&risen| risen));
    }

    #[test]
    fn a_resting_foot_that_creeps_never_rises_but_one_that_leans_on_it_slowly_does() {
        let creeping = |s: f32| 58.0 * (1.0 + 0.05 * (s.max(0.1) / 0.1).log10());
        assert!(!risen(600.0, creeping)[50..].iter().any(|&risen| risen));
        let leaning = |s: f32| if s < 60.0 { 30.0 } else { 30.0 + 3.0 * (s - 60.0) };
        assert!(risen(80.0, leaning)[615..].iter().all(|&risen| risen));
    }
}
