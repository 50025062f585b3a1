//! Packets of a simulated floor.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use super::floor_clock::{FloorClock, Host, MachineClock};
use super::{Foot, FootDriver, SimFloor};
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::{HostClock, Instant};
use underfoot::wire::{LinkCounters, SensorPacket};

/// Speed of a simulated floor's time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// As fast as packets are requested; the clock shows the floor's own time, and the source never sleeps.
    FreeRunning,
    /// A millisecond per millisecond of the host's monotonic clock, from the first request on. A request that is up
    /// to 50 ms late gets all due packets at once. Without a request for longer, the floor's time stands still
    /// meanwhile: a busy machine makes the floor slow, but never silent. No millisecond is left out.
    RealTime,
}

/// Pause of an empty floor between bursts of milliseconds: a wake-up for each millisecond costs more than its
/// simulation. The pause delays the first touch by 4 ms at most, a third of a frame of the window.
const REST: Duration = Duration::from_millis(4);

/// Milliseconds without feet after which a floor counts as empty.
const EMPTY_MS: u64 = 1000;

/// A simulated floor as a source of packets: one packet per board and millisecond,
/// from millisecond 0, with sequence numbers that start at 0.
pub struct SimulatedSource {
    floor: SimFloor,
    driver: Box<dyn FootDriver>,
    clock: Clock,
    feet: Vec<Foot>,
    /// Milliseconds simulated so far; the source is handing out the packets of the last one.
    ticks: u64,
    /// The last millisecond with a foot on the floor or above it.
    visited: u64,
    /// The next board of this millisecond.
    board: usize,
    /// Time stamp of this millisecond's packets.
    received: Instant,
    /// The moment up to which nobody waits for the clock.
    hurries_to: Instant,
    over: bool,
}

enum Clock {
    Virtual,
    Host(FloorClock),
}

impl Clock {
    /// The clock of a floor at this pace; a free-running floor needs no host.
    fn at(pace: Pace, host: impl FnOnce() -> Arc<dyn Host>) -> Self {
        match pace {
            Pace::FreeRunning => Self::Virtual,
            Pace::RealTime => Self::Host(FloorClock::new(host())),
        }
    }
}

impl SimulatedSource {
    /// The packets of `floor` under the feet that `driver` moves.
    ///
    /// # Panics
    /// At [`Pace::RealTime`] in a browser, whose clock the standard library cannot read; [`SimulatedSource::on`] takes
    /// another host.
    #[must_use]
    pub fn new(floor: SimFloor, driver: Box<dyn FootDriver>, pace: Pace) -> Self {
        Self::with_clock(floor, driver, Clock::at(pace, || Arc::new(MachineClock(std::time::Instant::now()))))
    }

    /// As [`SimulatedSource::new`], on a given host.
    #[must_use]
    pub fn on(floor: SimFloor, driver: Box<dyn FootDriver>, pace: Pace, host: Arc<dyn Host>) -> Self {
        Self::with_clock(floor, driver, Clock::at(pace, || host))
    }

    fn with_clock(floor: SimFloor, driver: Box<dyn FootDriver>, clock: Clock) -> Self {
        let board = floor.readings().len();
        Self {
            floor,
            driver,
            clock,
            feet: Vec::new(),
            ticks: 0,
            visited: 0,
            board,
            received: Instant::START,
            hurries_to: Instant::START,
            over: false,
        }
    }

    /// The same floor, simulated as fast as packets are requested up to `at`, and then at its pace.
    #[must_use]
    pub fn hurrying_to(mut self, at: Instant) -> Self {
        self.hurries_to = at;
        self
    }

    /// The clock that stamps the packets of a floor at [`Pace::RealTime`], for other threads; a free-running floor's
    /// clock is the time of the current packet, and this method returns a clock fixed at the start.
    #[must_use]
    pub fn clock(&self) -> HostClock {
        match &self.clock {
            Clock::Virtual => Arc::new(|| Instant::START),
            Clock::Host(clock) => clock.shared(),
        }
    }

    /// The feet that made the packets of this millisecond: the ground truth for comparisons.
    #[must_use]
    pub fn feet(&self) -> &[Foot] {
        &self.feet
    }

    /// The floor, to break and repair its sensors while it runs.
    pub fn floor_mut(&mut self) -> &mut SimFloor {
        &mut self.floor
    }

    /// Waits until the next millisecond is due; false if `patience` runs out before.
    fn wait(&mut self, due: Instant, patience: Duration) -> bool {
        let Clock::Host(clock) = &self.clock else { return true };
        clock.start();
        if due < self.hurries_to {
            return true;
        }
        let mut left = due.since(clock.now());
        if !left.is_zero() {
            if self.ticks > self.visited + EMPTY_MS {
                left += REST;
            }
            clock.sleep(left.min(patience));
        }
        left <= patience
    }
}

