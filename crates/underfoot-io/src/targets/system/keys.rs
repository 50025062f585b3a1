//! The keys of `enigo` by the symbols that messages use.

use enigo::Key;
use underfoot::messages::KeySymbol;

/// The key with this symbol; `None` if this system's keyboards have none.
pub(super) fn key(symbol: KeySymbol) -> Option<Key> {
    let name = match symbol {
        KeySymbol::Character(character) => return Some(Key::Unicode(character)),
        KeySymbol::Named(name) => name,
    };
    Some(match name {
        "space" => Key::Space,
        "Return" => Key::Return,
        "Escape" => Key::Escape,
        "Tab" => Key::Tab,
        "BackSpace" => Key::Backspace,
        "Delete" => Key::Delete,
        "Home" => Key::Home,
        "End" => Key::End,
        "Page_Up" => Key::PageUp,
        "Page_Down" => Key::PageDown,
        "Left" => Key::LeftArrow,
        "Up" => Key::UpArrow,
        "Right" => Key::RightArrow,
        "Down" => Key::DownArrow,
        "Shift" => Key::Shift,
        "Control" => Key::Control,
        "Alt" => Key::Alt,
        "Super" => Key::Meta,
        "plus" => Key::Unicode('+'),
        "minus" => Key::Unicode('-'),
        "KP_Add" => Key::Add,
        "KP_Subtract" => Key::Subtract,
        "XF86AudioPlay" => Key::MediaPlayPause,
        "XF86AudioPrev" => Key::MediaPrevTrack,
        "XF86AudioNext" => Key::MediaNextTrack,
        "XF86AudioMute" => Key::VolumeMute,
        "XF86AudioLowerVolume" => Key::VolumeDown,
        "XF86AudioRaiseVolume" => Key::VolumeUp,
        _ => return function_key(name).or_else(|| beyond_apple(name)),
    })
}

fn function_key(name: &str) -> Option<Key> {
    const KEYS: [Key; 12] = [
        Key::F1,
        Key::F2,
        Key::F3,
        Key::F4,
        Key::F5,
        Key::F6,
        Key::F7,
        Key::F8,
        Key::F9,
        Key::F10,
        Key::F11,
        Key::F12,
    ];
    let number: usize = name.strip_prefix('F')?.parse().ok()?;
    KEYS.get(number.checked_sub(1)?).copied()
}

/// Keys that Apple's keyboards lack.
#[cfg(not(target_os = "macos"))]
fn beyond_apple(name: &str) -> Option<Key> {
    Some(match name {
        "Insert" => Key::Insert,
        "Pause" => Key::Pause,
        "XF86AudioStop" => Key::MediaStop,
        #[cfg(windows)]
        "Menu" => Key::Apps,
        #[cfg(windows)]
        "Print" => Key::PrintScr,
        // Windows tells the two keys for Enter apart by a flag only.
        #[cfg(windows)]
        "KP_Enter" => Key::Return,
        _ => return None,
    })
}

#[cfg(target_os = "macos")]
const fn beyond_apple(_: &str) -> Option<Key> {
    None
}
