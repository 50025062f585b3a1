//! Messages as OSC over UDP, or over TCP in SLIP frames.

use std::io::{self, ErrorKind, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpStream, ToSocketAddrs, UdpSocket};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::Builder;
use std::time::Duration;

use rosc::{OscMessage, OscPacket, OscType, encoder};
use underfoot::messages::{Act, Holdable, OscTarget, OscTransport, OscValue};
use underfoot::wire::write_slip;

use super::outlet::{Outlet, OutletError};

/// Longest wait for a connection, on a thread of its own.
const CONNECT: Duration = Duration::from_secs(2);

/// A program that receives OSC.
#[derive(Debug)]
pub(super) struct OscOutlet {
    address: String,
    way: OscWay,
}

/// The protocol below OSC.
#[derive(Debug)]
enum OscWay {
    /// A name that is being looked up, or a connection that is being made.
    Opening(Receiver<io::Result<OscWay>>),
    Udp(UdpSocket),
    Tcp(TcpStream),
    /// It could not be opened, for this reason.
    Failed(String),
}

impl OscOutlet {
    /// Opens the way to `target`. Names and connections take their time on a thread of their own.
    pub(super) fn open(target: &OscTarget) -> Result<Self, OutletError> {
        let gone = |error: io::Error| OutletError::Gone(format!("{}: {error}", target.address));
        let way = match (target.address.parse(), target.over) {
            (Ok(address), OscTransport::Udp) => datagrams(address),
            _ => open_meanwhile(target.clone()),
        };
        Ok(Self { address: target.address.clone(), way: way.map_err(gone)? })
    }

    fn send(&mut self, address: &str, values: &[OscValue]) -> Result<(), OutletError> {
        let packet = encoded(address, values)?;
        self.settle();
        let gone = |error: io::Error| OutletError::Gone(format!("{}: {error}", self.address));
        match &mut self.way {
            // A receiver on this computer that is not there answers so at the next message.
            OscWay::Udp(socket) => match socket.send(&packet) {
                Err(error) if error.kind() == ErrorKind::ConnectionRefused => {
                    socket.send(&packet).map(drop).map_err(gone)
                }
                sent => sent.map(drop).map_err(gone),
            },
            OscWay::Opening(_) => Err(OutletError::Refused(format!("{} is not connected yet", self.address))),
            OscWay::Failed(reason) => Err(OutletError::Gone(reason.clone())),
            // A stream that takes only a part of a frame is of no use any more.
            OscWay::Tcp(stream) => {
                let mut frame = Vec::with_capacity(packet.len() + 2);
                write_slip(&packet, &mut frame);
                stream.write_all(&frame).map_err(gone)
            }
        }
    }

    /// Uses the way that has been opened meanwhile.
    fn settle(&mut self) {
        let OscWay::Opening(opened) = &self.way else { return };
        self.way = match opened.try_recv() {
            Ok(Ok(way)) => way,
            Ok(Err(error)) => OscWay::Failed(format!("{}: {error}", self.address)),
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => OscWay::Failed(format!("{}: no connection", self.address)),
        };
    }
}

impl Outlet for OscOutlet {
    fn is_opening(&mut self) -> bool {
        self.settle();
        matches!(self.way, OscWay::Opening(_))
    }

    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Osc(address, values) => self.send(address, values),
            Act::Down(Holdable::Osc(address), _) => self.send(address, &[OscValue::Int(1)]),
            Act::Up(Holdable::Osc(address)) => self.send(address, &[OscValue::Int(0)]),
            _ => Err(OutletError::Refused("a receiver of OSC has neither keys nor a pointer".into())),
        }
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        match what {
            Holdable::Osc(address) => self.send(address, &[OscValue::Int(0)]),
            _ => Ok(()),
        }
    }
}

/// Looks the name of `target` up and connects, on a thread of its own.
fn open_meanwhile(target: OscTarget) -> io::Result<OscWay> {
    let (done, opened) = channel();
    let open = move || {
        let way = looked_up(&target.address).and_then(|address| match target.over {
            OscTransport::Udp => datagrams(address),
            OscTransport::Tcp => stream(address),
        });
        // The outlet may be gone.
        let _ = done.send(way);
    };
    Builder::new().name("osc connect".into()).spawn(open)?;
    Ok(OscWay::Opening(opened))
}

/// The first address of a name; an IPv4 one if there is one.
fn looked_up(name: &str) -> io::Result<SocketAddr> {
    let found: Vec<SocketAddr> = name.to_socket_addrs()?.collect();
    let first = found.iter().find(|address| address.is_ipv4()).or(found.first()).copied();
    first.ok_or_else(|| io::Error::other("it has no address"))
}

fn datagrams(address: SocketAddr) -> io::Result<OscWay> {
    let any: IpAddr =
        if address.is_ipv4() { Ipv4Addr::UNSPECIFIED.into() } else { Ipv6Addr::UNSPECIFIED.into() };
    let socket = UdpSocket::bind((any, 0))?;
    socket.set_nonblocking(true)?;
    socket.set_broadcast(true)?;
    socket.connect(address)?;
    Ok(OscWay::Udp(socket))
}

fn stream(address: SocketAddr) -> io::Result<OscWay> {
    let stream = TcpStream::connect_timeout(&address, CONNECT)?;
    stream.set_nodelay(true)?;
    stream.set_nonblocking(true)?;
    Ok(OscWay::Tcp(stream))
}

fn encoded(address: &str, values: &[OscValue]) -> Result<Vec<u8>, OutletError> {
    let arguments = values.iter().map(|value| match value {
        OscValue::Int(number) => OscType::Int(*number),
        OscValue::Float(number) => OscType::Float(*number),
        OscValue::Text(text) => OscType::String(text.clone()),
    });
    let message = OscMessage { addr: address.to_owned(), args: arguments.collect() };
    encoder::encode(&OscPacket::Message(message)).map_err(|error| OutletError::Refused(error.to_string()))
}
