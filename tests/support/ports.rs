//! Ports for servers that a test starts.

use std::net::{TcpListener, UdpSocket};
use std::sync::atomic::{AtomicU32, Ordering};

/// A port that is free for UDP and TCP, and that no program takes by chance before its use: it lies below those that
/// the system assigns by itself (32768 on Linux), and each test process begins its search at another port.
pub(crate) fn free_port() -> u16 {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    (0..20_000)
        .map(|_| std::process::id() * 61 + NEXT.fetch_add(1, Ordering::Relaxed))
        .map(|number| 10_000 + (number % 20_000) as u16)
        .find(|port| {
            UdpSocket::bind(("127.0.0.1", *port)).is_ok() && TcpListener::bind(("127.0.0.1", *port)).is_ok()
        })
        .expect("one of 20,000 ports is free")
}
