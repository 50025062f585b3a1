//! The middle of the window: a sentence in large letters, and below it the floor or the boards.

use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, FontId, Rect, Sense, Ui, WidgetInfo, vec2};

use super::app::SetupApp;
use super::board_cards::board_cards;
use super::drawing::{FloorDrawing, TileLook};
use crate::preview::style::write_within;
use crate::setup::{SetupStep, SetupView, StandingView, StepState, WiringView, WorkView, mark_words};
use underfoot::floor::{Floor, TileId};
use underfoot::layout::Colour;
use underfoot::serve::{StandNews, StandTask, WiringTask};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of the sentence, in points, and that of its letters: a person reads it from the floor.
const BANNER: f32 = 64.0;
const LETTERS: f32 = 34.0;

impl SetupApp {
    /// Shows the floor, or the boards before there is one.
    pub(super) fn stage(&mut self, ui: &mut Ui, theme: &Theme, view: &SetupView) {
        let (ink, words) = self.banner(theme, view);
        banner(ui, ink, &words);
        if self.step == SetupStep::Boards {
            return board_cards(ui, theme, view);
        }
        let (room, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        if self.step == SetupStep::Shape {
            // A shape that cannot be has its reason on the page.
            let Ok(floor) = self.shape.floor() else { return };
            let drawing = FloorDrawing::new(ui, room, &floor.geometry, theme);
            drawing.tiles(ui, |_| TileLook::Plain);
            return drawing.places();
        }
        let Some(floor) = &view.floor else { return };
        draw_work(ui, room, theme, view, floor);
    }

    /// The sentence in large letters.
    fn banner(&mut self, theme: &Theme, view: &SetupView) -> (Colour, String) {
        let plain = |words: &str| (theme.ink, words.to_owned());
        match (self.step, &view.work) {
            (SetupStep::Boards, _) => match view.boards.len() {
                0 => plain("Switch on your boards"),
                1 => (theme.good, "1 board sends".to_owned()),
                count => (theme.good, format!("{count} boards send")),
            },
            (SetupStep::Shape, _) => match self.shape.floor() {
                Ok(floor) => plain(&format!("{} sensors", sensor_count(&floor))),
                Err(_) => (theme.fault, "This cannot be".to_owned()),
            },
            (SetupStep::Wiring, WorkView::Wiring(walk)) => wiring_banner(theme, walk),
            (SetupStep::Standing, WorkView::Standing(walk)) => standing_banner(theme, walk),
            (SetupStep::Standing, WorkView::Fitting) => plain("Calculating the laws"),
            (SetupStep::Standing, _) if view.fit.is_some() => match view.needy.len() {
                0 => (theme.good, "The floor is calibrated".to_owned()),
                1 => (theme.warning, "1 tile needs more stands".to_owned()),
                count => (theme.warning, format!("{count} tiles need more stands")),
            },
            (SetupStep::Standing, _) => plain("How heavy are you?"),
            (SetupStep::Readings, WorkView::Taring) => plain("Keep off the floor"),
            (SetupStep::Readings, _) if !view.is_rested => plain("Keep off the floor"),
            (SetupStep::Readings, _) if view.step(SetupStep::Readings).state == StepState::Done => {
                (theme.good, "Every sensor answers".to_owned())
            }
            (SetupStep::Readings, _) => plain("Step on every corner"),
            (SetupStep::Layout, WorkView::Open) => (theme.good, "Step on a button".to_owned()),
            _ => plain(self.step.name()),
        }
    }
}

/// Number of sensors of a floor.
pub(super) fn sensor_count(floor: &Floor) -> usize {
    let tiles = floor.geometry.tiles().filter(|tile| floor.geometry.has(*tile));
    tiles.map(|tile| floor.geometry.sensors(tile).len()).sum()
}

/// Writes the sentence, as large as it fits.
fn banner(ui: &mut Ui, ink: Colour, words: &str) {
    let (area, node) = ui.allocate_exact_size(vec2(ui.available_width(), BANNER), Sense::hover());
    node.widget_info(|| WidgetInfo::labeled(Role::Heading, true, words));
    let font = |size| FontId::proportional(size);
    let wide = ui.painter().layout_no_wrap(words.to_owned(), font(LETTERS), color(ink)).size().x;
    let size = LETTERS * (area.width() / wide.max(1.0)).min(1.0);
    if size >= 14.0 {
        ui.painter().text(area.center(), Align2::CENTER_CENTER, words, font(size), color(ink));
    } else {
        write_within(ui.painter(), area.left_center(), area.width(), words, font(14.0), color(ink));
    }
}

fn wiring_banner(theme: &Theme, walk: &WiringView) -> (Colour, String) {
    match walk.task {
        WiringTask::KeepOff => (theme.ink, "Keep off the floor".to_owned()),
        WiringTask::Step(tile) => (theme.accent, format!("Step on tile {tile}")),
        WiringTask::StepOff => (theme.good, "Good. Step off again".to_owned()),
        WiringTask::Nothing => (theme.good, "All boards are found".to_owned()),
    }
}

fn standing_banner(theme: &Theme, walk: &StandingView) -> (Colour, String) {
    if walk.trouble.is_some() {
        return (theme.fault, "Something is missing".to_owned());
    }
    match (walk.task, walk.news) {
        (StandTask::KeepOff, _) => (theme.ink, "Keep off the floor".to_owned()),
        (StandTask::Stay(_), _) => (theme.good, "Stay".to_owned()),
        (StandTask::Go(_), Some(StandNews::Moved(_))) => (theme.warning, "You moved: stand still".to_owned()),
        (StandTask::Go(mark), Some(StandNews::Elsewhere { mark: told, felt })) if mark == told => {
            (theme.warning, format!("Tile {felt} feels you, not {}", mark.tile))
        }
        (StandTask::Go(mark), _) => {
            let facing = if mark.facing == 0.0 { "north" } else { "south" };
            (theme.accent, format!("Stand on the shoes, facing {facing}"))
        }
        (StandTask::Nothing, _) => (theme.good, "Done. Step off".to_owned()),
    }
}

/// Draws the floor of the file with the work under way.
fn draw_work(ui: &Ui, room: Rect, theme: &Theme, view: &SetupView, floor: &Floor) {
    let drawing = FloorDrawing::new(ui, room, &floor.geometry, theme);
    match &view.work {
        WorkView::Wiring(walk) => {
            let is_right = view.step(SetupStep::Wiring).state == StepState::Done;
            drawing.tiles(ui, |tile| match wiring_look(walk, tile) {
                // The floor file has the swapped boards exchanged now.
                TileLook::Bad if is_right => TileLook::Good,
                look => look,
            });
            drawing.sensors(ui, &view.sensors);
        }
        WorkView::Standing(walk) => {
            drawing.tiles(ui, |_| TileLook::Plain);
            drawing.sensors(ui, &view.sensors);
            for (number, mark) in walk.marks.iter().enumerate() {
                if number != walk.done {
                    drawing.small_mark(mark, number < walk.done);
                }
            }
            let present = match walk.task {
                StandTask::Go(mark) => Some((mark, theme.accent)),
                StandTask::Stay(mark) => Some((mark, theme.good)),
                StandTask::KeepOff | StandTask::Nothing => None,
            };
            if let Some((mark, ink)) = present {
                let words = format!("Stand here: {}", mark_words(&mark, floor));
                drawing.present_mark(ui, &mark, walk.share, ink, &words);
            }
        }
        _ => {
            let has_fit = view.fit.is_some();
            drawing.tiles(ui, |tile| match has_fit {
                true if view.needy.contains(&tile) => TileLook::Bad,
                _ => TileLook::Plain,
            });
            if view.sensors.is_empty() {
                drawing.places();
            } else {
                drawing.sensors(ui, &view.sensors);
            }
        }
    }
}

fn wiring_look(walk: &WiringView, tile: TileId) -> TileLook {
    if walk.task == WiringTask::Step(tile) {
        return TileLook::Lit;
    }
    if matches!(walk.task, WiringTask::Step(_)) && walk.felt.is_some_and(|felt| felt.tile == tile) {
        return TileLook::Felt;
    }
    match walk.steps.iter().find(|step| step.tile == tile) {
        Some(step) if step.board == step.found && step.tile == step.felt => TileLook::Good,
        Some(_) => TileLook::Bad,
        None => TileLook::Plain,
    }
}
