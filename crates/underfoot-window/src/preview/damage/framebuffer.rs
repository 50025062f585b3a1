//! A canvas beside the window, for computers that draw without a graphics card.
//!
//! After a frame has been shown, the content of the window's own buffer is undefined.

use std::sync::{Mutex, PoisonError};

use eframe::egui_glow::Painter;
use eframe::glow::{self, HasContext as _};

use super::{Canvas, CanvasState};

/// Whether a graphics card draws: it draws a whole window faster than two pictures are compared.
pub(in crate::preview) fn has_graphics_card(gl: &glow::Context) -> bool {
    // SAFETY: the context is current while eframe creates the app.
    let renderer = unsafe { gl.get_parameter_string(glow::RENDERER) }.to_lowercase();
    !["llvmpipe", "softpipe", "swiftshader", "software"].iter().any(|name| renderer.contains(name))
}

/// A framebuffer of the window's size.
#[derive(Default)]
pub(in crate::preview) struct Framebuffer(Mutex<Option<Pixels>>);

/// The memory of the framebuffer. It lives as long as the window's context, which frees it.
#[derive(Clone, Copy)]
struct Pixels {
    size_px: [i32; 2],
    framebuffer: glow::Framebuffer,
    renderbuffer: glow::Renderbuffer,
}

impl Pixels {
    /// Reserves memory; `None` if the driver has none.
    fn new(gl: &glow::Context, size_px: [i32; 2]) -> Option<Self> {
        // SAFETY: the painter calls this while its context is current; both objects belong to it.
        unsafe {
            let framebuffer = gl.create_framebuffer().ok()?;
            let Ok(renderbuffer) = gl.create_renderbuffer() else {
                gl.delete_framebuffer(framebuffer);
                return None;
            };
            let pixels = Self { size_px, framebuffer, renderbuffer };
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(renderbuffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, size_px[0], size_px[1]);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            gl.framebuffer_renderbuffer(
                glow::FRAMEBUFFER,
                glow::COLOR_ATTACHMENT0,
                glow::RENDERBUFFER,
                Some(renderbuffer),
            );
            let is_whole = gl.check_framebuffer_status(glow::FRAMEBUFFER) == glow::FRAMEBUFFER_COMPLETE;
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            if !is_whole {
                pixels.free(gl);
            }
            is_whole.then_some(pixels)
        }
    }

    fn free(self, gl: &glow::Context) {
        // SAFETY: as in `new`; nothing uses the objects afterwards.
        unsafe {
            gl.delete_framebuffer(self.framebuffer);
            gl.delete_renderbuffer(self.renderbuffer);
        }
    }
}

impl Canvas for Framebuffer {
    fn begin(&self, painter: &Painter, size_px: [u32; 2]) -> CanvasState {
        let (gl, size_px) = (painter.gl(), size_px.map(|side| side as i32));
        let mut pixels = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let has_picture = pixels.is_some_and(|pixels| pixels.size_px == size_px);
        if !has_picture {
            if let Some(old) = pixels.take() {
                old.free(gl);
            }
            *pixels = Pixels::new(gl, size_px);
        }
        let framebuffer = pixels.map(|pixels| pixels.framebuffer);
        // SAFETY: the painter's context is current while it draws. Without memory, the window is drawn on itself.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, framebuffer) };
        match framebuffer {
            Some(_) if has_picture => CanvasState::Kept,
            Some(_) => CanvasState::New,
            None => CanvasState::Lost,
        }
    }

    fn end(&self, painter: &Painter, [width, height]: [u32; 2]) {
        let (gl, width, height) = (painter.gl(), width as i32, height as i32);
        let pixels = *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(Pixels { framebuffer, .. }) = pixels else { return };
        // SAFETY: as in `begin`; the painter restores the state that this changes, but for the framebuffer.
        unsafe {
            gl.disable(glow::SCISSOR_TEST);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(framebuffer));
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, None);
            gl.blit_framebuffer(
                0,
                0,
                width,
                height,
                0,
                0,
                width,
                height,
                glow::COLOR_BUFFER_BIT,
                glow::NEAREST,
            );
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        }
    }
}
