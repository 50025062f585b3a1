//! All grounds of a layout: frames in, events out.

use std::time::Duration;

use glam::Vec2;

use super::bed::Bed;
use super::tile::{Stride, Tread};
use super::{Elastic, GroundCounters, GroundEvent, GroundSpec, GroundState};
use crate::floor::{Geometry, Rect};
use crate::sense::{Contact, ForceFrame, Quality};
use crate::units::Instant;

/// Length of one step.
const STEP: Duration = Duration::from_millis(1);

/// Longest gap in steps for which motion goes on; after a longer one, a load on the ground counts as settled.
const LONGEST_GAP: u64 = 20;

/// Maximum number of events of one ground in a frame that are felt one by one.
const MOST_EVENTS: usize = 32;

/// Maximum load, in newtons, that counts as settled in the first frame of a contact: a gentle foot is detected with
/// no more than this.
const LANDING_N: f64 = 20.0;

/// Interval between the checks for healing.
const HEAL_EVERY: Duration = Duration::from_millis(100);

/// All grounds of a layout: frames and contacts in, events out.
///
/// Each tile of a ground has a sheet, a process and modes of its own. A tile without a load costs nothing. Nothing
/// allocates after the start.
///
/// # Source
/// "Separate, independent responses are rendered in parallel for each tile" (paper, section 4.1.1).
#[derive(Clone, Debug, Default)]
pub struct Grounds {
    beds: Vec<GroundBed>,
    last: Option<Instant>,
    events: Vec<GroundEvent>,
}

/// One ground.
#[derive(Clone, Debug)]
struct GroundBed {
    spec: GroundSpec,
    elastic: Elastic,
    bed: Bed,
    treads: Vec<Tread>,
    /// Tiles in motion or under load.
    awake: Vec<usize>,
    healed: Instant,
    revision: u64,
    counters: GroundCounters,
    /// Whether the ground is new, or was not stepped lately.
    is_fresh: bool,
}

impl Grounds {
    /// The `grounds` of a layout on a floor of this `geometry`, whole and without tracks.
    #[must_use]
    pub fn new(grounds: impl IntoIterator<Item = GroundSpec>, geometry: &Geometry) -> Self {
        let tiles = geometry.tile_count();
        let beds = grounds.into_iter().map(|spec| GroundBed {
            elastic: Elastic::new(spec.material.body(), STEP.as_secs_f64()),
            bed: Bed::new(&spec.material, spec.area, spec.seed, tiles),
            spec,
            treads: vec![Tread::default(); tiles],
            awake: Vec::with_capacity(tiles),
            healed: Instant::START,
            revision: 0,
            counters: GroundCounters::default(),
            is_fresh: true,
        });
        let beds: Vec<GroundBed> = beds.collect();
        let events = Vec::with_capacity(MOST_EVENTS * beds.len());
        Self { beds, last: None, events }
    }

    /// Maximum number of events in one frame.
    pub(crate) fn most_events(&self) -> usize {
        MOST_EVENTS * self.beds.len()
    }

    /// Takes over the state of grounds that both have, so that an edit of one leaves the cracks in the other.
    pub fn inherit(&mut self, old: &mut Self) {
        self.last = old.last;
        for bed in &mut self.beds {
            let same = old.beds.iter().position(|other| {
                let page = bed.spec.page;
                GroundSpec { page, ..other.spec } == bed.spec
            });
            if let Some(same) = same {
                let page = bed.spec.page;
                *bed = old.beds.swap_remove(same);
                bed.spec.page = page;
            }
        }
    }

    /// Processes a frame with its contacts; returns the ground events, in order of time.
    ///
    /// `previous` is the frame before. Only the grounds of `page` and those on all pages take part. A tile without
    /// sensing holds still; a load that stands there when sensing returns counts as settled and causes no cracks.
    ///
    /// # Real-time
    /// No allocation.
    pub fn step(
        &mut self,
        frame: &ForceFrame,
        previous: &ForceFrame,
        contacts: &[Contact],
        page: usize,
    ) -> &[GroundEvent] {
        self.events.clear();
        if self.beds.is_empty() {
            return &self.events;
        }
        let passed = self.last.map_or(u64::MAX, |last| frame.at.since(last).as_millis() as u64);
        self.last = Some(frame.at);
        for (number, bed) in self.beds.iter_mut().enumerate() {
            let is_shown = bed.spec.is_on(page);
            if !is_shown || passed > LONGEST_GAP {
                bed.doze();
            }
            if is_shown && passed > 0 {
                bed.wake(contacts, frame, previous);
                let first = self.events.len();
                bed.tread(number, frame, passed.min(LONGEST_GAP), &mut self.events);
                self.events[first..].sort_unstable_by_key(|event| (event.at, event.tile));
            }
        }
        &self.events
    }

    /// Ground events of the last frame.
    #[must_use]
    pub fn events(&self) -> &[GroundEvent] {
        &self.events
    }

    /// Number of grounds.
    #[must_use]
    pub fn len(&self) -> usize {
        self.beds.len()
    }

