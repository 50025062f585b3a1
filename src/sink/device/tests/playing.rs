//! Output of a device without faults.

use std::sync::atomic::{AtomicU64, Ordering};

use super::*;
use crate::sink::LatencyMeter;

#[test]
fn a_cue_starts_with_the_block_it_meets_on_its_tiles_own_channel() {
    let card = FakeCard::new("Card", 40, SampleFormat::F32);
    let meter = LatencyMeter::new();
    let latency = LatencyProbe::new(meter.clone(), Arc::new(|| Instant::from_micros(1_000_400)));
    let options = DeviceOptions { latency: Some(latency), ..DeviceOptions::default() };
    let mut rig = Rig::on(&FakeHost::with(&[&card]), options);
    card.pull::<f32>(480);
    rig.sender.send(&cue(35, Instant::from_millis(1000)));
    // More frames than the maximum block of the renderer.
    let block = card.pull::<f32>(700);
    let channel = |n: usize| block.iter().skip(n).step_by(40).copied().collect::<Vec<f32>>();
    assert!(channel(35)[0] != 0.0 && channel(35).iter().any(|sample| sample.abs() > 0.3));
    assert!((0..40).filter(|n| *n != 35).all(|n| is_silent(&channel(n))));
    assert_eq!(meter.summary().map(|latency| latency.count), Some(1));
    rig.pass(TICK);
    let status = rig.status();
    assert_eq!((status.blocks, status.channels, status.block), (2, 40, 700));
    assert_eq!(status.to_string(), "Card: playing 40 channels at 48000 Hz in blocks of 700");
}

#[test]
fn the_cards_own_format_is_filled() {
    let card = FakeCard::new("Card", 36, SampleFormat::I16);
    let mut rig = Rig::on(&FakeHost::with(&[&card]), DeviceOptions::default());
    card.pull::<i16>(480);
    rig.sender.send(&cue(2, Instant::START));
    assert!(card.pull::<i16>(480).iter().skip(2).step_by(36).any(|sample| sample.abs() > 10_000));
}

#[test]
fn a_desk_hears_the_west_of_the_floor_on_the_left() {
    let card = FakeCard::new("Card", 2, SampleFormat::F32);
    let options = DeviceOptions { mix: Mix::Stereo, ..DeviceOptions::default() };
    let mut rig = Rig::on(&FakeHost::with(&[&card]), options);
    card.pull::<f32>(480);
    rig.sender.send(&cue(0, Instant::START));
    let block = card.pull::<f32>(480);
    let power = |side: usize| block.iter().skip(side).step_by(2).map(|x| x * x).sum::<f32>();
    assert!(power(0) > 20.0 * power(1) && power(1) > 0.0);
}

/// A test clock in place of the host's; the card asks for blocks at uneven times.
#[test]
fn with_a_clock_every_cue_is_equally_late() {
    let (host, card) = one_card();
    let now = Arc::new(AtomicU64::new(0));
    let read = Arc::clone(&now);
    let steady: HostClock = Arc::new(move || Instant::from_micros(read.load(Ordering::Relaxed)));
    let options = DeviceOptions { steady: Some(steady), ..DeviceOptions::default() };
    let mut rig = Rig::delayed(&host, options, millis(8));
    let mut late = Vec::new();
    let mut frame = 0_u64;
    for block in 0..6000_u64 {
        // The callback of a 2 ms block runs up to 0.4 ms late.
        now.store(block * 2000 + (block * 37 % 5) * 100, Ordering::Relaxed);
        // A cue somewhere inside every 50th block, sent at once.
        let at = Instant::from_micros(block * 2000 - (block * 53 % 1000).min(block * 2000));
        // The loop is settled after some seconds.
        if block % 50 == 49 && block > 2000 {
            rig.sender.send(&cue((block / 50 % 36) as u16, at));
            late.push((frame, at, (block / 50 % 36) as usize));
        }
        let samples = card.pull::<f32>(96);
        late.retain_mut(|(sent, at, channel)| {
            let first = samples.iter().skip(*channel).step_by(36).position(|sample| *sample != 0.0);
            if let Some(first) = first {
                let due = at.micros() as f64 * 0.048 + 8.0 * 48.0;
                let played = (frame + first as u64) as f64;
                // The block starts 0.2 ms late on average; that is part of the steady delay.
                assert!((played - due + 9.6).abs() < 3.0, "sent at frame {sent}: {played} instead of {due}");
            }
            first.is_none()
        });
        frame += 96;
    }
    assert!(late.len() <= 1);
    assert_eq!(rig.sender.counters().late, 0);
}

#[test]
fn the_sink_looks_after_its_device_by_itself() {
    let (host, card) = one_card();
    let floor = Floor::default();
    let device = OutputDevice::find_among(host.cards(), &floor, DeviceOptions::default()).unwrap();
    let (_sender, renderer) = renderer(RendererConfig::of(&floor, 48_000));
    let mut sink = device.play(renderer).unwrap();
    assert!(sink.advance(Instant::START).is_ok());
    let mut status = DeviceStatus::default();
    assert!(sink.device(&mut status));
    assert_eq!((status.name.as_str(), status.id.as_str()), ("Card", "custom:Card"));
    assert_eq!(card.pull::<f32>(64).len(), 64 * 36);
    drop(sink);
    assert!(card.pull::<f32>(64).is_empty(), "dropping the sink stops the device");
}

#[test]
fn cards_are_found_by_name_part_and_identifier_and_others_are_listed() {
    let (usb, pci) =
        (FakeCard::new("USB Rack", 64, SampleFormat::F32), FakeCard::new("PCI", 64, SampleFormat::F32));
    let host = FakeHost::with(&[&pci, &usb]);
    let found = |name: Option<&str>| {
        let options = DeviceOptions { name: name.map(String::from), ..DeviceOptions::default() };
        let found = OutputDevice::find_among(host.cards(), &Floor::default(), options);
        found.map(|device| device.name().to_string()).map_err(|error| error.to_string())
    };
    assert_eq!(found(None).as_deref(), Ok("PCI"));
    for name in ["USB Rack", "usb rack", "rack", "custom:USB Rack"] {
        assert_eq!(found(Some(name)).as_deref(), Ok("USB Rack"), "{name}");
    }
    let message = found(Some("Banana")).unwrap_err();
    assert!(message.contains("choose one of PCI, USB Rack"), "{message}");
}

#[test]
fn a_renderer_of_another_rate_is_refused() {
    let floor = Floor::default();
    let (host, _card) = one_card();
    let device = OutputDevice::find_among(host.cards(), &floor, DeviceOptions::default()).unwrap();
    let (_sender, renderer) = renderer(RendererConfig::of(&floor, 96_000));
    let message = device.play(renderer).err().map(|error| error.to_string());
    assert_eq!(message.as_deref(), Some("Card plays 48000 samples per second, not 96000"));
}
