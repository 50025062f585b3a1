//! The floor for those who watch it for months: its health as JSON, its metrics for Prometheus, and a dashboard.

mod counts;
pub(super) mod dashboard;
mod health;
mod metrics;
mod observed;

use std::net::TcpStream;
use std::sync::Arc;
use std::time::Instant;

use underfoot_io::targets::LoadedPlan;

use super::{Shared, http};
pub(super) use counts::{CountingSink, EventCounts};
use health::HealthPage;
use observed::ObservedFloor;

/// Numbers since the start that the snapshots of a floor lack.
pub(super) struct FloorWatch {
    events: Arc<EventCounts>,
    messages: LoadedPlan,
    started: Instant,
}

impl FloorWatch {
    /// Begins now.
    pub(super) fn new(events: Arc<EventCounts>, messages: LoadedPlan) -> Self {
        Self { events, messages, started: Instant::now() }
    }
}

/// A request of a watcher.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Watched {
    Health,
    Metrics,
}

impl Watched {
    /// The answer at this path, if any.
    pub(super) fn at(path: &str) -> Option<Self> {
        match path {
            "/health" => Some(Self::Health),
            "/metrics" => Some(Self::Metrics),
            _ => None,
        }
    }

    /// Sends it.
    pub(super) fn answer(self, stream: TcpStream, shared: &Shared) {
        match self {
            Self::Health => {
                let page = HealthPage::of(&ObservedFloor::of(shared));
                let status = if page.is_failed() { "503 Service Unavailable" } else { "200 OK" };
                // Texts and numbers can always be written as JSON.
                let body = serde_json::to_string(&page).unwrap_or_default();
                http::answer(stream, status, &head("application/json"), &body);
            }
            Self::Metrics => {
                let text = metrics::text(ObservedFloor::of(shared));
                http::answer(stream, "200 OK", &head(metrics::TYPE), &text);
            }
        }
    }
}

fn head(kind: &str) -> String {
    format!("Content-Type: {kind}\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n")
}
