//! Recordings, read back from the disk.

use std::sync::Arc;
use std::time::Duration;

use underfoot::feel::{Click, Cue, CueSender, Mode, Renderer, RendererConfig, renderer};
use underfoot::floor::Floor;
use underfoot::sink::{
    ActuatorSink, LatencyMeter, LatencyProbe, ManualSink, WavFormat, WavOptions, WavSink, WhenFull,
};
use underfoot::units::{Instant, Newtons};

use super::strike;

fn floor() -> (CueSender, Renderer) {
    renderer(RendererConfig::of(&Floor::default(), 48_000))
}

fn cue(at: Instant, tile: u16) -> Cue {
    let modes = [Mode { frequency_hz: 180.0, decay_s: 0.03, amplitude: 1.0 }];
    let click = Click { modes: modes.into_iter().collect(), level: Newtons(8.0), ..Click::default() };
    strike(at, tile, click)
}

#[test]
fn a_recording_holds_every_channel_as_the_actuators_would_get_it() {
    let start = Instant::from_millis(7000);
    let folder = tempfile::tempdir().unwrap();
    for (format, tolerance) in [(WavFormat::Float32, 0.0), (WavFormat::Pcm24, 1.0 / 8_388_607.0)] {
        let path = folder.path().join("floor.wav");
        let (mut to_file, file_renderer) = floor();
        let options =
            WavOptions::default().with_start(start).with_format(format).with_when_full(WhenFull::Wait);
        let mut file = WavSink::create(&path, file_renderer, options).unwrap();
        let (mut to_memory, memory_renderer) = floor();
        let mut memory = ManualSink::new(memory_renderer, start);
        for sender in [&mut to_file, &mut to_memory] {
            sender.send(&cue(start + Duration::from_millis(20), 21));
        }
        for millis in 1..=300 {
            let now = start + Duration::from_millis(millis);
            file.advance(now).unwrap();
            memory.advance(now).unwrap();
        }
        let summary = file.finish().unwrap();
        assert_eq!((summary.frames, summary.left_out), (14_400, 0));
        assert_eq!(summary.files, std::slice::from_ref(&path));

        let mut reader = hound::WavReader::open(&path).unwrap();
        let spec = reader.spec();
        assert_eq!((spec.channels, spec.sample_rate), (36, 48_000));
        let samples: Vec<f32> = match format {
            WavFormat::Float32 => reader.samples::<f32>().map(Result::unwrap).collect(),
            WavFormat::Pcm24 => {
                reader.samples::<i32>().map(|sample| sample.unwrap() as f32 / 8_388_607.0).collect()
            }
        };
        assert_eq!(samples.len(), 36 * 14_400);
        for channel in 0..36 {
            let wanted = memory.channel(channel);
            let worst = wanted
                .iter()
                .zip(samples.iter().skip(channel).step_by(36))
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max);
            assert!(worst <= tolerance, "{format:?}, channel {channel}: {worst}");
        }
        assert!(memory.channel(21)[960..].iter().any(|sample| sample.abs() > 0.1));
    }
}

#[test]
fn a_path_that_cannot_be_written_is_named() {
    let error = WavSink::create("/no/such/folder/floor.wav", floor().1, WavOptions::default()).unwrap_err();
    assert!(error.to_string().starts_with("cannot write /no/such/folder/floor.wav: "), "{error}");
}

/// The device /dev/full accepts no byte, like a disk without space.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_with_the_path() {
    let error = WavSink::create("/dev/full", floor().1, WavOptions::default()).unwrap_err();
    assert!(error.to_string().starts_with("cannot write /dev/full: "), "{error}");
}

#[test]
fn latency_is_measured_from_the_packet_to_the_block_handed_on() {
    let meter = LatencyMeter::new();
    // A clock fixed at 30.25 ms; the packets arrived at 30 ms.
    let probe = LatencyProbe::new(meter.clone(), Arc::new(|| Instant::from_micros(30_250)));
    let (mut sender, renderer) = floor();
    let mut sink = ManualSink::new(renderer, Instant::START).with_latency(probe);
    for tile in 0..5 {
        sender.send(&cue(Instant::from_millis(30), tile));
    }
    sink.advance(Instant::from_millis(30)).unwrap();
    assert_eq!(meter.summary(), None, "the cue's sample is not handed on yet");
    sink.advance(Instant::from_millis(31)).unwrap();
    let summary = meter.summary().unwrap();
    assert_eq!(summary.count, 5);
    assert!(summary.median.abs_diff(Duration::from_micros(250)) <= Duration::from_micros(2), "{summary:?}");
}
