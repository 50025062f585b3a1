//! Device faults, by the rows of the fault table: A1 to A8 and A10.

use std::sync::atomic::Ordering;

use assert_no_alloc::{assert_no_alloc, violation_count};
use cpal::{BufferSize, ErrorKind};

use super::*;
use crate::feel::{Friction, Priority, SustainedCue, SustainedCues};

#[test]
fn a1_a_card_that_is_pulled_out_comes_back_without_a_restart_and_without_a_burst() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    rig.play(&card, millis(500));

    host.pull_out(&card);
    card.fail(ErrorKind::DeviceNotAvailable);
    rig.pass(TICK);
    let status = rig.status();
    assert_eq!(status.state, DeviceState::Lost);
    assert!(status.why.contains("disconnected"), "{}", status.why);

    // Feet press controls for five seconds; the supervisor searches for the device once a second.
    let looks = host.looks.load(Ordering::Relaxed);
    for _ in 0..50 {
        rig.sender.send(&cue(0, Instant::START));
        rig.pass(millis(100));
    }
    let looks = host.looks.load(Ordering::Relaxed) - looks;
    assert!((4..=6).contains(&looks), "looked {looks} times");
    assert_eq!(rig.status().state, DeviceState::Lost);

    // The device comes back as the second card; its identifier distinguishes it.
    host.plug_in(&FakeCard::new("Another", 36, SampleFormat::F32));
    host.plug_in(&card);
    rig.pass(millis(1100));
    assert_eq!((card.opened(), rig.status().reopened), (2, 1));
    assert!(is_silent(&card.pull(4800)), "what happened meanwhile is not felt");
    rig.pass(TICK);
    assert_eq!(rig.status().state, DeviceState::Playing);
    assert_eq!(rig.sender.counters().muted, 50);
    rig.sender.send(&cue(0, Instant::START));
    assert!(!is_silent(&card.pull(480)), "and what happens now is");
}

#[test]
fn a1_the_rest_goes_on_while_the_card_is_lost() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    host.pull_out(&card);
    card.fail(ErrorKind::DeviceNotAvailable);
    rig.pass(millis(5000));
    // More cues than the queue holds: none of them waits for the card, and stop still works.
    assert!((0..1000).all(|_| rig.sender.send(&cue(0, Instant::START))));
    rig.sender.silence();
    assert!(!rig.sender.send(&cue(0, Instant::START)));
    host.plug_in(&card);
    rig.pass(millis(1100));
    rig.sender.sustain(&SustainedCues::new());
    assert!(is_silent(&card.pull(4800)));
}

#[test]
fn a2_a_card_that_stops_calling_is_faulty_after_200_ms_and_opened_anew() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    rig.play(&card, millis(500));
    rig.pass(millis(180));
    assert_eq!((rig.status().state, card.opened()), (DeviceState::Playing, 1));
    rig.pass(TICK);
    let status = rig.status();
    assert_eq!(
        (status.state, status.why.as_str()),
        (DeviceState::Faulty, "it has stopped asking for samples")
    );
    rig.pass(TICK);
    assert_eq!((rig.status().state, card.opened()), (DeviceState::Faulty, 2), "opened, and not yet heard of");
    rig.play(&card, millis(100));
    assert_eq!((rig.status().state, rig.status().reopened), (DeviceState::Playing, 1));
}

#[test]
fn a2_a_card_that_never_calls_is_tried_again_and_again_with_more_and_more_patience() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    rig.pass(millis(60_000));
    assert_eq!(rig.status().state, DeviceState::Faulty);
    // 0.2 + 0.4 + 0.8 + 1.6 s, then every 3.2 s.
    assert!((18..=24).contains(&card.opened()), "{}", card.opened());
    rig.play(&card, millis(100));
    assert_eq!(rig.status().state, DeviceState::Playing);
}

#[test]
fn a2_what_happens_until_a_card_asks_for_its_first_block_again_is_not_felt() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    rig.play(&card, millis(500));
    rig.pass(millis(300));
    assert_eq!((rig.status().state, card.opened()), (DeviceState::Faulty, 2), "opened, and not yet heard of");
    // Feet press controls for a while before the device asks for samples.
    for _ in 0..5 {
        rig.sender.send(&cue(0, Instant::START));
        rig.pass(TICK);
    }
    assert!(is_silent(&card.pull(480)), "it would come all at once");
    rig.sender.send(&cue(0, Instant::START));
    assert!(!is_silent(&card.pull(480)), "and what happens now is felt");
}

#[test]
fn a3_underruns_are_counted_and_five_in_ten_seconds_bring_longer_blocks() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    assert_eq!(card.block(), BufferSize::Fixed(128));
    rig.play(&card, millis(1000));
    for _ in 0..4 {
        card.fail(ErrorKind::Xrun);
        rig.play(&card, millis(1000));
    }
    assert_eq!((rig.status().underruns, card.opened()), (4, 1));
    card.fail(ErrorKind::Xrun);
    rig.play(&card, millis(1000));
    let status = rig.status();
    assert_eq!((status.underruns, status.state, card.opened()), (5, DeviceState::Playing, 2));
    assert_eq!(card.block(), BufferSize::Fixed(256));
    assert!(!status.is_well() && status.to_string().contains("5 underruns"), "{status}");
}

