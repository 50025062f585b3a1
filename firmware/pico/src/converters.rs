//! Four MCP3208 converters of eight channels each, two on either SPI bus.
//!
//! A scan makes steps. Each step takes the results of the step before, and starts the next conversion on both buses; the
//! buses then work alone, and the processor may sleep.

use core::convert::Infallible;

use embedded_hal::digital::OutputPin;
use embedded_hal_nb::spi::FullDuplex;
use rp2040_hal::gpio::{DynPinId, FunctionSioOutput, Pin, PullDown};

/// Channels of one converter.
const CHANNELS: usize = 8;

/// Converters on one bus.
const ON_BUS: usize = 2;

/// Conversions of one bus in a scan.
const ON_EACH_BUS: usize = ON_BUS * CHANNELS;

/// Channels of all converters.
pub(crate) const SENSORS: usize = 2 * ON_EACH_BUS;

/// Steps of a scan: the last one only takes results.
pub(crate) const STEPS: u32 = ON_EACH_BUS as u32 + 1;

/// The clock of both buses: the most that an MCP3208 takes at 2.7 V, so that 3.3 V leave a margin.
pub(crate) const CLOCK_HZ: u32 = 1_000_000;

/// Time between two steps: the 24 clocks of a conversion, up to two between its bytes, and a margin.
pub(crate) const STEP_US: u32 = 32;

/// Cycles of the processor, at 125 MHz, for which a converter is not selected between two conversions: 500 ns.
const UNSELECTED: u32 = 63;

/// The output that selects one converter while it is low.
pub(crate) type Select = Pin<DynPinId, FunctionSioOutput, PullDown>;

/// One SPI bus with its converters.
pub(crate) struct Bus<S> {
    spi: S,
    selects: [Select; ON_BUS],
}

/// The bus did not clock out a conversion in its time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stalled;

impl<S: FullDuplex<u8, Error = Infallible>> Bus<S> {
    pub(crate) fn new(spi: S, selects: [Select; ON_BUS]) -> Self {
        Self { spi, selects }
    }

    /// Starts the conversion of channel `at` of this bus: a start bit, a bit for single-ended inputs, and three bits of the
    /// channel; then 12 bits of the result follow a zero.
    fn start(&mut self, at: usize) -> Result<(), Stalled> {
        let channel = (at % CHANNELS) as u8;
        if let Some(select) = self.selects.get_mut(at / CHANNELS) {
            let Ok(()) = select.set_low();
        }
        for byte in [0b110 | channel >> 2, channel << 6, 0] {
            self.spi.write(byte).map_err(|_| Stalled)?;
        }
        Ok(())
    }

    /// Ends the conversion of channel `at`: its result, or `None` if the line was high instead of the zero before it, as
    /// it is without a converter.
    fn end(&mut self, at: usize) -> Result<Option<u16>, Stalled> {
        if let Some(select) = self.selects.get_mut(at / CHANNELS) {
            let Ok(()) = select.set_high();
        }
        let mut take = || self.spi.read().map_err(|_| Stalled);
        let [_, high, low] = [take()?, take()?, take()?];
        let is_there = high & 0x10 == 0;
        Ok(is_there.then(|| whole_range(u16::from_be_bytes([high & 0xF, low]))))
    }
}

/// Spreads 12 bits over the 16 of a packet, so that no floor file has to state their range.
const fn whole_range(count: u16) -> u16 {
    count << 4 | count >> 8
}

/// Reads all converters, step by step.
pub(crate) struct Scan<A, B> {
    first: Bus<A>,
    second: Bus<B>,
    /// The conversion of each bus that the next step starts.
    next: usize,
    counts: [Option<u16>; SENSORS],
}

impl<A: FullDuplex<u8, Error = Infallible>, B: FullDuplex<u8, Error = Infallible>> Scan<A, B> {
    pub(crate) fn new(first: Bus<A>, second: Bus<B>) -> Self {
        Self { first, second, next: 0, counts: [None; SENSORS] }
    }

    /// Makes the next step. Returns the counts of all channels, converter by converter, when it was the last of a scan.
    pub(crate) fn step(&mut self) -> Result<Option<&[Option<u16>; SENSORS]>, Stalled> {
        if let Some(before) = self.next.checked_sub(1) {
            let results = [self.first.end(before)?, self.second.end(before)?];
            for (bus, result) in results.into_iter().enumerate() {
                if let Some(count) = self.counts.get_mut(bus * ON_EACH_BUS + before) {
                    *count = result;
                }
            }
        }
        if self.next == ON_EACH_BUS {
            self.next = 0;
            return Ok(Some(&self.counts));
        }
        cortex_m::asm::delay(UNSELECTED);
        self.first.start(self.next)?;
        self.second.start(self.next)?;
        self.next += 1;
        Ok(None)
    }
}
