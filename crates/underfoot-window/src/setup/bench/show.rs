//! The state of the steps, for the window.

use super::{Listens, SetupBench, Work};
use crate::setup::step::SetupStep;
use crate::setup::view::{SensorState, SetupView, StepState, StepView, WiringView, WorkView};

impl SetupBench {
    /// Returns the state for the window.
    pub fn view(&mut self) -> SetupView {
        if self.listens == Listens::Anybody {
            self.boards = self.rates.boards(&self.heard, self.now);
        }
        self.note_answers();
        let mut steps = self.steps.clone();
        let found = &mut steps[SetupStep::Boards.index()];
        found.state = match () {
            () if self.boards.iter().any(|board| !board.troubles.is_empty()) => StepState::Trouble,
            () if self.boards.is_empty() => StepState::Open,
            () => StepState::Done,
        };
        let record = self.record.as_ref();
        SetupView {
            boards: self.boards.clone(),
            unread: self.heard.unread(),
            troubles: self.troubles.clone(),
            floor: self.floor.clone(),
            work: self.work(),
            sensors: self.watch.iter().flat_map(|watch| watch.sensors(self.now)).collect(),
            is_rested: self.watch.as_ref().is_some_and(|watch| watch.is_rested()),
            steps,
            fit: record.and_then(|record| record.fit.clone()),
            needy: record.map(|record| record.needy.clone()).unwrap_or_default(),
        }
    }

    /// The readings are looked at once every sensor has answered to a load.
    fn note_answers(&mut self) {
        let step = &mut self.steps[SetupStep::Readings.index()];
        let Some(watch) = self.watch.as_ref().filter(|watch| watch.is_rested()) else { return };
        let answers = |state| matches!(state, SensorState::Answers | SensorState::Saturated);
        let mut sensors = watch.sensors(self.now).peekable();
        if step.state == StepState::Open && sensors.peek().is_some() && sensors.all(|it| answers(it.state)) {
            *step = StepView { state: StepState::Done, words: vec!["Every sensor answers.".to_owned()] };
        }
    }

    fn work(&self) -> WorkView {
        match &self.work {
            Work::Nothing => WorkView::Nothing,
            Work::Boards => WorkView::Boards,
            Work::Wiring(walk) => {
                let boards = self.floor.as_deref().map(|floor| floor.boards.as_slice()).unwrap_or_default();
                let address = |board: usize| Some(boards.get(board)?.address.clone());
                WorkView::Wiring(WiringView {
                    task: walk.task(),
                    steps: walk.steps().to_vec(),
                    length: walk.length(),
                    felt: walk.felt(),
                    unheard: walk.unheard().filter_map(address).collect(),
                })
            }
            Work::Readings => WorkView::Readings,
            Work::Taring => WorkView::Taring,
            Work::Standing(work) => WorkView::Standing(Box::new(work.view(self.now))),
            Work::Fitting(_) => WorkView::Fitting,
            Work::Open => WorkView::Open,
        }
    }
}
