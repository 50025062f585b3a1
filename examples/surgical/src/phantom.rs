//! Two series of an invented object, written as real DICOM files without any patient's data.

use std::io;
use std::path::Path;

use dicom_core::value::{PrimitiveValue, Value};
use dicom_core::{DataElement, Tag, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};

/// Slices of the first series, one in each file, and their size.
pub const SLICES: usize = 40;
const WIDE: usize = 224;

/// Distance between pixels, and between slices, in millimetres.
pub const SPACING_MM: f64 = 1.25;
const APART_MM: f64 = 3.0;

/// Distance between the centres of the two metal rods of the first series, and their depth below the middle, in
/// millimetres, against which measurements can be checked.
pub const RODS_MM: f64 = 90.0;
pub const RODS_DOWN_MM: f64 = 62.0;

/// Pictures of the second series, all in one file, and their size.
pub const PICTURES: usize = 24;
const FILM: usize = 256;

/// The root of identifiers made up for this app, under the arc for UUIDs.
const ROOT: &str = "2.25.193584207461330254481790331857";

/// Writes both series into `folder`.
///
/// # Errors
/// The files can't be written.
pub fn write(folder: &Path) -> io::Result<()> {
    for slice in 0..SLICES {
        let at_mm = slice as f64 * APART_MM;
        let stored = pixels(WIDE, |x, y| {
            let (x, y) = (x * SPACING_MM, y * SPACING_MM);
            // A pixel is the mean of its area, as in a scanner.
            let parts = [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)];
            let along = at_mm / (SLICES as f64 * APART_MM);
            let part = |(right, down)| hounsfield(x + right * SPACING_MM, y + down * SPACING_MM, along);
            let mean = parts.map(part).iter().sum::<f64>() / parts.len() as f64;
            // Stored as Hounsfield units and 1024.
            (1024.0 + mean + noise(x, y, slice)) as u16
        });
        let corner = -0.5 * WIDE as f64 * SPACING_MM;
        let mut file = common(1, slice + 1, "CT", "Phantom, computed", uids::CT_IMAGE_STORAGE);
        put(&mut file, tags::IMAGE_POSITION_PATIENT, VR::DS, format!("{corner}\\{corner}\\{at_mm}"));
        put(&mut file, tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "1\\0\\0\\0\\1\\0");
        put(&mut file, tags::PIXEL_SPACING, VR::DS, format!("{SPACING_MM}\\{SPACING_MM}"));
        put(&mut file, tags::RESCALE_INTERCEPT, VR::DS, "-1024");
        put(&mut file, tags::RESCALE_SLOPE, VR::DS, "1");
        put(&mut file, tags::WINDOW_CENTER, VR::DS, "40");
        put(&mut file, tags::WINDOW_WIDTH, VR::DS, "400");
        picture(&mut file, WIDE, 16, PrimitiveValue::U16(stored.into()));
        save(file, uids::CT_IMAGE_STORAGE, &folder.join(format!("ct_{:03}.dcm", slice + 1)))?;
    }
    let film: Vec<u8> = (0..PICTURES)
        .flat_map(|number| {
            let phase = number as f64 / PICTURES as f64;
            pixels(FILM, move |x, y| shadow(x / FILM as f64, y / FILM as f64, phase) as u8)
        })
        .collect();
    let mut file = common(2, 1, "XA", "Phantom, X-rayed", uids::X_RAY_ANGIOGRAPHIC_IMAGE_STORAGE);
    put(&mut file, tags::NUMBER_OF_FRAMES, VR::IS, PICTURES.to_string());
    put(&mut file, tags::IMAGER_PIXEL_SPACING, VR::DS, "0.8\\0.8");
    put(&mut file, tags::WINDOW_CENTER, VR::DS, "128");
    put(&mut file, tags::WINDOW_WIDTH, VR::DS, "256");
    picture(&mut file, FILM, 8, PrimitiveValue::U8(film.into()));
    save(file, uids::X_RAY_ANGIOGRAPHIC_IMAGE_STORAGE, &folder.join("xa.dcm"))
}

/// The elements that all files share.
fn common(series: usize, number: usize, modality: &str, title: &str, class: &str) -> InMemDicomObject {
    let mut file = InMemDicomObject::new_empty();
    put(&mut file, tags::SOP_CLASS_UID, VR::UI, class);
    put(&mut file, tags::SOP_INSTANCE_UID, VR::UI, format!("{ROOT}.{series}.{number}"));
    put(&mut file, tags::STUDY_INSTANCE_UID, VR::UI, ROOT);
    put(&mut file, tags::SERIES_INSTANCE_UID, VR::UI, format!("{ROOT}.{series}"));
    put(&mut file, tags::PATIENT_NAME, VR::PN, "Phantom^Simulated");
    put(&mut file, tags::PATIENT_ID, VR::LO, "NOBODY");
    put(&mut file, tags::STUDY_DATE, VR::DA, "20240517");
    put(&mut file, tags::MODALITY, VR::CS, modality);
    put(&mut file, tags::SERIES_DESCRIPTION, VR::LO, title);
    put(&mut file, tags::SERIES_NUMBER, VR::IS, series.to_string());
    put(&mut file, tags::INSTANCE_NUMBER, VR::IS, number.to_string());
    file
}

