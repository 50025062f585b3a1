//! The names of the window that has the keyboard.

use x11rb::errors::ReplyError;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt as _};
use x11rb::rust_connection::RustConnection;

/// Maximum number of windows from the focus up to the root: programs nest a few.
const DEEPEST: usize = 16;

/// Maximum length of a name that is read, in units of four bytes.
const LONGEST: u32 = 256;

/// Returns titles and classes of the window that has the focus and of those around it, from the innermost.
pub(super) fn focused(connection: &RustConnection) -> Result<Vec<String>, ReplyError> {
    let title = connection.intern_atom(false, b"_NET_WM_NAME")?.reply()?.atom;
    let kinds = [title, AtomEnum::WM_NAME.into(), AtomEnum::WM_CLASS.into()];
    let mut names = Vec::new();
    let mut window = connection.get_input_focus()?.reply()?.focus;
    for _ in 0..DEEPEST {
        // 0 and 1 stand for no window and for the pointer's.
        if window <= 1 {
            break;
        }
        for kind in kinds {
            let found = connection.get_property(false, window, kind, AtomEnum::ANY, 0, LONGEST)?.reply()?;
            let text = String::from_utf8_lossy(&found.value).replace('\0', " ");
            if !text.trim().is_empty() {
                names.push(text.trim().to_owned());
            }
        }
        window = connection.query_tree(window)?.reply()?.parent;
    }
    Ok(names)
}
