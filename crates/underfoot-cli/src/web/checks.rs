//! Layouts from clients, checked one at a time on a thread of low priority: a flood of them takes no time from
//! sensing.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::Builder;

use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::runtime::Session;
use underfoot::schema::{self, Diagnostics, Kinds};
use underfoot::sink::step_back;
use underfoot::widget::Guard;
use underfoot_io::targets::LoadedPlan;

use super::MOST;

/// Maximum number of reported problems of one layout.
const MOST_PROBLEMS: usize = 8;

/// Maximum length of that report, in bytes.
const MOST_BYTES: usize = 4096;

/// Success, or the reason for the refusal.
pub(super) type Checked = Result<(), String>;

/// A layout, and the channel for the result.
struct Job {
    text: String,
    answer: SyncSender<Checked>,
}

/// Queue of layouts to check; ends its thread when dropped.
pub(super) struct Checks(SyncSender<Job>);

impl Checks {
    /// Checks layouts for a floor of this geometry, and puts the valid ones on the floor of `session`.
    ///
    /// # Errors
    /// An error if the system provides no thread.
    pub(super) fn start(session: Session, geometry: Geometry, messages: LoadedPlan) -> std::io::Result<Self> {
        // Each client has at most one layout in the queue.
        let (jobs, asked) = sync_channel::<Job>(MOST);
        let work = move || {
            step_back();
            for Job { text, answer } in asked {
                // The client may have left.
                let _ = answer.try_send(put(&text, &session, &geometry, &messages));
            }
        };
        Builder::new().name("layout checks".into()).spawn(work)?;
        Ok(Self(jobs))
    }

    /// Queues a layout for a check; the result arrives in the returned channel.
    pub(super) fn ask(&self, text: String) -> Result<Receiver<Checked>, String> {
        let (answer, answered) = sync_channel(1);
        let busy = |_| "so many layouts wait to be checked: send it again".to_owned();
        self.0.try_send(Job { text, answer }).map_err(busy)?;
        Ok(answered)
    }
}

/// Puts a layout on the floor once no foot is engaged.
fn put(text: &str, session: &Session, geometry: &Geometry, messages: &LoadedPlan) -> Checked {
    let read = schema::parse_layout(text, "the layout", &Kinds::builtin(), geometry);
    let layout = read.map_err(|problems| first_of(&problems))?.layout;
    // Clients may not add, move or remove controls that act while they are held.
    for (layout, whose) in [(&*session.snapshot().layout, "on the floor"), (&layout, "sent")] {
        if let Some(id) = held_to_run(layout) {
            return Err(format!(
                "the layout {whose} has the control {id:?} with the guard HoldToRun: such layouts are changed \
                 where the server is"
            ));
        }
    }
    tracing::info!("a layout from elsewhere is on the floor");
    // Only a layout that the operator has named may press keys of this computer.
    messages.stop(&layout, "it came from a web page, and only a layout named on the command line may send");
    session.set_layout(layout);
    Ok(())
}

/// The first few problems, and the number of all.
fn first_of(problems: &Diagnostics) -> String {
    let mut told: String =
        problems.iter().take(MOST_PROBLEMS).map(|problem| format!("{problem}\n")).collect();
    told.truncate(told.floor_char_boundary(MOST_BYTES));
    let (errors, warnings) = (problems.errors(), problems.warnings());
    if errors + warnings > MOST_PROBLEMS {
        told.push_str(&format!("{errors} errors and {warnings} warnings in all\n"));
    }
    told
}

/// A control that acts only while it is held.
fn held_to_run(layout: &Layout) -> Option<&str> {
    let held = layout
        .widgets
        .iter()
        .find(|widget| matches!(widget.behaviour.thresholds().guard, Guard::HoldToRun(_)));
    held.map(|widget| widget.id.as_str())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use underfoot::floor::Floor;

    use super::*;

    #[test]
    fn of_many_problems_the_first_few_are_told() {
        let widget = |n: u32| format!("(id: \"w{n}\", kind: \"nothing\", at: (0, 0), size: (1, 1)),");
        let widgets: String = (0..2000).map(widget).collect();
        let text = format!(
            "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [{widgets}])"
        );
        let read = schema::parse_layout(&text, "it", &Kinds::builtin(), &Floor::default().geometry);
        let told = first_of(&read.unwrap_err());
        assert!(told.len() < MOST_BYTES + 200, "{} bytes", told.len());
        assert!(told.contains("unknown kind") && told.contains(" errors and 0 warnings in all"), "{told}");
    }
}