fn put(file: &mut InMemDicomObject, tag: Tag, vr: VR, text: impl Into<String>) {
    file.put(DataElement::new(tag, vr, PrimitiveValue::from(text.into())));
}

/// The pixels, of `bits` each, in squares of `wide`.
fn picture(file: &mut InMemDicomObject, wide: usize, bits: u16, pixels: PrimitiveValue) {
    put(file, tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2");
    let wide = wide as u16;
    let numbers = [
        (tags::SAMPLES_PER_PIXEL, 1),
        (tags::ROWS, wide),
        (tags::COLUMNS, wide),
        (tags::BITS_ALLOCATED, bits),
        (tags::BITS_STORED, bits),
        (tags::HIGH_BIT, bits - 1),
        (tags::PIXEL_REPRESENTATION, 0),
    ];
    for (tag, number) in numbers {
        file.put(DataElement::new(tag, VR::US, PrimitiveValue::from(number)));
    }
    let vr = if bits == 16 { VR::OW } else { VR::OB };
    file.put(DataElement::new(tags::PIXEL_DATA, vr, Value::Primitive(pixels)));
}

fn save(file: InMemDicomObject, class: &str, path: &Path) -> io::Result<()> {
    let meta = FileMetaTableBuilder::new()
        .transfer_syntax(uids::EXPLICIT_VR_LITTLE_ENDIAN)
        .media_storage_sop_class_uid(class);
    let file = file.with_meta(meta).map_err(io::Error::other)?;
    file.write_to_file(path).map_err(io::Error::other)
}

/// A square of values, by distances from its middle in pixels.
fn pixels<T>(wide: usize, value: impl Fn(f64, f64) -> T) -> Vec<T> {
    let middle = 0.5 * (wide as f64 - 1.0);
    (0..wide * wide).map(|at| value((at % wide) as f64 - middle, (at / wide) as f64 - middle)).collect()
}

/// A trunk with spine, lungs, vessels and two metal rods; places in millimetres, `along` from 0 to 1 through it.
fn hounsfield(x: f64, y: f64, along: f64) -> f64 {
    let inside = |cx: f64, cy: f64, rx: f64, ry: f64| ((x - cx) / rx).powi(2) + ((y - cy) / ry).powi(2) < 1.0;
    let bulge = (std::f64::consts::PI * along).sin();
    if !inside(0.0, 0.0, 126.0, 92.0) {
        return -1000.0;
    }
    if [-0.5, 0.5].iter().any(|side| inside(side * RODS_MM, RODS_DOWN_MM, 4.0, 4.0)) {
        return 2400.0;
    }
    if !inside(0.0, 0.0, 118.0, 84.0) {
        return -90.0;
    }
    if inside(0.0, 48.0, 20.0, 17.0) && !inside(0.0, 50.0, 8.0, 7.0) {
        return 620.0;
    }
    for side in [-1.0, 1.0] {
        let (rx, ry) = (34.0 * bulge + 4.0, 46.0 * bulge + 4.0);
        if inside(side * 60.0, -8.0, rx, ry) {
            // A vessel that winds through each lung, and a nodule in a few slices only.
            let turn = 6.0 * along + side;
            let vessel = inside(side * 60.0 + 14.0 * turn.cos(), -8.0 + 20.0 * turn.sin(), 4.0, 4.0);
            let nodule = side > 0.0 && (along - 0.6).abs() < 0.06 && inside(52.0, -24.0, 7.0, 7.0);
            return if nodule {
                70.0
            } else if vessel {
                45.0
            } else {
                -820.0
            };
        }
    }
    if inside(-6.0, -14.0, 24.0 * bulge, 30.0 * bulge) { 150.0 } else { 45.0 }
}

/// Detector noise of a few Hounsfield units, the same in every run.
fn noise(x: f64, y: f64, slice: usize) -> f64 {
    let mixed = (x * 12.9898 + y * 78.233 + slice as f64 * 37.719).sin() * 43_758.545;
    24.0 * (mixed - mixed.floor() - 0.5)
}

/// A catheter that enters a vessel tree, as a shadow on a bright screen; places from -0.5 to 0.5.
fn shadow(x: f64, y: f64, phase: f64) -> f64 {
    let mut light: f64 = 208.0 - 120.0 * (x * x + y * y);
    for rib in 0..6 {
        let at = -0.42 + 0.16 * f64::from(rib) + 0.22 * x * x;
        light -= 26.0 * (-((y - at) / 0.022).powi(2)).exp();
    }
    light -= 40.0 * (-(x / 0.07).powi(2)).exp();
    let branch = |offset: f64, bend: f64| {
        let middle = offset + bend * (y + 0.45).max(0.0).powi(2);
        (-((x - middle) / 0.014).powi(2)).exp()
    };
    // Contrast medium comes from below and fills the tree.
    let filled = 1.0 / (1.0 + ((0.45 - 1.1 * phase - y) * 30.0).exp());
    light -= 70.0 * filled * (branch(0.02, 0.35) + branch(0.02, -0.45) + branch(0.02, 0.05)).min(1.0);
    let tip = 0.48 - 0.8 * phase;
    if y > tip {
        light -= 60.0 * (-((x - 0.03 - 0.05 * (7.0 * y).sin()) / 0.006).powi(2)).exp();
    }
    light.clamp(0.0, 255.0)
}
