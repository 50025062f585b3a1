//! The floor of a server in the page: sensed again here from the packets of its boards, as `underfoot preview --join`
//! does, and without threads.

use std::sync::Arc;
use std::time::Duration;

use triple_buffer::{Input, Output, triple_buffer};
use underfoot::engine::Snapshot;
use underfoot::mirror::{Greeting, MirrorText, PolledMirror};
use underfoot::serve::{FloorCommand, Server};
use underfoot::sink::{SharedSender, wait_free_shared};
use underfoot::source::{PacketTap, TappedPackets};
use underfoot_window::edit::Document;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{
    DesignInput, EventNews, LayoutCause, PreviewCommand, PreviewInput, ProgramChannels, ServedDesk, ToWindow,
    announced, channels, usual_state,
};

use super::kinds::OwnTexts;
use super::lag::Lag;

/// Maximum number of commands that wait for the floor here: those that make its controls equal to the server's.
const COMMANDS_WAITING: usize = 256;

/// Maximum silence of a server, which sends something every few milliseconds.
const SILENT: Duration = Duration::from_secs(2);

/// A server's floor that the page shows.
pub struct JoinedFloor {
    run: Run,
    tap: PacketTap,
    window: ProgramChannels,
    desk: ServedDesk,
    snapshots: Input<Snapshot>,
    own: OwnTexts,
    /// Whether the connection stands: a greeting after its loss begins a new one.
    is_joined: bool,
    /// The time of the last message.
    heard: Duration,
    /// The time of the last call of [`JoinedFloor::run_until`].
    looked: Duration,
}

/// One connection to the server, from its greeting until it is lost.
struct Run {
    server: Server,
    mirror: PolledMirror,
    snapshots: Output<Snapshot>,
    commands: SharedSender<FloorCommand>,
    lag: Lag,
}

impl Run {
    fn begin(greeting: &Greeting, window: &ProgramChannels, tap: &PacketTap, now: Duration) -> Self {
        let (mirror, input) = PolledMirror::new(greeting, now);
        let input = tap.wrap(announced(input, window.layouts.clone(), LayoutCause::Served));
        let (written, snapshots) = triple_buffer(&Snapshot::default());
        let (commands, received) = wait_free_shared(COMMANDS_WAITING);
        let mut server = Server::new(&greeting.floor, greeting.layout.clone(), greeting.method, input)
            .with_events(Box::new(ToWindow::new(window.events.clone())))
            .with_snapshots(written)
            .with_commands(received);
        // The first snapshot, before the window asks for it.
        let _ = server.turn();
        Self { server, mirror, snapshots, commands, lag: Lag::default() }
    }

    /// Carries out all that has arrived.
    fn catch_up(&mut self) {
        while self.mirror.has_more() {
            // This source neither ends nor fails.
            let _ = self.server.turn();
        }
    }

    /// Lets the floor notice the time that has passed without packets.
    fn note_time(&mut self) {
        self.catch_up();
        let _ = self.server.turn();
    }
}

impl JoinedFloor {
    /// Joins the server at `address` by its first `text`, at `now` of the page. Design begins with the layout of
    /// `shared`, if there is one and it fits the floor, or else with the server's.
    ///
    /// # Errors
    /// The reason why the server can't be shown.
    pub fn join(
        text: &str,
        address: &str,
        shared: Option<&SharedLayout>,
        now: Duration,
    ) -> Result<(Self, PreviewInput), String> {
        let MirrorText::Greeting(greeting) = MirrorText::read(text)? else {
            return Err("the server does not greet as one of this program does".into());
        };
        let (window, program) = channels();
        let (tap, packets) = TappedPackets::new();
        let run = Run::begin(&greeting, &program, &tap, now);
        let desk = ServedDesk::new(&greeting, address.to_owned(), &program, now);
        let (input, shown) = triple_buffer(&Snapshot::default());
        let own = shared.map(OwnTexts::of).unwrap_or_default();
        let floor = Arc::new(greeting.floor.clone());
        let kinds_of = own.clone();
        let mut design = DesignInput {
            name: "the server’s layout".into(),
            text: greeting.layout_text.clone(),
            path: None,
            kinds_of: Box::new(move |path| Ok(kinds_of.read(path))),
            state: usual_state(),
        };
        if let Some(shared) = shared {
            let SharedLayout { name, text, .. } = shared;
            let read =
                shared.all_kinds().and_then(|kinds| Document::read(name, text, &Arc::new(kinds), &floor));
            match read {
                Ok(_) => (design.name, design.text) = (name.clone(), text.clone()),
                Err(problems) => {
                    desk.say(format!("The layout of the link does not fit this floor; {problems}"));
                }
            }
        }
        let input_of = PreviewInput {
            server: Some(desk.feed()),
            packets: Some(packets),
            design: Some(design),
            ..PreviewInput::new(floor, Arc::new(greeting.layout.clone()), address, shown, window)
        };
        let mut floor = Self {
            run,
            tap,
            window: program,
            desk,
            snapshots: input,
            own,
            is_joined: true,
            heard: now,
            looked: now,
        };
        floor.show();
        Ok((floor, input_of))
    }

