//! SLIP frames (RFC 1055), as OSC 1.1 uses them on serial lines.

/// The byte on both sides of a frame.
pub const END: u8 = 0xC0;

/// The byte before the second half of an escaped one.
pub const ESC: u8 = 0xDB;

/// The second half of an escaped [`END`].
pub const ESC_END: u8 = 0xDC;

/// The second half of an escaped [`ESC`].
pub const ESC_ESC: u8 = 0xDD;

/// Appends `datagram` to `out` as one SLIP frame with an END on both sides, as OSC 1.1 recommends.
pub fn write_slip(datagram: &[u8], out: &mut impl Extend<u8>) {
    out.extend([END]);
    for byte in datagram {
        match *byte {
            END => out.extend([ESC, ESC_END]),
            ESC => out.extend([ESC, ESC_ESC]),
            byte => out.extend([byte]),
        }
    }
    out.extend([END]);
}
