//! Classifies packets by their sequence numbers: next, lost, repeated, late, restarted.

/// Maximum distance behind the latest packet at which a packet is a straggler and not a sign of a reboot.
const WINDOW: u32 = 100;

/// Number of consecutive packets that must agree before a jump in the numbers is accepted.
const CONFIRMED: u8 = 3;

/// Verdict on one packet's sequence number.
///
/// Positions count on where the 32-bit numbers wrap, so they can be compared and subtracted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SequenceVerdict {
    /// Further on than any packet before; `skipped` numbers in between are still missing.
    Next {
        /// Its place in the stream.
        position: i64,
        /// Number of missing packets.
        skipped: u32,
    },
    /// Overtaken by later packets; comes for the first time.
    Straggler {
        /// Its place in the stream.
        position: i64,
        /// Whether it had been counted as skipped.
        missed: bool,
    },
    /// Repeated.
    Duplicate,
    /// Inconsistent: a damaged number, or the first sign of a reboot.
    OutOfOrder,
    /// Third consecutive packet that agrees with a new start; the stream starts again at `position`.
    Restart {
        /// Its place in the new stream.
        position: i64,
    },
}

/// Tracks the sequence numbers of one board.
///
/// ```text
/// number - latest   looks early   verdict
/// 1 or more         no            Next
/// 1 to 100          yes           OutOfOrder, at the third in a row Next
/// 101 or more       yes           OutOfOrder, at the third in a row Restart
/// 0                               Duplicate
/// -1 to -100                      Straggler or Duplicate
/// below -100                      OutOfOrder, at the third in a row Restart
/// ```
///
/// A packet cannot arrive before its sampling, so a number too large for the elapsed time is damaged: it "looks
/// early".
#[derive(Clone, Debug, Default)]
pub(super) struct PacketSequence {
    latest: Option<Latest>,
    jump: Option<Jump>,
}

#[derive(Clone, Copy, Debug)]
struct Latest {
    number: u32,
    position: i64,
    /// Bit k: the packet k before the latest has arrived.
    came: u128,
    /// Number of positions before the latest that belong to this stream, at most [`WINDOW`].
    known: u32,
}

#[derive(Clone, Copy, Debug)]
struct Jump {
    number: u32,
    agreeing: u8,
}

impl PacketSequence {
    /// Position in the stream of the furthest packet so far.
    pub(super) fn position(&self) -> Option<i64> {
        self.latest.map(|latest| latest.position)
    }

    /// Classifies the packet with this `number`; `early` returns whether a position lies further ahead than the
    /// elapsed time allows.
    pub(super) fn judge(&mut self, number: u32, early: impl FnOnce(i64) -> bool) -> SequenceVerdict {
        let Some(latest) = &mut self.latest else { return self.begin(number) };
        let step = number.wrapping_sub(latest.number).cast_signed();
        let position = latest.position + i64::from(step);
        match step {
            0 => SequenceVerdict::Duplicate,
            1.. if early(position) => self.jump(number, step),
            1.. => self.advance(number, step.unsigned_abs()),
            ..0 if step.unsigned_abs() <= WINDOW => {
                self.jump = None;
                let bit = 1 << step.unsigned_abs();
                if latest.came & bit != 0 {
                    return SequenceVerdict::Duplicate;
                }
                latest.came |= bit;
                SequenceVerdict::Straggler { position, missed: step.unsigned_abs() <= latest.known }
            }
            ..0 => self.jump(number, step),
        }
    }

    fn begin(&mut self, number: u32) -> SequenceVerdict {
        let position = 0;
        self.latest = Some(Latest { number, position, came: 1, known: 0 });
        self.jump = None;
        SequenceVerdict::Next { position, skipped: 0 }
    }

    fn advance(&mut self, number: u32, step: u32) -> SequenceVerdict {
        self.jump = None;
        let Some(latest) = &mut self.latest else { return self.begin(number) };
        latest.number = number;
        latest.position += i64::from(step);
        latest.came = latest.came.checked_shl(step).unwrap_or(0) | 1;
        latest.known = latest.known.saturating_add(step).min(WINDOW);
        SequenceVerdict::Next { position: latest.position, skipped: step - 1 }
    }

