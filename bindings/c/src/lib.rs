//! The runtime for programs in C; `underfoot.h` describes each function.
//!
//! Each function checks its pointers and texts, and catches panics.

mod last_error;
mod session;
mod status;
mod structs;

use std::ffi::{CStr, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::time::Duration;

use underfoot::glam::Vec2;
use underfoot::runtime::{ControlHandle, Refusal};
use underfoot::widget::{Indicator, Value};

pub use session::UfSession;
use status::{OK, ON, OVER, PANIC, TIMEOUT, bad_argument, of_reason, of_refusal};
pub use structs::{UfContact, UfEvent, UfOptions, UfValue};
use structs::{put, sized};

/// Length of one wait in a loop without a time-out.
const HOUR: Duration = Duration::from_secs(3600);

/// Calls `f`; returns `fallen` if it panics.
fn contained<T>(fallen: T, f: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(f)).unwrap_or_else(|_| {
        last_error::keep("a fault of the library");
        fallen
    })
}

/// The text at `text`; `None` for null and for bytes that are not UTF-8.
///
/// # Safety
/// `text` is null or ends with a 0 and stays as it is for `'a`.
unsafe fn text<'a>(text: *const c_char) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    // SAFETY: not null; the rest is the caller's promise.
    unsafe { CStr::from_ptr(text) }.to_str().ok()
}

/// Calls `what` with one control.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
unsafe fn with_control(
    session: *const UfSession,
    id: *const c_char,
    what: impl FnOnce(ControlHandle<'_>) -> Result<(), Refusal>,
) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let (Some(session), Some(id)) = (unsafe { session.as_ref() }, unsafe { text(id) }) else {
            return bad_argument();
        };
        match session.floor.control(id).and_then(what) {
            Ok(()) => OK,
            Err(refusal) => of_refusal(&refusal),
        }
    })
}

/// Starts a floor; see `underfoot.h`.
///
/// # Safety
/// The texts are null or end with 0, `options` is null or of its declared size, `error` is null or has `error_size`
/// bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_session_listen(
    address: *const c_char,
    layout: *const c_char,
    options: *const UfOptions,
    error: *mut c_char,
    error_size: usize,
) -> *mut UfSession {
    // SAFETY: as the caller promises.
    let (address, layout, options) = unsafe { (text(address), text(layout), options.as_ref()) };
    let started = contained(Err("a fault of the library".to_owned()), || {
        let (Some(address), Some(layout)) = (address, layout) else {
            return Err("address and layout must be texts in UTF-8".to_owned());
        };
        let every_change = every_change(options)?;
        let floor = options.map_or(ptr::null(), |options| options.floor_path);
        // SAFETY: as the caller promises.
        let floor = unsafe { optional_path(floor, "floor file") }?;
        UfSession::listen(address, layout, floor, every_change)
    });
    // SAFETY: as the caller promises.
    unsafe { handed_out(started, error, error_size) }
}

/// Starts a replay of a recorded floor; see `underfoot.h`.
///
/// # Safety
/// `recording` is null or ends with 0, `options` is null or of its declared size, `error` is null or has `error_size`
/// bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_session_replay(
    recording: *const c_char,
    speed: f64,
    options: *const UfOptions,
    error: *mut c_char,
    error_size: usize,
) -> *mut UfSession {
    // SAFETY: as the caller promises.
    let (recording, options) = unsafe { (text(recording), options.as_ref()) };
    let started = contained(Err("a fault of the library".to_owned()), || {
        let recording = recording.ok_or("the path of the recording must be a text in UTF-8")?;
        UfSession::replay(recording, speed, every_change(options)?)
    });
    // SAFETY: as the caller promises.
    unsafe { handed_out(started, error, error_size) }
}

