//! A canvas beside the window, for computers that draw without a graphics card.
//!
//! After a frame has been shown, the content of the window's own buffer is undefined, so all of the canvas goes there
//! each time. Where both have the same form, in pixels and in the order of their rows, that is a copy of memory;
//! otherwise the driver draws a rectangle of the window's size, which takes a third of the frame.

use std::ffi::{CStr, c_void};
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

/// Gives a framebuffer the window's order of rows, from the top to the bottom.
///
/// # Source
/// The extension `GL_MESA_framebuffer_flip_y`.
#[derive(Clone, Copy)]
pub(in crate::preview) struct TopFirst(unsafe extern "system" fn(target: u32, parameter: u32, value: i32));

impl TopFirst {
    const FRAMEBUFFER_FLIP_Y: u32 = 0x8BBB;

    /// Looks for the extension with a function that returns the addresses of the driver's functions. OpenGL ES lacks the
    /// order of colours in windows, so the extension alone is of no use there.
    pub(in crate::preview) fn find(
        gl: &glow::Context,
        address: &dyn Fn(&CStr) -> *const c_void,
    ) -> Option<Self> {
        if gl.version().is_embedded || !gl.supported_extensions().contains("GL_MESA_framebuffer_flip_y") {
            return None;
        }
        let address = address(c"glFramebufferParameteri");
        // SAFETY: an address that is not null is that of this function of OpenGL, whose arguments are three integers.
        let set = (!address.is_null()).then(|| unsafe { std::mem::transmute(address) });
        set.map(Self)
    }

    /// Applies to the framebuffer that is bound.
    fn apply(self) {
        // SAFETY: as for all calls of the driver, the context that the address came from is current.
        unsafe { self.0(glow::FRAMEBUFFER, Self::FRAMEBUFFER_FLIP_Y, 1) };
    }
}

/// A framebuffer of the window's size.
pub(in crate::preview) struct Framebuffer {
    top_first: Option<TopFirst>,
    pixels: Mutex<Option<Pixels>>,
}

impl Framebuffer {
    /// Reserves nothing before the first frame.
    pub(in crate::preview) fn new(top_first: Option<TopFirst>) -> Self {
        Self { top_first, pixels: Mutex::default() }
    }
}

/// The memory of the framebuffer. It lives as long as the window's context, which frees it.
#[derive(Clone, Copy)]
struct Pixels {
    size_px: [i32; 2],
    framebuffer: glow::Framebuffer,
    texture: glow::Texture,
}

impl Pixels {
    /// Reserves memory; `None` if the driver has none.
    fn new(gl: &glow::Context, size_px: [i32; 2], top_first: Option<TopFirst>) -> Option<Self> {
        // SAFETY: the painter calls this while its context is current; both objects belong to it.
        unsafe {
            let framebuffer = gl.create_framebuffer().ok()?;
            let Ok(texture) = gl.create_texture() else {
                gl.delete_framebuffer(framebuffer);
                return None;
            };
            let pixels = Self { size_px, framebuffer, texture };
            gl.bind_texture(glow::TEXTURE_2D, Some(texture));
            // With the rows as in windows, the colours too: then the driver copies.
            let (colours, bits) = match top_first {
                Some(_) => (glow::BGRA, glow::UNSIGNED_INT_8_8_8_8_REV),
                None => (glow::RGBA, glow::UNSIGNED_BYTE),
            };
            gl.tex_image_2d(
                glow::TEXTURE_2D,
                0,
                glow::RGBA as i32,
                size_px[0],
                size_px[1],
                0,
                colours,
                bits,
                glow::PixelUnpackData::Slice(None),
            );
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 0);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            gl.framebuffer_texture_2d(
                glow::FRAMEBUFFER,
                glow::COLOR_ATTACHMENT0,
                glow::TEXTURE_2D,
                Some(texture),
                0,
            );
            if let Some(top_first) = top_first {
                top_first.apply();
            }
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
            gl.delete_texture(self.texture);
        }
    }
}

impl Canvas for Framebuffer {
    fn begin(&self, painter: &Painter, size_px: [u32; 2]) -> CanvasState {
        let (gl, size_px) = (painter.gl(), size_px.map(|side| side as i32));
        let mut pixels = self.pixels.lock().unwrap_or_else(PoisonError::into_inner);
        let has_picture = pixels.is_some_and(|pixels| pixels.size_px == size_px);
        if !has_picture {
            if let Some(old) = pixels.take() {
                old.free(gl);
            }
            *pixels = Pixels::new(gl, size_px, self.top_first);
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
        let pixels = *self.pixels.lock().unwrap_or_else(PoisonError::into_inner);
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
