//! Textures of a scene's fields.

use egui::{Color32, ColorImage, TextureHandle, TextureId, TextureOptions};

/// The images of a scene's fields, which stay on the graphics card until they change.
#[derive(Default)]
pub(super) struct FieldImages {
    shown: Vec<Field>,
    /// Number of fields that the present frame has used so far.
    used: usize,
}

struct Field {
    texture: TextureHandle,
    image: ColorImage,
}

impl FieldImages {
    /// Starts a frame.
    pub(super) fn begin(&mut self) {
        self.used = 0;
    }

    /// Ends a frame: drops fields that it did not use.
    pub(super) fn end(&mut self) {
        self.shown.truncate(self.used);
    }

    /// The next field, `size` pixels wide and high; uploaded to the graphics card if it has changed since the last
    /// frame.
    pub(super) fn show(
        &mut self,
        ctx: &egui::Context,
        size: [usize; 2],
        colors: impl Iterator<Item = Color32>,
    ) -> TextureId {
        let at = self.used;
        self.used += 1;
        let Some(field) = self.shown.get_mut(at) else {
            let image = ColorImage::new(size, colors.collect());
            let texture = ctx.load_texture("field", image.clone(), TextureOptions::LINEAR);
            let id = texture.id();
            self.shown.push(Field { texture, image });
            return id;
        };
        let mut changed = field.image.size != size;
        if changed {
            field.image = ColorImage::new(size, colors.collect());
        } else {
            for (dot, color) in field.image.pixels.iter_mut().zip(colors) {
                changed |= *dot != color;
                *dot = color;
            }
        }
        if changed {
            field.texture.set(field.image.clone(), TextureOptions::LINEAR);
        }
        field.texture.id()
    }
}
