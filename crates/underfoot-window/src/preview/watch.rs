//! Checks whether the display is up to date: measures the time since the last packet and the last snapshot.

use super::feed::{ServerLink, ServerState};
use underfoot::engine::Snapshot;
use underfoot::sink::{AreaNews, AreaState};
use underfoot::wire::LinkState;

/// Time without a snapshot after which the sensing thread counts as stopped.
const STOPPED_S: f64 = 0.5;

/// Times of the last packet and the last snapshot, on the window's clock.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LinkNotices {
    packets: u64,
    packets_at_s: f64,
    snapshot_at_s: Option<f64>,
}

/// A message across the floor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Banner {
    /// The first line: the problem.
    pub(super) headline: String,
    /// The second line: its meaning, or what to do.
    pub(super) detail: String,
    /// Determines how much of the floor the banner may cover.
    pub(super) weight: Weight,
}

/// Severity of a banner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    /// The floor works in part.
    Hint,
    /// The floor does not work yet.
    Pause,
    /// The floor does not work any more.
    Fault,
}

impl LinkNotices {
    /// Observes a frame's state at `now_s`; `fresh` if the sensing thread wrote it since the last frame.
    pub(super) fn observe(&mut self, now_s: f64, snapshot: &Snapshot, fresh: bool) {
        if snapshot.counters.packets != self.packets {
            self.packets = snapshot.counters.packets;
            self.packets_at_s = now_s;
        }
        if fresh || self.snapshot_at_s.is_none() {
            self.snapshot_at_s = Some(now_s);
        }
    }

    /// The problem at `now_s`, if any.
    pub(super) fn banner(
        &self,
        now_s: f64,
        link: LinkState,
        source: &str,
        server: Option<&ServerState>,
    ) -> Option<Banner> {
        let still_s = self.snapshot_at_s.map_or(0.0, |at| now_s - at);
        if still_s >= STOPPED_S && link != LinkState::Waiting {
            return Some(Banner {
                headline: format!("Nothing new from the sensing for {still_s:.1} s"),
                detail: "The last known state is shown.".into(),
                weight: Weight::Fault,
            });
        }
        if let Some(server) = server.filter(|server| server.tells_by_lines()) {
            return told(server);
        }
        let silent_s = now_s - self.packets_at_s;
        if let (LinkState::Lost, Some(ServerState { address, link: ServerLink::Lost(why), .. })) =
            (link, server)
        {
            return Some(Banner {
                headline: format!("No word from {address} for {silent_s:.1} s: trying again"),
                detail: format!("The state of the floor is not known here: {why}."),
                weight: Weight::Fault,
            });
        }
        match link {
            LinkState::Live => None,
            LinkState::Waiting => Some(Banner {
                headline: "Waiting for the floor’s first packet".into(),
                detail: format!("Listening: {source}"),
                weight: Weight::Pause,
            }),
            LinkState::Partial => Some(Banner {
                headline: "Some boards are silent".into(),
                detail: "Hatched tiles are not sensed.".into(),
                weight: Weight::Hint,
            }),
            LinkState::Lost => Some(Banner {
                headline: format!("No sensor packets for {silent_s:.1} s"),
                detail: "Every control is released.".into(),
                weight: Weight::Fault,
            }),
        }
    }
}

/// The banner for a floor that is known from lines only.
fn told(server: &ServerState) -> Option<Banner> {
    let ServerLink::Ended(why) = &server.link else { return silent_areas(&server.areas) };
    Some(Banner {
        headline: format!("Nothing more comes from {}", server.address),
        detail: format!("The state of the floor is not known here: {why}."),
        weight: Weight::Fault,
    })
}

