//! Drawing of the picture: a slice through its window, marks and measures, a scale, and the sides of the body.

use eframe::egui::{
    Align2, Color32, ColorImage, Context, FontId, Painter, Pos2, Rect, Stroke, TextureHandle, TextureOptions,
    pos2, vec2,
};

use crate::series::{Pixels, Series, Window, opposite};
use crate::state::{Mark, State};

const GAUGE: Color32 = Color32::from_rgb(0xf2, 0xd0, 0x6b);
const SHADE: Color32 = Color32::from_rgba_premultiplied(0, 0, 0, 170);

/// Maps units of a series to the screen.
#[derive(Clone, Copy)]
pub struct Screen {
    rect: Rect,
    middle: [f64; 2],
    /// Points for each unit.
    pub scale: f64,
}

impl Screen {
    pub fn new(rect: Rect, state: &State) -> Self {
        let view = state.view();
        let [width, height] = state.sheet().extent(view.slice);
        let fit = (f64::from(rect.width()) / width).min(f64::from(rect.height()) / height);
        Self { rect, middle: view.middle, scale: fit * view.zoom }
    }

    pub fn point(&self, at: [f64; 2]) -> Pos2 {
        let off = [0, 1].map(|axis| ((at[axis] - self.middle[axis]) * self.scale) as f32);
        self.rect.center() + vec2(off[0], off[1])
    }
}

/// The visible slice as a texture.
#[derive(Default)]
pub struct Film {
    texture: Option<TextureHandle>,
    shown: Option<(usize, usize, Window)>,
}

impl Film {
    /// Draws slice, marks and scale into `rect`.
    pub fn paint(&mut self, context: &Context, painter: &Painter, rect: Rect, all: &[Series], state: &State) {
        painter.rect_filled(rect, 0.0, Color32::BLACK);
        let screen = Screen::new(rect, state);
        let Some(series) = all.get(state.current) else { return };
        let view = state.view();
        let wanted = (state.current, view.slice, view.window);
        if self.shown != Some(wanted)
            && let Some(frame) = series.frames.get(view.slice)
        {
            let image = developed(series.size, &frame.pixels, view.window, series.is_inverted);
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => self.texture = Some(context.load_texture("slice", image, TextureOptions::LINEAR)),
            }
            self.shown = Some(wanted);
        }
        if let Some(texture) = &self.texture {
            let place =
                Rect::from_two_pos(screen.point([0.0; 2]), screen.point(state.sheet().extent(view.slice)));
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture.id(), place, whole, Color32::WHITE);
        }
        marks(painter, &screen, state);
        crosshair(painter, rect.center());
        scale_bar(painter, &screen, state);
        sides(painter, rect, state);
        let about = &state.sheet().about;
        if !about.is_empty() {
            words_at(painter, rect.left_top() + vec2(20.0, 16.0), Align2::LEFT_TOP, about, 16.0);
        }
    }
}

/// Values as greys, black below the window and white above; for colours, each of red, green and blue likewise.
fn developed(size: [usize; 2], pixels: &Pixels, window: Window, is_inverted: bool) -> ColorImage {
    let low = window.level - 0.5 * window.width;
    let grey = |value: f64| {
        let share = ((value - low) / window.width).clamp(0.0, 1.0);
        (255.0 * if is_inverted { 1.0 - share } else { share }).round() as u8
    };
    match pixels {
        Pixels::Grey(values) => {
            let greys: Vec<u8> = values.iter().map(|value| grey(f64::from(*value))).collect();
            ColorImage::from_gray(size, &greys)
        }
        Pixels::Colour(colours) => {
            let shades: Vec<u8> = (0..=u8::MAX).map(|value| grey(f64::from(value))).collect();
            let shade = |value: u8| shades.get(usize::from(value)).copied().unwrap_or_default();
            let bytes: Vec<u8> = colours.as_flattened().iter().map(|value| shade(*value)).collect();
            ColorImage::from_rgb(size, &bytes)
        }
    }
}

/// Letters at all four edges for the sides of the body.
fn sides(painter: &Painter, rect: Rect, state: &State) {
    const SIZE: f32 = 26.0;
    let Some([right, down]) = state.sheet().towards(state.view().slice) else { return };
    let (left, up) = (opposite(right), opposite(down));
    let edges = [
        (rect.right_center() - vec2(18.0, 0.0), Align2::RIGHT_CENTER, right),
        (rect.center_bottom() - vec2(0.0, 14.0), Align2::CENTER_BOTTOM, down),
        (rect.left_center() + vec2(18.0, 0.0), Align2::LEFT_CENTER, &left),
        (rect.center_top() + vec2(0.0, 14.0), Align2::CENTER_TOP, &up),
    ];
    for (at, anchor, letters) in edges {
        words_at(painter, at, anchor, letters, SIZE);
    }
}

fn marks(painter: &Painter, screen: &Screen, state: &State) {
    let view = state.view();
    let line = Stroke::new(1.8, GAUGE);
    for (number, measure) in view.measures.iter().enumerate().filter(|(_, it)| it.slice == view.slice) {
        let [from, to] = measure.ends.map(|at| screen.point(at));
        painter.line_segment([from, to], Stroke::new(4.5, SHADE));
        painter.line_segment([from, to], line);
        for at in [from, to] {
            painter.circle_filled(at, 4.0, GAUGE);
        }
        let words = format!("{}: {:.1} {}", number + 1, measure.length(), state.sheet().unit(view.slice));
        words_at(painter, from.lerp(to, 0.5) - vec2(0.0, 8.0), Align2::CENTER_BOTTOM, &words, 17.0);
    }
    if let Some(Mark { slice, at }) = view.first
        && slice == view.slice
    {
        let at = screen.point(at);
        painter.line_segment([at, screen.point(view.middle)], Stroke::new(1.0, GAUGE.gamma_multiply(0.7)));
        painter.circle_filled(at, 4.0, GAUGE);
        painter.circle_stroke(at, 8.0, line);
    }
}

/// The target of the marking button.
fn crosshair(painter: &Painter, at: Pos2) {
    for (width, colour) in [(3.5, SHADE), (1.4, Color32::WHITE)] {
        for way in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
            painter.line_segment([at + 5.0 * way, at + 16.0 * way], Stroke::new(width, colour));
        }
    }
}

/// A bar labelled with its length, in the lower left.
fn scale_bar(painter: &Painter, screen: &Screen, state: &State) {
    let lengths = [200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2];
    let length = lengths.into_iter().find(|length| length * screen.scale < 220.0).unwrap_or(0.1);
    let left = screen.rect.left_bottom() + vec2(28.0, -28.0);
    let right = left + vec2((length * screen.scale) as f32, 0.0);
    let stroke = Stroke::new(2.0, Color32::WHITE);
    painter.line_segment([left, right], stroke);
    for end in [left, right] {
        painter.line_segment([end - vec2(0.0, 5.0), end + vec2(0.0, 5.0)], stroke);
    }
    words_at(
        painter,
        left - vec2(0.0, 9.0),
        Align2::LEFT_BOTTOM,
        &format!("{length} {}", state.sheet().unit(state.view().slice)),
        14.0,
    );
}

/// Words that are readable on any picture.
fn words_at(painter: &Painter, at: Pos2, anchor: Align2, words: &str, size: f32) {
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(size), Color32::WHITE);
    let place = anchor.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(vec2(5.0, 2.0)), 4.0, SHADE);
    painter.galley(place.min, galley, Color32::WHITE);
}
