//! The serial port over USB: whole frames in, packets of USB out.

use heapless::Vec;
use underfoot_packet::write_slip;
use usb_device::LangID;
use usb_device::bus::{UsbBus, UsbBusAllocator};
use usb_device::device::{StringDescriptors, UsbDevice, UsbDeviceBuilder, UsbDeviceState, UsbVidPid};
use usbd_serial::{CdcAcmClass, USB_CLASS_CDC};

/// Maximum length of a message with the readings of one instant: 24 bytes of address, 36 of type tags, 132 of numbers.
pub(crate) const MESSAGE: usize = 24 + 36 + 132;

/// Maximum length of its SLIP frame: all bytes escaped, and an END on both sides.
const FRAME: usize = 2 * MESSAGE + 2;

/// Bytes that wait for the computer: some ten milliseconds. Older readings are of no use.
const WAITING: usize = 2048;

/// The longest packet that needs no empty one behind it.
const PACKET: usize = 63;

/// Numbers that the makers of V-USB share among serial ports.
const SHARED: UsbVidPid = UsbVidPid(0x16C0, 0x27DD);

/// The port and the bytes that wait for the computer.
pub(crate) struct Port<'a, B: UsbBus> {
    device: UsbDevice<'a, B>,
    class: CdcAcmClass<'a, B>,
    waiting: Vec<u8, WAITING>,
    /// Number of bytes of `waiting` that have left.
    sent: usize,
    has_reader: bool,
}

impl<'a, B: UsbBus> Port<'a, B> {
    /// A port of the USB device with this serial number; `None` if its descriptors are too long.
    pub(crate) fn new(bus: &'a UsbBusAllocator<B>, serial_number: &'a str) -> Option<Self> {
        let class = CdcAcmClass::new(bus, 64);
        let texts = StringDescriptors::new(LangID::EN_US)
            .manufacturer("underfoot")
            .product("underfoot board")
            .serial_number(serial_number);
        let device = UsbDeviceBuilder::new(bus, SHARED)
            .strings(&[texts])
            .ok()?
            .device_class(USB_CLASS_CDC)
            // One packet holds all descriptors.
            .max_packet_size_0(64)
            .ok()?
            .build();
        Some(Self { device, class, waiting: Vec::new(), sent: 0, has_reader: false })
    }

    /// Answers the computer, and sends bytes that wait.
    pub(crate) fn poll(&mut self) {
        if self.device.poll(&mut [&mut self.class]) {
            // Nothing is expected, and an unread packet would block the port.
            let mut unread = [0; 64];
            while self.class.read_packet(&mut unread).is_ok() {}
        }
        let has_reader = self.class.dtr();
        if has_reader && !self.has_reader {
            // A program that opens the port wants no old readings.
            self.waiting.clear();
            self.sent = 0;
        }
        self.has_reader = has_reader;
        self.send();
    }

    /// Whether a computer has set up the device.
    pub(crate) fn has_computer(&self) -> bool {
        self.device.state() == UsbDeviceState::Configured
    }

    /// Adds `message` as a SLIP frame. False if it may not fit, and all of it is dropped: its number will be missing.
    pub(crate) fn add(&mut self, message: &[u8]) -> bool {
        if self.waiting.len() + FRAME > WAITING {
            self.waiting.copy_within(self.sent.., 0);
            self.waiting.truncate(self.waiting.len() - self.sent);
            self.sent = 0;
        }
        let is_fit = self.waiting.len() + FRAME <= WAITING;
        if is_fit {
            write_slip(message, &mut self.waiting);
        }
        self.send();
        is_fit
    }

    /// Passes the next bytes to the device, if it can take them.
    fn send(&mut self) {
        let waiting = self.waiting.get(self.sent..).unwrap_or_default();
        let Some(packet) = waiting.chunks(PACKET).next() else { return };
        if let Ok(sent) = self.class.write_packet(packet) {
            self.sent += sent;
        }
        if self.sent == self.waiting.len() {
            self.waiting.clear();
            self.sent = 0;
        }
    }
}
