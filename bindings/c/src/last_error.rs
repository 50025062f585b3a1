//! The text of the last failed call on each thread.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Stores `text` for `uf_last_error` on this thread, cut at its first 0.
pub(crate) fn keep(text: &str) {
    let text = text.split('\0').next().unwrap_or_default();
    let text = CString::new(text).unwrap_or_default();
    // At the end of a thread the text is no longer needed.
    let _ = LAST.try_with(|last| last.replace(text));
}

/// The text stored last on this thread; it is valid until the next failure there.
pub(crate) fn last() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(CStr::as_ptr(c""))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text() -> String {
        // SAFETY: lasts until the next failure on this thread.
        unsafe { CStr::from_ptr(last()) }.to_str().unwrap_or_default().to_owned()
    }

    #[test]
    fn each_thread_keeps_its_own_failure() {
        keep("one");
        std::thread::spawn(|| {
            assert_eq!(text(), "");
            keep("two");
        })
        .join()
        .unwrap_or_default();
        assert_eq!(text(), "one");
        keep("cut\0here");
        assert_eq!(text(), "cut");
    }
}
