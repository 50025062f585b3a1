//! Packets of a simulated floor.

use std::fmt;
use std::thread;
use std::time::Duration;

use super::{SensorSource, SourceError};
use crate::sim::{Foot, FootDriver, SimFloor};
use crate::units::Instant;
use crate::wire::SensorPacket;

/// How fast a simulated floor's time passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// As fast as packets are asked for; the clock shows the floor's own time and nothing ever sleeps.
    FreeRunning,
    /// A millisecond per millisecond of the host's monotonic clock, from the first packet asked for.
    /// Whoever asks too late gets what is due at once: no millisecond is left out.
    RealTime,
}

/// A simulated floor as a source of packets: one packet per board and millisecond,
/// from millisecond 0, with sequence numbers that start at 0.
pub struct SimulatedSource {
    floor: SimFloor,
    driver: Box<dyn FootDriver>,
    clock: Clock,
    feet: Vec<Foot>,
    /// Milliseconds simulated so far; the last one's packets are being handed out.
    ticks: u64,
    /// The next board of this millisecond.
    board: usize,
    /// When this millisecond's packets came into being.
    received: Instant,
    over: bool,
}

#[derive(Debug)]
enum Clock {
    Virtual,
    /// Stands still until the first packet is asked for.
    Host(Option<std::time::Instant>),
}

impl SimulatedSource {
    /// The packets of `floor` under the feet that `driver` moves.
    #[must_use]
    pub fn new(floor: SimFloor, driver: Box<dyn FootDriver>, pace: Pace) -> Self {
        let clock = match pace {
            Pace::FreeRunning => Clock::Virtual,
            Pace::RealTime => Clock::Host(None),
        };
        let board = floor.readings().len();
        Self {
            floor,
            driver,
            clock,
            feet: Vec::new(),
            ticks: 0,
            board,
            received: Instant::START,
            over: false,
        }
    }

    /// The feet that made the packets of this millisecond: the truth, for comparing.
    #[must_use]
    pub fn feet(&self) -> &[Foot] {
        &self.feet
    }

    /// The floor, to break and repair its sensors while it runs.
    pub fn floor_mut(&mut self) -> &mut SimFloor {
        &mut self.floor
    }

    /// Waits until the next millisecond is due; false if that is after `patience` has run out.
    fn wait(&mut self, due: Instant, patience: Duration) -> bool {
        let Clock::Host(start) = &mut self.clock else { return true };
        start.get_or_insert_with(std::time::Instant::now);
        let left = due.since(self.now());
        thread::sleep(left.min(patience));
        left <= patience
    }
}

impl SensorSource for SimulatedSource {
    /// The next packet: in board order within a millisecond, then the next millisecond.
    ///
    /// # Errors
    /// [`SourceError::Ended`] once the feet's performance is over, and ever after.
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        if self.board >= self.floor.readings().len() {
            if self.over {
                return Err(SourceError::Ended);
            }
            let due = Instant::from_millis(self.ticks);
            if !self.wait(due, patience) {
                return Ok(None);
            }
            if !self.driver.feet(due, &mut self.feet) {
                self.over = true;
                return Err(SourceError::Ended);
            }
            self.floor.step(&self.feet);
            self.ticks += 1;
            self.board = 0;
            self.received = match self.clock {
                Clock::Virtual => due,
                Clock::Host(_) => self.now(),
            };
        }
        let readings = self.floor.readings().get(self.board).cloned();
        let board = self.board as u16;
        self.board += 1;
        // Sequence numbers wrap as those of real boards do.
        let sequence = self.ticks.wrapping_sub(1) as u32;
        Ok(readings.map(|readings| SensorPacket { board, sequence, received: self.received, readings }))
    }

    fn now(&self) -> Instant {
        match self.clock {
            Clock::Virtual => self.received,
            Clock::Host(start) => start.map_or(Instant::START, |start| Instant::START + start.elapsed()),
        }
    }
}

