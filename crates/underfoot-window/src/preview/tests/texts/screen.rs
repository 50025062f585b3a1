//! The texts on the screen in one frame, with what lies under each.

use eframe::egui::epaint::{ClippedShape, TextShape};
use eframe::egui::{self, Color32, FontFamily, LayerId, Pos2, Rect, Shape};

use underfoot::layout::Colour;
use underfoot_scene::scene::Theme;

/// A text on the screen.
#[derive(Clone, Debug)]
pub(super) struct ScreenText {
    layer: LayerId,
    pub(super) text: String,
    /// Bounds of the letters' ink.
    area: Rect,
    /// The part of the window in which they can be seen.
    clip: Rect,
    colour: Color32,
    is_mono: bool,
    /// Whether dots stand for a part of it.
    is_shortened: bool,
    /// Colour under its middle; `None` over a picture.
    ground: Option<Color32>,
}

/// The shapes of one frame, layer by layer, the lowest first.
pub(super) struct ScreenShapes(Vec<(LayerId, Vec<ClippedShape>)>);

impl ScreenShapes {
    /// Takes the shapes of the present frame, which must be complete.
    pub(super) fn of(ctx: &egui::Context) -> Self {
        let mut layers = vec![LayerId::background()];
        let known: Vec<LayerId> = ctx.memory(|memory| memory.layer_ids().collect());
        layers.extend(known.into_iter().filter(|layer| *layer != LayerId::background()));
        layers.sort_by_key(|layer| layer.order);
        let shapes = |layer| {
            ctx.graphics(|graphics| graphics.get(layer).map(|list| list.all_entries().cloned().collect()))
        };
        Self(layers.into_iter().filter_map(|layer| Some((layer, shapes(layer)?))).collect())
    }

    /// All texts of the frame, on a window of the colour `canvas`.
    pub(super) fn texts(&self, canvas: Color32) -> Vec<ScreenText> {
        let mut below: Vec<(Rect, &Shape)> = Vec::new();
        let mut texts = Vec::new();
        for (layer, shapes) in &self.0 {
            for ClippedShape { clip_rect, shape, .. } in shapes {
                flat(shape, &mut |shape| {
                    match shape {
                        Shape::Text(text) => {
                            let area = text.visual_bounding_rect();
                            let ground = under(&below, area.intersect(*clip_rect).center(), canvas);
                            texts.extend(of_galley(*layer, *clip_rect, text, ground));
                        }
                        _ => below.push((*clip_rect, shape)),
                    };
                });
            }
        }
        texts
    }
}

fn flat<'s>(shape: &'s Shape, each: &mut impl FnMut(&'s Shape)) {
    match shape {
        Shape::Vec(all) => all.iter().for_each(|one| flat(one, each)),
        Shape::Noop => {}
        one => each(one),
    }
}

fn of_galley(layer: LayerId, clip: Rect, shape: &TextShape, ground: Option<Color32>) -> Option<ScreenText> {
    let job = &shape.galley.job;
    let format = &job.sections.first()?.format;
    let own = if format.color == Color32::PLACEHOLDER { shape.fallback_color } else { format.color };
    let colour = shape.override_text_color.unwrap_or(own).gamma_multiply(shape.opacity_factor);
    let is_mono = format.font_id.family == FontFamily::Monospace;
    let area = shape.visual_bounding_rect();
    let is_seen = colour.a() > 0 && area.is_positive() && !job.text.trim().is_empty();
    let is_shortened = shape.galley.elided;
    let text = job.text.clone();
    is_seen.then_some(ScreenText { layer, text, area, clip, colour, is_mono, is_shortened, ground })
}

/// The colour at `point` after these shapes; `None` where a picture lies there.
fn under(shapes: &[(Rect, &Shape)], point: Pos2, canvas: Color32) -> Option<Color32> {
    let mut ground = Some(canvas);
    for (_, shape) in shapes.iter().filter(|(clip, _)| clip.contains(point)) {
        let fill = match shape {
            Shape::Rect(it) if it.rect.contains(point) => it.fill,
            Shape::Circle(it) if it.center.distance(point) < it.radius => it.fill,
            Shape::Mesh(it) if it.calc_bounds().contains(point) => {
                ground = None;
                continue;
            }
            _ => continue,
        };
        ground = if fill.is_opaque() { Some(fill) } else { ground.map(|ground| ground.blend(fill)) };
    }
    ground
}

impl ScreenText {
    fn seen(&self) -> Rect {
        self.area.intersect(self.clip)
    }

    /// Whether the letters are a picture of the text in a list that scrolls in both directions.
    fn scrolls(&self) -> bool {
        self.is_mono
    }

    /// Whether both cover each other on the same layer.
    fn covers(&self, other: &Self) -> bool {
        // Strong letters are drawn twice at one place.
        let is_double = self.text == other.text && self.area.min.distance(other.area.min) < 1.0;
        let both = self.seen().intersect(other.seen());
        self.layer == other.layer && !is_double && both.width() > 1.0 && both.height() > 1.0
    }

