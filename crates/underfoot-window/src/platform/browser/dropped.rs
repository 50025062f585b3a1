//! Files of the computer, as the script of the page reports them: files and folders that the user drops or chooses, and
//! messages about them.
//!
//! The script walks through folders and reports all files at once, with their paths.

use js_sys::Array;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{CustomEvent, CustomEventInit, File};

/// The event in which the page reports files: pairs of a path and a file.
pub(super) const FILES: &str = "underfoot-files";

/// The event in which the page tells the user something of a file: its text.
pub(super) const TOLD: &str = "underfoot-told";

/// The event in which the window asks the page to let the user choose files.
pub(super) const CHOOSE: &str = "underfoot-choose";

/// The event in which the window reports a layout that the user has saved: its path and its text.
pub(super) const SAVED: &str = "underfoot-saved";

/// A file with its path below the place of the drop, such as `my floor/widgets/large.ron`.
pub(super) type FileAt = (String, File);

/// Passes the details of all events of one name to a function, while it exists.
pub(super) struct PageListener {
    name: &'static str,
    closure: Closure<dyn FnMut(CustomEvent)>,
}

impl PageListener {
    /// Calls `take` with the detail of each event.
    pub(super) fn new(name: &'static str, mut take: impl FnMut(JsValue) + 'static) -> Self {
        let closure = Closure::<dyn FnMut(CustomEvent)>::new(move |event: CustomEvent| take(event.detail()));
        if let Some(window) = web_sys::window() {
            let _ = window.add_event_listener_with_callback(name, closure.as_ref().unchecked_ref());
        }
        Self { name, closure }
    }
}

impl Drop for PageListener {
    fn drop(&mut self) {
        if let Some(window) = web_sys::window() {
            let _ =
                window.remove_event_listener_with_callback(self.name, self.closure.as_ref().unchecked_ref());
        }
    }
}

/// The files in the detail of an event.
pub(super) fn files_of(detail: &JsValue) -> Vec<FileAt> {
    Array::from(detail).iter().filter_map(file_at).collect()
}

fn file_at(pair: JsValue) -> Option<FileAt> {
    let pair: Array = pair.dyn_into().ok()?;
    Some((pair.get(0).as_string()?, pair.get(1).dyn_into().ok()?))
}

/// Dispatches an event to the page; returns whether the page takes care of it.
pub(super) fn dispatch(name: &str, detail: &JsValue) -> bool {
    let content = CustomEventInit::new();
    content.set_detail(detail);
    content.set_cancelable(true);
    let event = CustomEvent::new_with_event_init_dict(name, &content).ok();
    let answered = event.and_then(|event| web_sys::window()?.dispatch_event(&event).ok());
    answered == Some(false)
}
