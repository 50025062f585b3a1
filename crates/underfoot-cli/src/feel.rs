//! `underfoot feel`: effects as sound, picture and figures, and Apple's patterns in and out.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use serde_json::json;
use underfoot::feel::{Effect, Gesture};
use underfoot::schema::{
    self, Effects, NamedEffect, parse_effect, read_ahap, read_bounded, save_text, write_ahap,
};
use underfoot::sink::write_mono;
use underfoot::units::Newtons;
use underfoot_lab::experiment::{EffectSheet, Figure};
use underfoot_scene::picture;

use super::failure::Failure;
use super::fonts::fonts;
use super::number::{gesture, number};

/// Options of `underfoot feel`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Name of an effect (`--list` shows them), or a file: ours (.ron) or Apple's (.ahap).
    #[arg(value_name = "EFFECT", required_unless_present = "list")]
    effect: Option<PathBuf>,
    /// List the name and kind of every effect.
    #[arg(long, conflicts_with_all = ["wav", "png", "ron", "ahap"])]
    list: bool,
    /// Folder of effects to add; without it, a folder `effects` here.
    #[arg(long, value_name = "DIR")]
    effects: Option<PathBuf>,
    /// Write the effect as sound: one channel, newtons over `--full-scale`.
    #[arg(long, value_name = "FILE")]
    wav: Option<PathBuf>,
    /// Write a picture of waveform, spectrum and band: PNG, or SVG if the name ends in .svg.
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
    /// Write the effect as one of our files.
    #[arg(long, value_name = "FILE")]
    ron: Option<PathBuf>,
    /// Write the effect as one of Apple's files.
    #[arg(long, value_name = "FILE")]
    ahap: Option<PathBuf>,
    /// Slip speed of an even slide, in metres per second; without it, a gesture that demonstrates the effect.
    #[arg(long, value_name = "M_S", value_parser = speed)]
    speed: Option<f32>,
    /// Normal force of an even slide, in newtons.
    #[arg(long, value_name = "N", value_parser = force)]
    force: Option<f32>,
    /// Duration of the slide, or of a press, in seconds.
    #[arg(long, value_name = "S", value_parser = gesture)]
    seconds: Option<Duration>,
    /// Newtons at the sound's full scale.
    #[arg(long, value_name = "N", default_value_t = 40.0, value_parser = full_scale)]
    full_scale: f32,
    /// Samples per second.
    #[arg(long, value_name = "HZ", default_value_t = 48_000, value_parser = clap::value_parser!(u32).range(8000..=192_000))]
    rate: u32,
    /// Width of a PNG, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1800)]
    width: u32,
    /// Print the measurements as one JSON object.
    #[arg(long)]
    json: bool,
}

fn speed(text: &str) -> Result<f32, String> {
    number(text, &(0.0..=20.0), "metres per second").map(|speed| speed as f32)
}

fn force(text: &str) -> Result<f32, String> {
    number(text, &(0.0..=5000.0), "newtons").map(|force| force as f32)
}

fn full_scale(text: &str) -> Result<f32, String> {
    number(text, &(0.001..=1e6), "newtons").map(|force| force as f32)
}

/// Renders one effect, measures it and writes it out.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let effects = args.known()?;
    let Some(wanted) = args.effect.as_deref().filter(|_| !args.list) else {
        list(&effects, args.json);
        return Ok(());
    };
    let named = find(wanted, &effects)?;
    let gesture = args.gesture(&named.effect)?;
    let sheet = EffectSheet::new(&named.name, &named.about, Arc::clone(&named.effect), gesture, args.rate);
    if args.json {
        outln!("{}", measured(&sheet));
    } else {
        out!("{}", sheet.summary());
    }
    if let Some(path) = &args.wav {
        let cut = write_mono(path, &sheet.samples, args.rate, args.full_scale)?;
        if cut > 0 {
            errln!(
                "warning: {cut} samples are beyond {} N and were cut off; see --full-scale",
                args.full_scale
            );
        }
    }
    if let Some(path) = &args.png {
        picture::write(&sheet.draw(), fonts(), path, args.width)?;
    }
    if let Some(path) = &args.ron {
        save_text(&schema::write_named_effect(&named), path)?;
    }
    if let Some(path) = &args.ahap {
        let (text, lost) =
            write_ahap(&named.effect, &named.name).map_err(|error| Failure::Other(error.to_string()))?;
        lost.iter().for_each(|lost| errln!("warning: {lost}"));
        save_text(&text, path)?;
    }
    Ok(())
}

