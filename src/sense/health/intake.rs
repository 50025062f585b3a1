//! The destination of sensor readings, laid out for vector operations.

use super::{Health, RangeEnd};
use crate::sense::{ForceFrame, Quality};

/// Inputs and outputs for `LANES` consecutive sensors, four to a tile.
pub(in crate::sense) struct Lanes<'a, const LANES: usize> {
    /// Offset to subtract from each reading besides its tare.
    pub offsets: &'a [f32; LANES],
    pub forces: &'a mut [f32; LANES],
    pub quality: &'a mut [Quality; LANES],
    pub ends: &'a mut [RangeEnd; LANES],
    /// The readings as sent by the boards.
    pub raws: &'a mut [u16; LANES],
    /// Whether each has the nominal law.
    pub guessed: &'a mut [bool; LANES],
    /// Whether each has been read for the present frame.
    pub news: &'a mut [bool; LANES],
}

/// The readings of all sensors as their boards sent them, four to a tile.
#[derive(Clone, Debug)]
pub(super) struct Intake {
    /// Position of each reading in the converter's range.
    pub(super) ends: Vec<[RangeEnd; 4]>,
    /// Reading of each as sent by its board, 0 for zero; for newtons a digest of their bits.
    pub(super) raws: Vec<[u16; 4]>,
    /// Sensors with the nominal law: the plate checks do not apply to forces that may be off by a third.
    guessed: Vec<[bool; 4]>,
}

impl Intake {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            ends: vec![[RangeEnd::Within; 4]; tiles],
            raws: vec![[0; 4]; tiles],
            guessed: vec![[false; 4]; tiles],
        }
    }

    /// Whether every sensor of a tile has a law of its own.
    pub(super) fn has_laws(&self, tile: usize) -> bool {
        self.guessed[tile] == [false; 4]
    }
}

impl Health {
    /// The sensors from number `first` on, in tile-index order; `None` if the floor has fewer.
    #[inline]
    pub(in crate::sense) fn lanes<'a, const LANES: usize>(
        &'a mut self,
        first: usize,
        frame: &'a mut ForceFrame,
    ) -> Option<Lanes<'a, LANES>> {
        Some(Lanes {
            offsets: self.zeros.offsets().as_flattened().get(first..)?.first_chunk()?,
            forces: frame.forces.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            quality: frame.quality.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            ends: self.intake.ends.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            raws: self.intake.raws.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            guessed: self.intake.guessed.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            news: self.jumps.news().get_mut(first..)?.first_chunk_mut()?,
        })
    }

    /// Notes that a sensor, by its number, requires an examination of its tile.
    pub(in crate::sense) fn note_loud(&mut self, sensor: usize) {
        self.queue.note_loud(sensor);
    }

    /// Notes that boards convert to newtons themselves.
    pub(in crate::sense) fn note_newtons(&mut self) {
        self.first.note_newtons();
    }
}