/// Starts a simulated floor; see `underfoot.h`.
///
/// # Safety
/// The texts are null or end with 0, `options` is null or of its declared size, `error` is null or has `error_size`
/// bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_session_simulated(
    layout: *const c_char,
    scenario: *const c_char,
    options: *const UfOptions,
    error: *mut c_char,
    error_size: usize,
) -> *mut UfSession {
    // SAFETY: as the caller promises.
    let (layout, options) = unsafe { (text(layout), options.as_ref()) };
    let started = contained(Err("a fault of the library".to_owned()), || {
        let layout = layout.ok_or("the path of the layout must be a text in UTF-8")?;
        // SAFETY: as the caller promises.
        let scenario = unsafe { optional_path(scenario, "scenario") }?;
        UfSession::simulated(layout, scenario, every_change(options)?)
    });
    // SAFETY: as the caller promises.
    unsafe { handed_out(started, error, error_size) }
}

/// The path at `path`; `None` for null, and an error that names `file` for bytes that are not UTF-8.
///
/// # Safety
/// `path` is null or ends with a 0 and stays as it is for `'a`.
unsafe fn optional_path<'a>(path: *const c_char, file: &str) -> Result<Option<&'a str>, String> {
    if path.is_null() {
        return Ok(None);
    }
    // SAFETY: as the caller promises.
    unsafe { text(path) }.map(Some).ok_or_else(|| format!("the path of the {file} is not UTF-8"))
}

/// Whether the options request every value.
fn every_change(options: Option<&UfOptions>) -> Result<bool, String> {
    match options {
        Some(options) if !sized::<UfOptions>(options.size) => {
            Err("the options have a size that no version has".to_owned())
        }
        options => Ok(options.is_some_and(|options| options.every_change != 0)),
    }
}

/// The handle of a session; on failure null, with the reason in `error` and for `uf_last_error`.
///
/// # Safety
/// `error` is null or has `error_size` bytes.
unsafe fn handed_out(
    started: Result<UfSession, String>,
    error: *mut c_char,
    error_size: usize,
) -> *mut UfSession {
    match started {
        Ok(session) => Box::into_raw(Box::new(session)),
        Err(why) => {
            last_error::keep(&why);
            // SAFETY: as the caller promises.
            unsafe { put_at(error, error_size, &why) };
            ptr::null_mut()
        }
    }
}

/// Writes `text` to `place`, cut to `size` bytes with the closing 0; writes nothing if `place` is null or empty.
///
/// # Safety
/// `place` is null or has `size` bytes.
unsafe fn put_at(place: *mut c_char, size: usize, text: &str) {
    if !place.is_null() && size > 0 {
        // SAFETY: as the caller promises.
        put(unsafe { std::slice::from_raw_parts_mut(place, size) }, text);
    }
}

/// Takes the next event; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `event` is null or of its declared size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_next(session: *mut UfSession, event: *mut UfEvent, timeout_ms: c_int) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let (Some(session), false) = (unsafe { session.as_ref() }, event.is_null()) else {
            return bad_argument();
        };
        // SAFETY: not null; `size` comes first in all versions.
        if !sized::<UfEvent>(unsafe { ptr::read(event.cast::<u32>()) }) {
            return bad_argument();
        }
        let patience = u64::try_from(timeout_ms).ok().map(Duration::from_millis);
        loop {
            if let Some(next) = session.next(patience.unwrap_or(HOUR)) {
                // SAFETY: of this version's size at least, as was checked.
                unsafe { ptr::write(event, UfEvent::of(&next, ptr::read(event.cast::<u32>()))) };
                return OK;
            }
            if session.is_over() {
                return OVER;
            }
            if patience.is_some() {
                return TIMEOUT;
            }
        }
    })
}

/// Whether a foot holds a control now; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_held(session: *const UfSession, id: *const c_char) -> c_int {
    contained(0, || {
        // SAFETY: as the caller promises.
        let (Some(session), Some(id)) = (unsafe { session.as_ref() }, unsafe { text(id) }) else { return 0 };
        match session.floor.held(id) {
            Ok(held) => c_int::from(held.is_fresh()),
            // Not the number of a failure: a program that treats all but 0 as held would never stop.
            Err(refusal) => {
                of_refusal(&refusal);
                0
            }
        }
    })
}

/// Whether the layout has a control of this name; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_has(session: *const UfSession, id: *const c_char) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |_| Ok(())) }
}

