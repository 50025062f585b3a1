//! The floor as a drawing board: what is selected, moved, sized, put down, and what is wrong with it.

use std::borrow::Cow;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Key, PointerButton, Pos2, Sense, Stroke, StrokeKind, Ui, WidgetInfo,
    pos2, vec2,
};
use glam::Vec2;

use super::Designer;
use crate::edit::{Address, Edges, Grid, Guide, Item, List};
use crate::egui_painter::{self, Palette, ScreenFromFloor, color};
use crate::engine::Snapshot;
use crate::ergonomics::{REACH_M, STEP_AWAY_M, footing};
use crate::floor::Rect;
use crate::format::diagnostic::Severity;
use crate::layout::Layout;
use crate::scene::{self, Shoe, Show, Theme, View};
use crate::units::Newtons;

/// Half the side of a handle, and how near the pointer must be to it, in points.
const HANDLE: f32 = 5.0;
const NEAR: f32 = 9.0;

/// How near a line pulls, in points.
const PULL: f32 = 7.0;

/// How far the pointer goes before a press is a drag, in points.
const SLACK: f32 = 4.0;

/// Narrowest that anything is dragged to, in metres; the format allows 0.05 tiles.
const LEAST_M: f32 = 0.03;

/// What the pointer is doing.
#[derive(Clone, Debug, Default)]
pub(super) enum Gesture {
    #[default]
    None,
    /// It went down on something, which is moved once it goes further.
    Pressed { at: Pos2, record: Address },
    /// What is selected follows it.
    Moving { from: Vec2, edges: Edges },
    /// It draws a rectangle around what is to be selected.
    Lasso { from: Vec2 },
    /// The view follows it.
    Panning,
}

impl Designer {
    /// The floor, in what is left of the window.
    pub(super) fn canvas(&mut self, ui: &mut Ui, theme: &Theme, palette: &mut Palette) {
        let rect = ui.available_rect_before_wrap();
        let canvas = ui.allocate_rect(rect, Sense::click_and_drag());
        canvas.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Drawing board"));
        let geometry = self.document.floor().geometry;
        let show = Show { sensors: false, contacts: false, ..Show::WINDOW };
        let bounds = scene::extent(&geometry, show);
        let screen = rect.shrink(14.0);
        self.zoom(ui, &canvas, bounds, screen);
        let map = self.view.map(bounds, screen);
        let trial = self.gestures(ui, &canvas, map, screen);
        let shown = trial.layout.as_ref().unwrap_or_else(|| self.document.layout());
        let shown = self.without_hidden(shown);
        let snapshot = Snapshot { page: self.page, ..Snapshot::default() };
        let pointer = canvas.hover_pos().map(|at| map.floor(at));
        let shoes = self.shoes(pointer);
        let view = View { show, shoes: &shoes, ..View::new(&geometry, &shown, &snapshot, theme) };
        let mut scene = std::mem::take(&mut self.scene);
        scene::draw(&mut scene, &view);
        let painter = ui.painter_at(rect);
        egui_painter::paint(&painter, palette, &scene, map);
        self.scene = scene;
        self.reach(&painter, map, theme);
        self.marks(ui, rect, map, theme, &trial);
        self.names(ui, map);
    }

