//! Frames of OSC on a stream: SLIP with an END before and after each packet (RFC 1055, OSC 1.1).

const END: u8 = 0xc0;
const ESCAPE: u8 = 0xdb;
const ESCAPED_END: u8 = 0xdc;
const ESCAPED_ESCAPE: u8 = 0xdd;

/// Returns the frame of `packet`.
pub(super) fn framed(packet: &[u8]) -> Vec<u8> {
    let mut frame = Vec::with_capacity(packet.len() + 2);
    frame.push(END);
    for &byte in packet {
        match byte {
            END => frame.extend([ESCAPE, ESCAPED_END]),
            ESCAPE => frame.extend([ESCAPE, ESCAPED_ESCAPE]),
            byte => frame.push(byte),
        }
    }
    frame.push(END);
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_frames_use_are_escaped() {
        assert_eq!(framed(&[1, END, ESCAPE, 2]), [0xc0, 1, 0xdb, 0xdc, 0xdb, 0xdd, 2, 0xc0]);
    }
}