/// The reason why a control is off; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text, `text` is null or has `text_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_off(
    session: *const UfSession,
    id: *const c_char,
    text: *mut c_char,
    text_size: usize,
) -> c_int {
    let mut off = None;
    // SAFETY: as the caller promises.
    let status = unsafe {
        with_control(session, id, |control| {
            off = control.state()?.off;
            Ok(())
        })
    };
    // SAFETY: as the caller promises.
    unsafe { put_at(text, text_size, off.as_ref().map_or("", |off| &off.text)) };
    match off {
        _ if status != OK => status,
        Some(off) => of_reason(off.reason),
        None => ON,
    }
}

/// The word for a reason; see `underfoot.h`.
#[unsafe(no_mangle)]
pub extern "C" fn uf_off_name(reason: c_int) -> *const c_char {
    status::reason_name(reason).as_ptr()
}

/// The number of controls; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_control_count(session: *const UfSession) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let Some(session) = (unsafe { session.as_ref() }) else { return bad_argument() };
        c_int::try_from(session.floor.controls().len()).unwrap_or(c_int::MAX)
    })
}

/// The name of a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or has `id_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_control_id(
    session: *const UfSession,
    index: c_int,
    id: *mut c_char,
    id_size: usize,
) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let Some(session) = (unsafe { session.as_ref() }) else { return bad_argument() };
        let controls = session.floor.controls();
        let Some(control) = usize::try_from(index).ok().and_then(|index| controls.get(index)) else {
            last_error::keep(&format!("there is no control number {index}: there are {}", controls.len()));
            return status::UNKNOWN;
        };
        // SAFETY: as the caller promises.
        unsafe { put_at(id, id_size, control.id()) };
        OK
    })
}

/// The address for boards; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `address` is null or has `address_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_address(
    session: *const UfSession,
    address: *mut c_char,
    address_size: usize,
) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let Some(session) = (unsafe { session.as_ref() }) else { return bad_argument() };
        let text = session.floor.local_addr().map(|address| address.to_string()).unwrap_or_default();
        // SAFETY: as the caller promises.
        unsafe { put_at(address, address_size, &text) };
        c_int::try_from(text.len()).unwrap_or(c_int::MAX)
    })
}

/// The text of the last failed call; see `underfoot.h`.
#[unsafe(no_mangle)]
pub extern "C" fn uf_last_error() -> *const c_char {
    last_error::last()
}

/// A descriptor to poll; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_fd(session: *const UfSession) -> c_int {
    // SAFETY: as the caller promises.
    contained(PANIC, || unsafe { session.as_ref() }.map_or_else(bad_argument, UfSession::descriptor))
}

/// The value of a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text, `value` is null or of its declared size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_get(session: *const UfSession, id: *const c_char, value: *mut UfValue) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let (Some(session), Some(id)) = (unsafe { session.as_ref() }, unsafe { text(id) }) else {
            return bad_argument();
        };
        // SAFETY: not null; `size` comes first in all versions.
        if value.is_null() || !sized::<UfValue>(unsafe { ptr::read(value.cast::<u32>()) }) {
            return bad_argument();
        }
        let state = match session.floor.control(id).and_then(|control| control.state()) {
            Ok(state) => state,
            Err(refusal) => return of_refusal(&refusal),
        };
        // SAFETY: of this version's size at least, as was checked.
        unsafe { ptr::write(value, UfValue::of(state.value, ptr::read(value.cast::<u32>()))) };
        OK
    })
}

/// The feet on the floor; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `contacts` has `capacity` elements of `element_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_contacts(
    session: *const UfSession,
    contacts: *mut UfContact,
    capacity: usize,
    element_size: usize,
) -> c_int {
    contained(PANIC, || {
        let size = u32::try_from(element_size).unwrap_or(0);
        // SAFETY: as the caller promises.
        let Some(session) = (unsafe { session.as_ref() }) else { return bad_argument() };
        if (contacts.is_null() && capacity > 0) || !sized::<UfContact>(size) {
            return bad_argument();
        }
        let feet = session.floor.snapshot().floor.contacts;
        for (index, foot) in feet.iter().enumerate().take(capacity) {
            // SAFETY: within `capacity` elements, each of this version's size at least; aligned as the first one is,
            // or not, in a later version.
            unsafe {
                let place = contacts.byte_add(index * element_size);
                ptr::write_unaligned(place, UfContact::of(foot, size));
            }
        }
        c_int::try_from(feet.len()).unwrap_or(c_int::MAX)
    })
}

