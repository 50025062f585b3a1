//! A layout given away as a link: the button, and the dialogue with link and QR code.

use std::path::PathBuf;

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Color32, Modal, Rect, RichText, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2};
use qrcodegen::{Mask, QrCode, QrCodeEcc, QrSegment, Version};

use super::handheld::is_for_fingers;
use super::icons::{Icon, named, short};
use super::style::quiet;
use crate::link::SharedVisit;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Makes links of layouts.
pub trait ShareDesk {
    /// The link to a page that opens this layout.
    ///
    /// # Errors
    /// A sentence that says why there is no link, for example because the text is too long.
    fn link(&self, layout: &LayoutToShare) -> Result<String, String>;

    /// Whether the links begin with the address of a page that opens them, and layouts are shared by themselves.
    fn has_page(&self) -> bool {
        true
    }
}

/// The layout of Design mode, for a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayoutToShare {
    /// The name of its file, or the name that it began with.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Its file; `None` for a layout without a file.
    pub path: Option<PathBuf>,
    /// A visit to it; `None` for the layout alone.
    pub visit: Option<SharedVisit>,
}

/// Side of a QR code with its quiet zone, in points.
const CODE: f32 = 300.0;

/// Width of the button that copies, for fingers, in points.
const COPY: f32 = 110.0;

/// Modules of the quiet zone around a QR code, which its standard asks for.
const ZONE: i32 = 4;

/// The largest QR code that the cameras of phones read from a screen: 1273 letters.
const LARGEST: u8 = 25;

/// The dialogue about links.
pub(super) struct Share {
    desk: Box<dyn ShareDesk>,
    /// `None` while the dialogue is closed.
    given: Option<GivenLink>,
}

/// A link on display.
struct GivenLink {
    link: Result<String, String>,
    /// `None` for a link that is too long for a code.
    code: Option<QrCode>,
    is_copied: bool,
    /// Whether a visit is in it.
    has_visit: bool,
    /// Whether it begins with the address of a page.
    has_page: bool,
}

impl GivenLink {
    fn new(link: Result<String, String>, has_visit: bool, has_page: bool) -> Self {
        let code = link.as_ref().ok().and_then(|link| {
            let segments = QrSegment::make_segments(link);
            let (least, mask) = (Version::MIN, None::<Mask>);
            QrCode::encode_segments_advanced(
                &segments,
                QrCodeEcc::Low,
                least,
                Version::new(LARGEST),
                mask,
                false,
            )
            .ok()
        });
        Self { link, code, is_copied: false, has_visit, has_page }
    }
}

impl Share {
    pub(super) fn new(desk: Box<dyn ShareDesk>) -> Self {
        Self { desk, given: None }
    }

    /// Shows the button; a click opens the dialogue with the layout that `layout` returns.
    pub(super) fn button(&mut self, ui: &mut Ui, is_compact: bool, layout: impl FnOnce() -> LayoutToShare) {
        if !self.desk.has_page() {
            return;
        }
        let button = named(ui.button(short(Icon::Share2, "Share", is_compact)), "Share");
        if button.on_hover_text("A link that opens this layout in any browser").clicked() {
            self.open(&layout());
        }
    }

    /// Opens the dialogue with the link of `layout`.
    pub(super) fn open(&mut self, layout: &LayoutToShare) {
        let (has_visit, has_page) = (layout.visit.is_some(), self.desk.has_page());
        self.given = Some(GivenLink::new(self.desk.link(layout), has_visit, has_page));
    }

    /// Opens the page of the link of `layout` in a window of its own, or the dialogue if there is no such link.
    pub(super) fn play(&mut self, ctx: &egui::Context, layout: &LayoutToShare) {
        match self.desk.link(layout) {
            Ok(link) => ctx.open_url(egui::OpenUrl::new_tab(link)),
            Err(_) => self.open(layout),
        }
    }

