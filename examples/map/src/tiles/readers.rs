//! Threads that read pictures, so that the map keeps moving.

use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use eframe::egui::{ColorImage, Context};

use super::source::{Key, NoPicture, Source};

/// Number of pictures read at once: no more requests to a server than from a browser.
const READERS: usize = 4;

/// The result for a tile.
pub type Answer = (Key, Result<ColorImage, NoPicture>);

/// Reads the wanted tiles, and drops those that are no longer wanted.
pub struct Readers {
    wanted: Arc<Wanted>,
    answers: Receiver<Answer>,
    sender: Sender<Answer>,
    source: Arc<Source>,
    are_there: bool,
}

#[derive(Default)]
struct Wanted {
    list: Mutex<List>,
    more: Condvar,
}

#[derive(Default)]
struct List {
    /// In reverse order: the next one is the last.
    keys: Vec<Key>,
    /// Those that a thread is reading.
    begun: Vec<Key>,
    is_over: bool,
}

impl Wanted {
    fn lock(&self) -> MutexGuard<'_, List> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next one to read, after waiting for it; `None` at the end.
    fn next(&self) -> Option<Key> {
        let mut list = self.lock();
        loop {
            if list.is_over {
                return None;
            }
            if let Some(key) = list.keys.pop() {
                list.begun.push(key);
                return Some(key);
            }
            list = self.more.wait(list).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Readers {
    pub fn new(source: Arc<Source>) -> Self {
        let (sender, answers) = mpsc::channel();
        Self { wanted: Arc::default(), answers, sender, source, are_there: false }
    }

    /// Reads these, the first one first, in place of earlier ones that have not begun.
    pub fn want(&mut self, context: &Context, keys: impl DoubleEndedIterator<Item = Key>) {
        let mut list = self.wanted.lock();
        list.keys.clear();
        for key in keys.rev() {
            // A tile may be visible twice.
            if !list.begun.contains(&key) && !list.keys.contains(&key) {
                list.keys.push(key);
            }
        }
        let is_needed = !list.keys.is_empty();
        drop(list);
        if is_needed {
            self.start(context);
            self.wanted.more.notify_all();
        }
    }

    /// The results since the last call.
    pub fn answers(&self) -> impl Iterator<Item = Answer> + '_ {
        self.answers.try_iter().inspect(|(key, _)| self.wanted.lock().begun.retain(|begun| begun != key))
    }

    fn start(&mut self, context: &Context) {
        if std::mem::replace(&mut self.are_there, true) {
            return;
        }
        for _ in 0..READERS {
            let (wanted, answers) = (Arc::clone(&self.wanted), self.sender.clone());
            let (source, context) = (Arc::clone(&self.source), context.clone());
            let get = move || {
                while let Some(key) = wanted.next() {
                    if answers.send((key, source.read(key))).is_err() {
                        return;
                    }
                    context.request_repaint();
                }
            };
            if let Err(error) = thread::Builder::new().name("tiles".into()).spawn(get) {
                eprintln!("no thread reads tiles: {error}");
            }
        }
    }
}

impl Drop for Readers {
    /// Threads that wait for a server end by themselves.
    fn drop(&mut self) {
        self.wanted.lock().is_over = true;
        self.wanted.more.notify_all();
    }
}
