//! The tiles to be examined in the next frame.

/// The tiles to be examined in the next frame, and the readings of each at its last examination.
///
/// Allocates memory only at its creation.
#[derive(Clone, Debug)]
pub(super) struct TileQueue {
    /// Tiles with a reading to be examined in this frame.
    loud: Vec<u32>,
    /// Tiles with a faulty sensor, or that may start nothing.
    watched: Vec<u32>,
    /// Space for the next `watched`.
    spare: Vec<u32>,
    /// Number of the frame in which each tile was last examined, and its sensors' readings then.
    examined: Vec<u32>,
    read: Vec<[f32; 4]>,
}

impl TileQueue {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            loud: Vec::with_capacity(4 * tiles),
            watched: Vec::with_capacity(tiles),
            spare: Vec::with_capacity(tiles),
            examined: vec![0; tiles],
            read: vec![[0.0; 4]; tiles],
        }
    }

    /// Adds the tile of a sensor, by the sensor's number, to those of this frame.
    pub(super) fn note_loud(&mut self, sensor: usize) {
        let tile = (sensor / 4) as u32;
        // A tile may come four times if its sensors are on different boards, never more often.
        if self.loud.last() != Some(&tile) && self.loud.len() < self.loud.capacity() {
            self.loud.push(tile);
        }
    }

    /// Adds a tile to those of every frame.
    pub(super) fn watch(&mut self, tile: usize) {
        if !self.watched.contains(&(tile as u32)) {
            self.watched.push(tile as u32);
        }
    }

    /// The tiles with a faulty sensor, or that may start nothing.
    pub(super) fn watched(&self) -> impl Iterator<Item = usize> + '_ {
        self.watched.iter().map(|&tile| tile as usize)
    }

    /// Calls `examine` once for each tile of the queue, with its sensors' readings in the frame before; the tiles for
    /// which it returns true are watched from now on, and no others. `number` is that of the frame, and `forces` are
    /// its readings; `lasts` is the number of frames within which a tile's board sends again.
    pub(super) fn examine(
        &mut self,
        number: u32,
        forces: &[[f32; 4]],
        lasts: impl Fn(usize) -> u32,
        mut examine: impl FnMut(usize, [f32; 4]) -> bool,
    ) {
        let Self { loud, watched, spare, examined, read } = self;
        spare.clear();
        for tile in loud.drain(..).chain(watched.drain(..)) {
            let index = tile as usize;
            let last = std::mem::replace(&mut examined[index], number);
            if last == number {
                continue;
            }
            // A tile that was not examined carried hardly any load.
            let before = if number.wrapping_sub(last) <= lasts(index) { read[index] } else { [0.0; 4] };
            if examine(index, before) {
                spare.push(tile);
            }
            read[index] = forces[index];
        }
        std::mem::swap(watched, spare);
    }
}