#[test]
fn a3_a_card_without_longer_blocks_plays_on() {
    let (host, card) = one_card();
    card.set_longest_block(128);
    let mut rig = Rig::on(&host, DeviceOptions::default());
    for _ in 0..20 {
        card.fail(ErrorKind::Xrun);
        rig.play(&card, millis(100));
    }
    assert_eq!((rig.status().underruns, rig.status().state, card.opened()), (20, DeviceState::Playing, 1));
}

#[test]
fn a3_blocks_that_somebody_asked_for_stay_as_they_are() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions { block: Some(64), ..DeviceOptions::default() });
    for _ in 0..20 {
        rig.play(&card, millis(200));
        card.fail(ErrorKind::Xrun);
    }
    assert_eq!((card.block(), card.opened()), (BufferSize::Fixed(64), 1));
}

#[test]
fn a4_a_card_with_too_few_channels_is_refused_with_the_map() {
    let small = FakeCard::new("Small", 8, SampleFormat::F32);
    let host = FakeHost::with(&[&small]);
    let refused = OutputDevice::find_among(host.cards(), &Floor::default(), DeviceOptions::default());
    let message = refused.err().unwrap().to_string();
    assert!(message.contains("Small has 8 channels and the floor needs 36"), "{message}");
    assert!(message.contains("row   0 |  0  1  2  3  4  5"), "{message}");
    assert_eq!(small.opened(), 0);
}

#[test]
fn a4_a_card_that_comes_back_smaller_or_at_another_rate_is_not_played() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    rig.play(&card, millis(100));
    let come_back = |rig: &mut Rig| {
        card.fail(ErrorKind::StreamInvalidated);
        rig.pass(millis(2200));
        rig.status()
    };
    card.set_channels(8);
    let status = come_back(&mut rig);
    assert_eq!((status.state, card.opened()), (DeviceState::Unfit, 1));
    assert!(status.why.contains("28 tiles would not be felt"), "{}", status.why);
    card.set_channels(36);
    card.set_rate(44_100);
    rig.pass(millis(2200));
    let status = rig.status();
    assert_eq!((status.state, card.opened()), (DeviceState::Unfit, 1));
    assert!(status.why.contains("can't play 48000") && status.why.contains("`resample`"), "{}", status.why);
    card.set_rate(48_000);
    rig.play(&card, millis(1100));
    assert_eq!((rig.status().state, card.opened()), (DeviceState::Playing, 2));
}

#[test]
fn a4_rates_are_converted_when_that_is_asked() {
    let (host, card) = one_card();
    card.set_rate(44_100);
    let asked = |resample| DeviceOptions { sample_rate: Some(96_000), resample, ..DeviceOptions::default() };
    assert!(OutputDevice::find_among(host.cards(), &Floor::default(), asked(false)).is_err());
    let device = OutputDevice::find_among(host.cards(), &Floor::default(), asked(true)).unwrap();
    assert_eq!((device.sample_rate(), device.device_rate()), (96_000, 44_100));
    let mut rig = Rig::on(&host, asked(true));
    card.pull::<f32>(441);
    rig.sender.send(&cue(7, Instant::START));
    let block = card.pull::<f32>(4410);
    let click: Vec<f32> = block.iter().skip(7).step_by(36).copied().collect();
    let begin = click.iter().position(|sample| sample.abs() > 1e-3).unwrap();
    // Half the filter's length, 16 frames at 44.1 kHz, and the rise time of a click of 200 Hz.
    assert!(begin < 30, "{begin}");
    // 200 Hz is 20 periods in 0.1 s: it crosses zero upwards once in each.
    let crossings = click[begin..].windows(2).filter(|pair| pair[0] <= 0.0 && pair[1] > 0.0).count();
    assert!((19..=20).contains(&crossings), "{crossings}");
}

#[test]
fn a5_without_real_time_priority_it_works_and_says_so() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    card.fail(ErrorKind::RealtimeDenied);
    rig.play(&card, millis(100));
    let status = rig.status();
    assert_eq!((status.state, status.priority, card.opened()), (DeviceState::Playing, Priority::Denied, 1));
    assert!(status.to_string().ends_with("without real-time priority"), "{status}");
    assert!(
        priority::FIX.contains("rtprio") && priority::FIX.contains("limits.d"),
        "the warning names the fix"
    );
    rig.sender.send(&cue(0, Instant::START));
    assert!(!is_silent(&card.pull(480)));
}

/// Every callback in these tests runs under this guard; here it is shown to work.
#[test]
fn a6_a_callback_that_allocates_would_be_caught() {
    let before = violation_count();
    let grown = assert_no_alloc(|| std::hint::black_box(vec![0_u8; 16]));
    assert!(violation_count() > before, "{grown:?}");
}

