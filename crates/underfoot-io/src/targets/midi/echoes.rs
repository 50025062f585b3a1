//! Releases that are sent again in the cycles that follow.
//!
//! When a client of JACK dies, the server runs no receiver that it was connected to until it has noticed: messages
//! of others to this receiver are lost in the meantime. A guardian releases just then.

/// Maximum number of releases that are repeated; of more, the oldest are sent only once.
const MOST: usize = 128;

/// Releases that are repeated for a number of cycles.
pub(super) struct Echoes {
    entries: [Echo; MOST],
    /// The entry that the next release replaces.
    next: usize,
    cycles: u32,
}

/// A message of up to three bytes, and the number of cycles in which it is sent again.
#[derive(Clone, Copy)]
struct Echo {
    length: u8,
    bytes: [u8; 3],
    left: u32,
}

impl Echoes {
    /// Repeats each release in as many cycles.
    pub(super) const fn new(cycles: u32) -> Self {
        Self { entries: [Echo { length: 0, bytes: [0; 3], left: 0 }; MOST], next: 0, cycles }
    }

    /// Notes a release that goes out in this cycle.
    pub(super) fn add(&mut self, length: u8, bytes: [u8; 3]) {
        if let Some(entry) = self.entries.get_mut(self.next) {
            *entry = Echo { length, bytes, left: self.cycles };
        }
        self.next = (self.next + 1) % MOST;
    }

    /// Ends the repetitions on the channel of a message that follows: a note that it presses stays down.
    pub(super) fn cancel(&mut self, status: u8) {
        for echo in self.entries.iter_mut().filter(|echo| echo.bytes[0] & 0x0f == status & 0x0f) {
            echo.left = 0;
        }
    }

    /// Gives the messages of this cycle to `send`; returns whether more follow in the next.
    pub(super) fn repeat(&mut self, mut send: impl FnMut(&[u8])) -> bool {
        let mut follow = false;
        for echo in self.entries.iter_mut().filter(|echo| echo.left > 0) {
            echo.left -= 1;
            follow |= echo.left > 0;
            send(echo.bytes.get(..echo.length.into()).unwrap_or(&echo.bytes));
        }
        follow
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(echoes: &mut Echoes) -> Vec<Vec<u8>> {
        let mut heard = Vec::new();
        echoes.repeat(|bytes| heard.push(bytes.to_vec()));
        heard
    }

    #[test]
    fn a_release_is_repeated_and_a_foot_that_presses_again_ends_that_on_its_channel() {
        let mut echoes = Echoes::new(2);
        assert!(heard(&mut echoes).is_empty());
        echoes.add(3, [0x80, 60, 64]);
        echoes.add(3, [0x81, 62, 64]);
        assert_eq!(heard(&mut echoes), [[0x80, 60, 64], [0x81, 62, 64]]);
        echoes.cancel(0x90);
        assert_eq!(heard(&mut echoes), [[0x81, 62, 64]]);
        assert!(heard(&mut echoes).is_empty(), "two cycles are over");
    }

    #[test]
    fn more_releases_than_places_are_repeated_from_the_latest_back() {
        let mut echoes = Echoes::new(1);
        let notes = MOST as u8 + 3;
        (0..notes).for_each(|note| echoes.add(2, [0xd0, note, 0]));
        let heard = heard(&mut echoes);
        assert_eq!(heard.len(), MOST);
        assert!(heard.contains(&vec![0xd0, notes - 1]) && !heard.contains(&vec![0xd0, 0]));
    }
}
