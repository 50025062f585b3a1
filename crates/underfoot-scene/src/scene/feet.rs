//! Feet: simulated shoes, contacts and cursors.

use glam::Vec2;

use super::mark::{Ink, Paint, Stroke};
use super::view::Shoe;
use super::{Scene, View, outline};
use underfoot::engine::FootRole;
use underfoot::floor::Rect;
use underfoot::sense::Contact;

/// Area of a contact's circle per newton, in square metres: a circle of 350 N, half a person, is 13 cm wide.
const CIRCLE_M2_PER_N: f32 = 0.065 * 0.065 / 350.0;

/// Time over which a contact's velocity is extrapolated for its arrow, in seconds.
const AHEAD_S: f32 = 0.20;

/// Translucent soles, darker under pressure.
pub(super) fn shoes(scene: &mut Scene, view: &View<'_>) {
    for shoe in view.shoes {
        let finite = shoe.position.is_finite() && shoe.heading_rad.is_finite() && shoe.length_m.is_finite();
        if finite && shoe.length_m > 0.0 {
            self::shoe(scene, view, shoe);
        }
    }
}

fn shoe(scene: &mut Scene, view: &View<'_>, shoe: &Shoe) {
    let colour = view.theme.shoe;
    let down = shoe.force.0 > 0.0;
    let stroke = Stroke::new(0.003, Ink::faint(colour, if down { 0.75 } else { 0.4 }));
    let stroke = if down { stroke } else { stroke.dashed(0.014, 0.010) };
    let paint = Paint::fill(Ink::faint(colour, if down { 0.20 } else { 0.07 })).with_stroke(stroke);
    let sole = outline::sole(shoe.position, shoe.heading_rad, shoe.length_m, shoe.left);
    scene.add_path(sole, true, paint);
    if !down {
        return;
    }
    let forward = Vec2::from_angle(shoe.heading_rad).rotate(Vec2::Y);
    let roll = if shoe.roll.is_finite() { shoe.roll.clamp(0.0, 1.0) } else { 0.5 };
    // The sole is darkest at 800 N.
    let press = 0.10 + 0.25 * (shoe.force.0 / 800.0).clamp(0.0, 1.0).sqrt();
    for (along, size, share) in [(-0.33, 0.095, 1.0 - roll), (0.24, 0.125, roll)] {
        let centre = shoe.position + forward * along * shoe.length_m;
        let pad = Paint::fill(Ink::faint(colour, press * (0.25 + 0.75 * share)));
        scene.add_circle(centre, size * shoe.length_m, pad);
    }
}

/// Radius of a contact's circle, in metres.
fn radius_m(force: f32) -> f32 {
    (force.clamp(0.0, 5000.0) * CIRCLE_M2_PER_N).sqrt().max(0.012)
}

/// Draws circles with an area proportional to the force, a cross at the centroid, the velocity, number and newtons;
/// returns the areas of the texts.
pub(super) fn contacts(scene: &mut Scene, view: &View<'_>) -> Vec<Rect> {
    let mut tags = Vec::new();
    for contact in &view.snapshot.contacts {
        if contact.centroid.is_finite() {
            self::contact(scene, view, contact, &mut tags);
        }
    }
    tags
}

fn contact(scene: &mut Scene, view: &View<'_>, contact: &Contact, tags: &mut Vec<Rect>) {
    let theme = view.theme;
    let leads = view.snapshot.cursors.iter().flatten().any(|cursor| cursor.contact == contact.id);
    // Objects on the floor have the colour of stale values.
    let is_object =
        view.snapshot.feet.iter().any(|foot| foot.contact == contact.id && foot.role == FootRole::Object);
    let colour = match (is_object, leads) {
        (true, _) => theme.stale,
        (false, true) => theme.cursor,
        (false, false) => theme.contact,
    };
    let (at, radius) = (contact.centroid, radius_m(contact.force.0));
    let edge = Stroke::new(0.003, Ink::faint(colour, 0.9));
    scene.add_circle(at, radius, Paint::fill(Ink::faint(colour, 0.22)).with_stroke(edge));
    if leads && view.show.cursors {
        cursor_ring(scene, view, at, radius);
    }
    let cross = |width: f32, ink| Paint::stroke(Stroke::new(width, ink));
    for arm in [Vec2::new(0.011, 0.0), Vec2::new(0.0, 0.011)] {
        scene.add_line(at - arm * 1.2, at + arm * 1.2, cross(0.0065, Ink::faint(theme.plate, 0.85)));
        scene.add_line(at - arm, at + arm, cross(0.003, Ink::solid(colour)));
    }
    velocity(scene, view, contact);
    // The scale for the viewing distance: a larger floor is seen from further away, a single tile from nearby.
    let by = super::magnification(view.geometry).clamp(0.3, 4.0);
    let (ground, size_m) = (Paint::fill(Ink::faint(theme.plate, 0.92)), 0.026 * by);
    let middle = tag_place(view, at, radius, by, tags);
    let leads_from = (middle - at).clamp_length_max(radius);
    if middle.distance(at) > radius + 0.10 * by {
        let stroke = Stroke::new(0.002, Ink::faint(colour, 0.6));
        scene.add_line(at + leads_from, middle, Paint::stroke(stroke));
    }
    let edged = ground.with_stroke(Stroke::new(0.0018, Ink::faint(colour, 0.7)));
    let number = contact.id.0;
    let left = if is_object { " · ignored" } else { "" };
    scene.add_badge(
        middle,
        size_m,
        Ink::solid(colour),
        edged,
        format_args!("{number} · {:.0} N{left}", contact.force.0),
    );
}