/// The reason why boards that send give no usable frame; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `text` is null or has `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_link_cause(session: *const UfSession, text: *mut c_char, size: usize) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        let (Some(session), false) = (unsafe { session.as_ref() }, text.is_null() || size == 0) else {
            return bad_argument();
        };
        let cause = session.floor.snapshot().floor.link_cause;
        let said = cause.map(|cause| format!("{}: {cause}", cause.name())).unwrap_or_default();
        // SAFETY: not null; the rest is the caller's promise.
        put(unsafe { std::slice::from_raw_parts_mut(text, size) }, &said);
        OK
    })
}

/// Number of dropped events; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_dropped(session: *const UfSession) -> u64 {
    // SAFETY: as the caller promises.
    contained(0, || unsafe { session.as_ref() }.map_or(0, |session| session.floor.dropped()))
}

/// Sets a control to a number; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_number(session: *mut UfSession, id: *const c_char, value: f32) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set(value)) }
}

/// Sets a pad to two numbers; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_pair(
    session: *mut UfSession,
    id: *const c_char,
    east: f32,
    north: f32,
) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set(Value::Pair(Vec2::new(east, north)))) }
}

/// Sets the range of a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_range(
    session: *mut UfSession,
    id: *const c_char,
    least: f32,
    greatest: f32,
) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set_range(least..=greatest)) }
}

/// Sets the label of a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, the texts are null or end with 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_label(
    session: *mut UfSession,
    id: *const c_char,
    label: *const c_char,
) -> c_int {
    // SAFETY: as the caller promises.
    let Some(label) = (unsafe { text(label) }) else { return bad_argument() };
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set_label(label)) }
}

/// Sets the indicator of a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, the texts are null or end with 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_indicator(
    session: *mut UfSession,
    id: *const c_char,
    lamp: *const c_char,
) -> c_int {
    // SAFETY: as the caller promises.
    let Some(lamp) = (unsafe { text(lamp) }) else { return bad_argument() };
    let Some(lamp) = Indicator::ALL.into_iter().find(|other| other.name() == lamp) else {
        return bad_argument();
    };
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set_indicator(lamp)) }
}

/// Enables or disables a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_enabled(session: *mut UfSession, id: *const c_char, enabled: c_int) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set_enabled(enabled != 0)) }
}

/// Locks or unlocks the value of a control; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `id` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_locked(session: *mut UfSession, id: *const c_char, locked: c_int) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with_control(session, id, |control| control.set_locked(locked != 0)) }
}

/// Shows another page; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid, `page` is null or a text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_set_page(session: *mut UfSession, page: *const c_char) -> c_int {
    contained(PANIC, || {
        // SAFETY: as the caller promises.
        match (unsafe { session.as_ref() }, unsafe { text(page) }) {
            (Some(session), Some(page)) => {
                session.floor.set_page(page).map_or_else(|refusal| of_refusal(&refusal), |()| OK)
            }
            _ => bad_argument(),
        }
    })
}

/// Ends the floor; see `underfoot.h`.
///
/// # Safety
/// `session` is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_stop(session: *mut UfSession) {
    // SAFETY: as the caller promises.
    contained((), || unsafe { session.as_ref() }.into_iter().for_each(|session| session.floor.stop()));
}

/// Ends the floor and frees the session; see `underfoot.h`.
///
/// # Safety
/// `session` is null, or was returned by a `uf_session_` function and is in use nowhere else.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uf_close(session: *mut UfSession) {
    if !session.is_null() {
        // SAFETY: as the caller promises.
        contained((), || drop(unsafe { Box::from_raw(session) }));
    }
}

/// The text of a status; see `underfoot.h`.
#[unsafe(no_mangle)]
pub extern "C" fn uf_status_text(status: c_int) -> *const c_char {
    status::text(status).as_ptr()
}
