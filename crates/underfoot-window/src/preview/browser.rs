//! The window in a page of a browser.

use super::{PreviewError, PreviewInput, PreviewOptions};

/// Shows the window in `canvas` from now on, until the page is left. Letters that the program's own fonts lack are
/// drawn by the browser.
///
/// # Errors
/// [`PreviewError::NoWindow`] if the browser has no WebGL.
pub async fn run(
    input: PreviewInput,
    options: PreviewOptions,
    canvas: web_sys::HtmlCanvasElement,
) -> Result<(), PreviewError> {
    // There are no gradients that need dithering.
    let web = eframe::WebOptions { dithering: false, ..Default::default() };
    let start: eframe::AppCreator<'static> =
        Box::new(move |context| Ok(super::app(input, &options, context)));
    let started = eframe::WebRunner::new().start(canvas, web, start).await;
    started.map_err(|error| {
        let message = error.as_string().unwrap_or_else(|| format!("{error:?}"));
        PreviewError::NoWindow(message)
    })
}