    fn zoom(&mut self, ui: &Ui, canvas: &egui::Response, bounds: Rect, screen: egui::Rect) {
        let Some(pointer) = ui.input(|i| i.pointer.hover_pos()).filter(|_| canvas.contains_pointer()) else {
            return;
        };
        let (wheel, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let by = pinch * (wheel * 0.004).exp();
        if (by - 1.0).abs() > 1e-4 {
            self.view.about(pointer, by, bounds, screen);
        }
    }

    /// The whole floor again.
    pub(super) fn fit(&mut self) {
        self.view = crate::preview::zoom::Zoom::default();
    }

    /// Follows the pointer; what would come of it if it let go now.
    fn gestures(
        &mut self,
        ui: &Ui,
        canvas: &egui::Response,
        map: ScreenFromFloor,
        screen: egui::Rect,
    ) -> Trial {
        let (pointer, pressed, released, middle, space, shift, alt, delta) = ui.input(|i| {
            (
                i.pointer.interact_pos().or(i.pointer.hover_pos()),
                i.pointer.primary_pressed(),
                i.pointer.primary_released(),
                i.pointer.button_down(PointerButton::Middle),
                i.key_down(Key::Space),
                i.modifiers.shift,
                i.modifiers.alt,
                i.pointer.delta(),
            )
        });
        let Some(pointer) = pointer else { return Trial::default() };
        let inside = canvas.contains_pointer() || canvas.rect.contains(pointer) && self.placing.is_some();
        let at = map.floor(pointer);
        if middle && inside || matches!(self.gesture, Gesture::Panning) {
            self.view.pan(delta, screen);
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if let Some(thing) = self.placing.clone() {
            // Dragged here, the press began elsewhere.
            let dropped = released && !canvas.clicked() && !canvas.drag_stopped();
            return self.put_down(&thing, at, inside, pressed, dropped, map, alt);
        }
        if pressed && inside {
            canvas.request_focus();
            ui.ctx().memory_mut(|memory| memory.surrender_focus(canvas.id));
            self.stroke += 1;
            self.begin_gesture(pointer, at, map, space, shift);
        }
        if let Gesture::Pressed { at: from, record } = self.gesture.clone()
            && from.distance(pointer) > SLACK
        {
            if !self.selected.contains(&record) {
                self.select_only(record);
            }
            self.gesture = Gesture::Moving { from: map.floor(from), edges: Edges::ALL };
        }
        let trial = match &self.gesture {
            Gesture::Moving { from, edges } => self.moving(at - *from, *edges, map, alt),
            Gesture::Lasso { from } => Trial { lasso: Some(around(*from, at)), ..Trial::default() },
            _ => Trial::default(),
        };
        if inside && matches!(self.gesture, Gesture::None) {
            self.hover(ui, pointer, map);
        }
        if released {
            self.end_gesture(&trial, shift, map);
        }
        trial
    }

    fn begin_gesture(&mut self, pointer: Pos2, at: Vec2, map: ScreenFromFloor, space: bool, shift: bool) {
        if space {
            self.gesture = Gesture::Panning;
            return;
        }
        if let Some(edges) = self.handle_under(pointer, map) {
            self.gesture = Gesture::Moving { from: at, edges };
            return;
        }
        match self.touched(at) {
            // A region is behind everything: a drag across it selects, a click takes it.
            Some(record) if record.list() == Some(List::Regions) && !self.selected.contains(&record) => {
                self.gesture = Gesture::Lasso { from: at };
            }
            Some(record) if shift => self.toggle(record),
            Some(record) => self.gesture = Gesture::Pressed { at: pointer, record },
            // What is locked is chosen in the list.
            None => self.gesture = Gesture::Lasso { from: at },
        }
    }

    fn end_gesture(&mut self, trial: &Trial, shift: bool, map: ScreenFromFloor) {
        match std::mem::take(&mut self.gesture) {
            // A second click on a group takes what is in it.
            Gesture::Pressed { record, at } if self.selected == [record.clone()] => {
                let inner = self.document.item_at(&self.items, self.page, map.floor(at));
                self.select_only(inner.filter(|inner| inner.is_within(&record)).unwrap_or(record));
            }
            Gesture::Pressed { record, .. } => self.select_only(record),
            Gesture::Moving { .. } if !trial.areas.is_empty() => {
                let areas = trial.areas.clone();
                self.move_to(&areas);
            }
            Gesture::Lasso { from } => {
                let Some(area) = trial.lasso else { return };
                if !shift {
                    self.selected.clear();
                }
                if area.size().max_element() < 0.01 {
                    let record = self.touched(from);
                    self.selected.extend(record);
                    return;
                }
                let page = self.page;
                let inside = self.items.iter().filter(|item| {
                    item.record.list() == Some(List::Widgets)
                        && !item.is_group
                        && item.is_on(page)
                        && item.area.overlaps(area)
                        && !self.is_locked(&item.record)
                        && !self.is_hidden(&item.record)
                });
                let found: Vec<Address> = inside.map(|item| group_of(&item.record)).collect();
                for record in found {
                    if !self.selected.contains(&record) {
                        self.selected.push(record);
                    }
                }
            }
            _ => {}
        }
    }

    /// What is taken hold of at `point`: a group as a whole, unless something in it is selected. What is locked or
    /// hidden is let be.
    fn touched(&self, point: Vec2) -> Option<Address> {
        let free = |item: &&Item| !self.is_locked(&item.record) && !self.is_hidden(&item.record);
        let free: Vec<Item> = self.items.iter().filter(free).cloned().collect();
        let record = self.document.item_at(&free, self.page, point)?;
        let group = group_of(&record);
        let is_entered = self.selected.iter().any(|one| *one != group && one.is_within(&group));
        Some(if is_entered { record } else { group })
    }

    /// `layout` without what is hidden.
    fn without_hidden<'l>(&self, layout: &'l Layout) -> Cow<'l, Layout> {
        if self.hidden.is_empty() {
            return Cow::Borrowed(layout);
        }
        let hidden: Vec<&Item> = self.items.iter().filter(|item| self.is_hidden(&item.record)).collect();
        let is_left = |list: List, index: usize| {
            !hidden.iter().any(|item| match list {
                List::Widgets => item.widgets.contains(&index),
                _ => item.record == Address::of(list, index),
            })
        };
        let mut layout = layout.clone();
        keep(&mut layout.widgets, |index| is_left(List::Widgets, index));
        keep(&mut layout.stances, |index| is_left(List::Stances, index));
        let grounds: Vec<bool> = self
            .items
            .iter()
            .filter(|item| item.record.list() == Some(List::Grounds))
            .map(|item| !self.is_hidden(&item.record))
            .collect();
        keep(&mut layout.grounds, |index| grounds.get(index).copied().unwrap_or(true));
        Cow::Owned(layout)
    }

