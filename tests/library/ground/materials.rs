//! Snow, gravel, sand and wood underfoot.

use crate::support::{Walker, page};
use underfoot::engine::Snapshot;
use underfoot::feel::Cue;
use underfoot::glam::Vec2;
use underfoot::ground::GroundState;
use underfoot::units::Newtons;

const PLACE: Vec2 = Vec2::new(0.76, 0.76);

fn on(ground: &str) -> Walker {
    Walker::on(page(&format!("Layout(version: 1, grounds: [{ground}])")))
}

fn ground(walker: &Walker) -> GroundState {
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    snapshot.grounds.swap_remove(0)
}

/// A step of 70 kg at the place, and its cues.
fn step(walker: &mut Walker) -> Vec<Cue> {
    walker.take_cues();
    walker.step_at(PLACE, Newtons(690.0));
    walker.wait(250);
    walker.lift();
    walker.wait(150);
    walker.take_cues()
}

/// Sum of the squared levels: the loudness of many small clicks.
fn loudness(cues: &[Cue]) -> f32 {
    cues.iter().map(|cue| cue.click.level.0.powi(2)).sum()
}

#[test]
fn snow_is_packed_by_a_step_and_quieter_the_second_time() {
    let mut walker = on("Snow(renew_s: None)");
    let (first, second) = (step(&mut walker), step(&mut walker));
    let third: Vec<Cue> = (0..4).flat_map(|_| step(&mut walker)).collect();
    println!(
        "snow: {} cues, {:.1}; {} cues, {:.1}",
        first.len(),
        loudness(&first),
        second.len(),
        loudness(&second)
    );
    assert!(first.len() > 20, "{}", first.len());
    assert!(loudness(&second) < 0.8 * loudness(&first));
    assert!(loudness(&third) / 4.0 < 0.6 * loudness(&first));
    let state = ground(&walker);
    assert!(state.relief.depth_at(PLACE, walker.now()) > 0.5, "a print is left");
    assert_eq!(state.relief.depth_at(PLACE + 0.4, walker.now()), 0.0);
}

#[test]
fn grains_differ_in_number_and_strength_and_fall_silent() {
    let of = |name: &str| {
        let mut walker = on(name);
        let cues = step(&mut walker);
        // The last grains come to rest within ten times their settling time.
        walker.wait(500);
        walker.take_cues();
        walker.wait(1500);
        assert_eq!(walker.take_cues().len(), 0, "{name} lies still");
        let strongest = cues.iter().map(|cue| cue.click.level.0).fold(0.0, f32::max);
        println!("{name}: {} cues, strongest {strongest:.1} N", cues.len());
        (cues.len(), strongest)
    };
    let (gravel, sand) = (of("Gravel"), of("Sand"));
    assert!(gravel.0 > 10 && sand.0 > 2 * gravel.0, "sand has more grains");
    assert!(gravel.1 > 2.0 * sand.1, "and gravel harder ones");
}

/// Wood creaks while the load on it changes, at a rate proportional to that of the change, and during unloading too.
#[test]
fn wood_creaks_by_stick_and_slip() {
    let gaps = |millis: u64| {
        let mut walker = on("Wood(scatter: 0)");
        walker.step_at(PLACE, Newtons(60.0));
        walker.wait(200);
        walker.take_cues();
        for step in 1..=millis {
            walker.press_now(Newtons(60.0 + 600.0 * step as f32 / millis as f32));
        }
        let cues = walker.take_cues();
        let span = cues.last().unwrap().at.since(cues[0].at).as_secs_f64();
        (cues.len(), span / (cues.len() - 1) as f64)
    };
    let (slow, fast) = (gaps(1200), gaps(300));
    println!("wood: {} slips {:.4} s apart, {} slips {:.4} s apart", slow.0, slow.1, fast.0, fast.1);
    // A joint that carries 70 N and loses 0.4 of it slips each 28 N: 600 N make some 21 slips, in any time.
    assert!((14..=26).contains(&slow.0) && (14..=26).contains(&fast.0));
    assert!((slow.1 / fast.1 - 4.0).abs() < 0.8, "four times as fast, four times as many a second");
    let mut walker = on("Wood");
    walker.step_at(PLACE, Newtons(690.0));
    walker.wait(500);
    walker.take_cues();
    walker.leave_floor(200);
    assert!(walker.take_cues().len() > 5, "it creaks when the foot leaves");
}

#[test]
fn only_the_ground_under_the_foot_answers() {
    let mut walker = on("Ice(at: (0, 0), size: (3, 6)), Gravel(at: (3, 0), size: (3, 6))");
    step(&mut walker);
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    assert!(snapshot.grounds[0].counters.events > 5);
    assert_eq!(snapshot.grounds[1].counters.events, 0);
    walker.step_at(Vec2::new(1.5, 1.0), Newtons(690.0));
    walker.wait(100);
    let ice = snapshot.grounds[0].counters.events;
    walker.engine.snapshot(&mut snapshot);
    assert_eq!(snapshot.grounds[0].counters.events, ice);
    assert!(snapshot.grounds[1].counters.events > 5);
}

#[test]
fn grounds_of_another_page_are_silent() {
    let text = "Layout(version: 1, pages: [(id: \"a\", grounds: [Ice]), (id: \"b\", grounds: [Snow])])";
    let mut walker = Walker::on(page(text));
    step(&mut walker);
    let counts = |walker: &Walker| {
        let mut snapshot = Snapshot::default();
        walker.engine.snapshot(&mut snapshot);
        [0, 1].map(|index| snapshot.grounds[index].counters.events)
    };
    let before = counts(&walker);
    assert!(before[0] > 5 && before[1] == 0);
    walker.engine.set_page("b").unwrap();
    step(&mut walker);
    assert!(counts(&walker)[1] > 5 && counts(&walker)[0] == before[0]);
}
