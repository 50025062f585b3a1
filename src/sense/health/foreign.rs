//! Whether the floor file belongs to another floor, by the first readings of the empty tiles.

/// Maximum initial reading of a sensor (N) on the floor of the file: far more than zeros drift in a day.
const STRANGE_N: f32 = 2.0;

/// Force above which a tile counts as carrying a foot (N): more than the sum of another floor's zeros.
const LADEN_N: f32 = 25.0;

/// Share of empty tiles with strange readings above which the floor is a different one, and minimum number of empty
/// tiles.
const MOST_TILES: f32 = 0.4;
const FEWEST_TILES: usize = 4;

/// The first readings of all tiles, compared with the tare of the floor file.
#[derive(Clone, Debug)]
pub(super) struct FirstReadings {
    /// Whether each tile has been judged by its first block.
    seen: Vec<bool>,
    /// Number of these tiles, and number of those with readings that no empty tile of this floor should have.
    judged: usize,
    strange: usize,
    /// Number of those tiles with a load, which reveal nothing of their zeros.
    laden: usize,
    /// Whether the boards convert to newtons themselves: then the file does not apply.
    by_boards: bool,
    is_foreign: bool,
}

impl FirstReadings {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            seen: vec![false; tiles],
            judged: 0,
            strange: 0,
            laden: 0,
            by_boards: false,
            is_foreign: false,
        }
    }

    /// Whether most tiles had readings that no empty tile of the file's floor should have.
    pub(super) const fn are_foreign(&self) -> bool {
        self.is_foreign
    }

    /// Judges `tile` by the mean readings of its sensors in a block, unless an earlier block has been judged.
    pub(super) fn note(&mut self, tile: usize, means: &[f32; 4]) {
        if std::mem::replace(&mut self.seen[tile], true) {
            return;
        }
        self.judged += 1;
        let laden = means.iter().sum::<f32>().abs() > LADEN_N;
        let strange = means.iter().filter(|mean| mean.abs() > STRANGE_N).count() > 1;
        self.laden += usize::from(laden);
        self.strange += usize::from(strange && !laden);
        self.judge();
    }

    /// Notes that boards convert to newtons themselves.
    pub(super) fn note_newtons(&mut self) {
        if !std::mem::replace(&mut self.by_boards, true) {
            self.judge();
        }
    }

    fn judge(&mut self) {
        let empty = self.judged - self.laden;
        let all_seen = self.judged == self.seen.len() && !self.by_boards;
        self.is_foreign =
            all_seen && empty >= FEWEST_TILES && self.strange as f32 > MOST_TILES * empty as f32;
    }
}
