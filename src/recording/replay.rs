//! A recording as a source.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant as HostInstant};

use super::entry::Entry;
use super::reader::{Messages, Part};
use super::recorder::read_layout;
use super::transport::Transport;
use crate::floor::Geometry;
use crate::layout::Layout;
use crate::source::{SensorSource, SourceError};
use crate::units::{HostClock, Instant};
use crate::wire::{Request, SensorPacket};

/// The longest wait for what comes next: where a recording has a gap, nobody waits for hours.
const LONGEST_WAIT: Duration = Duration::from_secs(1);

/// The longest wait at one stretch: whoever leads the replay is heard in between.
const A_WHILE: Duration = Duration::from_millis(10);

/// How fast a recording is played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// So many seconds a second; what is not above 0 counts as [`Speed::Max`].
    Times(f64),
    /// As fast as can be.
    Max,
}

/// How far a replay has come.
#[derive(Debug, Default)]
pub struct Progress {
    now_us: AtomicU64,
    packets: AtomicU64,
    gaps: AtomicU64,
    is_over: AtomicBool,
    broken: Mutex<Option<String>>,
}

impl Progress {
    /// The recording's time.
    #[must_use]
    pub fn now(&self) -> Instant {
        Instant::from_micros(self.now_us.load(Ordering::Relaxed))
    }

    /// Packets played.
    #[must_use]
    pub fn packets(&self) -> u64 {
        self.packets.load(Ordering::Relaxed)
    }

    /// What was left out of the recording so far; events after it may be others than at the time.
    #[must_use]
    pub fn left_out(&self) -> u64 {
        self.gaps.load(Ordering::Relaxed)
    }

    /// Whether everything there is has been played.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    /// Why the recording breaks off, if that has been reached.
    #[must_use]
    pub fn broken(&self) -> Option<String> {
        self.broken.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Gives what a [`super::TappedSource`] gave, with the same times.
#[derive(Debug)]
pub struct ReplaySource {
    messages: Messages,
    geometry: Geometry,
    ahead: Option<(Instant, Entry)>,
    now: Instant,
    transport: Arc<Transport>,
    /// What was asked of the transport, and the recording's time and the host's since then.
    begun: Option<(u64, Instant, HostInstant)>,
    progress: Arc<Progress>,
}

impl ReplaySource {
    pub(super) fn new(messages: Messages, geometry: Geometry, speed: Speed) -> Self {
        let (transport, progress) = (Arc::new(Transport::new(speed)), Arc::default());
        let (now, begun) = (Instant::START, None);
        let mut source = Self { messages, geometry, ahead: None, now, transport, begun, progress };
        source.advance();
        source.now = source.ahead.as_ref().map_or(Instant::START, |(taken, _)| *taken);
        source
    }

    /// How far it has come, to look at from elsewhere.
    #[must_use]
    pub fn progress(&self) -> Arc<Progress> {
        Arc::clone(&self.progress)
    }

    /// What leads it, to be worked from elsewhere.
    #[must_use]
    pub fn transport(&self) -> Arc<Transport> {
        Arc::clone(&self.transport)
    }

    /// The clock of the recording, which stands still between packets.
    #[must_use]
    pub fn clock(&self) -> HostClock {
        let progress = self.progress();
        Arc::new(move || progress.now())
    }

    /// Gives the next entry and reads the one after it.
    fn advance(&mut self) -> Option<(Instant, Entry)> {
        let next = self.ahead.take();
        if let Some((taken, _)) = &next {
            self.now = self.now.max(*taken);
            self.progress.now_us.store(self.now.micros(), Ordering::Relaxed);
        }
        while self.ahead.is_none() && !self.progress.is_over() {
            match self.messages.next_part() {
                Part::Entry(_, Entry::Gap(entries)) => {
                    self.progress.gaps.fetch_add(entries, Ordering::Relaxed);
                }
                Part::Entry(taken, entry) => self.ahead = Some((taken, entry)),
                Part::Whole => self.progress.is_over.store(true, Ordering::Relaxed),
                Part::Broken(why) => {
                    let why = format!("{}: {why}", self.messages.path().display());
                    *self.progress.broken.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
                    self.progress.is_over.store(true, Ordering::Relaxed);
                }
                Part::Event(_) | Part::Attachment(..) | Part::Metadata { .. } => {}
            }
        }
        next
    }

    /// Waits until it is time for what is ahead, or for a while; whether it is time.
    fn wait(&mut self) -> bool {
        let Some((taken, entry)) = &self.ahead else { return !self.rests_at_the_end() };
        let taken = *taken;
        if matches!(entry, Entry::End) && self.rests_at_the_end() {
            return false;
        }
        if self.transport.hurries(taken) {
            self.begun = None;
            return true;
        }
        if self.transport.is_paused() {
            self.begun = None;
            thread::sleep(A_WHILE);
            return false;
        }
        let Speed::Times(speed) = self.transport.speed() else { return true };
        let changes = self.transport.changes();
        let begun = self.begun.filter(|(of, ..)| *of == changes);
        // What was ahead at a change is waited for as long as was left of it.
        let (_, first, host) = *self.begun.insert(begun.unwrap_or((changes, self.now, HostInstant::now())));
        let Ok(due) = Duration::try_from_secs_f64(taken.since(first).as_secs_f64() / speed) else {
            return true;
        };
        let wait = due.saturating_sub(host.elapsed());
        if wait > LONGEST_WAIT {
            // A gap: it goes on a second later.
            let left_out = (wait - LONGEST_WAIT).mul_f64(speed);
            self.begun = Some((changes, first + left_out, host));
        }
        thread::sleep(wait.min(A_WHILE));
        wait <= A_WHILE
    }

    /// Stands still for a while where the recording ends, if it is to stay there.
    fn rests_at_the_end(&self) -> bool {
        let stays = self.transport.stays();
        if stays {
            self.progress.is_over.store(true, Ordering::Relaxed);
            thread::sleep(A_WHILE);
        }
        stays
    }
}

impl SensorSource for ReplaySource {
    /// The next packet, or `None` where none came at the time, or where it is not time for what comes next; waits as
    /// its speed says, whatever `patience` is.
    ///
    /// # Errors
    /// [`SourceError::Ended`] at the end of the recording or where it breaks off, and ever after.
    fn next(&mut self, _patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        loop {
            if !self.wait() {
                return Ok(None);
            }
            match self.advance() {
                Some((_, Entry::Packet(packet))) => {
                    self.progress.packets.fetch_add(1, Ordering::Relaxed);
                    return Ok(Some(packet));
                }
                Some((_, Entry::Silence)) => return Ok(None),
                Some((_, Entry::End)) | None => return Err(SourceError::Ended),
                // Nobody took them.
                Some((_, Entry::Request(_) | Entry::Layout(_) | Entry::Gap(_))) => {}
            }
        }
    }

    fn now(&self) -> Instant {
        self.now
    }

    fn take_request(&mut self) -> Option<Request> {
        self.ahead.as_ref().filter(|(_, entry)| matches!(entry, Entry::Request(_)))?;
        match self.advance()? {
            (_, Entry::Request(request)) => Some(Request { sender: None, ..request }),
            _ => None,
        }
    }

    fn take_layout(&mut self) -> Option<Layout> {
        self.ahead.as_ref().filter(|(_, entry)| matches!(entry, Entry::Layout(_)))?;
        match self.advance()? {
            (_, Entry::Layout(text)) => read_layout(&text, &self.geometry)
                .inspect_err(|problems| tracing::warn!("a recorded layout can't be read: {problems}"))
                .ok(),
            _ => None,
        }
    }
}
