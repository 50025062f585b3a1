//! The start in a page: the layout of the address, the floor in the frames of the page, and the window in a canvas.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use js_sys::{Float32Array, Function};
use underfoot::floor::Geometry;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{
    LayoutToShare, PreviewError, PreviewInput, PreviewOptions, ProjectionOptions, ShareDesk, run, usual_state,
};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{HtmlCanvasElement, Window};

use super::floor::{FIRST, PageFloor, shipped};
use super::kinds::OwnTexts;
use super::sound::FrameSound;

/// Shows the window in `canvas`, on a floor with the layout behind `#` in the address of the page. `sound` describes
/// the sound, `play` gets its samples as a `Float32Array`, and `click` is called when a control clicks.
///
/// # Errors
/// A sentence for the user if there is no window: no WebGL, for example.
#[wasm_bindgen]
#[allow(clippy::needless_pass_by_value, reason = "JavaScript passes values")]
pub async fn start(
    canvas: HtmlCanvasElement,
    sound: String,
    play: Function,
    click: Function,
) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or("there is no page")?;
    let fragment = window.location().hash()?;
    let heard = FrameSound::default();
    let (floor, mut input) = opened(&fragment, &heard)?;
    floor.tell_sound(sound);
    let links =
        PageLinks { address: address(&window)?, geometry: input.floor.geometry, own: floor.own_texts() };
    input.share = Some(Box::new(links));
    // A link has its layout already.
    let options = PreviewOptions { begins_with_gallery: fragment.len() < 2, ..options() };
    run_in_frames(&window, floor, PageHooks { play, click }, heard);
    run(input, options, canvas).await.map_err(no_window)
}

/// The options of the window in a page, which keeps its settings in the storage of the browser.
pub(super) fn options() -> PreviewOptions {
    PreviewOptions {
        settings: Some(usual_state().join("window")),
        projection: ProjectionOptions {
            corners: Some(usual_state().join("projection.txt")),
            ..ProjectionOptions::default()
        },
        ..PreviewOptions::default()
    }
}

/// The sentence for a user whose browser shows no window.
#[allow(clippy::needless_pass_by_value, reason = "it stands in `map_err`")]
pub(super) fn no_window(PreviewError::NoWindow(reason): PreviewError) -> JsValue {
    format!("this browser gives the page no WebGL ({reason})").into()
}

/// The floor with the layout in `fragment`; for a link that cannot be read, the floor with the first layout, and a
/// message that says why.
fn opened(fragment: &str, heard: &FrameSound) -> Result<(PageFloor, PreviewInput), String> {
    let floor = |shared: &SharedLayout| {
        let heard = heard.clone();
        PageFloor::new(shared, move |samples| heard.add(samples)).map_err(|error| error.to_string())
    };
    let first = || floor(&shipped(FIRST));
    if fragment.len() < 2 {
        return first();
    }
    let read = SharedLayout::of_link(fragment).map_err(|error| error.to_string());
    match read.and_then(|shared| floor(&shared)) {
        Ok(opened) => Ok(opened),
        Err(wrong) => {
            let (floor, input) = first()?;
            floor.tell(format!("The layout of the link cannot be shown; {wrong}"));
            Ok((floor, input))
        }
    }
}

/// The address of this page, up to `#`.
pub(super) fn address(window: &Window) -> Result<String, JsValue> {
    let whole = window.location().href()?;
    Ok(whole.split('#').next().unwrap_or_default().to_owned())
}

/// Links to this page.
pub(super) struct PageLinks {
    pub(super) address: String,
    pub(super) geometry: Geometry,
    pub(super) own: OwnTexts,
}

impl ShareDesk for PageLinks {
    fn link(&self, layout: &LayoutToShare) -> Result<String, String> {
        let (name, text) = (layout.name.clone(), layout.text.clone());
        let grid =
            (self.geometry != Geometry::default()).then(|| (self.geometry.columns(), self.geometry.rows()));
        let shared = SharedLayout { name, text, grid, ..self.own.of_layout(layout.path.as_deref()) };
        let used = shared.with_used_only(&self.geometry).map_err(|problems| problems.to_string())?;
        let fragment = used.fragment().map_err(|error| error.to_string())?;
        Ok(format!("{}{fragment}", self.address))
    }
}

/// Functions of the page.
struct PageHooks {
    /// Plays samples.
    play: Function,
    /// Buzzes for a click.
    click: Function,
}

/// A function for frames of the page that holds itself.
type FrameSlot = Rc<RefCell<Option<Closure<dyn FnMut(f64)>>>>;

/// Advances the floor in each frame of the page from now on.
fn run_in_frames(window: &Window, mut floor: PageFloor, hooks: PageHooks, heard: FrameSound) {
    let frame = FrameSlot::default();
    let (own, page) = (Rc::clone(&frame), window.clone());
    *frame.borrow_mut() = Some(Closure::new(move |now_ms: f64| {
        floor.run_until(Duration::from_secs_f64((now_ms / 1e3).max(0.0)));
        // A page that cannot play has said so.
        heard.play(|samples| _ = hooks.play.call1(&JsValue::NULL, &Float32Array::from(samples)));
        if floor.has_clicked() {
            let _ = hooks.click.call0(&JsValue::NULL);
        }
        request(&page, &own);
    }));
    request(window, &frame);
}

/// Requests a call in the next frame of the page; a hidden page has none, and its floor stands still.
fn request(window: &Window, frame: &RefCell<Option<Closure<dyn FnMut(f64)>>>) {
    if let Some(frame) = frame.borrow().as_ref() {
        // It fails only while the page is being left.
        let _ = window.request_animation_frame(frame.as_ref().unchecked_ref());
    }
}