impl Args {
    /// The shipped effects and the user's.
    fn known(&self) -> Result<Effects, Failure> {
        let mut effects = Effects::builtin();
        let here = Path::new("effects");
        if let Some(folder) = self.effects.as_deref().or_else(|| here.is_dir().then_some(here)) {
            let warnings = effects.read_folder(folder)?;
            if !warnings.is_empty() {
                err!("{warnings}");
            }
        }
        Ok(effects)
    }

    fn gesture(&self, effect: &Effect) -> Result<Gesture, Failure> {
        let usual = Gesture::usual(effect);
        let slides = effect.kind.lasting().is_some();
        if !slides && (self.speed.is_some() || self.force.is_some()) {
            let message =
                format!("a {} does not follow a slip: --speed and --force don't matter", effect.kind.name());
            return Err(Failure::Other(message));
        }
        if slides && (self.speed.is_some() || self.force.is_some() || self.seconds.is_some()) {
            let force = Newtons(self.force.unwrap_or(200.0));
            let seconds = self.seconds.map_or(2.0, |seconds| seconds.as_secs_f32());
            return Ok(Gesture::steady(self.speed.unwrap_or(0.3), force, seconds));
        }
        Ok(match self.seconds {
            Some(seconds) => {
                let seconds = seconds.as_secs_f32();
                Gesture { holds: true, release_s: Some(0.02 + seconds), length_s: seconds + 0.5, ..usual }
            }
            None => usual,
        })
    }
}

/// Maximum size of the file of an effect or pattern, in bytes.
const MOST_BYTES: u64 = 4 << 20;

/// The effect with this name or in this file.
fn find(wanted: &Path, effects: &Effects) -> Result<NamedEffect, Failure> {
    let name = wanted.to_str().unwrap_or_default();
    if let Some(named) = effects.get(name).filter(|_| !wanted.is_file()) {
        return Ok(named.clone());
    }
    let unreadable = |error: std::io::Error| {
        let is_name = wanted.extension().is_none();
        if is_name && error.kind() == std::io::ErrorKind::NotFound {
            return Failure::Other(format!(
                "there is no effect \"{name}\"; `underfoot feel --list` names them all"
            ));
        }
        Failure::File(wanted.to_path_buf(), error)
    };
    let text = read_bounded(wanted, MOST_BYTES).map_err(unreadable)?;
    if wanted.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ahap")) {
        let (effect, lost) = read_ahap(&text, name).map_err(|error| Failure::Other(error.to_string()))?;
        lost.iter().for_each(|lost| errln!("warning: {name}: {lost}"));
        let stem = wanted.file_stem().and_then(|stem| stem.to_str()).unwrap_or("pattern").to_lowercase();
        let fit = |c: char| if c.is_ascii_lowercase() || c.is_ascii_digit() { c } else { '_' };
        let about = "A haptic pattern of Apple's".to_owned();
        return Ok(NamedEffect {
            name: stem.chars().map(fit).take(64).collect(),
            about,
            effect: Arc::new(effect),
        });
    }
    let (named, warnings) = parse_effect(&text, name, effects)?;
    if !warnings.is_empty() {
        err!("{warnings}");
    }
    Ok(named)
}

fn list(effects: &Effects, as_json: bool) {
    for named in effects.iter() {
        let kind = named.effect.kind.name();
        if as_json {
            outln!("{}", json!({ "name": named.name, "kind": kind, "about": named.about }));
        } else {
            outln!("{:<18}{kind:<12}{}", named.name, named.about);
        }
    }
}

fn measured(sheet: &EffectSheet) -> serde_json::Value {
    let analysis = sheet.analysis.as_ref();
    json!({
        "name": sheet.name,
        "kind": sheet.effect.kind.name(),
        "peak_n": analysis.map(|analysis| analysis.peak),
        "rms_n": analysis.map(|analysis| analysis.rms),
        "within_band": analysis.map(|analysis| analysis.within),
        "loudest_hz": analysis.map(|analysis| analysis.loudest_hz),
        "centroid_hz": analysis.map(|analysis| analysis.centroid_hz),
        "decay_s": sheet.decay_s,
        "band_hz": [sheet.effect.manner.band.low_hz, sheet.effect.manner.band.high_hz],
    })
}
