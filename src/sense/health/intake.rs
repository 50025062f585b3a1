//! The destination of sensor readings, laid out for vector operations.

use super::{End, Health};
use crate::sense::{ForceFrame, Quality};

/// Inputs and outputs for `LANES` consecutive sensors, four to a tile.
pub(in crate::sense) struct Lanes<'a, const LANES: usize> {
    /// Offset to subtract from each reading besides its tare.
    pub offsets: &'a [f32; LANES],
    pub forces: &'a mut [f32; LANES],
    pub quality: &'a mut [Quality; LANES],
    pub ends: &'a mut [End; LANES],
    /// The readings as sent by the boards.
    pub raws: &'a mut [u16; LANES],
    /// Whether each has the nominal law.
    pub guessed: &'a mut [bool; LANES],
    /// Whether each has been read for the present frame.
    pub news: &'a mut [bool; LANES],
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
            offsets: self.offsets.as_flattened().get(first..)?.first_chunk()?,
            forces: frame.forces.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            quality: frame.quality.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            ends: self.ends.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            raws: self.raws.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            guessed: self.guessed.as_flattened_mut().get_mut(first..)?.first_chunk_mut()?,
            news: self.jumps.news().get_mut(first..)?.first_chunk_mut()?,
        })
    }

    /// Notes that a sensor, by its number, requires an examination of its tile.
    pub(in crate::sense) fn note_loud(&mut self, sensor: usize) {
        let tile = (sensor / 4) as u32;
        // A tile may come four times if its sensors are on different boards, never more often.
        if self.loud.last() != Some(&tile) && self.loud.len() < self.loud.capacity() {
            self.loud.push(tile);
        }
    }

    /// Notes that boards convert to newtons themselves.
    pub(in crate::sense) fn note_newtons(&mut self) {
        if !std::mem::replace(&mut self.by_boards, true) {
            self.judge_floor();
        }
    }
}
