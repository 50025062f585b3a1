//! Messages through Zenoh, over TCP between endpoints that are named: nothing is looked for by multicast or gossip.
//!
//! Whether anybody is alive is not asked of Zenoh, whose sessions outlive a cut cable by seconds: the age of what
//! messages tell decides.

use thiserror::Error;
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::qos::{CongestionControl, Priority};

/// Where the gateway listens unless it is told otherwise; Zenoh's own port.
pub const ENDPOINT: &str = "tcp/127.0.0.1:7447";

/// Beneath this, nodes tell, each under its area's name.
const NODES: &str = "underfoot/cluster/node";

/// Here gateways tell.
const GATEWAY: &str = "underfoot/cluster/gateway";

/// Why there is no connection.
#[derive(Debug, Error)]
pub enum TransportError {
    /// An endpoint is not one, or the gateway can't listen on it.
    #[error("{endpoints}: {why}. Endpoints are written like {ENDPOINT}")]
    Endpoints {
        /// As they were given.
        endpoints: String,
        /// What Zenoh said.
        why: String,
    },
}

/// One end: a node's or a gateway's. It goes when this is dropped.
#[derive(Debug)]
pub struct Transport {
    session: zenoh::Session,
    key: String,
}

/// Which end.
#[derive(Clone, Copy, Debug)]
enum End<'a> {
    Gateway,
    Node { area: &'a str },
}

impl Transport {
    /// A gateway's end, which listens on `endpoints`; `hear` is called on threads of its own with what nodes send.
    ///
    /// # Errors
    /// [`TransportError::Endpoints`] if it can't listen there.
    pub fn gateway(
        endpoints: &[String],
        hear: impl Fn(&[u8]) + Send + Sync + 'static,
    ) -> Result<Self, TransportError> {
        Self::open(endpoints, End::Gateway, hear)
    }

    /// The end of the node of `area`, which connects to gateways at `endpoints`, now or when they are there; `hear` is
    /// called on threads of its own with what they send.
    ///
    /// # Errors
    /// [`TransportError::Endpoints`] if one of them can't be an endpoint.
    pub fn node(
        endpoints: &[String],
        area: &str,
        hear: impl Fn(&[u8]) + Send + Sync + 'static,
    ) -> Result<Self, TransportError> {
        Self::open(endpoints, End::Node { area }, hear)
    }

    fn open(
        endpoints: &[String],
        end: End<'_>,
        hear: impl Fn(&[u8]) + Send + Sync + 'static,
    ) -> Result<Self, TransportError> {
        let failed = |why: zenoh::Error| TransportError::Endpoints {
            endpoints: endpoints.join(", "),
            why: why.to_string(),
        };
        let session = zenoh::open(config(endpoints, end).map_err(failed)?).wait().map_err(failed)?;
        let (key, heard) = match end {
            End::Gateway => (GATEWAY.to_owned(), format!("{NODES}/*")),
            End::Node { area } => (format!("{NODES}/{area}"), GATEWAY.to_owned()),
        };
        let subscriber = session.declare_subscriber(heard);
        let hear = move |sample: zenoh::sample::Sample| hear(&sample.payload().to_bytes());
        subscriber.callback(hear).background().wait().map_err(failed)?;
        Ok(Self { session, key })
    }

    /// Sends `bytes` to the other end, if anybody is there and takes them: what can't be sent within a millisecond is
    /// dropped, and later messages tell that something is missing. Whether it was handed on.
    pub fn send(&self, bytes: Vec<u8>) -> bool {
        let put = self.session.put(self.key.as_str(), ZBytes::from(bytes));
        let put = put.congestion_control(CongestionControl::Drop).priority(Priority::RealTime).express(true);
        put.wait().is_ok()
    }
}

fn config(endpoints: &[String], end: End<'_>) -> Result<zenoh::Config, zenoh::Error> {
    let none: &[String] = &[];
    let (listened, connected) = match end {
        End::Gateway => (endpoints, none),
        End::Node { .. } => (none, endpoints),
    };
    let settings = serde_json::json!({
        "mode": "peer",
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "listen": { "endpoints": listened },
        // A gateway that starts later is found; one that is not there holds nobody up.
        "connect": {
            "endpoints": connected,
            "exit_on_failure": false,
            "retry": { "period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 2 },
        },
        // How long a dead connection is kept before another one is made.
        "transport": { "link": { "tx": { "lease": 1000 } } },
    });
    zenoh::Config::from_json5(&settings.to_string())
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;
    use std::sync::mpsc::channel;
    use std::time::Duration;

    use super::*;

    #[test]
    fn both_ends_hear_each_other_also_when_the_gateway_comes_later() {
        let endpoint = format!("tcp/{}", TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap());
        let endpoints = [endpoint];
        let (to_node, at_node) = channel();
        let node =
            Transport::node(&endpoints, "west", move |bytes| to_node.send(bytes.to_vec()).unwrap()).unwrap();
        assert!(node.send(b"nobody hears".to_vec()), "an absent gateway holds nobody up");
        let (to_gateway, at_gateway) = channel();
        let hear = move |bytes: &[u8]| to_gateway.send(bytes.to_vec()).unwrap();
        let gateway = Transport::gateway(&endpoints, hear).unwrap();
        let patience = Duration::from_millis(20);
        let heard = |send: &dyn Fn(), received: &std::sync::mpsc::Receiver<Vec<u8>>| {
            (0..1000).find_map(|_| {
                send();
                received.recv_timeout(patience).ok()
            })
        };
        assert_eq!(heard(&|| _ = node.send(b"there".to_vec()), &at_gateway), Some(b"there".to_vec()));
        assert_eq!(heard(&|| _ = gateway.send(b"and back".to_vec()), &at_node), Some(b"and back".to_vec()));
    }

    #[test]
    fn what_is_no_endpoint_is_refused_with_how_to_write_one() {
        let refused = Transport::gateway(&["somewhere".into()], |_| ()).unwrap_err();
        assert!(refused.to_string().contains("Endpoints are written like tcp/"), "{refused}");
    }
}