impl fmt::Debug for SimulatedSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SimulatedSource")
            .field("clock", &self.clock)
            .field("ticks", &self.ticks)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::floor::{Floor, Geometry};
    use crate::sim::SimConfig;
    use crate::units::Newtons;

    /// One foot that slides east, for so many milliseconds.
    struct Slide(u64);

    impl FootDriver for Slide {
        fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
            feet.clear();
            let position = Vec2::new(0.3 + at.secs() as f32, 0.5);
            feet.push(Foot { position, heading: 0.0, length_m: 0.27, force: Newtons(500.0), roll: 0.4 });
            at < Instant::from_millis(self.0)
        }
    }

    fn source(millis: u64, pace: Pace) -> SimulatedSource {
        let floor = Floor::of(Geometry::of_paper_tiles(6, 3).unwrap());
        SimulatedSource::new(SimFloor::new(&floor, SimConfig::default(), 8), Box::new(Slide(millis)), pace)
    }

    fn all_packets(source: &mut SimulatedSource) -> Vec<SensorPacket> {
        let mut packets = Vec::new();
        loop {
            match source.next(Duration::from_millis(20)) {
                Ok(packet) => packets.extend(packet),
                Err(SourceError::Ended) => return packets,
                Err(error) => panic!("{error}"),
            }
        }
    }

    #[test]
    fn each_board_sends_every_millisecond_with_the_next_number() {
        let mut source = source(20, Pace::FreeRunning);
        let packets = all_packets(&mut source);
        assert_eq!(packets.len(), 60);
        for (index, packet) in packets.iter().enumerate() {
            let tick = index as u64 / 3;
            assert_eq!((packet.board, packet.sequence), ((index % 3) as u16, tick as u32));
            assert_eq!(packet.received, Instant::from_millis(tick), "virtual time, exactly");
            assert_eq!(packet.readings.len(), 24);
        }
        assert_eq!(source.now(), Instant::from_millis(19));
        assert!(matches!(source.next(Duration::ZERO), Err(SourceError::Ended)), "and ever after");
    }

    #[test]
    fn the_same_seed_gives_the_same_packets() {
        assert_eq!(
            all_packets(&mut source(30, Pace::FreeRunning)),
            all_packets(&mut source(30, Pace::FreeRunning))
        );
    }

    #[test]
    fn real_time_loses_no_millisecond_to_a_late_reader() {
        let mut source = source(30, Pace::RealTime);
        assert_eq!(source.now(), Instant::START, "the clock waits for the first reader");
        let first = source.next(Duration::from_millis(20)).unwrap().unwrap();
        thread::sleep(Duration::from_millis(10));
        let mut packets = vec![first];
        packets.extend(all_packets(&mut source));
        let numbers: Vec<u32> =
            packets.iter().filter(|packet| packet.board == 0).map(|packet| packet.sequence).collect();
        assert_eq!(numbers, (0..30).collect::<Vec<u32>>());
        for packet in &packets {
            let due = Instant::from_millis(packet.sequence.into());
            assert!(packet.received >= due, "{packet:?} came before its time");
        }
        assert!(packets.windows(2).all(|pair| pair[0].received <= pair[1].received));
        assert!(source.now() >= Instant::from_millis(29));
    }

    #[test]
    fn an_impatient_reader_gets_nothing_before_the_time() {
        let mut source = source(1000, Pace::RealTime);
        for _ in 0..3 {
            assert!(source.next(Duration::ZERO).unwrap().is_some());
        }
        // The next millisecond may or may not have come; a second ahead it has not.
        let early = std::iter::from_fn(|| source.next(Duration::ZERO).ok().flatten()).take(600).count();
        assert!(early < 600, "200 ms of packets at once");
    }

    #[test]
    fn the_truth_is_at_hand() {
        let mut source = source(100, Pace::FreeRunning);
        source.next(Duration::ZERO).unwrap();
        assert_eq!(source.feet().len(), 1);
        assert_eq!(source.floor_mut().geometry().columns(), 6);
    }
}
