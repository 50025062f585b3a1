//! Every shipped effect, measured from the renderer's samples.

use std::sync::Arc;

use underfoot::feel::{
    Analysis, Band, Effect, EffectKind, Gesture, Lasting, Manner, Moment, StickSlip, Texture, analyse,
    audition,
};
use underfoot::schema::{Effects, parse_effect, write_named_effect};
use underfoot::units::Newtons;

const RATE: u32 = 48_000;

fn shipped(name: &str) -> Arc<Effect> {
    Arc::clone(&Effects::builtin().get(name).unwrap_or_else(|| panic!("{name}")).effect)
}

fn hear(effect: &Arc<Effect>, gesture: &Gesture) -> (Vec<f32>, Analysis) {
    let samples = audition(effect, gesture, RATE);
    let analysis =
        analyse(&samples, RATE as f32, effect.manner.band).unwrap_or_else(|| panic!("silence: {effect:?}"));
    (samples, analysis)
}

fn rms(samples: &[f32]) -> f32 {
    (samples.iter().map(|sample| sample * sample).sum::<f32>() / samples.len() as f32).sqrt()
}

/// The second second of a steady slide.
fn slide(effect: &Arc<Effect>, speed: f32, force: f32) -> Analysis {
    let samples = audition(effect, &Gesture::steady(speed, Newtons(force), 2.0), RATE);
    analyse(&samples[RATE as usize..], RATE as f32, Band::USEFUL)
        .unwrap_or_else(|| panic!("silence at {speed} m/s"))
}

#[test]
fn every_shipped_effect_has_95_percent_of_its_energy_between_50_and_750_hz() {
    let effects = Effects::builtin();
    assert!((12..=40).contains(&effects.iter().count()));
    for named in effects.iter() {
        let (_, analysis) = hear(&named.effect, &Gesture::usual(&named.effect));
        let within = self::analyse(
            &audition(&named.effect, &Gesture::usual(&named.effect), RATE),
            RATE as f32,
            Band::USEFUL,
        );
        let within = within.map_or(0.0, |analysis| analysis.within);
        println!(
            "{:16} {:5.1} N, {:5.2} % within, {:4.0} Hz",
            named.name,
            analysis.peak,
            100.0 * within,
            analysis.centroid_hz
        );
        assert!(within >= 0.95, "{}: {:.2} %", named.name, 100.0 * within);
        // Neither too strong nor too weak.
        assert!((1.5..=45.0).contains(&analysis.peak), "{}: {} N", named.name, analysis.peak);
    }
}

#[test]
fn what_slides_keeps_to_its_band_at_every_speed_and_force() {
    for named in Effects::builtin().iter().filter(|named| named.effect.kind.lasting().is_some()) {
        for speed in [0.03, 0.1, 0.3, 0.6, 1.2] {
            for force in [30.0, 200.0, 600.0] {
                let analysis = slide(&named.effect, speed, force);
                assert!(
                    analysis.within >= 0.95,
                    "{} at {speed} m/s, {force} N: {:.1} %",
                    named.name,
                    100.0 * analysis.within
                );
            }
        }
    }
}

#[test]
fn what_slides_has_its_level_and_rises_with_force() {
    for named in Effects::builtin().iter().filter(|named| named.effect.kind.lasting().is_some()) {
        let (name, effect) = (&named.name, &named.effect);
        let level = match effect.kind.lasting() {
            Some(Lasting::Friction(friction)) => friction.level.0,
            Some(lasting) => lasting.material().unwrap().level.0,
            None => unreachable!("only what lasts"),
        };
        let full = match effect.kind {
            // A sole is loudest in the range of stick and slip.
            EffectKind::StickSlip(_) => {
                (1..=8_u8).map(|n| slide(effect, 0.075 * f32::from(n), 200.0).rms).fold(0.0, f32::max)
            }
            _ => slide(effect, 0.6, 200.0).rms,
        };
        // A sine of that level; a second of gravel is partly random.
        let sine = level / 2.0_f32.sqrt();
        assert!((0.7..1.4).contains(&(full / sine)), "{name}: {full} instead of {sine}");
        let [hard, half, light] = [200.0, 100.0, 25.0].map(|force| slide(effect, 0.6, force).rms);
        assert!(hard > 1.3 * half && half > 1.5 * light, "{name}: {hard}, {half}, {light}");
        // A foot at rest feels no friction.
        let still = audition(effect, &Gesture::steady(0.0, Newtons(200.0), 1.0), RATE);
        assert!(rms(&still) < 0.01 * full, "{name} at rest");
    }
}

