//! The events of each behaviour.

use super::{ActsOn, Behaviour, Direction, EventKind, Guard, Value};

/// Returns the possible events of a control with this behaviour, with their meaning.
///
/// `held` is its value. The value or direction of an event is an example.
pub(crate) fn possible_events(behaviour: &Behaviour, held: Option<Value>) -> Vec<(EventKind, &'static str)> {
    use EventKind::{
        Armed, Cancelled, Changed, Clicked, Disarmed, DoubleTapped, HardPressed, HardReleased, LongPressed,
        Pressed, Refused, Released, Swiped, Ticked, Warned,
    };
    let changed = held.map(|value| (Changed(value), "It holds another value."));
    let mut events = vec![
        (Pressed, "A foot engaged it."),
        (Released, "The foot let go; the press counts."),
        (Cancelled, "The press ended without counting."),
        (Refused, "A foot pressed it while it is locked."),
    ];
    match behaviour {
        Behaviour::Button(button) => {
            let when = match button.acts_on {
                ActsOn::Press => "It was pressed.",
                ActsOn::Release => "It was pressed and released.",
            };
            events.push((Clicked, when));
            let gestures = &button.gestures;
            let mut offer = |offered: bool, event| {
                if offered {
                    events.push(event);
                }
            };
            offer(gestures.double_tap.is_some(), (DoubleTapped, "It was tapped twice."));
            offer(gestures.long_press.is_some(), (LongPressed, "It has been held for long."));
            offer(gestures.swipe_m.is_some(), (Swiped(Direction::North), "The foot swiped over it."));
            offer(gestures.hard.is_some(), (HardPressed, "The press reached the second stage."));
            offer(gestures.hard.is_some(), (HardReleased, "It came back from the second stage."));
        }
        Behaviour::Selector(_) => {
            events.push((Ticked, "The foot passed to another option; nothing has changed yet."));
            events.extend(changed);
        }
        Behaviour::Hold(_)
        | Behaviour::Switch(_)
        | Behaviour::Slider(_)
        | Behaviour::Pedal(_)
        | Behaviour::Pad(_)
        | Behaviour::Dial(_)
        | Behaviour::Stepper(_)
        | Behaviour::Lean(_) => events.extend(changed),
    }
    match behaviour.thresholds().guard {
        Guard::Free => {}
        Guard::Confirm { .. } => {
            events.push((Armed, "A first press armed it: the next one acts."));
            events.push((Disarmed, "It is armed no longer."));
        }
        Guard::HoldToRun { .. } => events.push((Warned, "It will soon stop by itself.")),
    }
    events
}