/// The banner for areas that are not live.
fn silent_areas(areas: &[AreaNews]) -> Option<Banner> {
    let silent: Vec<&AreaNews> = areas.iter().filter(|news| news.state != AreaState::Live).collect();
    let is_alone = silent.len() == areas.len();
    let weight = match is_alone {
        false => Weight::Hint,
        true if silent.iter().all(|news| news.state == AreaState::Waiting) => Weight::Pause,
        true => Weight::Fault,
    };
    let not_sensed = "Hatched tiles are not sensed";
    let (headline, detail) = match silent.as_slice() {
        [] => return None,
        [news] => {
            let because = if news.why.is_empty() { String::new() } else { format!(": {}", news.why) };
            (format!("Area “{}” is {}", news.area, news.state.name()), format!("{not_sensed}{because}."))
        }
        _ if weight == Weight::Pause => {
            ("Waiting for the first of the areas".into(), format!("{not_sensed}."))
        }
        several => {
            let names: Vec<String> =
                several.iter().map(|news| format!("{} is {}", news.area, news.state.name())).collect();
            (
                format!("{} of {} areas are silent", several.len(), areas.len()),
                format!("{}.", names.join(", ")),
            )
        }
    };
    Some(Banner { headline, detail, weight })
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use underfoot::units::Instant;

    fn at(packets: u64) -> Snapshot {
        let mut snapshot = Snapshot::default();
        snapshot.counters.packets = packets;
        snapshot
    }

    #[test]
    fn silence_is_counted_from_the_last_packet() {
        let mut watch = LinkNotices::default();
        watch.observe(5.0, &at(600), true);
        watch.observe(5.4, &at(600), true);
        let banner = watch.banner(5.4, LinkState::Lost, "", None).unwrap();
        assert_eq!(banner.headline, "No sensor packets for 0.4 s");
        assert_eq!(banner.weight, Weight::Fault);
        watch.observe(5.5, &at(606), true);
        assert_eq!(watch.banner(5.5, LinkState::Live, "", None), None);
    }

    #[test]
    fn a_server_that_is_gone_is_named_with_the_reason() {
        let mut watch = LinkNotices::default();
        watch.observe(5.0, &at(600), true);
        watch.observe(5.4, &at(600), true);
        let mut server = ServerState {
            address: "10.0.0.7:9002".into(),
            link: ServerLink::Joined,
            takes_layouts: false,
            left_out: 0,
            areas: Vec::new(),
        };
        let boards = watch.banner(5.4, LinkState::Lost, "", Some(&server)).unwrap();
        assert_eq!(boards.headline, "No sensor packets for 0.4 s", "the server is there, the boards are not");
        server.link = ServerLink::Lost("the server is silent".into());
        let gone = watch.banner(5.4, LinkState::Lost, "", Some(&server)).unwrap();
        assert_eq!(gone.headline, "No word from 10.0.0.7:9002 for 0.4 s: trying again");
        assert!(gone.detail.ends_with("the server is silent."), "{}", gone.detail);
    }

    #[test]
    fn areas_that_are_lost_are_named_with_the_reason() {
        let area = |name: &str, state, why: &str| AreaNews {
            at: Instant::START,
            area: name.into(),
            state,
            why: why.into(),
            uncertainty: Duration::ZERO,
        };
        let mut server = ServerState {
            address: "standard input".into(),
            link: ServerLink::Followed,
            takes_layouts: false,
            left_out: 0,
            areas: vec![area("west", AreaState::Live, ""), area("east", AreaState::Live, "")],
        };
        let said = |server: &ServerState, link| LinkNotices::default().banner(0.0, link, "", Some(server));
        assert_eq!(said(&server, LinkState::Live), None);
        server.areas[1] = area("east", AreaState::Lost, "nothing new from its node for 100 ms");
        let one = said(&server, LinkState::Partial).unwrap();
        assert_eq!((one.headline.as_str(), one.weight), ("Area “east” is lost", Weight::Hint));
        assert_eq!(one.detail, "Hatched tiles are not sensed: nothing new from its node for 100 ms.");
        server.areas[0] = area("west", AreaState::Disputed, "two nodes");
        let both = said(&server, LinkState::Lost).unwrap();
        assert_eq!((both.headline.as_str(), both.weight), ("2 of 2 areas are silent", Weight::Fault));
        assert_eq!(both.detail, "west is disputed, east is lost.");
        server.link = ServerLink::Ended("the other program has ended".into());
        let over = said(&server, LinkState::Lost).unwrap();
        assert_eq!(over.headline, "Nothing more comes from standard input");
    }

    #[test]
    fn a_sensing_thread_that_stops_writing_is_noticed() {
        let mut watch = LinkNotices::default();
        watch.observe(1.0, &at(1), true);
        assert_eq!(watch.banner(1.4, LinkState::Live, "", None), None);
        watch.observe(1.6, &at(1), false);
        assert!(watch.banner(1.6, LinkState::Live, "", None).unwrap().headline.starts_with("Nothing new"));
    }

    #[test]
    fn before_the_first_packet_the_window_says_what_it_waits_for() {
        let watch = LinkNotices::default();
        let banner = watch.banner(9.0, LinkState::Waiting, "port 9000", None).unwrap();
        assert_eq!(banner.detail, "Listening: port 9000");
        assert_eq!(banner.weight, Weight::Pause);
    }
}
