//! A server's floor behind the window: sensed again here from the packets of its boards. This program has no outputs
//! then.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
use std::thread::{self, Builder};
use std::time::{Duration, Instant as HostInstant};

use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::mirror::{Greeting, MirrorLink, MirrorNews, MirrorSource};
use underfoot::runtime::Session;
use underfoot::serve::FloorCommand;
use underfoot::source::{PacketTap, TappedPackets};
use underfoot_window::preview::{
    EventNews, LayoutCause, LayoutNews, PreviewCommand, ProgramChannels, ServedDesk, ServerFeed, ToWindow,
    announced,
};

use super::super::failure::Failure;
use super::super::layout_args::LayoutArgs;
use super::super::watch::FileWatch;
use super::LOOK;
use super::commands::keep_floor;
use super::stop_and_wait;

/// Maximum time for the server's greeting; without it, the window does not open.
const PATIENCE: Duration = Duration::from_secs(3);

/// A server's floor that is shown; ends when the window closes its channels.
pub(super) struct Joined {
    pub(super) floor: Floor,
    pub(super) layout: Arc<Layout>,
    pub(super) layout_text: String,
    pub(super) snapshots: triple_buffer::Output<Snapshot>,
    /// The packets of the boards.
    pub(super) packets: TappedPackets,
    /// Reports the state of the server to the window.
    pub(super) feed: ServerFeed,
}

impl Joined {
    /// Joins the server that serves web pages at `address`; `files` belong to the layout that is designed here.
    pub(super) fn start(
        address: SocketAddr,
        window: ProgramChannels,
        files: LayoutArgs,
    ) -> Result<Self, Failure> {
        let failed = |error: std::io::Error| Failure::Other(format!("can't join {address}: {error}"));
        let (link, news) = MirrorLink::start(address).map_err(failed)?;
        let (greeting, source) = first(&news, address)?;
        let (tap, packets) = TappedPackets::new();
        let run = Run::begin(&greeting, source, &window, &tap)?;
        let desk = ServedDesk::new(&greeting, address.to_string(), &window, Duration::ZERO);
        let (feed, (input, snapshots)) = (desk.feed(), triple_buffer::triple_buffer(&Snapshot::default()));
        let (floor, layout_text) = (greeting.floor.clone(), greeting.layout_text.clone());
        let layout = Arc::new(greeting.layout.clone());
        let mut served = ServedFloor {
            link,
            news,
            run,
            tap,
            window,
            desk,
            snapshots: input,
            begun: HostInstant::now(),
            watch: None,
            files,
        };
        served.watch = served.watch();
        Builder::new().name("joined".into()).spawn(move || served.run()).map_err(failed)?;
        Ok(Self { floor, layout, layout_text, snapshots, packets, feed })
    }
}

/// The first greeting, which the window needs before it can open.
fn first(news: &Receiver<MirrorNews>, address: SocketAddr) -> Result<(Box<Greeting>, MirrorSource), Failure> {
    let until = HostInstant::now() + PATIENCE;
    let mut why = "it says nothing".to_owned();
    loop {
        match news.recv_timeout(until.saturating_duration_since(HostInstant::now())) {
            Ok(MirrorNews::Joined(greeting, source)) => return Ok((greeting, source)),
            Ok(MirrorNews::Lost(reason)) => why = reason,
            Ok(_) => {}
            Err(_) => {
                return Err(Failure::Other(format!(
                    "can't join the floor at {address}: {why}; it must be served by `underfoot run` with --web {address}"
                )));
            }
        }
    }
}

/// One connection to the server, from its greeting until it is lost.
struct Run {
    session: Session,
    snapshots: triple_buffer::Output<Snapshot>,
    left_out: Box<dyn Fn() -> u64 + Send>,
}

