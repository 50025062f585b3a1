//! One connection to a broker, by the crate `rumqttc` on a thread of its own; after a failure it is of no use any more, so
//! that nothing waits in it.

use std::hash::{BuildHasher, RandomState};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::thread::Builder;
use std::time::{Duration, Instant};

use rumqttc::{
    Client, ConnectReturnCode, ConnectionError, Event, LastWill, MqttOptions, NetworkOptions, Outgoing,
    Packet, QoS,
};
use underfoot::messages::{MqttMessage, MqttTarget};

use super::OFFLINE;

/// Time between two signs of life; a broker that misses one is lost.
const KEEP_ALIVE: Duration = Duration::from_secs(2);

/// Longest wait for a broker, in seconds.
const CONNECT_S: u64 = 2;

/// Maximum number of messages that wait for the network: all states of a large layout.
const QUEUE: usize = 4096;

/// Longest wait for the last messages.
const FAREWELL: Duration = Duration::from_millis(300);

/// Maximum number of characters of the floor's name at the broker, before a number.
const LONGEST_NAME: usize = 14;

/// The variable of the environment with the password.
const PASSWORD: &str = "UNDERFOOT_MQTT_PASSWORD";

/// A connection to a broker, or an attempt.
pub(super) struct BrokerLink {
    news: Receiver<LinkNews>,
    client: Option<Client>,
    is_connected: bool,
    ends: Arc<AtomicBool>,
}

/// News of the thread of a connection.
enum LinkNews {
    Begun(Client),
    Connected,
    Lost(String),
}

/// The result of a look at a connection.
pub(super) enum LinkState {
    Same,
    /// The broker is there now.
    Changed,
    /// The connection is of no use any more, for this reason.
    Lost(String),
}

impl BrokerLink {
    /// Begins to connect to the broker of `target`.
    pub(super) fn open(target: &MqttTarget) -> Result<Self, String> {
        let options =
            options(target).ok_or_else(|| format!("{} is no address of a broker", target.address))?;
        let (tell, news) = channel();
        let ends = Arc::<AtomicBool>::default();
        let noticed = Arc::clone(&ends);
        Builder::new()
            .name("mqtt".into())
            .spawn(move || converse(options, &tell, &noticed))
            .map_err(|error| format!("{}: {error}", target.address))?;
        Ok(Self { news, client: None, is_connected: false, ends })
    }

    /// Takes in the news of the connection.
    pub(super) fn look(&mut self) -> LinkState {
        let mut state = LinkState::Same;
        loop {
            match self.news.try_recv() {
                Ok(LinkNews::Begun(client)) => self.client = Some(client),
                Ok(LinkNews::Connected) => {
                    self.is_connected = true;
                    state = LinkState::Changed;
                }
                Ok(LinkNews::Lost(reason)) => return LinkState::Lost(reason),
                Err(TryRecvError::Empty) => return state,
                Err(TryRecvError::Disconnected) => return LinkState::Lost("no connection".into()),
            }
        }
    }

    /// Whether the broker has accepted the connection.
    pub(super) const fn is_connected(&self) -> bool {
        self.is_connected
    }

    /// Publishes `message`; returns whether there was room for it.
    pub(super) fn publish(&self, message: &MqttMessage) -> bool {
        let MqttMessage { topic, payload, retained } = message;
        let publish =
            |client: &Client| client.try_publish(topic, QoS::AtMostOnce, *retained, payload.as_bytes());
        self.client.as_ref().is_some_and(|client| publish(client).is_ok())
    }

    /// Closes the connection after all published messages, so that the broker does not execute the last will.
    pub(super) fn end(&self) {
        self.disconnect();
        let begun = Instant::now();
        loop {
            match self.news.recv_timeout(FAREWELL.saturating_sub(begun.elapsed())) {
                Ok(LinkNews::Lost(_)) | Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                    return;
                }
                Ok(_) => {}
            }
        }
    }

    fn disconnect(&self) {
        let said = self.client.as_ref().is_some_and(|client| client.try_disconnect().is_ok());
        // A queue that is full has no room for that: the thread ends at the next event.
        self.ends.store(!said, Ordering::Relaxed);
    }
}

impl Drop for BrokerLink {
    fn drop(&mut self) {
        self.disconnect();
    }
}

/// Runs one connection until it breaks or `ends` is set.
fn converse(options: MqttOptions, tell: &Sender<LinkNews>, ends: &AtomicBool) {
    let (client, mut connection) = Client::new(options, QUEUE);
    let mut network = NetworkOptions::new();
    network.set_tcp_nodelay(true);
    network.set_connection_timeout(CONNECT_S);
    connection.eventloop.set_network_options(network);
    // The outlet may be gone already.
    let _ = tell.send(LinkNews::Begun(client));
    for event in connection.iter() {
        let told = match event {
            Ok(Event::Incoming(Packet::ConnAck(_))) => tell.send(LinkNews::Connected),
            // All earlier messages have gone out.
            Ok(Event::Outgoing(Outgoing::Disconnect)) => return,
            Ok(_) => Ok(()),
            Err(error) => {
                let _ = tell.send(LinkNews::Lost(reason(&error)));
                return;
            }
        };
        if told.is_err() || ends.load(Ordering::Relaxed) {
            return;
        }
    }
}

/// The reason why a connection broke, in a few words.
fn reason(error: &ConnectionError) -> String {
    match error {
        ConnectionError::Io(error) => error.to_string(),
        ConnectionError::NetworkTimeout | ConnectionError::FlushTimeout => {
            "the broker does not answer".into()
        }
        ConnectionError::MqttState(_) | ConnectionError::RequestsDone => "the connection has broken".into(),
        ConnectionError::ConnectionRefused(code) => match code {
            ConnectReturnCode::BadUserNamePassword | ConnectReturnCode::NotAuthorized => {
                format!("the broker asks for a user of the target and a password in {PASSWORD}")
            }
            code => format!("the broker refuses the connection: {code:?}"),
        },
        other => other.to_string(),
    }
}

/// The options of a connection to `target`; `None` if its address is none.
fn options(target: &MqttTarget) -> Option<MqttOptions> {
    let (host, port) = target.address.rsplit_once(':')?;
    let host = host.trim_start_matches('[').trim_end_matches(']');
    // Another process with the name of this one would throw it out.
    let name: String = target.base().chars().take(LONGEST_NAME).collect();
    let client = format!("{name}-{:08x}", RandomState::new().hash_one(std::process::id()) as u32);
    let mut options = MqttOptions::new(client, host, port.parse().ok()?);
    options.set_keep_alive(KEEP_ALIVE);
    options.set_last_will(LastWill::new(target.availability(), OFFLINE, QoS::AtMostOnce, true));
    if let Some(user) = &target.user {
        options.set_credentials(user, std::env::var(PASSWORD).unwrap_or_default());
    }
    Some(options)
}