    fn jump(&mut self, number: u32, step: i32) -> SequenceVerdict {
        let agreeing = match self.jump {
            Some(jump) if number == jump.number => return SequenceVerdict::Duplicate,
            Some(jump) if number == jump.number.wrapping_add(1) => jump.agreeing + 1,
            _ => 1,
        };
        self.jump = Some(Jump { number, agreeing });
        if agreeing < CONFIRMED {
            SequenceVerdict::OutOfOrder
        } else if (0..=WINDOW).contains(&step.cast_unsigned()) {
            // Slightly early: the transmission delay has become shorter.
            self.advance(number, step.unsigned_abs())
        } else {
            self.begin(number);
            SequenceVerdict::Restart { position: 0 }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(position: i64) -> SequenceVerdict {
        SequenceVerdict::Next { position, skipped: 0 }
    }

    /// Classifies numbers that all come in time.
    fn judge(sequence: &mut PacketSequence, numbers: impl IntoIterator<Item = u32>) -> Vec<SequenceVerdict> {
        numbers.into_iter().map(|number| sequence.judge(number, |_| false)).collect()
    }

    #[test]
    fn numbers_wrap_without_a_seam() {
        let verdicts = judge(&mut PacketSequence::default(), [u32::MAX - 1, u32::MAX, 0, 1]);
        assert_eq!(verdicts, [next(0), next(1), next(2), next(3)]);
        let gap = judge(&mut PacketSequence::default(), [u32::MAX - 1, 1, u32::MAX]);
        assert_eq!(gap[1], SequenceVerdict::Next { position: 3, skipped: 2 });
        assert_eq!(gap[2], SequenceVerdict::Straggler { position: 1, missed: true });
    }

    #[test]
    fn stragglers_count_once_and_only_inside_the_stream() {
        let verdicts = judge(&mut PacketSequence::default(), [10, 13, 11, 11, 9, 13]);
        assert_eq!(verdicts[2], SequenceVerdict::Straggler { position: 1, missed: true });
        assert_eq!(verdicts[3], SequenceVerdict::Duplicate);
        assert_eq!(verdicts[4], SequenceVerdict::Straggler { position: -1, missed: false });
        assert_eq!(verdicts[5], SequenceVerdict::Duplicate);
    }

    #[test]
    fn a_reboot_is_believed_at_its_third_packet_even_if_each_comes_twice() {
        let mut sequence = PacketSequence::default();
        judge(&mut sequence, 5000..5010);
        let verdicts = judge(&mut sequence, [0, 0, 1, 1, 2, 2, 3]);
        let [out_of_order, duplicate] = [SequenceVerdict::OutOfOrder, SequenceVerdict::Duplicate];
        let restart = SequenceVerdict::Restart { position: 0 };
        assert_eq!(verdicts, [out_of_order, duplicate, out_of_order, duplicate, restart, duplicate, next(1)]);
    }

    #[test]
    fn single_damaged_numbers_derail_nothing() {
        let mut sequence = PacketSequence::default();
        judge(&mut sequence, [1000]);
        for bit in 0..32 {
            let good = 1001 + bit;
            let damaged = good ^ (1 << bit);
            let verdict = sequence.judge(damaged, |position| position > sequence_position(good));
            assert!(
                !matches!(verdict, SequenceVerdict::Next { .. } | SequenceVerdict::Restart { .. }),
                "bit {bit}: {verdict:?}"
            );
            assert_eq!(sequence.judge(good, |_| false), next(sequence_position(good)), "after bit {bit}");
        }
    }

    fn sequence_position(number: u32) -> i64 {
        i64::from(number) - 1000
    }

    #[test]
    fn early_numbers_are_believed_when_three_agree() {
        let mut sequence = PacketSequence::default();
        judge(&mut sequence, [100]);
        let verdicts: Vec<_> = [110, 111, 112].map(|number| sequence.judge(number, |_| true)).into();
        let ahead = SequenceVerdict::Next { position: 12, skipped: 11 };
        assert_eq!(verdicts, [SequenceVerdict::OutOfOrder, SequenceVerdict::OutOfOrder, ahead]);
        let far: Vec<_> = [9110, 9111, 9112].map(|number| sequence.judge(number, |_| true)).into();
        assert_eq!(far[2], SequenceVerdict::Restart { position: 0 });
    }
}