impl Run {
    fn begin(
        greeting: &Greeting,
        source: MirrorSource,
        window: &ProgramChannels,
        tap: &PacketTap,
    ) -> Result<Self, Failure> {
        let (clock, left_out) = (source.clock(), Box::new(source.left_out()));
        let input = announced(source, window.layouts.clone(), LayoutCause::Served);
        let input = tap.wrap(input);
        let session = Session::source(input, clock)
            .floor(greeting.floor.clone())
            .layout(greeting.layout.clone())
            .method(greeting.method)
            .sink(ToWindow::new(window.events.clone()))
            .start()?;
        let snapshots = session.take_snapshots();
        Ok(Self { session, snapshots, left_out })
    }
}

struct ServedFloor {
    link: MirrorLink,
    news: Receiver<MirrorNews>,
    run: Run,
    tap: PacketTap,
    window: ProgramChannels,
    desk: ServedDesk,
    snapshots: triple_buffer::Input<Snapshot>,
    begun: HostInstant,
    /// Dropped when the next one starts.
    watch: Option<FileWatch>,
    files: LayoutArgs,
}

impl ServedFloor {
    /// Shows the floor until the window closes its channels.
    fn run(mut self) {
        loop {
            match self.news.recv_timeout(LOOK) {
                Ok(news) => self.hear(news),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => thread::sleep(LOOK),
            }
            loop {
                match self.window.commands.try_recv() {
                    Ok(command) => self.apply(command),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return stop_and_wait(&self.run.session),
                }
            }
            self.look();
        }
    }

    fn hear(&mut self, news: MirrorNews) {
        let now = self.begun.elapsed();
        match news {
            MirrorNews::Joined(greeting, source) => self.join_again(&greeting, source),
            MirrorNews::Again(greeting) => self.desk.take(&greeting, now),
            MirrorNews::Line(line) => self.desk.hear(&line.message, now),
            MirrorNews::Lost(why) => self.desk.lose(why),
        }
    }

    /// Starts again from a new greeting: all earlier state is discarded.
    fn join_again(&mut self, greeting: &Greeting, source: MirrorSource) {
        if !self.desk.suits(greeting) {
            return;
        }
        stop_and_wait(&self.run.session);
        let layout = Arc::new(greeting.layout.clone());
        let _ = self.window.events.send(EventNews::Restarted(layout));
        match Run::begin(greeting, source, &self.window, &self.tap) {
            Ok(run) => self.run = run,
            Err(failure) => return self.desk.say(failure.to_string()),
        }
        self.desk.join_again(greeting, self.begun.elapsed());
    }

    /// Passes on the latest snapshot and the requests, and sets controls to the server's state.
    fn look(&mut self) {
        let now = self.begun.elapsed();
        for asked in self.desk.requests(now) {
            self.link.ask(&asked.request, &asked.args);
        }
        if self.run.snapshots.update() {
            self.snapshots.input_buffer_mut().clone_from(self.run.snapshots.output_buffer());
            self.snapshots.publish();
        }
        if !self.desk.is_due(now) {
            return;
        }
        self.desk.note_left_out((self.run.left_out)());
        let (layout, here) = (self.run.session.snapshot().layout, self.run.snapshots.output_buffer());
        for message in self.desk.corrections(&layout, here, now) {
            self.run.session.send(FloorCommand::Control(message));
        }
    }

    /// Carries out a command of the window.
    fn apply(&mut self, command: PreviewCommand) {
        match self.desk.apply(command) {
            Err(PreviewCommand::Watch(path)) => {
                self.files.layout = path;
                self.watch = self.watch();
            }
            Err(PreviewCommand::SaveFloor { floor, path }) => self.desk.say(keep_floor(&floor, &path)),
            Ok(()) | Err(_) => {}
        }
    }

    /// Reports each change of the layout's files to the window.
    fn watch(&self) -> Option<FileWatch> {
        let news = self.window.layouts.clone();
        let watch = FileWatch::on_change(&self.files, move || {
            // If the queue is full, it already contains changes.
            let _ = news.try_send(LayoutNews::Changed);
        });
        watch.inspect_err(|failure| self.desk.say(failure.to_string())).ok().flatten()
    }
}