#[test]
fn the_pitch_of_what_slides_rises_with_the_speed() {
    // Noise by its centroid, ridges by the distance of their pulses, a sole by the rate of its slips.
    let smooth: Vec<f32> = [0.05, 0.2, 0.4, 0.6]
        .iter()
        .map(|speed| slide(&shipped("smooth"), *speed, 200.0).centroid_hz)
        .collect();
    assert!(smooth.windows(2).all(|pair| pair[1] > 1.15 * pair[0]), "{smooth:?}");
    for name in ["wood", "grating", "gravel", "rubber"] {
        let effect = match shipped(name).kind.clone() {
            // The rate of slips is measured best without randomness.
            EffectKind::StickSlip(stick) => {
                let kind = EffectKind::StickSlip(StickSlip { rough: 0.0, ..stick });
                Arc::new(Effect { kind, manner: Manner::PLAIN })
            }
            _ => shipped(name),
        };
        // A sole slips that slowly; above, its slips merge.
        let slowest = if name == "rubber" { 0.02 } else { 0.04 };
        let rates: Vec<f32> =
            [1.0, 3.0, 9.0].iter().map(|times| bumps_per_second(&effect, slowest * times)).collect();
        assert!(rates.windows(2).all(|pair| pair[1] > 1.3 * pair[0]), "{name}: {rates:?}");
    }
}

/// Rate at which the loudness of a steady slide rises over its mean, within two seconds.
fn bumps_per_second(effect: &Arc<Effect>, speed: f32) -> f32 {
    let samples = audition(effect, &Gesture::steady(speed, Newtons(200.0), 3.0), RATE);
    let mut level = 0.0;
    let loud: Vec<f32> = samples[RATE as usize..]
        .iter()
        .map(|sample| {
            // Follows within 2 ms.
            level += (sample.abs() - level) * 0.01;
            level
        })
        .collect();
    let mean = loud.iter().sum::<f32>() / loud.len() as f32;
    let rises = loud.windows(2).filter(|pair| pair[0] < 1.2 * mean && pair[1] >= 1.2 * mean).count();
    rises as f32 / 2.0
}

/// Ridges are spatial: the pitch is the speed divided by their distance.
#[test]
fn even_ridges_sound_at_the_speed_over_their_distance() {
    let EffectKind::Texture(texture) = shipped("grating").kind.clone() else { panic!("ridges") };
    for (speed, spacing_m) in [(0.6, 0.004), (0.5, 0.0025), (0.9, 0.003)] {
        let even = Lasting::Texture(Texture { spacing_m, uneven: 0.0, ..texture }).balanced(Band::USEFUL);
        let Lasting::Texture(even) = even else { panic!("ridges") };
        let effect = Arc::new(Effect { kind: EffectKind::Texture(even), manner: Manner::PLAIN });
        let analysis = slide(&effect, speed, 200.0);
        let pitch = speed / spacing_m;
        // All partials are multiples of it.
        let near: f32 = analysis
            .spectrum
            .iter()
            .enumerate()
            .filter(|(bin, _)| {
                let times = *bin as f32 * analysis.bin_hz / pitch;
                times > 0.5 && (times - times.round()).abs() * pitch < 6.0
            })
            .map(|(_, power)| power)
            .sum();
        assert!(near > 0.95, "{near} of the power is at multiples of {pitch} Hz");
    }
}

