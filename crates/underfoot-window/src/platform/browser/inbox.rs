//! Files of the computer that the user drops on the page or chooses, and files that the page gives away.
//!
//! The window decides which of the files it keeps in the storage of the browser.

use std::cell::OnceCell;
use std::path::Path;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::{Context, DroppedFileHandle};
use underfoot_format::source::MAX_BYTES;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Blob, File, HtmlAnchorElement, HtmlInputElement, Url};

use super::dropped::{CHOOSE, FILES, FileAt, PageListener, SAVED, TOLD, dispatch, files_of};
use crate::platform::{Arrival, Incoming, placed};

/// Maximum length of the texts of one drop, in bytes; the storage of a browser holds some 5 MB.
const MOST_TEXT: usize = 8 << 20;

/// Takes in files of the computer, each under its own path.
pub(crate) struct FileInbox {
    come: Receiver<Arrival>,
    door: Door,
    _listeners: [PageListener; 2],
}

/// The end at which files come in.
#[derive(Clone)]
struct Door {
    sent: Sender<Arrival>,
    /// Draws the window after an arrival; empty before its first frame.
    ctx: Rc<OnceCell<Context>>,
}

impl FileInbox {
    /// Whether [`FileInbox::choose`] shows the files of this computer; without that, the window asks for a path.
    pub(crate) const CHOOSES: bool = true;

    /// An empty inbox, which takes in what is dropped on the page from now on.
    pub(crate) fn new() -> Self {
        let (sent, come) = channel();
        let door = Door { sent, ctx: Rc::default() };
        let (dropped, told) = (door.clone(), door.clone());
        let listeners = [
            PageListener::new(FILES, move |detail| dropped.read(files_of(&detail))),
            PageListener::new(TOLD, move |detail| {
                if let Some(text) = detail.as_string() {
                    told.give(Arrival::Told(text));
                }
            }),
        ];
        Self { come, door, _listeners: listeners }
    }

    /// Does nothing: the page reports what is dropped on it, with folders.
    pub(crate) fn take_dropped(&self, _file: &DroppedFileHandle) {}

    /// Lets the user choose files of the computer.
    pub(crate) fn choose(&self) {
        // The page of a browser that can also save in place.
        if dispatch(CHOOSE, &JsValue::NULL) {
            return;
        }
        if let Err(error) = ask(self.door.clone()) {
            self.door.give(Arrival::Refused(format!("the browser shows no files: {}", words(&error))));
        }
    }

    /// The next arrival.
    pub(crate) fn next(&self, ctx: &Context) -> Option<Arrival> {
        self.door.ctx.get_or_init(|| ctx.clone());
        self.come.try_recv().ok()
    }
}

impl Door {
    fn give(&self, arrival: Arrival) {
        // The inbox has the other end; without one, nobody waits.
        let _ = self.sent.send(arrival);
        if let Some(ctx) = self.ctx.get() {
            ctx.request_repaint();
        }
    }

    /// Reads `files` and passes their texts on: kinds and effects before the layouts that may be made of them, and the
    /// layouts from the last by name to the first, which stays open.
    fn read(&self, mut files: Vec<FileAt>) {
        let door = self.clone();
        files.sort_by(|(one, _), (other, _)| one.cmp(other));
        wasm_bindgen_futures::spawn_local(async move {
            if files.is_empty() {
                return door.give(Arrival::Refused("there is no file in it whose name ends in .ron".into()));
            }
            let (mut layouts, mut parts, mut length) = (Vec::new(), Vec::new(), 0);
            for (path, file) in files {
                match text_of(&path, &file).await {
                    Ok(text) if length + text.len() > MOST_TEXT => {
                        let most = MOST_TEXT >> 20;
                        let wrong =
                            format!("{path} and what follows is not opened: it is more than {most} MB");
                        door.give(Arrival::Refused(wrong));
                        break;
                    }
                    Ok(text) => {
                        length += text.len();
                        let (content, place) = placed(Path::new(&path), &text);
                        match content {
                            Incoming::Layout => layouts.push((place, text)),
                            Incoming::Part => parts.push((place, text)),
                        }
                    }
                    Err(wrong) => door.give(Arrival::Refused(format!("{path} is not opened: {wrong}"))),
                }
            }
            if !parts.is_empty() {
                door.give(Arrival::Parts(parts));
            }
            layouts.into_iter().rev().for_each(|(path, text)| door.give(Arrival::LayoutText(path, text)));
        });
    }
}

/// Shows the browser's own dialogue for files.
fn ask(door: Door) -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
    let input: HtmlInputElement = document.create_element("input")?.dyn_into()?;
    input.set_type("file");
    input.set_accept(".ron");
    input.set_multiple(true);
    let chosen = input.clone();
    let take = Closure::once_into_js(move || {
        let Some(files) = chosen.files() else { return };
        let files = (0..files.length()).filter_map(|index| files.get(index));
        let files: Vec<FileAt> = files.map(|file| (file.name(), file)).collect();
        // An empty choice is a change of mind.
        if !files.is_empty() {
            door.read(files);
        }
    });
    input.set_onchange(Some(take.unchecked_ref()));
    input.click();
    Ok(())
}

/// The text of `file`, which came from `path`.
async fn text_of(path: &str, file: &File) -> Result<String, String> {
    match Path::new(path).extension().and_then(|ending| ending.to_str()) {
        Some("ron") => {}
        Some("mcap") => {
            return Err("a recording is played if it is dropped on the floor alone".into());
        }
        _ => return Err("a layout is a text in RON, and its name ends in .ron".into()),
    }
    if file.size() > MAX_BYTES as f64 {
        return Err(format!("it is larger than {} MB", MAX_BYTES >> 20));
    }
    let bytes = wasm_bindgen_futures::JsFuture::from(file.array_buffer());
    let bytes = bytes.await.map_err(|error| words(&error))?;
    let text = String::from_utf8(js_sys::Uint8Array::new(&bytes).to_vec());
    text.map_err(|_| "it is not a text in UTF-8".to_owned())
}

/// Reports a layout that the user has saved at `path`: the page puts it into its own file too, if it can, and tells.
pub(crate) fn note_saved(path: &Path, text: &str) {
    let path = path.display().to_string();
    dispatch(SAVED, &js_sys::Array::of2(&path.into(), &text.into()));
}

fn words(error: &JsValue) -> String {
    error.as_string().unwrap_or_else(|| format!("{error:?}"))
}

/// Whether [`give`] gives the user files that the browser keeps.
pub(crate) const GIVES: bool = true;

/// Gives the user a file called `name` with this text, as a download.
///
/// # Errors
/// The words of the browser.
pub(crate) fn give(name: &str, text: &str) -> Result<(), String> {
    download(name, text).map_err(|error| words(&error))
}

fn download(name: &str, text: &str) -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
    let blob = Blob::new_with_str_sequence(&js_sys::Array::of1(&text.into()))?;
    let address = Url::create_object_url_with_blob(&blob)?;
    let link: HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
    link.set_href(&address);
    let file = Path::new(name).file_name().unwrap_or_default().to_string_lossy().into_owned();
    link.set_download(&if file.ends_with(".ron") { file } else { format!("{file}.ron") });
    link.click();
    Url::revoke_object_url(&address)
}
