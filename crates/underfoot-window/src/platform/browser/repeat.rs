//! Work beside the frames of the window, in the frames of the page.

use std::cell::RefCell;
use std::io;
use std::rc::Rc;

use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use web_time::Instant;

/// Calls `work` again and again: in the frame at `first`, and then in that at each time that it returns, until it
/// returns `None`. While the page is hidden, it has no frames.
///
/// # Errors
/// None in a page; outside of one, an error.
pub(crate) fn repeat(
    _name: &str,
    first: Instant,
    mut work: impl FnMut() -> Option<Instant> + 'static,
) -> io::Result<()> {
    let slot: Rc<RefCell<Option<Closure<dyn FnMut()>>>> = Rc::default();
    let (own, mut due) = (Rc::clone(&slot), Some(first));
    *slot.borrow_mut() = Some(Closure::new(move || {
        if due.is_some_and(|due| Instant::now() >= due) {
            due = work();
        }
        if due.is_some() {
            // It fails only while the page is being left.
            let _ = own.borrow().as_ref().is_some_and(request);
        }
    }));
    let begun = slot.borrow().as_ref().is_some_and(request);
    if begun { Ok(()) } else { Err(io::Error::other("there is no page")) }
}

/// Requests a call in the next frame of the page; false outside of a page.
fn request(frame: &Closure<dyn FnMut()>) -> bool {
    let window = web_sys::window();
    window.is_some_and(|window| window.request_animation_frame(frame.as_ref().unchecked_ref()).is_ok())
}
