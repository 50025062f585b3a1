//! The page of the gallery: each shipped layout with its picture, its sentence and its link.
//!
//! With `UPDATE_EXPECTED=1` the test writes page and pictures anew.

use std::fs;
use std::path::Path;

use underfoot::floor::Floor;
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, head_comment, parse_layout};
use underfoot_window::link::SharedLayout;

use super::end_to_end::{said, underfoot};

/// The address in the page: that of the web edition which its manual serves on the reader's own computer.
const PAGE: &str = "http://127.0.0.1:8000/";

/// Width of the pictures, in pixels.
const WIDTH: &str = "400";

const HEAD: &str = "\
# Gallery

The layouts that come with underfoot, to try and to start from. `underfoot preview museum_room` opens one in the window;
the button at the top of the window with the name of the layout, and *File*, *Gallery* in Design, show all of them.

The links lead to the [web edition](web-edition.md) that `./dev web` makes, where its page serves it on this computer;
behind another address the same part from `#` on opens the same layout. `underfoot share museum_room` prints it. A
window, a page and a link send no [messages](apps.md#layouts-that-may-send): only `underfoot run` does.

A test makes this page, its pictures and its links from the files of [`layouts/`](../layouts).

| | |
|---|---|
";

/// Standard output of the program.
fn printed(args: &[&str]) -> String {
    let output = underfoot().args(args).output().unwrap();
    assert!(output.status.success(), "{args:?}: {}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// The row of one layout; its link opens the layout to the byte.
fn row(name: &str) -> String {
    let text = builtin_layout(name).unwrap();
    let link = printed(&["share", name, "--page", PAGE]);
    assert_eq!(SharedLayout::of_link(&link).unwrap().text, text, "{name}");
    let layout = parse_layout(text, name, &Kinds::builtin(), &Floor::default().geometry).unwrap().layout;
    let about = head_comment(text);
    assert!((20..=160).contains(&about.len()) && about.ends_with('.'), "{name}: {about}");
    let verb = if layout.sends() { "run" } else { "preview" };
    let title = layout.title;
    assert!(!title.is_empty(), "{name}");
    format!(
        "| ![{title}](gallery/{name}.png) | **{title}**<br>{about}<br>[Open it]({}), or `underfoot {verb} {name}`; \
         [the file](../layouts/{name}.ron) |\n",
        link.trim()
    )
}

#[test]
fn the_gallery_shows_every_shipped_layout_as_it_is_and_its_links_open() {
    let docs = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs"));
    let is_update = std::env::var_os("UPDATE_EXPECTED").is_some();
    let mut page = HEAD.to_owned();
    page.extend(builtin_layouts().map(row));
    let folder = tempfile::tempdir().unwrap();
    let (file, pictures) = (docs.join("gallery.md"), docs.join("gallery"));
    let mut stale = Vec::new();
    for name in builtin_layouts() {
        let (drawn, kept) = (folder.path().join("it.png"), pictures.join(format!("{name}.png")));
        printed(&["render", name, "--bare", "--width", WIDTH, "--out", drawn.to_str().unwrap()]);
        let drawn = fs::read(drawn).unwrap();
        if is_update {
            fs::create_dir_all(&pictures).unwrap();
            fs::write(&kept, &drawn).unwrap();
        }
        stale.extend((fs::read(&kept).unwrap_or_default() != drawn).then_some(name));
    }
    if is_update {
        fs::write(&file, &page).unwrap();
    }
    let is_right = fs::read_to_string(&file).unwrap_or_default() == page;
    assert!(is_right && stale.is_empty(), "write docs/gallery.md anew with UPDATE_EXPECTED=1: {stale:?}");
    assert_eq!(fs::read_dir(&pictures).unwrap().count(), builtin_layouts().count());
}

#[test]
fn no_shipped_layout_has_a_finding() {
    let names: Vec<&str> = builtin_layouts().collect();
    printed(&[&["check", "--strict"], &names[..]].concat());
}
