//! The effects that answer a foot's actions on a control.

use std::sync::Arc;

use underfoot::feel::{Clicks, Effect, EffectKind, Lasting, SustainedCue};
use underfoot::floor::Geometry;
use underfoot::schema::{Effects, Kinds, parse_layout};
use underfoot::units::Newtons;
use underfoot::widget::Value;

use crate::controls::bench::Bench;

/// Hums of ends and of held controls; frictions are excluded.
fn hums(sustained: &[SustainedCue]) -> Vec<f32> {
    sustained
        .iter()
        .filter_map(
            |sustained_cue| {
                if let Lasting::Hum(hum) = sustained_cue.effect { Some(hum.level.0) } else { None }
            },
        )
        .collect()
}

#[test]
fn a_slider_has_a_wall_at_its_end_that_is_felt_when_it_is_hit_and_pushed() {
    let mut bench = Bench::with(r#"kind: "slider""#);
    bench.press_at(0.5, 0.5);
    bench.walker.take_cues();
    bench.walker.take_sustained();
    bench.slide_to(0.9, 0.5);
    assert!(
        bench.walker.take_cues().is_empty() && hums(&bench.walker.take_sustained()).is_empty(),
        "nothing on the way"
    );
    bench.slide_to(1.12, 0.5);
    let thuds = bench.walker.take_cues();
    assert_eq!(thuds.len(), 1, "one thud");
    assert!(thuds[0].manner.duck_db > 0.0 && thuds[0].click.level.0 > 10.0, "{thuds:?}");
    assert_eq!(bench.number(), 1.0);
    let pushed = hums(&bench.walker.take_sustained());
    let (first, last) = (pushed[2], pushed[pushed.len() - 1]);
    assert!(last > 2.0 * first && last > 3.0, "the wall gets harder: {first} to {last} N");
    // A foot that only stands there feels no more hum; one that pushes on feels it again.
    bench.wait(1800);
    bench.walker.take_sustained();
    bench.wait(100);
    assert!(hums(&bench.walker.take_sustained()).is_empty());
    bench.slide_to(1.2, 0.5);
    assert!(!hums(&bench.walker.take_sustained()).is_empty());
    bench.slide_to(0.7, 0.5);
    bench.walker.take_sustained();
    bench.wait(50);
    assert!(hums(&bench.walker.take_sustained()).is_empty(), "back on the way there is no wall");
    assert!(bench.walker.take_cues().is_empty());
    // The other end, slowly: the same thud, softer and a little lower.
    let to = bench.at(-0.02, 0.5);
    bench.walker.slide_to(to, 0.05);
    let soft = bench.walker.take_cues();
    assert_eq!(soft.len(), 1);
    assert!(soft[0].click.level.0 < 0.8 * thuds[0].click.level.0);
    assert!(soft[0].click.modes[0].frequency_hz < thuds[0].click.modes[0].frequency_hz);
}

#[test]
fn steps_are_told_apart_by_value_and_side() {
    let mut bench = Bench::with(
        r#"kind: "slider", max: 10, step: 1, feel: (step: "detent", end: None, drag: None, press: None)"#,
    );
    bench.press_at(0.04, 0.5);
    bench.walker.take_cues();
    bench.slide_to(0.95, 0.5);
    let up = bench.walker.take_cues();
    bench.slide_to(0.04, 0.5);
    let down = bench.walker.take_cues();
    assert!((8..=10).contains(&up.len()) && up.len() == down.len(), "{} and {}", up.len(), down.len());
    let hz = |cue: &underfoot::feel::Cue| cue.click.modes[0].frequency_hz;
    assert!(up.windows(2).all(|pair| hz(&pair[1]) > hz(&pair[0])), "brighter upwards");
    let strongest = up.iter().max_by(|a, b| a.click.level.0.total_cmp(&b.click.level.0)).unwrap();
    assert!((hz(strongest) - 225.0 * 1.025).abs() < 2.0, "the middle is marked");
    let total = |cues: &[underfoot::feel::Cue]| cues.iter().map(|cue| cue.click.level.0).sum::<f32>();
    assert!(total(&down) < 0.85 * total(&up), "lighter on the way back");
}

/// Ticks of the value itself, on a slider without steps.
#[test]
fn detents_of_their_own_need_no_steps() {
    let detents = r#"Detents(level_n: 5, modes: [(hz: 200, decay_ms: 8)], every: 0.2)"#;
    let mut bench =
        Bench::with(&format!(r#"kind: "slider", feel: (step: {detents}, end: None, press: None)"#));
    bench.press_at(0.1, 0.5);
    bench.walker.take_cues();
    bench.slide_to(0.9, 0.5);
    assert_eq!(bench.walker.take_cues().len(), 4, "at 0.2, 0.4, 0.6 and 0.8");
    assert!(bench.number() > 0.85);
}

#[test]
fn a_switch_says_which_way_it_went() {
    let mut bench = Bench::with(r#"kind: "switch""#);
    let answers = |bench: &mut Bench| -> Vec<f32> {
        bench.tap();
        bench.wait(200);
        bench.walker.take_cues().iter().map(|cue| cue.click.modes[0].frequency_hz).collect()
    };
    let on = answers(&mut bench);
    assert_eq!(bench.value(), Some(Value::Switch(true)));
    let off = answers(&mut bench);
    // A press, then two clicks: upwards, downwards.
    assert!(on.len() == 3 && on[2] > on[1], "{on:?}");
    assert!(off.len() == 3 && off[2] < off[1], "{off:?}");
}

#[test]
fn what_is_held_is_felt_until_the_foot_lets_go_or_the_floor_is_lost() {
    let mut bench = Bench::with(r#"kind: "hold", feel: (hold: "engine_hum", press: None, release: None)"#);
    bench.press();
    bench.wait(400);
    let hums_now = hums(&bench.walker.take_sustained());
    assert!(hums_now.last().is_some_and(|level| *level > 2.9), "{:?}", hums_now.last());
    bench.lift();
    bench.walker.take_sustained();
    bench.wait(20);
    assert!(hums(&bench.walker.take_sustained()).is_empty());
    bench.press();
    bench.lose_the_floor();
    bench.walker.connected = true;
    bench.walker.take_sustained();
    bench.wait(50);
    assert!(hums(&bench.walker.take_sustained()).is_empty(), "a cancel ends it too");
}

#[test]
fn what_a_control_lets_be_heard_is_what_it_lets_be_felt() {
    let mut slider = Bench::with(r#"kind: "slider", feel: (drag: "smooth", sound: 0.5)"#);
    slider.press_at(0.5, 0.5);
    slider.walker.take_sustained();
    slider.slide_to(1.12, 0.5);
    let (sustained, thuds) = (slider.walker.take_sustained(), slider.walker.take_cues());
    assert!(
        sustained.iter().any(|sustained_cue| matches!(sustained_cue.effect, Lasting::Friction(_))),
        "it slides"
    );
    assert!(
        sustained.iter().any(|sustained_cue| matches!(sustained_cue.effect, Lasting::Hum(_))),
        "and pushes"
    );
    assert!(sustained.iter().all(|sustained_cue| sustained_cue.audio_gain == 0.5));
    assert!(!thuds.is_empty() && thuds.iter().all(|cue| cue.audio_gain == 0.5));
    let mut hold = Bench::with(r#"kind: "hold", feel: (hold: "engine_hum", press: None, sound: 0.5)"#);
    hold.press();
    hold.wait(100);
    let held = hold.walker.take_sustained();
    assert!(!held.is_empty() && held.iter().all(|sustained_cue| sustained_cue.audio_gain == 0.5));
}

#[test]
fn a_long_press_swells_and_then_says_that_it_was_long() {
    let mut bench = Bench::with(r#"kind: "gesture_button", feel: (press: None, release: None)"#);
    bench.press();
    bench.wait(500);
    let levels = hums(&bench.walker.take_sustained());
    assert!(levels.windows(50).step_by(50).all(|part| part[49] >= part[0]), "it swells");
    assert!(bench.walker.take_cues().is_empty());
    bench.wait(200);
    assert_eq!(bench.walker.take_cues().len(), 1, "long enough");
    bench.walker.take_sustained();
    bench.wait(100);
    assert!(
        hums(&bench.walker.take_sustained()).iter().all(|level| *level == 0.0),
        "and the swelling is over"
    );
}

#[test]
fn a_stepper_at_its_end_knocks_instead_of_stepping() {
    let mut bench = Bench::with(r#"kind: "stepper", min: 0, max: 1, repeat_after_ms: None"#);
    let tap_up = |bench: &mut Bench| {
        bench.press_at(0.8, 0.5);
        bench.lift();
        bench.walker.take_cues()
    };
    tap_up(&mut bench);
    assert_eq!(bench.number(), 1.0);
    let knock = tap_up(&mut bench);
    assert_eq!(bench.number(), 1.0);
    assert!(knock.iter().any(|cue| cue.manner.duck_db > 0.0), "{knock:?}");
}

fn layout_with(effects: &str, press: &str) -> Result<Arc<Effect>, String> {
    let text = format!(
        "Layout(version: 1, regions: [(id: \"all\", at: (0, 2), size: (6, 4))], effects: [{effects}],
            widgets: [(id: \"it\", kind: \"button\", at: (2, 3), size: (1, 1), feel: (press: {press}))])"
    );
    let layout = parse_layout(&text, "test.ron", &Kinds::builtin(), &Geometry::default());
    layout
        .map(|loaded| loaded.layout.widgets[0].feel.press.clone().unwrap())
        .map_err(|wrong| wrong.to_string())
}

#[test]
fn a_layout_brings_effects_of_its_own_and_makes_them_from_others() {
    let bump = r#"(name: "bump", plays: Click(level_n: 9, modes: [(hz: 120, decay_ms: 20)]))"#;
    let effect = layout_with(bump, r#""bump""#).unwrap();
    let EffectKind::Click(Clicks { press, .. }) = &effect.kind else { panic!("a click") };
    assert_eq!(press.level, Newtons(9.0));
    let louder = layout_with(bump, r#"Click(from: "bump", level_n: 20)"#).unwrap();
    let EffectKind::Click(Clicks { press: louder, .. }) = &louder.kind else { panic!("a click") };
    assert_eq!((louder.level, &louder.modes), (Newtons(20.0), &press.modes));
    let pair = r#"(name: "pair", plays: Sequence(parts: [(at_ms: 0, plays: "bump"), (at_ms: 60, level: 0.5, plays: "bump")]))"#;
    let pair = layout_with(&format!("{bump}, {pair}"), r#""pair""#).unwrap();
    assert!(matches!(&pair.kind, EffectKind::Sequence(sequence) if sequence.parts.len() == 2));
    let wrong = layout_with(bump, r#""bunp""#).unwrap_err();
    assert!(wrong.contains("unknown effect \"bunp\"") && wrong.contains("did you mean \"bump\"?"), "{wrong}");
}

#[test]
fn a_folder_of_effects_replaces_shipped_ones_wherever_they_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"Effect(name: "crisp_click", plays: Click(from: "crisp_click", level_n: 3))"#;
    std::fs::write(folder.path().join("crisp_click.ron"), text).unwrap();
    let mut effects = Effects::builtin();
    effects.read_folder(folder.path()).unwrap();
    let kinds = Kinds::shipped(effects.clone()).unwrap();
    let press = kinds.get("button").unwrap().feel.press.clone().unwrap();
    let EffectKind::Click(Clicks { press, release }) = &press.kind else { panic!("a click") };
    assert_eq!(press.level, Newtons(3.0));
    assert!(release.is_some(), "what is not written stays");

    // An effect that a button cannot play is reported, with the file that uses it.
    let rubbing = r#"Effect(name: "crisp_click", plays: Friction(level_n: 3, low_hz: 80, high_hz: 200))"#;
    std::fs::write(folder.path().join("crisp_click.ron"), rubbing).unwrap();
    effects.read_folder(folder.path()).unwrap();
    let wrong = Kinds::shipped(effects.clone()).unwrap_err().to_string();
    assert!(
        wrong.contains("a Friction can't be played for `press`") && wrong.contains("widgets/button.ron"),
        "{wrong}"
    );

    std::fs::write(folder.path().join("another.ron"), rubbing).unwrap();
    let wrong = effects.read_folder(folder.path()).unwrap_err().to_string();
    assert!(wrong.contains("two effects are called \"crisp_click\""), "{wrong}");
    assert!(effects.read_folder(&folder.path().join("nowhere")).is_err());
}
