//! Press forces compared with people's forces.

use glam::Vec2;

use super::{Part, Subject, cm};
use underfoot::units::Newtons;
use underfoot::widget::Behaviour;

/// Weight of the lightest person that the rules consider: 45 kg.
const LIGHT_PERSON: Newtons = Newtons(45.0 * 9.81);
/// Share of the weight on the pressing foot while the other foot stands.
const SHIFTED: f32 = 0.5;
/// Maximum force of a foot that only rests.
pub(super) const RESTING: Newtons = Newtons(35.0);
/// Force on each foot of a standing person of 70 kg.
const STANDING: Newtons = Newtons(350.0);
/// Maximum distance that feet stray from a stance zone (m).
const STRAY_M: f32 = 0.10;

pub(super) fn review(subject: &mut Subject<'_>) {
    light_person(subject);
    full_pedal(subject);
    stance(subject);
}

fn light_person(subject: &mut Subject<'_>) {
    let thresholds = subject.widget.behaviour.thresholds();
    let share = thresholds.share.map(|share| share.press);
    // Press force if the person's weight is known, and if it is unknown.
    let heaviest = thresholds.press.max(LIGHT_PERSON * share.unwrap_or(0.0));
    let lightest =
        share.map_or(thresholds.press, |share| Newtons(thresholds.press.0.min(LIGHT_PERSON.0 * share)));
    let of_weight = format!("it takes {:.0} N, the whole weight is {:.0} N", heaviest.0, LIGHT_PERSON.0);
    if heaviest > LIGHT_PERSON {
        let message = format!("{} takes more than a person of 45 kg weighs", subject.name());
        subject.error("U201", Part::Press, message, of_weight);
    } else if heaviest > LIGHT_PERSON * SHIFTED {
        let message = format!("{} takes more than a person of 45 kg presses with one foot", subject.name());
        subject.warning("U201", Part::Press, message, of_weight);
    }
    if lightest < RESTING {
        let message = format!("{} is pressed by a foot that only rests on it", subject.name());
        let expected = format!("it takes {:.0} N", lightest.0);
        subject.warning("U202", Part::Press, message, expected);
    }
}

/// Checks the force for a pedal's greatest value.
fn full_pedal(subject: &mut Subject<'_>) {
    let Behaviour::Pedal(pedal) = &subject.widget.behaviour else { return };
    let full = pedal.full;
    if full > LIGHT_PERSON * SHIFTED {
        let message = format!("a person of 45 kg can't press {} all the way with one foot", subject.name());
        let expected = format!("that takes {:.0} N, the whole weight is {:.0} N", full.0, LIGHT_PERSON.0);
        subject.warning("U201", Part::Press, message, expected);
    }
}

fn stance(subject: &mut Subject<'_>) {
    let area = subject.widget.area;
    let press = subject.widget.behaviour.thresholds().press;
    let gap = |other: underfoot::floor::Rect| {
        (other.min - area.max).max(area.min - other.max).max(Vec2::ZERO).length()
    };
    let nearest = subject
        .layout
        .stances
        .iter()
        .map(|stance| (stance, gap(stance.area)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((stance, gap)) = nearest else { return };
    let zone = if stance.label.is_empty() { String::new() } else { format!(" \"{}\"", stance.label) };
    if stance.area.grown(-1e-4).overlaps(area) {
        let message = format!("part of {} lies in the stance zone{zone}", subject.name());
        subject.error("U203", Part::Place, message, "a foot there presses nothing".into());
    } else if gap < STRAY_M - 1e-4 && press < STANDING {
        let message =
            format!("{} is pressed by who stands at the edge of the stance zone{zone}", subject.name());
        let expected =
            format!("{} away; it takes {:.0} N, a standing foot bears {:.0} N", cm(gap), press.0, STANDING.0);
        subject.warning("U203", Part::Place, message, expected);
    }
}
