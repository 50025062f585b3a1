//! Ends of steps: results and answers of the program, in the floor and in words.

use std::sync::Arc;

use underfoot::floor::{Day, Floor};
use underfoot::sense::{StandError, StandFit};
use underfoot::units::Newtons;

use super::{Listens, SetupBench, Work};
use crate::setup::messages::SetupAnswer;
use crate::setup::standing::{fit_words, keep_laws, needy_tiles};
use crate::setup::step::SetupStep;
use crate::setup::view::{StepState, StepView};

/// A step that is done, with these results.
const fn done(words: Vec<String>) -> StepView {
    StepView { state: StepState::Done, words }
}

impl SetupBench {
    /// Takes the answer of the program to a request.
    pub fn answer(&mut self, answer: SetupAnswer) {
        match answer {
            SetupAnswer::Listening(Ok(())) => self.troubles.clear(),
            SetupAnswer::Listening(Err(reason)) => {
                self.troubles = vec![reason];
                // The next order tries again.
                self.listens = Listens::Nobody;
            }
            SetupAnswer::Troubles(troubles) => self.troubles = troubles,
            SetupAnswer::Saved(saved) => self.saved(saved),
            SetupAnswer::Tared(tared) => self.tared(tared),
            SetupAnswer::Fitted(fitted, day) => self.fitted(*fitted, day),
            SetupAnswer::Opened(Ok(place)) => {
                self.steps[SetupStep::Layout.index()] = done(vec![place]);
            }
            SetupAnswer::Closed(Ok(())) => self.work = Work::Nothing,
            SetupAnswer::Opened(Err(reason)) | SetupAnswer::Closed(Err(reason)) => {
                self.work = Work::Nothing;
                self.fail(SetupStep::Layout, reason);
            }
        }
    }

    /// The floor file is written, or not.
    fn saved(&mut self, saved: Result<String, String>) {
        let Some((floor, step, mut result)) = self.saving.pop_front() else { return };
        match saved {
            Err(reason) => self.fail(step, reason),
            Ok(place) => {
                result.words.push(place);
                if step == SetupStep::Shape {
                    // A new floor: earlier results are those of another.
                    self.steps = Default::default();
                    self.record = None;
                }
                self.steps[step.index()] = result;
                let is_rewired = self.floor.as_ref().is_none_or(|old| old.boards != floor.boards);
                self.floor = Some(Arc::new(floor));
                if is_rewired {
                    self.record = None;
                    if self.listens == Listens::Floor {
                        // The boards have other numbers from now on.
                        self.listens = Listens::Nobody;
                        self.listen(Listens::Floor);
                    }
                }
            }
        }
    }

    /// The walk from board to board is over.
    pub(super) fn conclude_wiring(&mut self) {
        let (Work::Wiring(walk), Some(floor)) = (&self.work, &self.floor) else { return };
        let Some(found) = walk.outcome(floor) else { return };
        let step = SetupStep::Wiring;
        let found = match found {
            Err(twice) => return self.fail(step, capital(&twice.to_string())),
            Ok(found) => found,
        };
        let address = |board: usize| floor.boards.get(board).map_or("?", |board| board.address.as_str());
        let mut words: Vec<String> = found
            .moved
            .iter()
            .map(|(place, found)| format!("{} is where {} should be.", address(*found), address(*place)))
            .collect();
        // Within a board, the order of the channels is that of the floor file.
        let mixed = walk.steps().iter().filter(|step| step.board == step.found && step.felt != step.tile);
        let mixed: Vec<String> = mixed
            .map(|step| {
                format!(
                    "{} felt tile {} where the floor file has its tile {}: its channels are in another order, which \
                     steps alone cannot tell sensor by sensor. Exchange its plugs, or the `channels` of the floor file.",
                    address(step.found),
                    step.tile,
                    step.felt
                )
            })
            .collect();
        let state = if mixed.is_empty() { StepState::Done } else { StepState::Trouble };
        let is_right = words.is_empty() && mixed.is_empty();
        words.extend(mixed);
        if is_right {
            words.push("Every board is where the floor file has it.".to_owned());
        } else if !found.moved.is_empty() {
            words.push("The floor file has their addresses exchanged now.".to_owned());
        }
        let result = StepView { state, words };
        if found.moved.is_empty() {
            self.steps[step.index()] = result;
        } else {
            self.save(found.floor, step, result);
        }
    }

    /// The tare is taken, or not.
    fn tared(&mut self, tared: Result<(Vec<[Newtons; 4]>, Day), String>) {
        self.work = Work::Readings;
        let Some(floor) = &self.floor else { return };
        match tared {
            Err(reason) => self.fail(SetupStep::Readings, capital(&reason)),
            Ok((tare, day)) => {
                let weights = tare.iter().map(|tare| tare.iter().map(|tare| tare.0).sum::<f32>());
                let (least, most) =
                    weights.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, m), w| (l.min(w), m.max(w)));
                let words =
                    format!("The tare is taken: the tiles read {least:.1} to {most:.1} N when empty.");
                let floor = Floor { tare, tared: Some(day), ..Floor::clone(floor) };
                self.save(floor, SetupStep::Readings, done(vec![words]));
            }
        }
    }

    /// The laws are found, or not.
    fn fitted(&mut self, fitted: Result<StandFit, StandError>, day: Day) {
        let Work::Fitting(record) = std::mem::replace(&mut self.work, Work::Readings) else { return };
        let Some(floor) = &self.floor else { return };
        let fit = match fitted {
            Err(error) => return self.fail(SetupStep::Standing, capital(&error.to_string())),
            Ok(fit) => fit,
        };
        let mut record = *record;
        let mut floor = Floor::clone(floor);
        keep_laws(&mut floor, &fit, day);
        record.needy = needy_tiles(&fit, &record.marks, &floor);
        let mut words = fit_words(&fit);
        let state = if record.needy.is_empty() { StepState::Done } else { StepState::Trouble };
        if !record.needy.is_empty() {
            let tiles: Vec<String> = record.needy.iter().map(ToString::to_string).collect();
            words.push(format!("More stands are needed on {}.", tiles.join(" ")));
        }
        record.fit = Some(Arc::new(fit));
        self.record = Some(record);
        self.save(floor, SetupStep::Standing, StepView { state, words });
    }
}

/// `text` with a capital letter at its beginning and a full stop at its end.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase).into_iter().flatten();
    let text: String = first.chain(letters).collect();
    if text.ends_with(['.', '?', '!']) { text } else { text + "." }
}
