//! An app in another process: listens to a floor over OSC and answers it.
//!
//! Start `underfoot simulate` and `underfoot run layouts/map.ron` beside it. Any OSC library of any language will do.

use std::error::Error;
use std::io::ErrorKind;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket, OscType, decoder, encoder};

#[path = "held/mod.rs"]
pub mod held;

use held::Held;

fn main() -> Result<(), Box<dyn Error>> {
    let socket = UdpSocket::bind("127.0.0.1:9001")?;
    // Silence ends holds, so the loop must not block.
    socket.set_read_timeout(Some(Duration::from_millis(20)))?;
    println!("Listening on {}; Ctrl-C ends it.", socket.local_addr()?);
    let (mut held, mut before) = (Held::default(), Vec::new());
    loop {
        for line in listen(&socket, "127.0.0.1:9000", &mut held)? {
            println!("{line}");
        }
        let now = held.at(Instant::now());
        if now != before {
            println!("held: {}", now.join(", "));
            before = now;
        }
    }
}

/// Waits for one datagram and returns its reports about controls; resets the zoom at each click on `home`.
///
/// # Errors
/// An error of the socket, or a datagram that is not OSC.
pub fn listen(socket: &UdpSocket, floor: &str, held: &mut Held) -> Result<Vec<String>, Box<dyn Error>> {
    let mut bytes = [0; 1536];
    let length = match socket.recv(&mut bytes) {
        Ok(length) => length,
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
            return Ok(Vec::new());
        }
        Err(error) => return Err(error.into()),
    };
    let mut lines = Vec::new();
    for message in messages(decoder::decode_udp(&bytes[..length])?.1) {
        if held.take(&message, Instant::now()) {
            continue;
        }
        let Some(("", widget)) = message.addr.split_once("/underfoot/widget/") else { continue };
        lines.push(match message.args.first() {
            // Value first, then force, x and y.
            Some(OscType::Float(value)) if widget.ends_with("/changed") => format!("{widget} to {value:.2}"),
            Some(OscType::Int(on)) => format!("{widget} to {}", if *on == 1 { "on" } else { "off" }),
            _ => widget.to_string(),
        });
        if widget == "home/clicked" {
            let reset =
                OscMessage { addr: "/underfoot/widget/zoom/set".into(), args: vec![OscType::Float(0.3)] };
            socket.send_to(&encoder::encode(&OscPacket::Message(reset))?, floor)?;
        }
    }
    Ok(lines)
}

/// The messages of a packet, with bundles unpacked.
fn messages(packet: OscPacket) -> Vec<OscMessage> {
    match packet {
        OscPacket::Message(message) => vec![message],
        OscPacket::Bundle(bundle) => bundle.content.into_iter().flat_map(messages).collect(),
    }
}
