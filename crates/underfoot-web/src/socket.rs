//! The connection of the page to the server that it comes from.

use js_sys::{ArrayBuffer, JsString, Uint8Array};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{BinaryType, CloseEvent, MessageEvent, WebSocket};

/// News of a connection.
pub(crate) enum SocketNews {
    /// A text has come.
    Text(String),
    /// Bytes have come.
    Frame(Vec<u8>),
    /// The connection has ended, or could not be made.
    Closed,
}

/// A WebSocket, which passes on its news until it is closed or dropped.
pub(crate) struct PageSocket {
    socket: WebSocket,
    /// Called for each message, for as long as this exists.
    _heard: Closure<dyn Fn(MessageEvent)>,
    /// Called at the end.
    _closed: Closure<dyn Fn(CloseEvent)>,
}

impl PageSocket {
    /// Connects to `address`, and calls `tell` with the news.
    pub(crate) fn open(address: &str, tell: impl Fn(SocketNews) + Clone + 'static) -> Result<Self, JsValue> {
        let socket = WebSocket::new(address)?;
        socket.set_binary_type(BinaryType::Arraybuffer);
        let hear = tell.clone();
        let heard = Closure::<dyn Fn(MessageEvent)>::new(move |message: MessageEvent| {
            let data = message.data();
            if let Some(text) = data.dyn_ref::<JsString>() {
                hear(SocketNews::Text(text.into()));
            } else if let Some(bytes) = data.dyn_ref::<ArrayBuffer>() {
                hear(SocketNews::Frame(Uint8Array::new(bytes).to_vec()));
            }
        });
        let closed = Closure::<dyn Fn(CloseEvent)>::new(move |_| tell(SocketNews::Closed));
        socket.set_onmessage(Some(heard.as_ref().unchecked_ref()));
        socket.set_onclose(Some(closed.as_ref().unchecked_ref()));
        Ok(Self { socket, _heard: heard, _closed: closed })
    }

    /// Sends a text; false if the connection does not stand.
    pub(crate) fn send(&self, text: &str) -> bool {
        self.socket.ready_state() == WebSocket::OPEN && self.socket.send_with_str(text).is_ok()
    }

    /// Ends the connection: no more news follow.
    pub(crate) fn close(&self) {
        self.socket.set_onmessage(None);
        self.socket.set_onclose(None);
        // It may have ended meanwhile.
        let _ = self.socket.close();
    }
}

impl Drop for PageSocket {
    fn drop(&mut self) {
        self.close();
    }
}