    /// The reason why the text is cut in a window of this size, if it is; not if it is a text of the floor, whose
    /// visible part is `covered`, under a panel.
    fn cut(&self, window: Rect, covered: Option<Rect>) -> Option<&'static str> {
        if self.is_shortened && self.seen().is_positive() {
            return Some("shortened");
        }
        let (area, clip) = (self.area, self.clip);
        let is_floor =
            |floor: Rect| floor.expand(1.0).contains_rect(clip) && clip.expand(1.0).contains_rect(floor);
        if covered.is_some_and(is_floor) && window.contains_rect(area) {
            return None;
        }
        let is_level = area.top() < clip.bottom() && area.bottom() > clip.top();
        // The sign that takes a value out is drawn with empty margins.
        let slack = if self.text == "⟲" { 3.0 } else { 1.0 };
        if is_level
            && !self.scrolls()
            && (area.left() < clip.left() - slack || area.right() > clip.right() + slack)
        {
            return Some("cut at its side");
        }
        // Lists in panels scroll; they are narrower than the rest of the window.
        let is_list = clip.width() < 0.6 * window.width();
        let is_beside = area.left() < clip.right() && area.right() > clip.left();
        if is_beside && !is_list && (area.top() < clip.top() - 1.0 || area.bottom() > clip.bottom() + 1.0) {
            return Some("cut above or below");
        }
        let is_out =
            !self.scrolls() && self.seen().is_positive() && !window.expand(1.0).contains_rect(self.seen());
        is_out.then_some("out of the window")
    }

    /// The contrast of the text with its ground; `None` over a picture, and for faint text such as that of buttons
    /// that are off.
    fn contrast(&self) -> Option<f32> {
        let of = |it: Color32| Colour::rgb(it.r(), it.g(), it.b());
        let ground = self.ground.filter(|_| self.colour.a() > 230 && self.seen().is_positive())?;
        Some(of(self.colour).contrast(of(ground)))
    }
}

/// The faults of the texts of a window in this theme: covered, cut, or hard to read. Panels lie over the floor except
/// for its part `covered`.
pub(super) fn faults(
    texts: &[ScreenText],
    window: Rect,
    covered: Option<Rect>,
    theme: &Theme,
) -> Vec<String> {
    let mut found = Vec::new();
    for (index, text) in texts.iter().enumerate() {
        for other in texts.iter().take(index).filter(|other| text.covers(other)) {
            found.push(format!("“{}” covers “{}” at {:?}", text.text, other.text, text.area));
        }
        if let Some(why) = text.cut(window, covered) {
            found.push(format!("“{}” is {why}: {:?} in {:?}", text.text, text.area, text.clip));
        }
        if let Some(ratio) = text.contrast().filter(|ratio| *ratio < theme.least_contrast() - 0.1) {
            found.push(format!(
                "“{}” is hard to read: {ratio:.2}, {:?} on {:?}",
                text.text, text.colour, text.ground
            ));
        }
    }
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Align2, FontId, pos2, vec2};

    use crate::preview::style::write_within;

    fn found(draw: impl Fn(&egui::Painter)) -> Vec<String> {
        let window = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        let input = egui::RawInput { screen_rect: Some(window), ..Default::default() };
        let mut texts = Vec::new();
        let mut output = egui::Context::default().run_ui(input, |ui| {
            draw(ui.painter());
            texts = ScreenShapes::of(ui.ctx()).texts(Color32::BLACK);
        });
        output.textures_delta.clear();
        faults(&texts, window, None, &Theme::CONTRAST)
    }

    fn write(painter: &egui::Painter, at: Pos2, colour: Color32) {
        painter.text(at, Align2::LEFT_TOP, "a word", FontId::proportional(20.0), colour);
    }

    #[test]
    fn texts_that_cover_each_other_are_cut_or_are_hard_to_read_are_found() {
        let at = pos2(100.0, 100.0);
        assert_eq!(found(|painter| write(painter, at, Color32::WHITE)), Vec::<String>::new());
        let covered = found(|painter| {
            write(painter, at, Color32::WHITE);
            write(painter, at + vec2(8.0, 5.0), Color32::WHITE);
        });
        assert!(covered.len() == 1 && covered[0].contains("covers"), "{covered:?}");
        let clip = Rect::from_min_size(at, vec2(30.0, 100.0));
        let cut = found(|painter| write(&painter.with_clip_rect(clip), at, Color32::WHITE));
        assert!(cut.len() == 1 && cut[0].contains("cut at its side"), "{cut:?}");
        let short = found(|painter| {
            write_within(painter, at, 40.0, "a word", FontId::proportional(20.0), Color32::WHITE);
        });
        assert!(short.len() == 1 && short[0].contains("shortened"), "{short:?}");
        let faint = found(|painter| write(painter, at, Color32::from_gray(90)));
        assert!(faint.len() == 1 && faint[0].contains("hard to read"), "{faint:?}");
        let bright = found(|painter| {
            painter.rect_filled(Rect::from_min_size(at, vec2(90.0, 40.0)), 0, Color32::WHITE);
            write(painter, at, Color32::WHITE);
        });
        assert!(bright.len() == 1 && bright[0].contains("hard to read"), "{bright:?}");
    }
}