/// Finds a place for a contact's tag that covers no control with its name and value, no other tag, and nothing
/// outside the floor: beside the circle if there is room, otherwise as near as possible; north-east first.
fn tag_place(view: &View<'_>, at: Vec2, radius: f32, by: f32, tags: &mut Vec<Rect>) -> Vec2 {
    /// Half the size of a tag.
    const HALF: Vec2 = Vec2::new(0.075, 0.022);
    /// Directions in order of preference.
    const WAYS: [Vec2; 8] = [
        Vec2::new(0.7, 0.7),
        Vec2::new(-0.7, 0.7),
        Vec2::new(0.7, -0.7),
        Vec2::new(-0.7, -0.7),
        Vec2::X,
        Vec2::NEG_X,
        Vec2::Y,
        Vec2::NEG_Y,
    ];
    let half = HALF * by;
    let floor = view.geometry.bounds();
    let areas: Vec<Rect> = view.controls().map(|widget| widget.area).chain(tags.iter().copied()).collect();
    let mut best = (f32::INFINITY, at);
    for step in 0..12_u8 {
        let farther = 0.03 * by * f32::from(step);
        for (rank, way) in (0_u8..).zip(WAYS) {
            let place = at + way * (Vec2::splat(radius + farther) + half);
            let place = place.clamp(floor.min + half, (floor.max - half).max(floor.min + half));
            let tag = Rect::from_centre_size(place, 2.0 * half);
            let covered = areas.iter().filter(|area| area.overlaps(tag)).count() as f32;
            let on_circle = f32::from(u8::from(place.distance(at) < 0.7 * radius));
            let cost = 10.0 * covered + 3.0 * on_circle + place.distance(at) + 0.002 * f32::from(rank);
            if cost < best.0 {
                best = (cost, place);
            }
        }
    }
    tags.push(Rect::from_centre_size(best.1, 2.0 * half));
    best.1
}

/// A heavy ring with four ticks for a contact that operates the controls.
pub(super) fn cursor_ring(scene: &mut Scene, view: &View<'_>, at: Vec2, radius: f32) {
    let theme = view.theme;
    let ring = radius + 0.011;
    scene.add_circle(at, ring, Paint::stroke(Stroke::new(0.0095, Ink::faint(theme.plate, 0.85))));
    scene.add_circle(at, ring, Paint::stroke(Stroke::new(0.0055, Ink::solid(theme.cursor))));
    for way in [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y] {
        let stroke = Stroke::new(0.0055, Ink::solid(theme.cursor));
        scene.add_line(at + way * ring, at + way * (ring + 0.014), Paint::stroke(stroke));
    }
}

/// An arrow to the predicted place of the contact; none below the speed of noise.
fn velocity(scene: &mut Scene, view: &View<'_>, contact: &Contact) {
    let speed = contact.velocity.length();
    if !speed.is_finite() || speed < 0.05 {
        return;
    }
    let way = contact.velocity / speed;
    let tip = contact.centroid + way * (speed * AHEAD_S).min(0.30);
    let stroke = Paint::stroke(Stroke::new(0.004, Ink::solid(view.theme.ink)));
    scene.add_line(contact.centroid, tip, stroke);
    let back = tip - way * 0.014;
    scene.add_path([back + way.perp() * 0.009, tip, back - way.perp() * 0.009], false, stroke);
}