    /// Shows the dialogue while it is open.
    pub(super) fn show(&mut self, ui: &Ui, theme: &Theme) {
        let Some(given) = &mut self.given else { return };
        let ctx = ui.ctx();
        let frame = egui::Frame::popup(&ctx.global_style()).inner_margin(18);
        let mut is_done = false;
        let modal = Modal::new(egui::Id::unique("share")).frame(frame).show(ctx, |ui| {
            let room = ctx.content_rect().size();
            ui.set_width((CODE + 60.0).min(room.x - 52.0));
            let subject = if given.has_visit { "Share this visit" } else { "Share this layout" };
            ui.label(RichText::new(subject).size(16.0).strong());
            ui.add_space(4.0);
            if is_for_fingers(ui) {
                // A low screen shows the code when it scrolls.
                let most = room.y - 170.0;
                ScrollArea::vertical().max_height(most).show(ui, |ui| given.show(ui, theme));
            } else {
                given.show(ui, theme);
            }
            ui.add_space(8.0);
            is_done = ui.button("Close").clicked();
        });
        if is_done || modal.should_close() {
            self.given = None;
        }
    }
}

impl GivenLink {
    fn show(&mut self, ui: &mut Ui, theme: &Theme) {
        let link = match &self.link {
            Ok(link) => link,
            Err(why) => {
                ui.label(RichText::new(why).color(color(theme.warning)));
                return;
            }
        };
        let text = match (self.has_page, self.has_visit) {
            (false, _) => "Put it behind the address of a web edition, or open it with underfoot preview.",
            (true, true) => "Layout and feet are in the link itself: no server keeps them.",
            (true, false) => "The layout is in the link itself: no server keeps it.",
        };
        ui.label(quiet(theme, text));
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let mut text = link.as_str();
            let width = if is_for_fingers(ui) { ui.available_width() - COPY } else { CODE - 30.0 };
            let field =
                ui.add(TextEdit::singleline(&mut text).desired_width(width).align(egui::Align2::LEFT_CENTER));
            field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Link"));
            let copy = named(ui.button(short(Icon::Copy, "Copy", false)), "Copy");
            if ui.memory(|memory| memory.focused().is_none()) {
                copy.request_focus();
            }
            if copy.clicked() {
                ui.ctx().copy_text(link.clone());
                self.is_copied = true;
            }
        });
        let count = link.chars().count();
        let copied = if self.is_copied { "Copied. " } else { "" };
        ui.label(quiet(theme, format!("{copied}{count} letters")));
        ui.add_space(6.0);
        match &self.code {
            Some(code) => draw(ui, code),
            None => {
                ui.label(quiet(
                    theme,
                    "The link is too long for a QR code that phones read: send it as text.",
                ));
            }
        }
    }
}

/// Draws a QR code, black on white whatever the theme is: cameras want it so.
fn draw(ui: &mut Ui, code: &QrCode) {
    let modules = code.size() + 2 * ZONE;
    // Whole pixels, so that no module is wider than another.
    let scale = ui.ctx().pixels_per_point();
    let wanted = CODE.min(ui.available_width());
    let module = (wanted * scale / modules as f32).floor().max(1.0) / scale;
    let side = module * modules as f32;
    let (area, response) = ui.allocate_exact_size(vec2(side, side), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "QR code of the link"));
    let painter = ui.painter_at(area);
    painter.rect_filled(area, 0.0, Color32::WHITE);
    for y in 0..code.size() {
        let row: Vec<i32> = (0..code.size()).filter(|x| code.get_module(*x, y)).collect();
        // Neighbours in a row are one rectangle.
        for run in row.chunk_by(|one, next| one + 1 == *next) {
            let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
            let corner =
                |x: i32, y: i32| area.min + vec2((x + ZONE) as f32 * module, (y + ZONE) as f32 * module);
            let black = Rect::from_min_max(corner(*first, y), corner(last + 1, y + 1));
            painter.rect_filled(black, 0.0, Color32::BLACK);
        }
    }
}