    /// Two shoes on each place to stand, and one under the pointer, where they are asked for.
    fn shoes(&self, pointer: Option<Vec2>) -> Vec<Shoe> {
        /// A sole that 95 of 100 people can stand on.
        const LENGTH_M: f32 = 0.30;
        /// From the middle of one sole to that of the other.
        const APART_M: f32 = 0.20;
        if !self.seen_to_scale.shoes {
            return Vec::new();
        }
        let shoe = |position: Vec2, left: bool| Shoe {
            position,
            heading_rad: 0.0,
            length_m: LENGTH_M,
            force: Newtons(0.0),
            roll: 0.5,
            left,
        };
        let stances = self.layout().stances.iter().map(|stance| stance.area.centre());
        let pairs = stances.flat_map(|at| {
            let half = Vec2::new(0.5 * APART_M, 0.0);
            [shoe(at - half, true), shoe(at + half, false)]
        });
        pairs.chain(pointer.map(|at| shoe(at, false))).collect()
    }

    /// How far feet reach from each place to stand, without a step and with one, where that is asked for.
    fn reach(&self, painter: &egui::Painter, map: ScreenFromFloor, theme: &Theme) {
        if !self.seen_to_scale.reach {
            return;
        }
        let colour = color(theme.accent).gamma_multiply(0.8);
        for stance in &self.layout().stances {
            for (far, text) in [(REACH_M, "reach"), (STEP_AWAY_M, "one step")] {
                let line: Vec<Pos2> =
                    rounded(footing(stance), far).into_iter().map(|at| map.point(at)).collect();
                let north = line.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y));
                painter.extend(egui::Shape::dashed_line(&line, Stroke::new(1.5, colour), 7.0, 5.0));
                if let Some(at) = north {
                    label(painter, at + vec2(-24.0, -8.0), &format!("{text}, {far:.1} m"), colour, theme);
                }
            }
        }
    }

    pub(super) fn toggle(&mut self, record: Address) {
        match self.selected.iter().position(|other| *other == record) {
            Some(at) => drop(self.selected.remove(at)),
            None => self.selected.push(record),
        }
    }

    /// Which edges a handle of the selected thing under the pointer drags.
    fn handle_under(&self, pointer: Pos2, map: ScreenFromFloor) -> Option<Edges> {
        let [item] = self.selected_items()[..] else { return None };
        if !can_be_sized(item) || self.is_locked(&item.record) {
            return None;
        }
        let near = handles(map.rect(item.area)).into_iter().find(|(at, _)| at.distance(pointer) <= NEAR);
        near.map(|(_, edges)| edges)
    }

    fn hover(&self, ui: &Ui, pointer: Pos2, map: ScreenFromFloor) {
        let icon = match self.handle_under(pointer, map) {
            Some(Edges { north: false, south: false, .. }) => CursorIcon::ResizeHorizontal,
            Some(Edges { east: false, west: false, .. }) => CursorIcon::ResizeVertical,
            Some(edges) if edges.north == edges.east => CursorIcon::ResizeNeSw,
            Some(_) => CursorIcon::ResizeNwSe,
            None if ui.input(|i| i.key_down(Key::Space)) => CursorIcon::Grab,
            None => CursorIcon::Default,
        };
        ui.ctx().set_cursor_icon(icon);
    }

    /// What comes of moving what is selected by `by`.
    fn moving(&self, by: Vec2, edges: Edges, map: ScreenFromFloor, alt: bool) -> Trial {
        let items = self.selected_items();
        let Some(all) = crate::edit::around(items.iter().map(|item| item.area)) else {
            return Trial::default();
        };
        let moved = edges.moved(all, by, LEAST_M);
        let (snapped, guides) = self.snapped(moved, edges, map, alt);
        let shift = snapped.min - all.min;
        let areas: Vec<Rect> = match items[..] {
            [_] => vec![snapped],
            _ => items.iter().map(|item| Rect::new(item.area.min + shift, item.area.max + shift)).collect(),
        };
        let pairs: Vec<(&Item, Rect)> = items.iter().copied().zip(areas.iter().copied()).collect();
        let tried = self.document.placing(&pairs).and_then(|edits| self.document.trial(&edits));
        let (layout, refused) = match tried {
            Ok(layout) => (Some(layout), None),
            Err(refusal) => (None, Some(refusal.short())),
        };
        Trial { layout, refused, areas, guides, lasso: None }
    }

    fn snapped(&self, area: Rect, edges: Edges, map: ScreenFromFloor, alt: bool) -> (Rect, Vec<Guide>) {
        if alt {
            return (area, Vec::new());
        }
        let others = self.items.iter().filter(|item| {
            matches!(item.record.list(), Some(List::Widgets | List::Regions | List::Stances))
                && item.is_on(self.page)
                && !item.is_group
                && !self.selected.iter().any(|selected| item.record.is_within(selected))
        });
        let neighbours: Vec<Rect> = others.map(|item| item.area).collect();
        let geometry = &self.document.floor().geometry;
        let grid = Grid { geometry, neighbours: &neighbours, reach_m: PULL / map.scale() };
        grid.snap(area, edges)
    }

    #[expect(clippy::too_many_arguments, reason = "what the pointer does in one frame")]
    fn put_down(
        &mut self,
        thing: &super::palette::Thing,
        at: Vec2,
        inside: bool,
        pressed: bool,
        dropped: bool,
        map: ScreenFromFloor,
        alt: bool,
    ) -> Trial {
        if !inside {
            return Trial::default();
        }
        let size = thing.size(&self.document.floor().geometry);
        let area = Rect::from_centre_size(at, size);
        let (area, guides) = self.snapped(area, Edges::ALL, map, alt);
        // Dragged here, it is put down where the button comes up; after a click, where it goes down.
        if pressed || dropped {
            if self.put(thing, area) || dropped {
                self.placing = None;
            }
            return Trial::default();
        }
        Trial { areas: vec![area], guides, ..Trial::default() }
    }

    /// What is selected, what it snaps to, and what is wrong.
    fn marks(&self, ui: &Ui, rect: egui::Rect, map: ScreenFromFloor, theme: &Theme, trial: &Trial) {
        let painter = ui.painter_at(rect);
        let accent = color(theme.accent);
        for (number, finding) in self.findings.iter().enumerate() {
            let Some(widget) = self.layout().widgets.get(finding.widget) else { continue };
            let is_hidden = || self.document.found_in(finding).is_none_or(|record| self.is_hidden(&record));
            if widget.page.is_some_and(|page| page != self.page) || trial.layout.is_some() || is_hidden() {
                continue;
            }
            let colour = color(match finding.severity {
                Severity::Error => theme.fault,
                Severity::Warning => theme.warning,
            });
            let shown = map.rect(widget.area);
            painter.rect_stroke(shown.expand(2.0), 4, Stroke::new(1.5, colour), StrokeKind::Outside);
            let measure = finding.expected.as_str();
            let text = format!("{} {measure}", finding.rule.code);
            // One below the other, where a control has several.
            let above = self.findings[..number].iter().filter(|other| other.widget == finding.widget).count();
            let at = pos2(shown.left(), shown.bottom() + 3.0 + 17.0 * above as f32);
            label(&painter, at, &text, colour, theme);
        }
        let is_moving = !trial.areas.is_empty();
        for item in self.selected_items() {
            let shown = map.rect(item.area);
            let colour = if is_moving { accent.gamma_multiply(0.4) } else { accent };
            painter.rect_stroke(shown, 2, Stroke::new(2.0, colour), StrokeKind::Outside);
        }
        if let ([item], false) = (&self.selected_items()[..], is_moving)
            && can_be_sized(item)
        {
            for (at, _) in handles(map.rect(item.area)) {
                let square = egui::Rect::from_center_size(at, vec2(2.0 * HANDLE, 2.0 * HANDLE));
                painter.rect(square, 2, color(theme.plate), Stroke::new(1.5, accent), StrokeKind::Inside);
            }
        }
        let bad = color(theme.fault);
        for area in &trial.areas {
            let shown = map.rect(*area);
            let colour = if trial.refused.is_some() { bad } else { accent };
            painter.rect(
                shown,
                2,
                colour.gamma_multiply(0.12),
                Stroke::new(2.0, colour),
                StrokeKind::Outside,
            );
            let size = area.size() * 100.0;
            let text = format!("{:.1} x {:.1} cm", size.x, size.y);
            label(&painter, pos2(shown.left(), shown.top() - 20.0), &text, colour, theme);
        }
        if let (Some(refused), Some(area)) = (&trial.refused, trial.areas.first()) {
            label(
                &painter,
                pos2(map.rect(*area).left(), map.rect(*area).bottom() + 4.0),
                refused,
                bad,
                theme,
            );
        }
        for guide in &trial.guides {
            let at = map.point(Vec2::splat(guide.at_m));
            let line = if guide.is_upright {
                [pos2(at.x, rect.top()), pos2(at.x, rect.bottom())]
            } else {
                [pos2(rect.left(), at.y), pos2(rect.right(), at.y)]
            };
            painter.line_segment(line, Stroke::new(1.0, accent));
        }
        if let Some(lasso) = trial.lasso {
            let shown = map.rect(lasso);
            painter.rect(shown, 0, accent.gamma_multiply(0.1), Stroke::new(1.0, accent), StrokeKind::Inside);
        }
    }

    /// Tells screen readers and tests what is where.
    fn names(&self, ui: &Ui, map: ScreenFromFloor) {
        let is_seen = |item: &&Item| item.is_on(self.page) && !item.is_group && !self.is_hidden(&item.record);
        for item in self.items.iter().filter(is_seen) {
            let id = ui.scope_id().with(("record", item.record.to_string()));
            let node = ui.interact(map.rect(item.area), id, Sense::hover());
            let is_selected = self.selected.contains(&item.record);
            node.widget_info(|| {
                WidgetInfo::selected(
                    Role::ListItem,
                    true,
                    is_selected,
                    format!("On the floor: {}", item.name),
                )
            });
        }
    }
}

