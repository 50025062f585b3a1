//! The behaviour of a node when its gateway cannot, or must not, use its reports.
//!
//! Apps have received the cancellation of all holds; the node must not render, nor report later, anything else.

use std::time::Duration;

use underfoot::units::Instant;

use crate::message::{AreaStanding, GatewayMessage, VERSION};

/// Longest silence of a gateway, which sends a message every 50 ms.
const SILENT_AFTER: Duration = Duration::from_millis(150);

/// Greatest number of gateways that a node remembers.
const MOST: usize = 4;

/// The action that the node must take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Action {
    /// A gateway uses this node's reports.
    Heard,
    /// Cancel all holds: the gateway has done so, or is gone.
    Cancel(CancelReason),
    /// Cancel all holds and stop all actuators: another node serves the area too.
    Mute,
    /// Start the actuators again: the other node has stopped.
    Unmute,
}

/// The reason why holds are cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CancelReason {
    /// The gateway has received no new frame for 100 ms.
    Late,
    /// The gateway has sent no message.
    Silent,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    gateway: u64,
    heard: Instant,
    standing: AreaStanding,
    is_silent: bool,
}

/// The gateways that a node knows.
#[derive(Clone, Debug)]
pub struct GatewayGuard {
    area: String,
    gateways: Vec<Known>,
    is_muted: bool,
}

impl GatewayGuard {
    /// The guard of the node of `area`.
    #[must_use]
    pub fn new(area: &str) -> Self {
        Self { area: area.to_owned(), gateways: Vec::new(), is_muted: false }
    }

    /// Processes the message of a gateway, received at `now` on the node's clock.
    pub fn hear(&mut self, message: &GatewayMessage, now: Instant) -> Vec<Action> {
        let Some((_, standing)) = message.areas.iter().find(|(area, _)| *area == self.area) else {
            return Vec::new();
        };
        if message.version != VERSION {
            return Vec::new();
        }
        let gateway = message.gateway;
        let next = Known { gateway, heard: now, standing: *standing, is_silent: false };
        let before = match self.gateways.iter_mut().find(|known| known.gateway == gateway) {
            Some(known) => Some(std::mem::replace(known, next)),
            None => {
                if self.gateways.len() == MOST {
                    self.gateways.remove(0);
                }
                self.gateways.push(next);
                None
            }
        };
        let was_live = before.is_some_and(|known| known.standing == AreaStanding::Live && !known.is_silent);
        let mut actions = Vec::new();
        match standing {
            AreaStanding::Live if !was_live => actions.push(Action::Heard),
            AreaStanding::Lost if was_live => actions.push(Action::Cancel(CancelReason::Late)),
            _ => {}
        }
        actions.extend(self.mute());
        actions
    }

    /// Checks the time-outs at `now`.
    pub fn tick(&mut self, now: Instant) -> Vec<Action> {
        let mut actions = Vec::new();
        for known in &mut self.gateways {
            if !known.is_silent && now.since(known.heard) > SILENT_AFTER {
                known.is_silent = true;
                if known.standing == AreaStanding::Live {
                    actions.push(Action::Cancel(CancelReason::Silent));
                }
            }
        }
        // A gateway that has restarted has another nonce.
        self.gateways.retain(|known| now.since(known.heard) < Duration::from_secs(60));
        actions
    }

    fn mute(&mut self) -> Option<Action> {
        let is_disputed =
            self.gateways.iter().any(|known| known.standing == AreaStanding::Disputed && !known.is_silent);
        let was_muted = std::mem::replace(&mut self.is_muted, is_disputed);
        match (was_muted, is_disputed) {
            (false, true) => Some(Action::Mute),
            (true, false) => Some(Action::Unmute),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(standing: AreaStanding) -> GatewayMessage {
        GatewayMessage {
            version: VERSION,
            gateway: 9,
            areas: vec![("west".into(), standing)],
            ..GatewayMessage::default()
        }
    }

    // C8
    #[test]
    fn what_feet_hold_is_cancelled_once_when_the_gateway_no_longer_hears_or_speaks() {
        let mut guard = GatewayGuard::new("west");
        let hear =
            |guard: &mut GatewayGuard, standing, ms| guard.hear(&said(standing), Instant::from_millis(ms));
        assert_eq!(hear(&mut guard, AreaStanding::Waiting, 0), []);
        assert_eq!(hear(&mut guard, AreaStanding::Live, 50), [Action::Heard]);
        assert_eq!(guard.tick(Instant::from_millis(200)), []);
        assert_eq!(guard.tick(Instant::from_millis(201)), [Action::Cancel(CancelReason::Silent)]);
        assert_eq!(guard.tick(Instant::from_millis(400)), []);
        assert_eq!(hear(&mut guard, AreaStanding::Live, 500), [Action::Heard]);
        assert_eq!(hear(&mut guard, AreaStanding::Lost, 550), [Action::Cancel(CancelReason::Late)]);
        assert_eq!(hear(&mut guard, AreaStanding::Lost, 600), []);
    }

    #[test]
    fn a_node_whose_area_is_disputed_is_mute_until_it_no_longer_is() {
        let mut guard = GatewayGuard::new("west");
        let mut hear = |standing| guard.hear(&said(standing), Instant::from_millis(1));
        assert_eq!(hear(AreaStanding::Disputed), [Action::Mute]);
        assert_eq!(hear(AreaStanding::Disputed), []);
        assert_eq!(hear(AreaStanding::Lost), [Action::Unmute]);
        assert_eq!(hear(AreaStanding::Live), [Action::Heard]);
    }
}
