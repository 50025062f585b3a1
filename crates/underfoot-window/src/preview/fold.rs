//! Panels of a window in a hand: all begin folded, so that the floor fills the window, and one is open at a time.

use eframe::egui::{Context, Ui};

use super::app::App;
use super::bars::help_bar;
use underfoot_scene::scene::Theme;

/// Height below which a window in a hand has no status bar, in points.
const TALL: f32 = 440.0;

/// The open panels of a window in a hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct UnfoldedPanels {
    designs: bool,
    /// The panel at the side, effects, plots, things to put down, and the text of the layout.
    are_open: [bool; 5],
}

impl UnfoldedPanels {
    /// Whether a panel is open.
    pub(super) fn is_any(self) -> bool {
        self.are_open.contains(&true)
    }
}

/// Fits buttons and panels to how the window is held.
pub(super) fn fit_hand(app: &mut App, ctx: &Context) {
    app.window.hold = app.window.hold_watch.follow(ctx);
    let is_in_hand = app.window.hold.is_in_hand();
    app.appearance.fit(ctx, is_in_hand);
    let folds = app.window.hold.sheet(ctx.content_rect()).is_some();
    app.panel.is_folded = folds;
    if folds {
        fold(app);
    } else {
        app.window.unfolded = UnfoldedPanels::default();
    }
}

/// Leaves the panel open that was opened last; in another mode, all are closed.
fn fold(app: &mut App) {
    let before = app.window.unfolded;
    let designs = app.is_designing();
    let mut are_open: [bool; 5] = panels(app).map(|open| open.is_some_and(|open| *open));
    let newest = (0..are_open.len()).find(|panel| are_open[*panel] && !before.are_open[*panel]);
    if designs != before.designs {
        are_open = [false; 5];
    } else if let Some(newest) = newest {
        are_open = std::array::from_fn(|panel| panel == newest);
    }
    for (panel, is_open) in panels(app).into_iter().zip(are_open) {
        if let Some(panel) = panel {
            *panel = is_open;
        }
    }
    app.window.unfolded = UnfoldedPanels { designs, are_open };
}

/// Whether each panel is open, if the window has it.
fn panels(app: &mut App) -> [Option<&mut bool>; 5] {
    let [things, text] = app.designer.as_mut().map_or([None, None], |designer| designer.sheets().map(Some));
    [
        Some(app.panel.wanted.get_or_insert(false)),
        app.tuner.as_mut().map(|tuner| &mut tuner.is_open),
        Some(&mut app.plots.is_open),
        things,
        text,
    ]
}

/// Shows the bars below the floor; a window in a hand has no keys to explain, and a low one no room for figures.
pub(super) fn show_lower_bars(app: &mut App, ui: &mut Ui, theme: &Theme) {
    let is_in_hand = app.window.hold.is_in_hand();
    if !is_in_hand || ui.ctx().content_rect().height() >= TALL {
        app.status.show(ui, theme, &app.shown);
    }
    if !is_in_hand {
        help_bar(ui, theme, app.activity());
    }
}
