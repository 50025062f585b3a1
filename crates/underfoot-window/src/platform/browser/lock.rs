//! A folder that one page uses alone.

use std::path::{Path, PathBuf};

use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;

use super::files::{read, remove, write_over};

const LOCK: &str = "lock";

/// Interval between renewals, in milliseconds.
const RENEWED_MS: i32 = 20_000;

/// Age of a lock whose page has ended without releasing it, in milliseconds: browsers delay the timers of a hidden
/// page by up to a minute.
const STALE_MS: f64 = 180_000.0;

/// A folder that only this page uses, among all pages of this browser.
#[derive(Debug)]
pub(crate) struct FolderLock {
    entry: PathBuf,
    timer: Option<i32>,
    _renew: Closure<dyn FnMut()>,
    release: Closure<dyn FnMut()>,
}

impl FolderLock {
    /// Locks a folder; `None` while another page uses it.
    pub(crate) fn take(folder: &Path) -> Option<Self> {
        let entry = folder.join(LOCK);
        let taken = read(&entry, 64).ok().and_then(|text| text.parse::<f64>().ok());
        if taken.is_some_and(|at| js_sys::Date::now() - at < STALE_MS) {
            return None;
        }
        write_over(&now(), &entry).ok()?;
        let at = entry.clone();
        let renew = Closure::new(move || _ = write_over(&now(), &at));
        let at = entry.clone();
        let release = Closure::new(move || remove(&at));
        let window = web_sys::window()?;
        let timer = window.set_interval_with_callback_and_timeout_and_arguments_0(
            renew.as_ref().unchecked_ref(),
            RENEWED_MS,
        );
        let listener = release.as_ref().unchecked_ref();
        let _ = window.add_event_listener_with_callback("pagehide", listener);
        Some(Self { entry, timer: timer.ok(), _renew: renew, release })
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        remove(&self.entry);
        let Some(window) = web_sys::window() else { return };
        if let Some(timer) = self.timer {
            window.clear_interval_with_handle(timer);
        }
        let listener = self.release.as_ref().unchecked_ref();
        let _ = window.remove_event_listener_with_callback("pagehide", listener);
    }
}

fn now() -> String {
    js_sys::Date::now().to_string()
}