impl SensorSource for SimulatedSource {
    /// The next packet: in board order within a millisecond, then the next millisecond.
    ///
    /// # Errors
    /// [`SourceError::Ended`] once the feet's script is over, and in every call after.
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
            if !self.feet.is_empty() {
                self.visited = self.ticks;
            }
            self.board = 0;
            // The time stamp is the millisecond itself, even when catching up: no packet was late on the way.
            self.received = due;
            if let Clock::Host(clock) = &self.clock {
                clock.simulated(due);
            }
        }
        let readings = self.floor.readings().get(self.board).cloned();
        let board = self.board as u16;
        self.board += 1;
        // Sequence numbers wrap as those of real boards do.
        let sequence = self.ticks.wrapping_sub(1) as u32;
        Ok(readings.map(|readings| SensorPacket { board, sequence, received: self.received, readings }))
    }

    fn now(&self) -> Instant {
        match &self.clock {
            Clock::Virtual => self.received,
            Clock::Host(clock) => clock.now(),
        }
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

impl fmt::Debug for SimulatedSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SimulatedSource")
            .field("now", &self.now())
            .field("ticks", &self.ticks)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use glam::Vec2;

    use super::super::floor_clock::CATCH_UP;
    use super::super::floor_clock::tests::ByHand;
    use super::*;
    use crate::SimConfig;
    use underfoot::floor::{Floor, Geometry};
    use underfoot::units::Newtons;

    /// One foot that slides east for this many milliseconds.
    struct Slide(u64);

    impl FootDriver for Slide {
        fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
            feet.clear();
            let position = Vec2::new(0.3 + at.secs() as f32, 0.5);
            feet.push(Foot {
                position,
                heading: 0.0,
                length_m: 0.27,
                force: Newtons(500.0),
                roll: 0.4,
                left: false,
            });
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
            assert_eq!(packet.received, Instant::from_millis(packet.sequence.into()));
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
        // The next millisecond may be due already; 200 of them can't be.
        let early = std::iter::from_fn(|| source.next(Duration::ZERO).ok().flatten()).take(600).count();
        assert!(early < 600, "200 ms of packets at once");
    }

    #[test]
    fn a_reader_that_comes_back_after_seconds_finds_the_floor_as_it_was_left() {
        let host = ByHand::default();
        let floor = Floor::of(Geometry::of_paper_tiles(6, 1).unwrap());
        let floor = SimFloor::new(&floor, SimConfig::default(), 8);
        let mut source =
            SimulatedSource::on(floor, Box::new(Slide(9000)), Pace::RealTime, Arc::new(host.clone()));
        let clock = source.clock();
        let mut next = || source.next(Duration::from_millis(5)).unwrap().unwrap();
        for pause_s in [0.05, 0.3, 1.0, 5.0] {
            let before = next().received;
            host.pass(Duration::from_secs_f64(pause_s));
            let ahead = clock().since(before);
            assert!(ahead <= CATCH_UP, "{ahead:?} have passed for everybody else");
            assert_eq!(next().received, before + Duration::from_millis(1), "and for the floor a millisecond");
            // It catches up, and then runs on with the host.
            (0..100).for_each(|_| drop(next()));
            let (host_began, began) = (host.elapsed(), next().received);
            (0..100).for_each(|_| drop(next()));
            assert_eq!(next().received.since(began), Duration::from_millis(101));
            assert!(host.elapsed().abs_diff(host_began).abs_diff(Duration::from_millis(101)) < CATCH_UP);
        }
    }

    #[test]
    fn a_floor_hurries_to_a_moment_and_keeps_its_pace_from_there() {
        let host = ByHand::default();
        let floor = Floor::of(Geometry::of_paper_tiles(6, 1).unwrap());
        let floor = SimFloor::new(&floor, SimConfig::default(), 8);
        let driver = Box::new(Slide(9000));
        let source = SimulatedSource::on(floor, driver, Pace::RealTime, Arc::new(host.clone()));
        let mut source = source.hurrying_to(Instant::from_millis(3000));
        let clock = source.clock();
        for ms in 0..3000 {
            let packet = source.next(Duration::ZERO).unwrap().unwrap();
            assert_eq!(packet.received, Instant::from_millis(ms));
        }
        assert_eq!((host.elapsed(), clock()), (Duration::ZERO, Instant::from_millis(2999)));
        (0..500).for_each(|_| drop(source.next(Duration::from_millis(5)).unwrap().unwrap()));
        assert!(host.elapsed().abs_diff(Duration::from_millis(500)) < CATCH_UP, "{:?}", host.elapsed());
    }

    /// An empty floor for this many milliseconds, and then one foot.
    struct Late(u64);

    impl FootDriver for Late {
        fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
            let came = at >= Instant::from_millis(self.0);
            if came { Slide(9000).feet(at, feet) } else { true }
        }
    }

    #[test]
    fn an_empty_floor_wakes_seldom_and_loses_no_millisecond() {
        let host = ByHand::default();
        let floor = Floor::of(Geometry::of_paper_tiles(6, 1).unwrap());
        let floor = SimFloor::new(&floor, SimConfig::default(), 8);
        let driver = Box::new(Late(2000));
        let mut source = SimulatedSource::on(floor, driver, Pace::RealTime, Arc::new(host.clone()));
        let mut moments = |milliseconds: usize| {
            let mut seen: Vec<Duration> = Vec::new();
            for _ in 0..milliseconds {
                let packet = std::iter::repeat_with(|| source.next(Duration::from_millis(5)).unwrap());
                assert!(packet.take(9).flatten().next().is_some());
                if seen.last() != Some(&host.elapsed()) {
                    seen.push(host.elapsed());
                }
            }
            seen.len()
        };
        assert!(moments(1000) > 900, "somebody may have just left");
        assert!(moments(900) < 250, "nobody is there");
        moments(200);
        assert!(moments(500) > 450, "a foot is there");
    }

    #[test]
    fn the_truth_is_at_hand() {
        let mut source = source(100, Pace::FreeRunning);
        source.next(Duration::ZERO).unwrap();
        assert_eq!(source.feet().len(), 1);
        assert_eq!(source.floor_mut().geometry().columns(), 6);
    }
}
