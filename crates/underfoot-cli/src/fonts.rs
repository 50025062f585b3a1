//! The fonts of pictures.

use std::sync::LazyLock;

use underfoot_scene::letters::Fonts;

/// The built-in fonts, and for letters that they lack those of this computer.
pub(crate) fn fonts() -> &'static Fonts {
    static FONTS: LazyLock<Fonts> = LazyLock::new(Fonts::of_this_computer);
    &FONTS
}
