//! The thread of the steps: boards in, files and other threads out. It never waits for the window.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant as HostInstant};

use triple_buffer::Input;
use underfoot::sense::{StandError, StandFit};
use underfoot::serve::take_tare;
use underfoot::source::FloorInput;
use underfoot_window::setup::{
    FitJob, SetupAnswer, SetupBench, SetupInput, SetupOrder, SetupRequest, SetupView,
};

use super::super::Args;
use super::super::boards::BoardListener;
use super::child::LayoutWindow;
use crate::calibrate::today;
use crate::floor_args::{FloorOut, saved_words};
use crate::output;
use crate::senders::{BoardArgs, ListenArgs};

/// Interval between two states for the window.
const SHOW: Duration = Duration::from_millis(33);

/// Time for which packets are taken before orders are looked at.
const ROUND: Duration = Duration::from_millis(10);

/// Time for which the tare waits for a quiet floor.
const PATIENCE: Duration = Duration::from_secs(5);

/// The boards that it listens to.
enum BoardInput {
    Nobody,
    Anybody(Box<BoardListener>),
    Floor(Box<FloorInput>),
}

/// The steps, with all that they need of this machine.
pub(super) struct Worker {
    args: Args,
    bench: SetupBench,
    views: Input<SetupView>,
    orders: Receiver<SetupOrder>,
    is_over: Arc<AtomicBool>,
    input: BoardInput,
    fit: Option<JoinHandle<Result<StandFit, StandError>>>,
    layout: Option<LayoutWindow>,
    begun: HostInstant,
    shown: Option<HostInstant>,
}

impl Worker {
    pub(super) fn new(
        args: Args,
        bench: SetupBench,
        (views, orders): (Input<SetupView>, Receiver<SetupOrder>),
        is_over: Arc<AtomicBool>,
    ) -> Self {
        Self {
            args,
            bench,
            views,
            orders,
            is_over,
            input: BoardInput::Nobody,
            fit: None,
            layout: None,
            begun: HostInstant::now(),
            shown: None,
        }
    }

    /// Works until the window is closed, or a signal ends the program.
    pub(super) fn run(mut self, stop: &AtomicBool) {
        let path = self.args.floor.clone();
        let mut file = FloorOut::new(&path);
        while !self.is_over.load(Ordering::Relaxed) {
            if stop.load(Ordering::Relaxed) {
                // A window that another one covers does not draw, so it cannot end by itself.
                std::process::exit(i32::from(!output::finish()));
            }
            loop {
                match self.orders.try_recv() {
                    Ok(order) => self.bench.order(&order),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return,
                }
            }
            while let Some(request) = self.bench.next_request() {
                let answer = self.serve(request, &path, &mut file);
                if let Some(answer) = answer {
                    self.bench.answer(answer);
                }
            }
            self.listen();
            self.collect();
            if self.shown.is_none_or(|shown| shown.elapsed() >= SHOW) {
                self.show();
            }
        }
    }

    fn show(&mut self) {
        self.shown = Some(HostInstant::now());
        self.views.write(self.bench.view());
    }

    /// Serves a request; `None` if its answer comes later.
    fn serve<'p>(
        &mut self,
        request: SetupRequest,
        path: &'p Path,
        file: &mut FloorOut<'p>,
    ) -> Option<SetupAnswer> {
        Some(match request {
            SetupRequest::Listen(input) => SetupAnswer::Listening(self.open(input)),
            SetupRequest::Save(floor) => {
                let saved = file.save(&floor).map(|saved| saved_words(&saved, path));
                *file = FloorOut::new(path);
                SetupAnswer::Saved(saved.map_err(|failure| failure.to_string()))
            }
            SetupRequest::TakeTare(floor) => {
                // The window shows meanwhile that the floor must be empty.
                self.show();
                let tared = match &mut self.input {
                    BoardInput::Floor(input) => take_tare(&mut input.source, &floor, PATIENCE, true)
                        .map(|tare| (tare, today()))
                        .map_err(|failure| failure.to_string()),
                    BoardInput::Nobody | BoardInput::Anybody(_) => Err("the floor is not read".to_owned()),
                };
                SetupAnswer::Tared(tared)
            }
            SetupRequest::Fit(job) => {
                match fit(job.clone()) {
                    Ok(thread) => self.fit = Some(thread),
                    // Nothing is measured meanwhile.
                    Err(_) => return Some(SetupAnswer::Fitted(Box::new(job.run()), today())),
                }
                return None;
            }
            SetupRequest::Open => match LayoutWindow::open(&self.args) {
                Ok((window, place)) => {
                    self.layout = Some(window);
                    SetupAnswer::Opened(Ok(place))
                }
                Err(failure) => SetupAnswer::Opened(Err(failure.to_string())),
            },
        })
    }

    /// Listens to other boards, which frees ports first.
    fn open(&mut self, input: SetupInput) -> Result<(), String> {
        self.input = BoardInput::Nobody;
        let opened = match input {
            SetupInput::Nobody => Ok(BoardInput::Nobody),
            SetupInput::Anybody => BoardListener::open(self.args.listen, &self.args.serial, self.begun)
                .map(|listener| BoardInput::Anybody(Box::new(listener))),
            SetupInput::Floor(floor) => {
                // A port that is not there is silent, and the window says so.
                let boards = BoardArgs::awaiting_ports();
                let listens = ListenArgs { listen: self.args.listen, boards };
                listens.open(&floor).map(|input| BoardInput::Floor(Box::new(input)))
            }
        };
        self.input = opened.map_err(|failure| failure.to_string())?;
        Ok(())
    }

    /// Takes what the boards send.
    fn listen(&mut self) {
        let failure = match &mut self.input {
            BoardInput::Nobody => {
                thread::sleep(ROUND);
                return;
            }
            BoardInput::Anybody(listener) => {
                let polled = listener.poll(self.bench.heard());
                self.bench.set_now(listener.now());
                self.bench.answer(SetupAnswer::Troubles(listener.troubles()));
                polled.err().map(|failure| failure.to_string())
            }
            BoardInput::Floor(input) => take(input, &mut self.bench).err().map(|error| error.to_string()),
        };
        if let Some(reason) = failure {
            self.input = BoardInput::Nobody;
            self.bench.answer(SetupAnswer::Listening(Err(reason)));
        }
    }

    /// Collects the results of other threads and programs.
    fn collect(&mut self) {
        if self.fit.as_ref().is_some_and(JoinHandle::is_finished)
            && let Some(thread) = self.fit.take()
        {
            let fitted = thread.join().unwrap_or(Err(StandError::NoLaw));
            self.bench.answer(SetupAnswer::Fitted(Box::new(fitted), today()));
        }
        if let Some(ended) = self.layout.as_mut().and_then(LayoutWindow::ended) {
            self.layout = None;
            self.bench.answer(SetupAnswer::Closed(ended));
        }
    }
}

/// Takes packets of the floor for a while.
fn take(input: &mut FloorInput, bench: &mut SetupBench) -> Result<(), underfoot::source::SourceError> {
    let round = HostInstant::now();
    while round.elapsed() < ROUND {
        match input.source.next(ROUND)? {
            Some(packet) => bench.take(&packet),
            None => break,
        }
    }
    bench.set_now(input.source.now());
    Ok(())
}

/// Fits laws on a thread of their own.
fn fit(job: Box<FitJob>) -> std::io::Result<JoinHandle<Result<StandFit, StandError>>> {
    thread::Builder::new().name("laws".into()).spawn(move || job.run())
}
