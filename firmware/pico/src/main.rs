//! Firmware of a Raspberry Pi Pico that reads 32 force sensors and sends them over USB.
//!
//! A thousand times a second, it reads four MCP3208 converters, and sends one packet: an OSC message in a SLIP frame,
//! numbered by the milliseconds of its own clock. `docs/build-a-floor.md` has the wiring.

#![no_std]
#![no_main]

mod converters;
mod identity;
mod light;
mod port;
mod sampling;

use core::fmt::Write as _;

use embedded_hal::digital::OutputPin as _;
use embedded_hal::spi::MODE_0;
use heapless::String;
use panic_halt as _;
use rp2040_hal::clocks::{Clock as _, init_clocks_and_plls};
use rp2040_hal::fugit::RateExtU32 as _;
use rp2040_hal::gpio::FunctionSioOutput;
use rp2040_hal::gpio::{FunctionNull, FunctionSpi, Pin, PinId, Pins, PullDown, PullUp, ValidFunction};
use rp2040_hal::pac;
use rp2040_hal::usb::UsbBus;
use rp2040_hal::{Sio, Spi, Timer, Watchdog};
use underfoot_packet::BoardAddress;
use usb_device::bus::UsbBusAllocator;

use converters::{Bus, CLOCK_HZ, Scan, Select};
use identity::Identity;
use light::Light;
use port::Port;
use sampling::{Devices, sample};

/// The second stage of the boot loader, for the flash of a Pico.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT_LOADER: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;

/// The crystal of a Pico.
const CRYSTAL_HZ: u32 = 12_000_000;

/// Length of the texts with the board's number.
const TEXT: usize = 24;

/// A pin after a reset.
type Unused<I> = Pin<I, FunctionNull, PullDown>;

/// An output that selects a converter, and selects none yet.
fn select<I: PinId + ValidFunction<FunctionSioOutput>>(pin: Unused<I>) -> Select {
    let mut select = pin.into_push_pull_output().into_dyn_pin();
    let Ok(()) = select.set_high();
    select
}

/// A line of an SPI bus.
fn line<I: PinId + ValidFunction<FunctionSpi>>(pin: Unused<I>) -> Pin<I, FunctionSpi, PullDown> {
    pin.into_function()
}

/// The line from the converters, which is high without one.
fn answer<I: PinId + ValidFunction<FunctionSpi>>(pin: Unused<I>) -> Pin<I, FunctionSpi, PullUp> {
    pin.into_function().into_pull_type()
}

#[rp2040_hal::entry]
fn main() -> ! {
    run();
    // A board that cannot start stays dark.
    loop {
        cortex_m::asm::wfe();
    }
}

/// Sets up the chip and samples for ever; `None` if a part of it is missing.
fn run() -> Option<()> {
    let mut chip = pac::Peripherals::take()?;
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let resets = &mut chip.RESETS;
    let clocks = init_clocks_and_plls(
        CRYSTAL_HZ,
        chip.XOSC,
        chip.CLOCKS,
        chip.PLL_SYS,
        chip.PLL_USB,
        resets,
        &mut watchdog,
    )
    .ok()?;
    let mut timer = Timer::new(chip.TIMER, resets, &clocks);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, Sio::new(chip.SIO).gpio_bank0, resets);

    let clock = clocks.peripheral_clock.freq();
    let first = Spi::<_, _, _, 8>::new(chip.SPI0, (line(pins.gpio3), answer(pins.gpio4), line(pins.gpio2)));
    let first = first.init(resets, clock, CLOCK_HZ.Hz(), MODE_0);
    let second =
        Spi::<_, _, _, 8>::new(chip.SPI1, (line(pins.gpio11), answer(pins.gpio12), line(pins.gpio10)));
    let second = second.init(resets, clock, CLOCK_HZ.Hz(), MODE_0);
    let scan = Scan::new(
        Bus::new(first, [select(pins.gpio5), select(pins.gpio6)]),
        Bus::new(second, [select(pins.gpio13), select(pins.gpio14)]),
    );

    let identity = Identity::read();
    let number = identity.map_or(0, |identity| identity.0);
    let mut serial_number = String::<TEXT>::new();
    write!(serial_number, "underfoot-{number}").ok()?;
    let mut address = String::<TEXT>::new();
    write!(address, "{}", BoardAddress(number.into())).ok()?;
    let bus = UsbBus::new(chip.USBCTRL_REGS, chip.USBCTRL_DPRAM, clocks.usb_clock, true, resets);
    let bus = UsbBusAllocator::new(bus);
    let port = Port::new(&bus, &serial_number)?;

    let alarm = timer.alarm_0()?;
    let light = Light(pins.gpio25.into_push_pull_output());
    let devices = Devices { light, timer, alarm, watchdog };
    sample(scan, port, identity.is_some().then_some(address.as_str()), devices)
}