/// Two seconds of eight feet that slide and click, on a card of another rate, at a steady delay, with latency measured.
#[test]
fn a6_the_busiest_callback_does_not_allocate() {
    let (host, card) = one_card();
    card.set_rate(44_100);
    let clock: HostClock = Arc::new(|| Instant::START);
    let options = DeviceOptions {
        sample_rate: Some(48_000),
        resample: true,
        steady: Some(clock.clone()),
        latency: Some(LatencyProbe::new(crate::sink::LatencyMeter::new(), clock)),
        ..DeviceOptions::default()
    };
    let mut rig = Rig::on(&host, options);
    for n in 0..1000_u64 {
        let sustained: SustainedCues =
            (0..8).map(|foot| sustained_cue(foot, 0.01 * (n % 50) as f32)).collect();
        rig.sender.sustain(&sustained);
        (0..4).for_each(|tile| _ = rig.sender.send(&cue(((n + tile) % 36) as u16, Instant::START)));
        // `pull` fails if anything is allocated.
        assert!(n < 10 || !is_silent(&card.pull(88)));
    }
    assert_eq!(rig.sender.counters().dropped, 0);
}

#[test]
fn a7_nonsense_becomes_silence_and_is_counted() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    let monsters = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9];
    for (tile, monster) in (0_u16..).zip(monsters) {
        let mut cue = cue(tile, Instant::START);
        cue.click.level = Newtons(monster);
        rig.sender.send(&cue);
        cue.click.level = Newtons(20.0);
        cue.click.modes[0].frequency_hz = monster;
        rig.sender.send(&cue);
    }
    let sustained: SustainedCues =
        monsters.into_iter().zip(0..).map(|(monster, foot)| sustained_cue(foot, monster)).collect();
    rig.sender.sustain(&sustained);
    for _ in 0..20 {
        let block = card.pull::<f32>(480);
        assert!(block.iter().all(|sample| sample.is_finite() && sample.abs() <= 1.0));
    }
    let counters = rig.sender.counters();
    assert!(counters.refused + counters.not_finite + counters.overloaded >= 7, "{counters:?}");
    // The other voices still play.
    rig.sender.sustain(&SustainedCues::new());
    (0..10).for_each(|_| _ = card.pull::<f32>(480));
    rig.sender.send(&cue(35, Instant::START));
    assert!(!is_silent(&card.pull(480)));
}

/// The queue's own test tries every order of the two threads' steps; this one goes through the card.
#[test]
fn a8_a_full_queue_gives_up_the_oldest_clicks_and_never_the_stop() {
    let (host, card) = one_card();
    let mut rig = Rig::on(&host, DeviceOptions::default());
    card.pull::<f32>(480);
    // 44 clicks too many on the first tiles; the newest is on the last tile.
    for n in 0..300_u16 {
        rig.sender.send(&cue(if n < 44 { 0 } else { 1 + n % 35 }, Instant::START));
    }
    card.pull::<f32>(1);
    rig.sender.sustain(&SustainedCues::new());
    let block = card.pull::<f32>(480);
    let felt = |tile: usize| !is_silent(&block.iter().skip(tile).step_by(36).copied().collect::<Vec<_>>());
    assert_eq!(rig.sender.counters().dropped, 44);
    assert!(!felt(0) && (1..36).all(felt), "the oldest are evicted");
    (0..300).for_each(|_| _ = rig.sender.send(&cue(0, Instant::START)));
    rig.sender.silence();
    // 5 ms of fade-out.
    card.pull::<f32>(480);
    assert!(is_silent(&card.pull(4800)), "stop works though the queue is full");
}

#[test]
fn a10_another_default_device_is_none_of_our_business() {
    let (host, card) = one_card();
    let other = FakeCard::new("Other", 36, SampleFormat::F32);
    let mut rig = Rig::on(&host, DeviceOptions::default());
    rig.play(&card, millis(100));
    // Headphones are plugged in, and the system makes them its default.
    host.pull_out(&card);
    host.plug_in(&other);
    host.plug_in(&card);
    rig.play(&card, millis(2000));
    assert_eq!((card.opened(), other.opened()), (1, 0));
    // The device is reopened even if the host has moved the stream to the new default.
    card.fail(ErrorKind::DeviceChanged);
    rig.pass(TICK * 2);
    rig.play(&card, millis(100));
    assert_eq!((card.opened(), other.opened(), rig.status().name.as_str()), (2, 0, "Card"));
    // When the device is gone, the supervisor stays silent instead of using another one.
    host.pull_out(&card);
    card.fail(ErrorKind::DeviceNotAvailable);
    rig.pass(millis(5000));
    assert_eq!((other.opened(), rig.status().state), (0, DeviceState::Lost));
}

fn sustained_cue(foot: u32, speed_m_s: f32) -> SustainedCue {
    let friction = Friction {
        level: Newtons(3.0),
        low_hz: 80.0,
        high_hz: 500.0,
        full_speed_m_s: 0.5,
        full_force: Newtons(400.0),
    };
    let spots = [Spot { tile: foot as u16, weight: 1.0 }].into_iter().collect();
    SustainedCue {
        key: foot,
        spots,
        effect: friction.into(),
        speed_m_s,
        force: Newtons(300.0),
        ..SustainedCue::default()
    }
}