/// Equally loud, and still easy to distinguish: they differ in their spectrum and in their rhythm.
#[test]
fn textures_differ_in_timbre_and_not_only_in_loudness() {
    let mut faces: Vec<(String, [f32; 3])> = Vec::new();
    for name in ["smooth", "wood", "grating", "glass", "rubber", "leather", "gravel", "sand"] {
        let samples = audition(&shipped(name), &Gesture::steady(0.25, Newtons(200.0), 2.0), RATE);
        let samples = &samples[RATE as usize / 2..];
        let analysis = analyse(samples, RATE as f32, Band::USEFUL).unwrap();
        let levels: Vec<f32> = samples.chunks(240).map(rms).collect();
        let mean = levels.iter().sum::<f32>() / levels.len() as f32;
        let unrest = (levels.iter().map(|level| (level / mean - 1.0).powi(2)).sum::<f32>()
            / levels.len() as f32)
            .sqrt();
        let above: f32 = analysis
            .spectrum
            .iter()
            .enumerate()
            .filter(|(bin, _)| *bin as f32 * analysis.bin_hz > 300.0)
            .map(|(_, p)| p)
            .sum();
        let face = [(analysis.centroid_hz / 100.0).log2(), 2.0 * unrest, 2.0 * above];
        println!("{name:8} {:4.0} Hz, unrest {unrest:.2}, above 300 Hz {above:.2}", analysis.centroid_hz);
        for (other, known) in &faces {
            let apart = face.iter().zip(known).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt();
            assert!(apart > 0.15, "{name} feels like {other}: {face:?}, {known:?}");
        }
        faces.push((name.to_owned(), face));
    }
}

#[test]
fn a_release_is_softer_and_comes_when_the_foot_lets_go() {
    for name in ["crisp_click", "soft_click", "heavy_click"] {
        let effect = shipped(name);
        let gesture =
            Gesture { press_s: Some(0.02), release_s: Some(0.5), length_s: 0.9, ..Gesture::usual(&effect) };
        let (samples, _) = hear(&effect, &gesture);
        let peak = |from: f32, to: f32| {
            let range = (from * RATE as f32) as usize..(to * RATE as f32) as usize;
            samples[range].iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()))
        };
        let (press, release) = (peak(0.0, 0.4), peak(0.49, 0.9));
        assert!(release > 0.15 * press && release < 0.8 * press, "{name}: {press}, {release}");
        assert!(peak(0.4, 0.499) < 0.01 * press, "{name} is over in between");
        let first = samples.iter().position(|sample| *sample != 0.0).unwrap();
        assert!(first.abs_diff(RATE as usize / 50) <= 1, "{name} begins at sample {first}");
    }
}

#[test]
fn an_end_is_felt_when_it_is_reached_harder_when_fast_and_while_the_foot_pushes_on() {
    let effect = shipped("end_stop");
    let run = |speed: f32| {
        let at = |at_s, speed_m_s, value, beyond_m| Moment {
            at_s,
            speed_m_s,
            value,
            beyond_m,
            force: Newtons(100.0),
        };
        let moments = vec![
            at(0.0, speed, 0.5, 0.0),
            at(0.3, speed, 1.0, 0.0),
            at(0.6, 0.0, 1.0, 0.0),
            at(0.7, 0.1, 1.0, 0.03),
            at(1.0, 0.0, 1.0, 0.03),
            at(1.1, 0.1, 0.9, 0.0),
        ];
        let gesture = Gesture { moments, press_s: None, release_s: None, holds: false, length_s: 1.5 };
        audition(&effect, &gesture, RATE)
    };
    let (slow, fast) = (run(0.05), run(0.5));
    let range = |from: f32, to: f32| (from * RATE as f32) as usize..(to * RATE as f32) as usize;
    for samples in [&slow, &fast] {
        assert!(samples[range(0.0, 0.298)].iter().all(|sample| *sample == 0.0), "nothing before the end");
        let first = samples.iter().position(|sample| *sample != 0.0).unwrap();
        assert!((first as f32 / RATE as f32 - 0.3).abs() < 0.002, "the thud comes at the end");
        assert!(rms(&samples[range(0.75, 0.95)]) > 1.0, "a wall while the foot pushes on");
        assert!(rms(&samples[range(1.2, 1.5)]) < 0.02, "and nothing once it is back");
    }
    let peak = |samples: &[f32]| samples[range(0.29, 0.45)].iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    assert!(peak(&fast) > 1.6 * peak(&slow));
}

