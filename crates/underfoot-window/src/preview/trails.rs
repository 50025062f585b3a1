//! Trails of contacts.

use underfoot::engine::Snapshot;
use underfoot::sense::ContactId;
use underfoot_scene::scene::Trail;

/// Lifetime of a point, in seconds.
const KEPT_S: f64 = 2.0;

/// Minimum distance between two points of a trail, in metres: it ignores sway.
const STEP_M: f32 = 0.004;

/// Maximum number of points of one trail: 60 frames a second give at most 120 in two seconds.
const MOST: usize = 128;

/// Maximum number of trails: a crowd's feet within two seconds.
const MOST_CONTACTS: usize = 512;

/// The recent positions of each contact.
#[derive(Debug, Default)]
pub(super) struct Trails {
    /// The contact of each trail, and the times of its points.
    of: Vec<(ContactId, Vec<f64>)>,
    trails: Vec<Trail>,
}

impl Trails {
    /// Adds the positions of the contacts at `now_s`, and removes old points.
    pub(super) fn update(&mut self, now_s: f64, snapshot: &Snapshot) {
        for contact in &snapshot.contacts {
            let known = self.of.iter().position(|(id, _)| *id == contact.id);
            if known.is_none() && self.of.len() >= MOST_CONTACTS {
                continue;
            }
            let at = known.unwrap_or_else(|| {
                self.of.push((contact.id, Vec::new()));
                self.trails.push(Trail::default());
                self.of.len() - 1
            });
            let (Some((_, moments)), Some(trail)) = (self.of.get_mut(at), self.trails.get_mut(at)) else {
                continue;
            };
            trail.leads = snapshot.cursors.iter().flatten().any(|cursor| cursor.contact == contact.id);
            let last = trail.points.last();
            if last.is_none_or(|last| last.distance(contact.centroid) >= STEP_M) && moments.len() < MOST {
                moments.push(now_s);
                trail.points.push(contact.centroid);
            }
        }
        for ((_, moments), trail) in self.of.iter_mut().zip(&mut self.trails) {
            let old = moments.iter().take_while(|moment| now_s - **moment > KEPT_S).count();
            moments.drain(..old);
            trail.points.drain(..old);
        }
        self.of.retain(|(_, moments)| !moments.is_empty());
        self.trails.retain(|trail| !trail.points.is_empty());
    }

    /// The remaining trails.
    pub(super) fn all(&self) -> &[Trail] {
        &self.trails
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::preview::sample::{at_rest, map, step_on};

    #[test]
    fn a_trail_follows_its_contact_and_fades_after_it_has_gone() {
        let mut trails = Trails::default();
        for frame in 0..60 {
            let mut snapshot = at_rest(&map());
            step_on(&mut snapshot, 1, Vec2::new(0.3 + 0.01 * frame as f32, 1.0), 300.0, Vec2::ZERO);
            trails.update(f64::from(frame) / 60.0, &snapshot);
        }
        assert_eq!(trails.all().len(), 1);
        assert_eq!(trails.all()[0].points.len(), 60);
        let nobody = at_rest(&map());
        trails.update(2.5, &nobody);
        assert_eq!(trails.all()[0].points.len(), 30, "what is younger than two seconds");
        trails.update(3.1, &nobody);
        assert!(trails.all().is_empty() && trails.of.is_empty());
    }

    #[test]
    fn a_contact_that_sways_leaves_no_trail_of_a_thousand_places() {
        let mut trails = Trails::default();
        for frame in 0..600 {
            let mut snapshot = at_rest(&map());
            let sway = 0.001 * (frame as f32).sin();
            step_on(&mut snapshot, 1, Vec2::new(0.3 + sway, 1.0), 300.0, Vec2::ZERO);
            trails.update(f64::from(frame) / 60.0, &snapshot);
        }
        assert!(trails.all()[0].points.len() <= 1);
    }
}
