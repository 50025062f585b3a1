//! Settings of Zenoh: admission of nodes, and the messages that pass.

use std::io::{self, Write};

use serde_json::{Value, json};
use tempfile::NamedTempFile;
use zenoh::Config;

use super::{End, GATEWAY, NODES, node_key};
use crate::auth::Key;
use crate::message::MAX_BYTES;

/// The name by which nodes connect to gateways.
const USER: &str = "node";

/// Sessions besides two for each node: a node that starts again comes while its old session lasts.
const SPARE_SESSIONS: usize = 8;

/// Time for opening a session, in milliseconds; the number of unfinished ones is limited.
const MADE_WITHIN_MS: u64 = 2000;

/// The password with which nodes connect; the floor's key cannot be derived from it.
fn password(key: &Key) -> String {
    blake3::Hash::from(key.derived("underfoot-cluster 2026 Zenoh sessions of nodes")).to_hex().to_string()
}

/// A file with the password of nodes, for a gateway; Zenoh reads it from a file only. It is private to this user.
pub(super) fn password_file(end: End<'_>, key: &Key) -> io::Result<Option<NamedTempFile>> {
    let End::Gateway { .. } = end else { return Ok(None) };
    let mut file = NamedTempFile::new()?;
    writeln!(file, "{USER}:{}", password(key))?;
    Ok(Some(file))
}

/// The settings of one end; those of a gateway refer to `passwords`.
pub(super) fn config(
    endpoints: &[String],
    end: End<'_>,
    key: &Key,
    passwords: Option<&NamedTempFile>,
) -> Result<Config, zenoh::Error> {
    let none: &[String] = &[];
    let (listened, connected) = match end {
        End::Gateway { .. } => (endpoints, none),
        End::Node { .. } => (none, endpoints),
    };
    let credentials = match end {
        End::Gateway { .. } => json!({ "dictionary_file": passwords.map(NamedTempFile::path) }),
        End::Node { .. } => json!({ "user": USER, "password": password(key) }),
    };
    let sessions = match end {
        End::Gateway { areas } => 2 * areas.len() + SPARE_SESSIONS,
        End::Node { .. } => endpoints.len() + SPARE_SESSIONS,
    };
    let settings = json!({
        "mode": "peer",
        // Without a region for them, clients are not admitted.
        "gateway": { "south": [] },
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "listen": { "endpoints": listened },
        // A node finds a gateway that starts later; an absent gateway does not block.
        "connect": {
            "endpoints": connected,
            "exit_on_failure": false,
            "retry": { "period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 2 },
        },
        "transport": {
            "unicast": { "max_sessions": sessions, "accept_timeout": MADE_WITHIN_MS },
            // Time for which a dead connection is kept before a new one is made.
            "link": { "tx": { "lease": 1000 }, "rx": { "max_message_size": 2 * MAX_BYTES } },
            "auth": { "usrpwd": credentials },
        },
        "access_control": access(end),
    });
    Config::from_json5(&settings.to_string())
}

/// The rules of access: each end publishes its own messages and subscribes to those of the other. All else is denied.
fn access(end: End<'_>) -> Value {
    let all_nodes = format!("{NODES}/*");
    let ((hears, tells), users) = match end {
        End::Gateway { areas } => {
            let nodes: Vec<String> = areas.iter().map(|area| node_key(area)).collect();
            ((nodes, vec![GATEWAY.to_owned()]), Some([USER]))
        }
        // A gateway has no name in Zenoh; its messages authenticate it.
        End::Node { area } => ((vec![GATEWAY.to_owned()], vec![node_key(area)]), None),
    };
    let (wants, wanted) = match end {
        End::Gateway { .. } => (all_nodes, GATEWAY.to_owned()),
        End::Node { .. } => (GATEWAY.to_owned(), all_nodes),
    };
    let rule = |id: &str, message: &str, flow: &str, keys: &[String]| json!({ "id": id, "permission": "allow", "messages": [message], "flows": [flow], "key_exprs": keys });
    let rules = [
        rule("hears", "put", "ingress", &hears),
        rule("tells", "put", "egress", &tells),
        rule("wants", "declare_subscriber", "egress", &[wants]),
        rule("is asked for", "declare_subscriber", "ingress", &[wanted]),
    ];
    let subject = match users {
        Some(users) => json!({ "id": "other end", "usernames": users }),
        None => json!({ "id": "other end" }),
    };
    let ids: Vec<&Value> = rules.iter().map(|rule| &rule["id"]).collect();
    json!({
        "enabled": true,
        "default_permission": "deny",
        "rules": rules,
        "subjects": [subject],
        "policies": [{ "rules": ids, "subjects": ["other end"] }],
    })
}
