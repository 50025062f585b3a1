//! Reports of a value for all possible movements of a foot.

use glam::Vec2;
use proptest::prelude::*;

use super::*;
use crate::units::Newtons;

fn event(at: Instant, id: &str, kind: EventKind) -> WidgetEvent {
    let (force, position) = (Newtons(100.0), Vec2::ZERO);
    WidgetEvent { at, id: WidgetId::new(id), kind, contact: None, force, position }
}

fn changed(at: Instant, value: f32) -> WidgetEvent {
    event(at, "zoom", EventKind::Changed(Value::Number(value)))
}

/// Returns time and value of each report when `value` gives the value in each millisecond.
fn told(millis: u64, value: impl Fn(u64) -> f32) -> Vec<(u64, f32)> {
    let (mut limiter, mut told, mut last) = (ChangeLimiter::default(), Vec::new(), f32::NAN);
    for ms in 0..millis {
        let (at, now) = (Instant::from_millis(ms), value(ms));
        let events = if now == last { vec![] } else { vec![changed(at, now)] };
        last = now;
        for event in limiter.thin(&events, at) {
            let EventKind::Changed(Value::Number(number)) = event.kind else { panic!("{event:?}") };
            told.push((ms, number));
        }
    }
    told
}

/// Noise between -1 and 1, uniform over the milliseconds, without a generator.
fn noise(ms: u64) -> f32 {
    ((ms * 2_654_435_761 % 4_294_967_296) as f32 / 2_147_483_648.0) - 1.0
}

#[test]
fn a_foot_at_rest_is_told_a_few_times_and_not_480_in_half_a_second() {
    let resting = told(500, |ms| 0.5 + 0.004 * noise(ms));
    assert!(resting.len() <= 10, "{resting:?}");
    let later = told(10_500, |ms| 0.5 + 0.004 * noise(ms)).iter().filter(|(ms, _)| *ms > 500).count();
    assert!(later <= 10, "{later} in ten seconds");
}

#[test]
fn a_foot_that_slides_is_followed_60_times_a_second_up_to_where_it_rests() {
    // Half the range in a second, with noise; then the value is constant.
    let slide = |ms: u64| if ms < 1000 { 0.0005 * ms as f32 + 0.001 * noise(ms) } else { 0.5123 };
    let told = told(1300, slide);
    let moving = told.iter().filter(|(ms, _)| *ms < 1000).count();
    assert!((40..=60).contains(&moving), "{moving} in the second of the slide");
    for (ms, value) in told.iter().filter(|(ms, _)| (100..1000).contains(ms)) {
        assert!((value - 0.0005 * *ms as f32).abs() < 0.02, "{value} at {ms} ms");
    }
    let (ms, last) = *told.last().unwrap();
    assert_eq!(last, 0.5123);
    assert!(ms <= 1101, "the last value is told 100 ms after it came: {ms}");
}

#[test]
fn the_last_value_comes_before_the_release_and_switches_do_not_wait() {
    let mut limiter = ChangeLimiter::default();
    let at = Instant::from_millis;
    assert_eq!(limiter.thin(&[changed(at(0), 0.1)], at(0)).len(), 1);
    assert_eq!(limiter.thin(&[changed(at(1), 0.2)], at(1)).len(), 0);
    let events = [changed(at(2), 0.3), event(at(2), "zoom", EventKind::Released)];
    assert_eq!(limiter.thin(&events, at(2)), events, "0.2 is past, 0.3 is told first");
    for ms in 3..10 {
        let switched = event(at(ms), "lamp", EventKind::Changed(Value::Switch(ms % 2 == 0)));
        assert_eq!(limiter.thin(std::slice::from_ref(&switched), at(ms)), [switched]);
    }
    let pair = |x| EventKind::Changed(Value::Pair(Vec2::new(0.0, x)));
    limiter.thin(&[event(at(10), "pad", pair(0.0))], at(10));
    assert_eq!(limiter.thin(&[event(at(11), "pad", pair(0.5))], at(11)).len(), 0);
    assert_eq!(limiter.thin(&[], at(40)).len(), 1);
}

proptest! {
    /// For any sequence of events: the rate is kept except at ends of presses, and the last report has the last
    /// value.
    #[test]
    fn never_more_than_60_a_second_and_never_an_old_value_in_the_end(
        steps in prop::collection::vec((1_u64..40, prop::option::of(-1e6_f32..1e6), any::<bool>()), 1..200),
    ) {
        let mut limiter = ChangeLimiter::default();
        let (mut at, mut last, mut known, mut times) = (Instant::START, None, None, Vec::new());
        let mut hear = |told: &[WidgetEvent], at: Instant, ended: bool| {
            for event in told {
                if let EventKind::Changed(value) = event.kind {
                    known = Some(value);
                    times.push((at, ended));
                }
            }
            known
        };
        for (millis, value, ends) in steps {
            at = at + Duration::from_millis(millis);
            let mut events = Vec::new();
            if let Some(value) = value {
                events.push(changed(at, value));
                last = Some(Value::Number(value));
            }
            if ends {
                events.push(event(at, "zoom", EventKind::Released));
            }
            let known = hear(limiter.thin(&events, at), at, ends);
            prop_assert!(!ends || known == last, "a press ends with its last value");
        }
        let rest = at + REST + PERIOD;
        prop_assert_eq!(hear(limiter.thin(&[], rest), rest, false), last);
        for pair in times.windows(2) {
            prop_assert!(pair[1].1 || pair[1].0.since(pair[0].0) >= PERIOD, "{:?}", pair);
        }
    }
}
