//! The line for a report.

use super::Job;
use crate::outgoing::json::{ContactsRecord, CrackRecord, GapRecord, HeldRecord, Line, Message, PageRecord};
use crate::sink::Report;
use crate::sink::backlog::Gap;
use crate::sink::crack_rate::CrackNews;

/// Returns the line for `job`; `None` for a job without a line.
pub(super) fn line(job: &Job) -> Option<Line> {
    Some(match job {
        &Job::Gap(Gap { at, dropped }) => Line::new(at, Message::Gap(GapRecord { dropped })),
        Job::Report(report) => Line::new(report.at(), message(report)?),
    })
}

fn message(report: &Report<'_>) -> Option<Message> {
    Some(match report {
        Report::Event(event) => Message::Control(event.as_ref().into()),
        Report::Ignored(press) => Message::Ignored(press.as_ref().into()),
        Report::Contacts(_, contacts) => Message::Contacts(ContactsRecord::from(contacts.as_ref())),
        Report::Page(shown) => Message::Page(PageRecord { page: Some(shown.page.as_str().into()) }),
        &Report::Crack(CrackNews { seed, energy_j, x_m, y_m, skipped, .. }) => {
            Message::Crack(CrackRecord { seed, energy_j, x_m, y_m, skipped })
        }
        Report::Link(_, state) => Message::Link((*state).into()),
        Report::LinkCause(_, cause) => Message::LinkCause(cause.as_deref().into()),
        Report::Health(_, health) => Message::Health(health.as_ref().into()),
        Report::Device(_, status) => Message::Device(status.as_ref().into()),
        Report::Held(report) => Message::Held(HeldRecord::new(&report.held, report.sequence)),
        Report::Muted(_, muted) => Message::Mute(muted.as_ref().into()),
        Report::Control(_, state) => Message::State(state.as_ref().into()),
        Report::Area(news) => Message::Area(news.as_ref().into()),
        Report::Message(news) => Message::Sent(news.as_ref().into()),
        // The queue has the cracks in the place of ground events; alive reports have no line.
        Report::Ground(_) | Report::Alive(..) => return None,
    })
}