/// What would come of a gesture if it ended now.
#[derive(Default)]
struct Trial {
    /// The layout; `None` where it is refused, or nothing is changed.
    layout: Option<Layout>,
    /// Why it would be refused.
    refused: Option<String>,
    /// The areas of what is selected, or of what is put down.
    areas: Vec<Rect>,
    guides: Vec<Guide>,
    lasso: Option<Rect>,
}

/// The outermost group that it is in; itself where it is in none.
fn group_of(record: &Address) -> Address {
    let mut outermost = record.clone();
    while let Some((parent, ..)) =
        outermost.split().filter(|(parent, ..)| parent.list() == Some(List::Widgets))
    {
        outermost = parent;
    }
    outermost
}

/// Leaves out those for which `is_left` says no.
fn keep<T>(all: &mut Vec<T>, is_left: impl Fn(usize) -> bool) {
    let mut index = 0;
    all.retain(|_| {
        index += 1;
        is_left(index - 1)
    });
}

/// A closed line that keeps `far` from `area`.
fn rounded(area: Rect, far: f32) -> Vec<Vec2> {
    let corners = [area.max, Vec2::new(area.min.x, area.max.y), area.min, Vec2::new(area.max.x, area.min.y)];
    let arc = |(quarter, corner): (usize, Vec2)| {
        (0..=16_u8).map(move |part| {
            let turn = quarter as f32 + f32::from(part) / 16.0;
            corner + far * Vec2::from_angle(turn * std::f32::consts::FRAC_PI_2)
        })
    };
    let mut line: Vec<Vec2> = corners.into_iter().enumerate().flat_map(arc).collect();
    line.extend(line.first().copied());
    line
}