#[test]
fn every_detent_is_felt_once_and_told_apart_by_value_and_side() {
    let effect = shipped("detent");
    let samples = audition(&effect, &Gesture::usual(&effect), RATE);
    // Up from 0.02 to 0.98 and back in tenths: nine each way, every 125 ms.
    let mut peaks: Vec<(f32, f32)> = Vec::new();
    for (n, part) in samples.chunks(RATE as usize / 100).enumerate() {
        let peak = part.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        let at = n as f32 / 100.0;
        if peak > 2.0 && peaks.last().is_none_or(|(last, _)| at - last > 0.05) {
            peaks.push((at, 0.0));
        }
        if let Some((last, level)) = peaks.last_mut()
            && at - *last < 0.05
        {
            *level = level.max(peak);
        }
    }
    assert_eq!(peaks.len(), 18, "{peaks:?}");
    let (up, down) = peaks.split_at(9);
    assert!(up[4].1 > 1.25 * up[3].1, "the middle is marked");
    for (up, down) in up.iter().zip(down.iter().rev()) {
        assert!(down.1 < 0.95 * up.1, "lighter on the way back");
    }
}

#[test]
fn what_is_held_goes_on_until_it_is_let_go_and_a_rise_rises() {
    let hum = shipped("engine_hum");
    let held =
        Gesture { press_s: Some(0.1), release_s: Some(4.0), holds: true, length_s: 5.0, moments: Vec::new() };
    let samples = audition(&hum, &held, RATE);
    let range = |from: f32, to: f32| (from * RATE as f32) as usize..(to * RATE as f32) as usize;
    assert!(rms(&samples[range(3.5, 3.9)]) > 1.0);
    assert!(rms(&samples[range(4.1, 5.0)]) < 0.01);

    let rise = shipped("long_press_rise");
    let samples = audition(&rise, &Gesture { release_s: Some(0.5), ..held.clone() }, RATE);
    let levels: Vec<f32> =
        [0.2, 0.3, 0.4].iter().map(|from| rms(&samples[range(*from, from + 0.1)])).collect();
    assert!(levels.windows(2).all(|pair| pair[1] > pair[0]), "{levels:?}");
    assert!(rms(&samples[range(0.6, 1.0)]) < 0.01, "let go, it is gone");
}

/// The whole path from a cue to samples stays finite for any numbers from a file or a sensor.
#[test]
fn the_physical_friction_stays_finite_for_absurd_input() {
    let EffectKind::StickSlip(rubber) = shipped("rubber").kind.clone() else { panic!("stick-slip") };
    for speed in [f32::NAN, f32::INFINITY, -1.0, 1e-30, 1e9] {
        for force in [f32::NAN, f32::INFINITY, -1.0, 1e9] {
            for stick in [
                rubber,
                StickSlip { stretch_m: f32::NAN, ..rubber },
                StickSlip { let_go_m_s: 0.0, sole_hz: 1e9, ..rubber },
                StickSlip { grip: 0.0, glide: f32::INFINITY, ..rubber },
            ] {
                let effect = Arc::new(Effect { kind: EffectKind::StickSlip(stick), manner: Manner::PLAIN });
                let samples = audition(&effect, &Gesture::steady(speed, Newtons(force), 0.2), RATE);
                assert!(samples.iter().all(|sample| sample.abs() <= 4000.0), "{speed} m/s, {force} N");
            }
        }
    }
}

#[test]
fn every_shipped_effect_is_written_and_read_back_the_same() {
    let effects = Effects::builtin();
    for named in effects.iter() {
        let text = write_named_effect(named);
        let (read, warnings) =
            parse_effect(&text, "written.ron", &Effects::default()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert!(warnings.is_empty());
        assert_eq!(&read, named, "{text}");
    }
}
