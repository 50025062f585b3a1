//! Messages as OSC over UDP, or over TCP in SLIP frames.

use std::io::{ErrorKind, Write};
use std::net::{SocketAddr, TcpStream, ToSocketAddrs, UdpSocket};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::Builder;
use std::time::Duration;

use rosc::{OscMessage, OscPacket, OscType, encoder};
use underfoot::messages::{Act, Holdable, OscTarget, OscValue, Transport};

use super::outlet::{Outlet, OutletError};
use super::slip::framed;

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
    Udp(UdpSocket),
    /// A connection that is being made.
    Connecting(Receiver<std::io::Result<TcpStream>>),
    Tcp(TcpStream),
}

impl OscOutlet {
    /// Opens the way to `target`; a TCP connection is made meanwhile.
    pub(super) fn open(target: &OscTarget) -> Result<Self, OutletError> {
        let gone = |error: std::io::Error| OutletError::Gone(format!("{}: {error}", target.address));
        let found: Vec<SocketAddr> = target.address.to_socket_addrs().map_err(gone)?.collect();
        let first = found.iter().find(|address| address.is_ipv4()).or(found.first()).copied();
        let Some(address) = first else {
            return Err(OutletError::Gone(format!("{} has no address", target.address)));
        };
        let way = match target.over {
            Transport::Udp => {
                let any: SocketAddr = if address.is_ipv4() {
                    (std::net::Ipv4Addr::UNSPECIFIED, 0).into()
                } else {
                    (std::net::Ipv6Addr::UNSPECIFIED, 0).into()
                };
                let socket = UdpSocket::bind(any).map_err(gone)?;
                socket.set_nonblocking(true).map_err(gone)?;
                socket.set_broadcast(true).map_err(gone)?;
                socket.connect(address).map_err(gone)?;
                OscWay::Udp(socket)
            }
            Transport::Tcp => OscWay::Connecting(connect(address).map_err(gone)?),
        };
        Ok(Self { address: target.address.clone(), way })
    }

    fn send(&mut self, address: &str, values: &[OscValue]) -> Result<(), OutletError> {
        let packet = encoded(address, values)?;
        self.settle()?;
        let gone = |error: std::io::Error| OutletError::Gone(format!("{}: {error}", self.address));
        match &mut self.way {
            // A receiver on this computer that is not there answers so at the next message.
            OscWay::Udp(socket) => match socket.send(&packet) {
                Err(error) if error.kind() == ErrorKind::ConnectionRefused => {
                    socket.send(&packet).map(drop).map_err(gone)
                }
                sent => sent.map(drop).map_err(gone),
            },
            OscWay::Connecting(_) => {
                Err(OutletError::Refused(format!("{} is not connected yet", self.address)))
            }
            // A stream that takes only a part of a frame is of no use any more.
            OscWay::Tcp(stream) => stream.write_all(&framed(&packet)).map_err(gone),
        }
    }

    /// Uses a connection that has been made.
    fn settle(&mut self) -> Result<(), OutletError> {
        let OscWay::Connecting(made) = &self.way else { return Ok(()) };
        match made.try_recv() {
            Ok(Ok(stream)) => {
                self.way = OscWay::Tcp(stream);
                Ok(())
            }
            Ok(Err(error)) => Err(OutletError::Gone(format!("{}: {error}", self.address))),
            Err(TryRecvError::Empty) => Ok(()),
            Err(TryRecvError::Disconnected) => {
                Err(OutletError::Gone(format!("{}: no connection", self.address)))
            }
        }
    }
}

impl Outlet for OscOutlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Osc(address, values) => self.send(address, values),
            Act::Down(Holdable::Osc(address)) => self.send(address, &[OscValue::Int(1)]),
            Act::Up(Holdable::Osc(address)) => self.send(address, &[OscValue::Int(0)]),
            _ => Err(OutletError::Refused("a receiver of OSC has neither keys nor a pointer".into())),
        }
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        match what {
            Holdable::Osc(address) => self.send(address, &[OscValue::Int(0)]),
            Holdable::Key(_) | Holdable::Button(_) => Ok(()),
        }
    }
}

/// Connects on a thread of its own, since an absent computer lets a caller wait.
fn connect(address: SocketAddr) -> std::io::Result<Receiver<std::io::Result<TcpStream>>> {
    let (done, made) = channel();
    let connect = move || {
        let stream = TcpStream::connect_timeout(&address, CONNECT).and_then(|stream| {
            stream.set_nodelay(true)?;
            stream.set_nonblocking(true)?;
            Ok(stream)
        });
        // The outlet may be gone.
        let _ = done.send(stream);
    };
    Builder::new().name("osc connect".into()).spawn(connect)?;
    Ok(made)
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
