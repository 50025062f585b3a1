//! The loop that reads all sensors at a steady rate and sends them.

use core::convert::Infallible;

use cortex_m::peripheral::NVIC;
use embedded_hal::digital::OutputPin;
use embedded_hal_nb::spi::FullDuplex;
use heapless::Vec;
use rp2040_hal::fugit::{ExtU32 as _, ExtU64 as _};
use rp2040_hal::pac::{self, interrupt};
use rp2040_hal::timer::{Alarm, Instant};
use rp2040_hal::{Timer, Watchdog};
use underfoot_packet::write_counts;
use usb_device::bus::UsbBus;

use crate::converters::{SENSORS, STEP_US, STEPS, Scan};
use crate::light::{Light, Status};
use crate::port::{MESSAGE, Port};

/// Scans a second; another number when built with the variable `UNDERFOOT_RATE_HZ`.
const RATE_HZ: u32 = match option_env!("UNDERFOOT_RATE_HZ") {
    Some(text) => decimal(text),
    None => 1000,
};

const _: () = assert!(
    RATE_HZ > 0 && 1000 % RATE_HZ == 0,
    "UNDERFOOT_RATE_HZ divides 1000: packets are numbered by milliseconds"
);

/// Milliseconds between two scans.
const PERIOD_MS: u32 = 1000 / RATE_HZ;

const _: () = assert!(STEPS * STEP_US < 1000 * PERIOD_MS, "a scan ends before the next one begins");

/// Time without a whole scan after which the chip starts anew; by then the program has ended all holds.
const WATCHDOG_MS: u32 = 100;

/// The number of a decimal text; 0 if it is none.
const fn decimal(text: &str) -> u32 {
    match u32::from_str_radix(text, 10) {
        Ok(number) => number,
        Err(_) => 0,
    }
}

#[interrupt]
fn TIMER_IRQ_0() {
    NVIC::mask(pac::Interrupt::TIMER_IRQ_0);
}

#[interrupt]
fn USBCTRL_IRQ() {
    NVIC::mask(pac::Interrupt::USBCTRL_IRQ);
}

/// Sleeps until the timer or the USB device has something to do; returns whether the USB device has. Their interrupts
/// only end the sleep: each masks itself.
fn sleep() -> bool {
    for wanted in [pac::Interrupt::TIMER_IRQ_0, pac::Interrupt::USBCTRL_IRQ] {
        // SAFETY: the handlers share nothing with the loop.
        unsafe { NVIC::unmask(wanted) };
    }
    // A handler that has run since counts as an event.
    cortex_m::asm::wfe();
    !NVIC::is_enabled(pac::Interrupt::USBCTRL_IRQ)
}

/// The instants of scans.
struct Clock {
    timer: Timer,
    due: Instant,
    /// The same in milliseconds since the start of the chip.
    ms: u32,
}

impl Clock {
    fn new(timer: Timer) -> Self {
        // A full millisecond, so that all numbers are those of the timer.
        let ms = timer.get_counter().duration_since_epoch().to_millis() as u32 + PERIOD_MS;
        Self { timer, due: Instant::from_ticks(1000 * u64::from(ms)), ms }
    }

    /// Goes on to the next scan. Those that are too late for it are left out, and so are their numbers.
    fn advance(&mut self) {
        let now = self.timer.get_counter();
        loop {
            self.due += u64::from(PERIOD_MS).millis();
            self.ms = self.ms.wrapping_add(PERIOD_MS);
            if self.due > now {
                return;
            }
        }
    }
}

/// The devices at the board's own pins.
pub(crate) struct Devices<P, A> {
    pub(crate) light: Light<P>,
    pub(crate) timer: Timer,
    pub(crate) alarm: A,
    pub(crate) watchdog: Watchdog,
}

/// Reads the converters and sends their counts to `address`, for ever; without an address it sends nothing.
pub(crate) fn sample<B: UsbBus>(
    mut scan: Scan<impl FullDuplex<u8, Error = Infallible>, impl FullDuplex<u8, Error = Infallible>>,
    mut port: Port<'_, B>,
    address: Option<&str>,
    devices: Devices<impl OutputPin, impl Alarm>,
) -> ! {
    let Devices { mut light, timer, mut alarm, mut watchdog } = devices;
    let mut clock = Clock::new(timer);
    // No alarm of this chip lies too far ahead within an hour.
    let _ = alarm.schedule_at(clock.due);
    alarm.enable_interrupt();
    watchdog.start((1000 * WATCHDOG_MS).micros());
    loop {
        if sleep() {
            port.poll();
        }
        if !alarm.finished() {
            continue;
        }
        alarm.clear_interrupt();
        match scan.step() {
            Ok(Some(counts)) => {
                watchdog.feed();
                let status =
                    address.map_or(Status::NoIdentity, |address| send(&mut port, address, clock.ms, counts));
                light.show(status, clock.ms);
                clock.advance();
                let _ = alarm.schedule_at(clock.due);
            }
            Ok(None) => {
                let _ = alarm.schedule(STEP_US.micros());
            }
            // Nothing but a new start mends the bus, and the watchdog makes it.
            Err(_) => loop {
                cortex_m::asm::wfe();
            },
        }
    }
}

/// Sends one packet; the state of the board after it.
fn send<B: UsbBus>(
    port: &mut Port<'_, B>,
    address: &str,
    number: u32,
    counts: &[Option<u16>; SENSORS],
) -> Status {
    let mut message = Vec::<u8, MESSAGE>::new();
    write_counts(address, number, counts.iter().copied(), &mut message);
    let is_sent = port.has_computer() && port.add(&message);
    if counts.contains(&None) {
        Status::NoConverter
    } else if !port.has_computer() {
        Status::NoComputer
    } else if !is_sent {
        Status::NoReader
    } else {
        Status::Sending
    }
}
