//! Messages through Zenoh, over TCP between named endpoints, without discovery by multicast or gossip.
//!
//! A gateway admits only nodes with the floor's key, no clients, and only messages of nodes and gateways, each in its
//! direction. This keeps others from listening through it and from using its memory; accepting a message does not
//! depend on it ([`crate::auth`]).
//!
//! This module does not ask Zenoh whether the other end is alive, since Zenoh's sessions outlive a cut cable by
//! seconds: the age of the messages' contents decides.

mod config;

use thiserror::Error;
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::qos::{CongestionControl, Priority};

use self::config::{config, password_file};
use crate::auth::Key;

/// Default endpoint of the gateway; Zenoh's own port.
pub const ENDPOINT: &str = "tcp/127.0.0.1:7447";

/// Key prefix under which nodes publish, each under its area's name.
const NODES: &str = "underfoot/cluster/node";

/// Key under which gateways publish.
const GATEWAY: &str = "underfoot/cluster/gateway";

/// The reason why there is no connection.
#[derive(Debug, Error)]
pub enum TransportError {
    /// An endpoint is invalid, or the gateway cannot listen on it.
    #[error("{endpoints}: {why}. Endpoints are written like {ENDPOINT}")]
    Endpoints {
        /// The endpoints as given.
        endpoints: String,
        /// Zenoh's error message.
        why: String,
    },
    /// A gateway hands Zenoh the password of nodes in a file.
    #[error("the file with Zenoh's password can't be written: {0}. `TMPDIR` names another folder for it")]
    Password(std::io::Error),
}

/// One end: a node's or a gateway's. Dropping it closes it.
#[derive(Debug)]
pub struct TransportEnd {
    session: zenoh::Session,
    key: String,
}

