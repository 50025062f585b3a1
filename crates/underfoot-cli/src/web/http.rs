//! Requests and answers of HTTP, one per connection.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Maximum size of a request's head, in bytes.
const MOST_HEAD: usize = 8192;

/// Maximum time for the rest of a request after its answer.
const LINGER: Duration = Duration::from_millis(20);

/// The head of a request.
#[derive(Debug, PartialEq)]
pub(super) struct RequestHead {
    pub(super) method: String,
    /// The path, without the query.
    pub(super) path: String,
    /// The text behind the question mark; `None` without one.
    pub(super) query: Option<String>,
    /// Names in lower case, and values.
    headers: Vec<(String, String)>,
}

impl RequestHead {
    /// Reads the head; `None` if it has no request line.
    fn parse(text: &str) -> Option<Self> {
        let (line, rest) = text.split_once("\r\n")?;
        let mut words = line.split(' ');
        let (method, target, version) = (words.next()?, words.next()?, words.next()?);
        if !target.starts_with('/') || !version.starts_with("HTTP/1.") {
            return None;
        }
        let (path, query) = match target.split_once('?') {
            Some((path, query)) => (path, Some(query.to_owned())),
            None => (target, None),
        };
        let header = |line: &str| {
            let (name, value) = line.split_once(':')?;
            Some((name.to_ascii_lowercase(), value.trim().to_owned()))
        };
        let headers = rest.split("\r\n").filter_map(header).collect();
        Some(Self { method: method.to_owned(), path: path.to_owned(), query, headers })
    }

    /// The first header with this name in lower case.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(other, _)| other == name).map(|(_, value)| value.as_str())
    }

    /// Whether it asks for a WebSocket.
    pub(super) fn is_upgrade(&self) -> bool {
        self.header("upgrade").is_some_and(|to| to.eq_ignore_ascii_case("websocket"))
    }
}

/// Makes `stream` block on its client, up to this time-out.
pub(super) fn wait_for(stream: &TcpStream, patience: Duration) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(patience))?;
    stream.set_write_timeout(Some(patience))?;
    stream.set_nodelay(true)
}

/// The head of the request, which remains in the stream; `None` if none has come within `patience`, or one that is too
/// long or malformed.
pub(super) fn head(stream: &TcpStream, patience: Duration) -> Option<RequestHead> {
    let begun = Instant::now();
    let mut bytes = [0; MOST_HEAD];
    while begun.elapsed() < patience {
        let count = stream.peek(&mut bytes).ok().filter(|&count| count > 0)?;
        let head = &bytes[..count];
        if let Some(end) = head.windows(4).position(|end| end == b"\r\n\r\n") {
            return RequestHead::parse(&String::from_utf8_lossy(&head[..end + 4]));
        }
        if count == MOST_HEAD {
            return None;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    None
}

/// Refuses a request with a reason.
pub(super) fn turn_away(stream: TcpStream, status: &str, why: &str) {
    answer(stream, status, "Content-Type: text/plain; charset=utf-8\r\n", why);
}

/// Answers with `body` and ends the connection; each line of `head` ends with a line break.
pub(super) fn answer(mut stream: TcpStream, status: &str, head: &str, body: impl AsRef<[u8]>) {
    let body = body.as_ref();
    // An answer without content must not give its length (RFC 9110, 8.6), nor that of another answer.
    let has_length = !status.starts_with("204") && !status.starts_with("304");
    let length = if has_length { format!("Content-Length: {}\r\n", body.len()) } else { String::new() };
    let head = format!("HTTP/1.1 {status}\r\n{head}{length}Connection: close\r\n\r\n");
    // The client may not wait for the answer.
    let _ = stream.write_all(&[head.as_bytes(), body].concat());
    // Reads the request, so that the system does not cut the answer off.
    let _ = stream.set_read_timeout(Some(LINGER));
    let _ = stream.read(&mut [0; MOST_HEAD]);
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_its_path_its_query_and_its_headers() {
        let head = RequestHead::parse(
            "GET /a/b?VALUE HTTP/1.1\r\nHost: 127.0.0.1:9002\r\nUPGRADE: WebSocket\r\n\r\n",
        );
        let head = head.unwrap();
        assert_eq!((&*head.method, &*head.path, head.query.as_deref()), ("GET", "/a/b", Some("VALUE")));
        assert_eq!(head.header("host"), Some("127.0.0.1:9002"));
        assert!(head.is_upgrade());
        for bad in [
            "",
            "\r\n\r\n",
            "GET /\r\n\r\n",
            "GET http://elsewhere/ HTTP/1.1\r\n\r\n",
            "GET / RTSP/1.0\r\n\r\n",
        ] {
            assert_eq!(RequestHead::parse(bad), None, "{bad:?}");
        }
    }
}
