//! The session behind a handle of C, with a descriptor that becomes readable.

use std::ffi::c_int;
#[cfg(unix)]
use std::io::{Read, Write};
#[cfg(unix)]
use std::os::{fd::AsRawFd, unix::net::UnixStream};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use underfoot::recording::Speed;
use underfoot::runtime::{Event, Kind, Session, SessionBuilder};
use underfoot_sim::FloorQuality;

use crate::structs::ID_SIZE;

/// The content of `uf_session`.
#[derive(Debug)]
pub struct UfSession {
    pub(crate) floor: Session,
    /// Whether the caller has taken the last event.
    over: AtomicBool,
    /// Has a byte whenever there may be events.
    #[cfg(unix)]
    woken: UnixStream,
}

impl UfSession {
    pub(crate) fn listen(
        address: &str,
        layout: &str,
        floor_file: Option<&str>,
        every_change: bool,
    ) -> Result<Self, String> {
        let mut builder = Session::listen(address);
        if let Some(path) = floor_file {
            builder = builder.floor_file(path).map_err(|problems| problems.to_string())?;
        }
        let builder = builder.layout_file(layout).map_err(|problems| problems.to_string())?;
        Self::start(builder, every_change)
    }

    /// Plays a recording at `speed` times its original speed; 0 plays it as fast as possible.
    pub(crate) fn replay(recording: &str, speed: f64, every_change: bool) -> Result<Self, String> {
        let speed = match speed {
            0.0 => Speed::Max,
            times if times > 0.0 && times.is_finite() => Speed::Times(times),
            _ => return Err("the speed is a number above 0, or 0 for as fast as can be".to_owned()),
        };
        let builder = Session::replay(recording, speed).map_err(|error| error.to_string())?;
        Self::start(builder, every_change)
    }

    /// Plays a scenario on a simulated floor; without a file the built-in one.
    pub(crate) fn simulated(
        layout: &str,
        scenario: Option<&str>,
        every_change: bool,
    ) -> Result<Self, String> {
        let builder =
            underfoot_sim::session_from_files(layout, scenario.map(Path::new), FloorQuality::default())
                .map_err(|error| error.to_string())?;
        Self::start(builder, every_change)
    }

    fn start(mut builder: SessionBuilder, every_change: bool) -> Result<Self, String> {
        if every_change {
            builder = builder.every_change();
        }
        #[cfg(unix)]
        let woken = {
            let pair = || -> std::io::Result<_> {
                let (mut wake, woken) = UnixStream::pair()?;
                wake.set_nonblocking(true)?;
                woken.set_nonblocking(true)?;
                // A full pipe is readable already.
                Ok((move || drop(wake.write(&[1])), woken))
            };
            let (wake, woken) = pair().map_err(|error| format!("the system gives no pipe: {error}"))?;
            builder = builder.wake(wake);
            woken
        };
        let floor = builder.start().map_err(|error| error.to_string())?;
        if let Some(widget) =
            floor.snapshot().layout.widgets.iter().find(|widget| widget.id.as_str().len() >= ID_SIZE)
        {
            return Err(format!("the id {} is longer than {} bytes", widget.id, ID_SIZE - 1));
        }
        Ok(Self {
            floor,
            over: AtomicBool::new(false),
            #[cfg(unix)]
            woken,
        })
    }

    /// The next event within `patience`. The descriptor is emptied before the last look into the queue, so that each
    /// later event makes it readable again.
    pub(crate) fn next(&self, patience: Duration) -> Option<Event> {
        let event = self.floor.next_event().or_else(|| {
            #[cfg(unix)]
            while (&self.woken).read(&mut [0; 64]).is_ok_and(|count| count == 64) {}
            self.floor.next_event_timeout(patience)
        })?;
        if matches!(event.kind, Kind::Ended(_)) {
            self.over.store(true, Ordering::Release);
        }
        Some(event)
    }

    /// Whether the caller has taken the last event.
    pub(crate) fn is_over(&self) -> bool {
        self.over.load(Ordering::Acquire)
    }

    #[cfg(unix)]
    pub(crate) fn descriptor(&self) -> c_int {
        self.woken.as_raw_fd()
    }

    #[cfg(not(unix))]
    pub(crate) fn descriptor(&self) -> c_int {
        crate::status::BAD_ARGUMENT
    }
}
