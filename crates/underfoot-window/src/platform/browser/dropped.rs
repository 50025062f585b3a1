//! Files and folders that the user drops on the page.
//!
//! The script of the page walks through folders and reports all files at once, with their paths.

use js_sys::Array;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{CustomEvent, File};

/// The name of the event in which the page reports files: pairs of a path and a file.
const EVENT: &str = "underfoot-files";

/// A file with its path below the place of the drop, such as `my floor/widgets/large.ron`.
pub(super) type FileAt = (String, File);

/// Passes all files that are dropped on the page to a function, while it exists.
pub(super) struct DropListener(Closure<dyn FnMut(CustomEvent)>);

impl DropListener {
    /// Calls `take` with the files of each drop.
    pub(super) fn new(mut take: impl FnMut(Vec<FileAt>) + 'static) -> Self {
        let closure = Closure::<dyn FnMut(CustomEvent)>::new(move |event: CustomEvent| {
            take(Array::from(&event.detail()).iter().filter_map(file_at).collect());
        });
        if let Some(window) = web_sys::window() {
            let _ = window.add_event_listener_with_callback(EVENT, closure.as_ref().unchecked_ref());
        }
        Self(closure)
    }
}

impl Drop for DropListener {
    fn drop(&mut self) {
        if let Some(window) = web_sys::window() {
            let _ = window.remove_event_listener_with_callback(EVENT, self.0.as_ref().unchecked_ref());
        }
    }
}

fn file_at(pair: JsValue) -> Option<FileAt> {
    let pair: Array = pair.dyn_into().ok()?;
    Some((pair.get(0).as_string()?, pair.get(1).dyn_into().ok()?))
}
