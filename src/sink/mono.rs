//! One channel of samples as a WAV file.

use std::path::Path;

use hound::{SampleFormat, WavSpec, WavWriter};

use super::SinkError;
use super::wav::file_error;

/// Writes newtons as a sound of one channel and 24 bits with full scale at `full_scale` newtons. Returns the number
/// of samples that were clipped, and of those that were not finite and became silence.
///
/// # Errors
/// [`SinkError::File`] if the file cannot be written.
pub fn write_mono(path: &Path, samples: &[f32], sample_rate: u32, full_scale: f32) -> Result<u64, SinkError> {
    let spec = WavSpec { channels: 1, sample_rate, bits_per_sample: 24, sample_format: SampleFormat::Int };
    let failed = |error| file_error(path, error);
    let mut writer = WavWriter::create(path, spec).map_err(failed)?;
    let mut cut = 0;
    for sample in samples {
        let value = f64::from(*sample) / f64::from(full_scale);
        cut += u64::from(!(-1.0..=1.0).contains(&value));
        let value = if value.is_nan() { 0.0 } else { value.clamp(-1.0, 1.0) };
        writer.write_sample((value * 8_388_607.0).round() as i32).map_err(failed)?;
    }
    writer.finalize().map_err(failed)?;
    Ok(cut)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newtons_become_shares_of_the_full_scale() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("click.wav");
        let cut = write_mono(&path, &[0.0, 10.0, -40.0, 50.0, f32::NAN], 48_000, 40.0).unwrap();
        assert_eq!(cut, 2);
        let read: Vec<i32> = hound::WavReader::open(&path).unwrap().samples().map(Result::unwrap).collect();
        assert_eq!(read, [0, 2_097_152, -8_388_607, 8_388_607, 0]);
        assert!(write_mono(Path::new("/no/such/folder/a.wav"), &[], 48_000, 40.0).is_err());
    }
}