fn can_be_sized(item: &Item) -> bool {
    !item.is_group && item.widgets.len() <= 1
}

fn around(a: Vec2, b: Vec2) -> Rect {
    Rect::new(a.min(b), a.max(b))
}

/// The handles around `shown`, with what each drags.
fn handles(shown: egui::Rect) -> [(Pos2, Edges); 8] {
    let (x, y) = (shown.center().x, shown.center().y);
    let edges = |west, east, south, north| Edges { west, east, south, north };
    [
        (shown.left_top(), edges(true, false, false, true)),
        (shown.right_top(), edges(false, true, false, true)),
        (shown.left_bottom(), edges(true, false, true, false)),
        (shown.right_bottom(), edges(false, true, true, false)),
        (pos2(shown.left(), y), edges(true, false, false, false)),
        (pos2(shown.right(), y), edges(false, true, false, false)),
        (pos2(x, shown.bottom()), edges(false, false, true, false)),
        (pos2(x, shown.top()), edges(false, false, false, true)),
    ]
}

/// Small text on a plate, so that it can be read on anything.
fn label(painter: &egui::Painter, at: Pos2, text: &str, colour: Color32, theme: &Theme) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(11.5), colour);
    let plate = Align2::LEFT_TOP.anchor_size(at, galley.size() + vec2(8.0, 2.0));
    painter.rect_filled(plate, 3, color(theme.plate).gamma_multiply(0.92));
    painter.galley(plate.min + vec2(4.0, 1.0), galley, colour);
}