    /// The user's kinds and effects, for links.
    #[must_use]
    pub fn own_texts(&self) -> OwnTexts {
        self.own.clone()
    }

    /// Shows a message in the window.
    pub fn tell(&self, text: impl Into<String>) {
        self.desk.say(text.into());
    }

    /// Takes a text of the server at `now`.
    ///
    /// # Errors
    /// The reason why the connection is of no more use.
    pub fn hear(&mut self, text: &str, now: Duration) -> Result<(), String> {
        self.heard = now;
        match MirrorText::read(text)? {
            MirrorText::Greeting(greeting) if self.is_joined => {
                self.run.mirror.put_layout(greeting.layout_text.clone());
                self.desk.take(&greeting, now);
            }
            MirrorText::Greeting(greeting) => self.join_again(&greeting, now),
            MirrorText::Line(line) => self.desk.hear(&line.message, now),
            MirrorText::Other => {}
        }
        Ok(())
    }

    /// Starts again from a new greeting: all earlier state is discarded.
    fn join_again(&mut self, greeting: &Greeting, now: Duration) {
        if !self.desk.suits(greeting) {
            return;
        }
        let layout = Arc::new(greeting.layout.clone());
        let _ = self.window.events.try_send(EventNews::Restarted(layout));
        self.run = Run::begin(greeting, &self.window, &self.tap, now);
        self.desk.join_again(greeting, now);
        self.is_joined = true;
    }

    /// Takes a frame of packets of the server at `now`, and senses it.
    ///
    /// # Errors
    /// The reason why the connection is of no more use: this computer is slower than the floor.
    pub fn take(&mut self, frame: &[u8], now: Duration) -> Result<(), String> {
        self.heard = now;
        // Between the loss of a connection and the next greeting, frames have no floor.
        if !self.is_joined {
            return Ok(());
        }
        // Invalid frames are counted with the refused packets.
        let _ = self.run.mirror.put(frame, now);
        self.run.catch_up();
        self.show();
        let lag = self.run.lag.note(self.run.mirror.arrived(), now);
        if Lag::is_too_long(lag) {
            return Err(format!("the page was {:.1} s behind the floor", lag.as_secs_f64()));
        }
        Ok(())
    }

    /// Notes at `now` that the connection is lost: the state of the floor is unknown, so every foot vanishes and every
    /// control is released.
    pub fn lose(&mut self, why: &str, now: Duration) {
        self.desk.lose(why);
        if std::mem::take(&mut self.is_joined) {
            self.run.mirror.end(now);
            self.run.note_time();
            self.show();
        }
    }

    /// Carries out the commands of the window, and detects silence at `now`; called every few milliseconds.
    /// Returns the requests to send to the server.
    ///
    /// # Errors
    /// The reason why the connection is of no more use: the server is silent.
    pub fn run_until(&mut self, now: Duration) -> Result<Vec<String>, String> {
        while let Ok(command) = self.window.commands.try_recv() {
            // No other program changes the files of a page, so none are watched.
            if let Err(PreviewCommand::SaveFloor { .. }) = self.desk.apply(command) {
                self.tell("The file of the floor is where the floor is served: check and save it there.");
            }
        }
        // A busy page takes frames late: only those that arrived before the last call are certainly taken.
        let since = std::mem::replace(&mut self.looked, now);
        self.run.mirror.pass(since);
        self.run.note_time();
        self.show();
        self.correct(now);
        // Texts and numbers can always be written as JSON.
        let requests = self.desk.requests(now);
        let requests = requests.iter().filter_map(|asked| serde_json::to_string(asked).ok()).collect();
        if self.is_joined && since.saturating_sub(self.heard) > SILENT {
            return Err("the server is silent".into());
        }
        Ok(requests)
    }

    /// Makes the controls here equal to the server's.
    fn correct(&mut self, now: Duration) {
        if !self.desk.is_due(now) {
            return;
        }
        self.desk.note_left_out(self.run.mirror.left_out());
        let (layout, here) = (self.run.server.engine().layout(), self.run.snapshots.output_buffer());
        for message in self.desk.corrections(layout, here, now) {
            // A full channel has earlier corrections; later ones repeat these.
            let _ = self.run.commands.try_send(FloorCommand::Control(message));
        }
    }

    /// Passes on the latest snapshot.
    fn show(&mut self) {
        if self.run.snapshots.update() {
            self.snapshots.input_buffer_mut().clone_from(self.run.snapshots.output_buffer());
            self.snapshots.publish();
        }
    }
}
