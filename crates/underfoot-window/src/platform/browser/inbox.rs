//! Files of the computer that the user drops on the page or chooses, and files that the page gives away.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::{Context, DroppedFileHandle};
use underfoot_format::source::MAX_BYTES;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Blob, File, HtmlAnchorElement, HtmlInputElement, Url};

use super::files::save;

/// Copies files of the computer into the storage of the browser, each under its own name.
pub(crate) struct FileInbox {
    sent: Sender<Result<PathBuf, String>>,
    come: Receiver<Result<PathBuf, String>>,
}

impl FileInbox {
    /// Whether [`FileInbox::choose`] shows the files of this computer; without that, the window asks for a path.
    pub(crate) const CHOOSES: bool = true;

    /// An empty inbox.
    pub(crate) fn new() -> Self {
        let (sent, come) = channel();
        Self { sent, come }
    }

    /// Takes in a file that was dropped on the page.
    pub(crate) fn take_dropped(&self, file: &DroppedFileHandle, ctx: &Context) {
        if let Some(file) = file.web_file() {
            copy(file.clone(), self.sent.clone(), ctx.clone());
        }
    }

    /// Lets the user choose a file of the computer.
    pub(crate) fn choose(&self, ctx: &Context) {
        if let Err(error) = ask(self.sent.clone(), ctx.clone()) {
            // The inbox has both ends.
            let _ = self.sent.send(Err(format!("the browser shows no files: {}", words(&error))));
        }
    }

    /// The next file, or the reason why it did not come.
    pub(crate) fn next(&self) -> Option<Result<PathBuf, String>> {
        self.come.try_recv().ok()
    }
}

/// Shows the browser's own dialogue for files.
fn ask(sent: Sender<Result<PathBuf, String>>, ctx: Context) -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
    let input: HtmlInputElement = document.create_element("input")?.dyn_into()?;
    input.set_type("file");
    input.set_accept(".ron");
    let chosen = input.clone();
    let take = Closure::once_into_js(move || {
        if let Some(file) = chosen.files().and_then(|files| files.get(0)) {
            copy(file, sent, ctx);
        }
    });
    input.set_onchange(Some(take.unchecked_ref()));
    input.click();
    Ok(())
}

/// Copies `file` into the storage, and reports its path there.
fn copy(file: File, to: Sender<Result<PathBuf, String>>, ctx: Context) {
    wasm_bindgen_futures::spawn_local(async move {
        let name = file.name();
        let copied = stored(&file).await.map_err(|wrong| format!("{name} is not opened: {wrong}"));
        let _ = to.send(copied);
        ctx.request_repaint();
    });
}

async fn stored(file: &File) -> Result<PathBuf, String> {
    let path = PathBuf::from(file.name());
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("ron") => {}
        Some("mcap") => {
            return Err(
                "a page does not play recordings yet; the program does: underfoot preview FILE".into()
            );
        }
        _ => return Err("a layout is a text in RON, and its name ends in .ron".into()),
    }
    if file.size() > MAX_BYTES as f64 {
        return Err(format!("it is larger than {} MB", MAX_BYTES >> 20));
    }
    let bytes = wasm_bindgen_futures::JsFuture::from(file.array_buffer());
    let bytes = bytes.await.map_err(|error| words(&error))?;
    let text = String::from_utf8(js_sys::Uint8Array::new(&bytes).to_vec());
    let text = text.map_err(|_| "it is not a text in UTF-8".to_owned())?;
    save(&text, &path).map_err(|error| error.to_string())?;
    Ok(path)
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