    /// Whether there are no grounds.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.beds.is_empty()
    }

    /// Writes the state of the grounds into `states`, one each, in the layout's order.
    ///
    /// Skips states that are up to date already, so that frequent calls cost little.
    pub fn show(&self, states: &mut Vec<GroundState>) {
        states.resize_with(self.beds.len(), GroundState::default);
        for (bed, state) in self.beds.iter().zip(states) {
            // The state of an unrelated ground may have the same revision by chance: it covers another area.
            if state.revision != bed.revision || state.counters != bed.counters || state.is_empty() {
                state.revision = bed.revision;
                bed.bed.show(state);
            }
            state.counters = bed.counters;
        }
    }
}

impl GroundBed {
    /// Resets all tiles.
    fn doze(&mut self) {
        for tile in self.awake.drain(..) {
            if let Some(tread) = self.treads.get_mut(tile) {
                *tread = Tread::default();
            }
        }
        self.is_fresh = true;
    }

    /// Assigns contacts to tiles.
    fn wake(&mut self, contacts: &[Contact], frame: &ForceFrame, previous: &ForceFrame) {
        for index in &self.awake {
            if let Some(tread) = self.treads.get_mut(*index) {
                tread.contact = None;
            }
        }
        for contact in contacts {
            for load in &contact.tiles {
                let Some(tread) = self.treads.get_mut(load.index) else { continue };
                if !holds(self.spec.area, load.centroid) {
                    continue;
                }
                let whole_n = force_n(frame, load.index);
                if !tread.is_awake {
                    let was_unknown =
                        previous.quality.get(load.index).is_none_or(|quality| is_unknown(*quality));
                    let unseen = self.is_fresh || was_unknown;
                    let settled = if unseen { whole_n } else { whole_n.min(LANDING_N) };
                    *tread =
                        Tread { motion: self.elastic.settled(settled), is_awake: true, ..Tread::default() };
                    self.bed.settle(load.index, tread.motion.x_m);
                    self.awake.push(load.index);
                }
                let share = (f64::from(load.force.0) / whole_n.max(1.0)).clamp(0.0, 1.0);
                if tread.contact.is_none() {
                    (tread.weight, tread.share) = (0.0, 0.0);
                }
                // Of several feet on one tile the heaviest counts: the dominant centroid.
                if contact.force.0 > tread.weight {
                    (tread.contact, tread.weight) = (Some(contact.id), contact.force.0);
                    tread.place = contact.centroid.clamp(self.spec.area.min, self.spec.area.max);
                }
                tread.share = (tread.share + share).min(1.0);
            }
        }
        self.is_fresh = false;
    }

    fn tread(&mut self, number: usize, frame: &ForceFrame, steps: u64, events: &mut Vec<GroundEvent>) {
        let Self { elastic, bed, treads, awake, counters, revision, healed, .. } = self;
        if frame.at.since(*healed) >= HEAL_EVERY {
            *healed = frame.at;
            *revision += u64::from(bed.heal(frame.at));
        }
        let before = counters.events;
        let first = events.len();
        awake.retain(|&index| {
            let Some(tread) = treads.get_mut(index) else { return false };
            if frame.quality.get(index).is_none_or(|quality| is_unknown(*quality)) {
                *tread = Tread::default();
                return false;
            }
            let (from_n, to_n) = (tread.motion.force_n, force_n(frame, index) * tread.share);
            for step in 1..=steps {
                let earlier = tread.motion;
                elastic.step(&mut tread.motion, from_n + (to_n - from_n) * step as f64 / steps as f64);
                let stride = Stride {
                    tile: index,
                    place: tread.place,
                    elastic,
                    before: earlier,
                    after: tread.motion,
                    from: frame.at,
                };
                let contact = tread.contact;
                bed.tread(&stride, |event| {
                    counters.events += 1;
                    if events.len() - first == MOST_EVENTS {
                        counters.unfelt += 1;
                        return;
                    }
                    let within = Duration::from_nanos((event.share * 1e6) as u64);
                    events.push(GroundEvent {
                        at: frame.at + within,
                        ground: number,
                        tile: index,
                        contact,
                        place: event.place,
                        energy_j: event.energy_j,
                        seed: event.seed,
                        click: event.click,
                    });
                });
            }
            let goes_on = tread.contact.is_some() || !elastic.is_still(&tread.motion);
            if !goes_on {
                *tread = Tread::default();
            }
            goes_on
        });
        if counters.events > before {
            *revision += 1;
        }
        counters.evicted = bed.evicted();
    }
}

/// Whether `area` contains `point`, with all of its edges.
fn holds(area: Rect, point: Vec2) -> bool {
    point == point.clamp(area.min, area.max)
}

/// The load on a tile, in newtons.
fn force_n(frame: &ForceFrame, tile: usize) -> f64 {
    frame.forces.get(tile).map_or(0.0, |forces| forces.iter().copied().map(f64::from).sum())
}

/// Whether sensors of this quality leave the load on a tile unknown.
fn is_unknown(quality: [Quality; 4]) -> bool {
    quality.iter().all(|quality| *quality >= Quality::Stale)
}

impl GroundState {
    fn is_empty(&self) -> bool {
        self.relief.size() == (0, 0)
    }
}
