//! Controls on tiles whose readings are missing or unsuitable.

use super::belief::is_sensed;
use super::off::of_calibration;
use super::{Interaction, Moment, holds_to_run, report};
use crate::engine::event::ControlEvent;
use crate::floor::Geometry;
use crate::layout::{HitIndex, Layout};
use crate::sense::Quality;
use crate::widget::{Control, Input};

impl Interaction {
    /// Inhibits controls that act while they are held: on a floor with doubtful calibration, and where the readings
    /// below them are unsuitable.
    pub(super) fn inhibit(&mut self, at: &Moment<'_>, events: &mut Vec<ControlEvent>) {
        let fault = at.frame.calibration_fault.map(of_calibration);
        for widget in (0..self.controls.len()).filter(|&widget| holds_to_run(at.layout, widget)) {
            let inhibited = fault.or_else(|| self.of_readings(widget, at.frame));
            if self.controls.get(widget).is_some_and(|control| control.inhibited() != inhibited) {
                let switch = |control: &mut Control| control.set_inhibited(inhibited);
                self.change(widget, switch, at.layout, at.now(), events);
            }
        }
    }

    /// Cancels controls on tiles without sensing.
    pub(super) fn lose_unsensed(&mut self, at: &Moment<'_>, events: &mut Vec<ControlEvent>) {
        for widget in self.lost.drain(..) {
            if let Some(unsensed) = self.unsensed.get_mut(widget) {
                *unsensed = false;
            }
        }
        let quality = &at.frame.quality;
        if quality.len() >= self.geometry.tile_count()
            && quality.iter().flatten().all(|quality| *quality < Quality::Stale)
        {
            return;
        }
        for tile in 0..self.geometry.tile_count() {
            if quality.get(tile).is_some_and(is_sensed) {
                continue;
            }
            let plate = self.geometry.plate(self.geometry.tile_at_index(tile));
            for &widget in self.hits.on_tile(tile) {
                let lies_there = at.layout.widgets.get(widget).is_some_and(|spec| plate.overlaps(spec.area));
                if let Some(unsensed) = self.unsensed.get_mut(widget).filter(|lost| lies_there && !**lost) {
                    *unsensed = true;
                    self.lost.push(widget);
                }
            }
        }
        // In the layout's order, independent of the tiles.
        self.lost.sort_unstable();
        for which in 0..self.lost.len() {
            let widget = self.lost[which];
            let Some(control) = self.controls.get_mut(widget) else { continue };
            let emitted = control.step(at.now(), Input::Lost);
            let held = self.release_hold(widget);
            report(at.layout, at.now(), widget, held, &emitted, events);
            self.wake(widget);
        }
    }
}

/// For each control of `layout`, the indices of the tiles below it.
pub(super) fn tiles_under(layout: &Layout, geometry: &Geometry, hits: &HitIndex) -> Vec<Vec<usize>> {
    let mut under = vec![Vec::new(); layout.widgets.len()];
    for tile in 0..geometry.tile_count() {
        let plate = geometry.plate(geometry.tile_at_index(tile));
        for &widget in hits.on_tile(tile) {
            if let (Some(spec), Some(tiles)) = (layout.widgets.get(widget), under.get_mut(widget))
                && plate.overlaps(spec.area)
            {
                tiles.push(tile);
            }
        }
    }
    under
}
