//! A cable between a node and its gateway, which can be cut and can delay its bytes.

use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

/// Reaction time of a cut, and of the end of a test.
const LOOK_EVERY: Duration = Duration::from_millis(1);

#[derive(Debug, Default)]
struct State {
    is_cut: AtomicBool,
    is_over: AtomicBool,
    /// Greatest delay, in milliseconds.
    jitter_ms: AtomicU64,
}

/// A relay of a TCP connection. A cut sends no notice: as with a cable, bytes stop arriving, and the waiting ones
/// arrive after the repair.
#[derive(Debug)]
pub(crate) struct Link {
    port: u16,
    state: Arc<State>,
}

impl Link {
    /// A link to `port` of this machine.
    pub(crate) fn to(port: u16) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let own = listener.local_addr().unwrap().port();
        let state = Arc::<State>::default();
        let shared = Arc::clone(&state);
        thread::spawn(move || {
            for near in listener.incoming().map_while(Result::ok) {
                if shared.is_over.load(Ordering::Relaxed) {
                    return;
                }
                let Ok(far) = TcpStream::connect(SocketAddr::from(([127, 0, 0, 1], port))) else { continue };
                for (from, to) in [(&near, &far), (&far, &near)] {
                    let (from, to) = (from.try_clone().unwrap(), to.try_clone().unwrap());
                    let shared = Arc::clone(&shared);
                    thread::spawn(move || carry(from, to, &shared));
                }
            }
        });
        Self { port: own, state }
    }

    /// The endpoint for a node.
    pub(crate) fn endpoint(&self) -> String {
        format!("tcp/127.0.0.1:{}", self.port)
    }

    pub(crate) fn cut(&self) {
        self.state.is_cut.store(true, Ordering::Relaxed);
    }

    pub(crate) fn mend(&self) {
        self.state.is_cut.store(false, Ordering::Relaxed);
    }

    /// Delays everything by 0 to `ms` from now on, in order.
    pub(crate) fn jitter(&self, ms: u64) {
        self.state.jitter_ms.store(ms, Ordering::Relaxed);
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.state.is_over.store(true, Ordering::Relaxed);
        // The listening thread wakes and sees the flag.
        let _ = TcpStream::connect(SocketAddr::from(([127, 0, 0, 1], self.port)));
    }
}

/// Relays bytes until one of the ends closes.
fn carry(mut from: TcpStream, mut to: TcpStream, state: &State) {
    let _ = from.set_read_timeout(Some(LOOK_EVERY));
    let _ = to.set_nodelay(true);
    let mut buffer = vec![0; 65_536];
    // Any sequence without a pattern.
    let mut random = 1_u64;
    while !state.is_over.load(Ordering::Relaxed) {
        if state.is_cut.load(Ordering::Relaxed) {
            thread::sleep(LOOK_EVERY);
            continue;
        }
        match from.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => {
                let most = state.jitter_ms.load(Ordering::Relaxed);
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                if most > 0 {
                    thread::sleep(Duration::from_micros((random >> 33) % (most * 1000)));
                }
                // Bytes read at the time of the cut are delivered after the repair.
                while state.is_cut.load(Ordering::Relaxed) && !state.is_over.load(Ordering::Relaxed) {
                    thread::sleep(LOOK_EVERY);
                }
                if to.write_all(&buffer[..count]).is_err() {
                    break;
                }
            }
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(_) => break,
        }
    }
    let _ = to.shutdown(std::net::Shutdown::Both);
    let _ = from.shutdown(std::net::Shutdown::Both);
}