/// The kind of end.
#[derive(Clone, Copy, Debug)]
enum End<'a> {
    Gateway { areas: &'a [String] },
    Node { area: &'a str },
}

/// The key expression of the node of `area`.
fn node_key(area: &str) -> String {
    format!("{NODES}/{area}")
}

impl TransportEnd {
    /// A gateway's end, which listens on `endpoints` for the nodes of `areas` that have the same `key`; it calls
    /// `hear` with their messages, on threads of its own.
    ///
    /// # Errors
    /// [`TransportError::Endpoints`] if it can't listen there.
    pub fn gateway(
        endpoints: &[String],
        areas: &[String],
        key: &Key,
        hear: impl Fn(&[u8]) + Send + Sync + 'static,
    ) -> Result<Self, TransportError> {
        Self::open(endpoints, End::Gateway { areas }, key, hear)
    }

    /// The end of the node of `area`, which connects to gateways at `endpoints` that have the same `key`, now or when
    /// they start; it calls `hear` with their messages, on threads of its own.
    ///
    /// # Errors
    /// [`TransportError::Endpoints`] if one of them can't be an endpoint.
    pub fn node(
        endpoints: &[String],
        area: &str,
        key: &Key,
        hear: impl Fn(&[u8]) + Send + Sync + 'static,
    ) -> Result<Self, TransportError> {
        Self::open(endpoints, End::Node { area }, key, hear)
    }

    fn open(
        endpoints: &[String],
        end: End<'_>,
        key: &Key,
        hear: impl Fn(&[u8]) + Send + Sync + 'static,
    ) -> Result<Self, TransportError> {
        let failed = |why: zenoh::Error| TransportError::Endpoints {
            endpoints: endpoints.join(", "),
            why: why.to_string(),
        };
        // Zenoh reads the file while it opens the session.
        let file = password_file(end, key).map_err(TransportError::Password)?;
        let config = config(endpoints, end, key, file.as_ref()).map_err(failed)?;
        let session = zenoh::open(config).wait().map_err(failed)?;
        let (key, heard) = match end {
            End::Gateway { .. } => (GATEWAY.to_owned(), format!("{NODES}/*")),
            End::Node { area } => (node_key(area), GATEWAY.to_owned()),
        };
        let subscriber = session.declare_subscriber(heard);
        let hear = move |sample: zenoh::sample::Sample| hear(&sample.payload().to_bytes());
        subscriber.callback(hear).background().wait().map_err(failed)?;
        Ok(Self { session, key })
    }

    /// Sends `bytes` to the other end, if there is one that receives them. A message that cannot be sent within a
    /// millisecond is dropped; later messages show the gap. Returns whether Zenoh accepted it.
    pub fn send(&self, bytes: Vec<u8>) -> bool {
        let put = self.session.put(self.key.as_str(), ZBytes::from(bytes));
        let put = put.congestion_control(CongestionControl::Drop).priority(Priority::RealTime).express(true);
        put.wait().is_ok()
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::Duration;

    use super::*;

    /// Time without a message that counts as silence: a hundred times that of a message.
    const SILENCE: Duration = Duration::from_millis(300);

    type Received = Receiver<Vec<u8>>;

    fn endpoint() -> String {
        format!("tcp/{}", TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap())
    }

    fn key() -> Key {
        Key::new([7; 32])
    }

    fn listener() -> (impl Fn(&[u8]) + Send + Sync + 'static, Received) {
        let (to, received) = channel();
        (move |bytes: &[u8]| _ = to.send(bytes.to_vec()), received)
    }

    fn gateway(endpoint: &str) -> (TransportEnd, Received) {
        let (hear, received) = listener();
        (TransportEnd::gateway(&[endpoint.into()], &["west".into()], &key(), hear).unwrap(), received)
    }

    fn node(endpoint: &str, area: &str, key: &Key) -> (TransportEnd, Received) {
        let (hear, received) = listener();
        (TransportEnd::node(&[endpoint.into()], area, key, hear).unwrap(), received)
    }

    /// The first message that arrives while `send` is called repeatedly.
    fn heard(send: &dyn Fn(), received: &Received) -> Option<Vec<u8>> {
        (0..1000).find_map(|_| {
            send();
            received.recv_timeout(Duration::from_millis(20)).ok()
        })
    }

    /// A session of another program that connects to the endpoint in this mode; `None` if it is not admitted.
    fn stranger(endpoint: &str, mode: &str, credentials: Option<&Key>) -> Option<zenoh::Session> {
        let mut settings = serde_json::json!({
            "mode": mode,
            "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
            "listen": { "endpoints": [] },
            "connect": { "endpoints": [endpoint], "timeout_ms": 1000, "exit_on_failure": true },
        });
        if let Some(key) = credentials {
            let nodes = config(&[], End::Node { area: "west" }, key, None).unwrap();
            let shown = nodes.get_json("transport/auth/usrpwd").unwrap();
            settings["transport"]["auth"]["usrpwd"] = serde_json::from_str(&shown).unwrap();
        }
        let config = zenoh::Config::from_json5(&settings.to_string()).unwrap();
        zenoh::open(config).wait().ok()
    }

    /// Number of messages of others that a session receives while `send` is called.
    fn overheard(session: &zenoh::Session, send: &dyn Fn()) -> usize {
        let all = session.declare_subscriber("**").wait().unwrap();
        (0..15).for_each(|_| {
            send();
            std::thread::sleep(SILENCE / 15);
        });
        let heard = std::iter::from_fn(|| all.try_recv().ok().flatten());
        heard.filter(|sample| *sample.payload().to_bytes() != *b"forged").count()
    }

    #[test]
    fn both_ends_hear_each_other_also_when_the_gateway_comes_later() {
        let endpoint = endpoint();
        let (node, at_node) = node(&endpoint, "west", &key());
        assert!(node.send(b"nobody hears".to_vec()), "an absent gateway holds nobody up");
        let (gateway, at_gateway) = gateway(&endpoint);
        assert_eq!(heard(&|| _ = node.send(b"there".to_vec()), &at_gateway), Some(b"there".to_vec()));
        assert_eq!(heard(&|| _ = gateway.send(b"and back".to_vec()), &at_node), Some(b"and back".to_vec()));
    }

    #[test]
    fn what_is_no_endpoint_is_refused_with_how_to_write_one() {
        let refused = TransportEnd::gateway(&["somewhere".into()], &[], &key(), |_| ()).unwrap_err();
        assert!(refused.to_string().contains("Endpoints are written like tcp/"), "{refused}");
    }

    #[test]
    fn a_node_with_another_key_is_not_admitted() {
        let endpoint = endpoint();
        let (_gateway, at_gateway) = gateway(&endpoint);
        let (own, _) = node(&endpoint, "west", &key());
        let (other, at_other) = node(&endpoint, "west", &Key::new([8; 32]));
        assert!(heard(&|| _ = own.send(b"own".to_vec()), &at_gateway).is_some());
        for _ in 0..15 {
            other.send(b"other".to_vec());
            std::thread::sleep(SILENCE / 15);
        }
        assert!(at_gateway.try_iter().all(|bytes| bytes != b"other"));
        assert!(at_other.try_recv().is_err());
    }

    // C5
    #[test]
    fn a_stranger_is_not_admitted() {
        let endpoint = endpoint();
        let (_gateway, _) = gateway(&endpoint);
        for mode in ["client", "peer", "router"] {
            assert!(stranger(&endpoint, mode, None).is_none(), "{mode}");
        }
        assert!(stranger(&endpoint, "peer", Some(&Key::new([8; 32]))).is_none(), "with another key");
        assert!(stranger(&endpoint, "peer", Some(&key())).is_some(), "with the floor's key");
    }

    #[test]
    fn a_client_is_not_admitted_even_with_the_key() {
        let endpoint = endpoint();
        let (_gateway, _) = gateway(&endpoint);
        assert!(stranger(&endpoint, "client", Some(&key())).is_none());
    }

    #[test]
    fn a_session_with_the_key_exchanges_only_messages_of_its_direction() {
        let endpoint = endpoint();
        let (gateway, at_gateway) = gateway(&endpoint);
        let (node, at_node) = node(&endpoint, "west", &key());
        assert!(heard(&|| _ = gateway.send(b"back".to_vec()), &at_node).is_some());
        let session = stranger(&endpoint, "peer", Some(&key())).unwrap();
        // These messages pass Zenoh; the gateway rejects them.
        let told = || session.put("underfoot/cluster/node/west", b"told".to_vec()).wait().unwrap();
        assert!(heard(&told, &at_gateway).is_some());
        while at_gateway.recv_timeout(SILENCE).is_ok() {}
        while at_node.try_recv().is_ok() {}
        let both = || {
            node.send(b"there".to_vec());
            session.put(GATEWAY, b"forged".to_vec()).wait().unwrap();
            session.put("underfoot/cluster/node/nowhere", b"forged".to_vec()).wait().unwrap();
        };
        assert_eq!(overheard(&session, &both), 0);
        assert!(at_gateway.try_iter().all(|bytes| bytes == b"there"));
        assert!(at_node.try_recv().is_err());
    }
}
