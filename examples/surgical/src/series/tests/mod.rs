//! Files that are series, and files that are not.

mod hostile;
mod kinds;
mod make;

use std::fs;

use dicom_dictionary_std::tags;
use dicom_object::{DefaultDicomObject, open_file};

use super::*;
use crate::phantom;
use make::Maker;

/// The reader's result for a file of these bytes; a panic of a decoder is not caught.
fn read_bytes(bytes: &[u8]) -> Result<Part, Unfit> {
    file::part(Path::new("made.dcm"), bytes, &mut MOST_PIXELS.clone())
}

fn shown(file: &Maker) -> Result<Part, Unfit> {
    read_bytes(&file.file())
}

fn phantom() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    phantom::write(folder.path()).unwrap();
    folder
}

#[test]
fn the_phantom_is_read_as_it_was_written() {
    let folder = phantom();
    let found = read(folder.path()).unwrap();
    assert_eq!(found.left_out, Vec::<String>::new());
    let [ct, xa] = found.series.as_slice() else { panic!("{}", found.series.len()) };
    assert_eq!((ct.title.as_str(), ct.frames.len()), ("CT Phantom, computed", phantom::SLICES));
    assert_eq!((xa.title.as_str(), xa.frames.len()), ("XA Phantom, X-rayed", phantom::PICTURES));
    let plane = &ct.frames[0].plane;
    assert_eq!(plane.spacing_mm, Some([phantom::SPACING_MM; 2]));
    assert_eq!(plane.towards, Some(["L".to_owned(), "P".to_owned()]));
    assert_eq!(ct.about, "Phantom, Simulated   NOBODY   2024-05-17");
    assert_eq!(ct.window, Window { level: 40.0, width: 400.0 });
    // Air in a corner, up to the noise: the modality's scale has been applied.
    let greys = |slice: usize| match &ct.frames[slice].pixels {
        Pixels::Grey(values) => values,
        Pixels::Colour(colours) => panic!("{colours:?}"),
    };
    assert!((greys(0)[0] + 1000.0).abs() < 15.0, "{}", greys(0)[0]);
    let row = (0.5 * ct.size[1] as f64 + phantom::RODS_DOWN_MM / phantom::SPACING_MM) as usize;
    let metal: Vec<f64> = (0..ct.size[0])
        .filter(|x| greys(20)[row * ct.size[0] + x] > 2000.0)
        .map(|x| x as f64 * phantom::SPACING_MM)
        .collect();
    let half = 0.5 * ct.size[0] as f64 * phantom::SPACING_MM;
    let (left, right): (Vec<f64>, Vec<f64>) = metal.iter().partition(|x| **x < half);
    let middle = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
    assert!((middle(&right) - middle(&left) - phantom::RODS_MM).abs() < 0.01);
}

#[test]
fn one_file_may_be_named_alone() {
    let folder = phantom();
    let found = read(&folder.path().join("xa.dcm")).unwrap();
    assert_eq!((found.series.len(), found.series[0].frames.len()), (1, phantom::PICTURES));
    assert!(read(&folder.path().join("none.dcm")).is_err());
}

#[test]
fn what_is_no_picture_is_told_by_name_and_the_others_are_shown() {
    let folder = phantom();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("notes.txt"), "not DICOM at all").unwrap();
    fs::write(at("empty.dcm"), "").unwrap();
    let whole = fs::read(at("ct_001.dcm")).unwrap();
    fs::write(at("ct_002.dcm"), &whole[..whole.len() / 2]).unwrap();
    let change = |from: &str, to: &str, change: fn(&mut DefaultDicomObject)| {
        let mut file = open_file(at(from)).unwrap();
        change(&mut file);
        file.write_to_file(at(to)).unwrap();
    };
    change("ct_003.dcm", "ct_003.dcm", |file| assert!(file.remove_element(tags::PIXEL_DATA)));
    change("ct_004.dcm", "ct_004.dcm", |file| assert!(file.remove_element(tags::ROWS)));
    change("ct_005.dcm", "ct_005.dcm", |file| {
        let taller = dicom_core::PrimitiveValue::from(4000_u16);
        file.put(dicom_core::DataElement::new(tags::ROWS, dicom_core::VR::US, taller));
    });
    change("xa.dcm", "smaller.dcm", |file| {
        let one = dicom_core::PrimitiveValue::from("1");
        file.put(dicom_core::DataElement::new(tags::NUMBER_OF_FRAMES, dicom_core::VR::IS, one));
        let uid = format!("{}.1", "2.25.193584207461330254481790331857");
        let uid = dicom_core::PrimitiveValue::from(uid);
        file.put(dicom_core::DataElement::new(tags::SERIES_INSTANCE_UID, dicom_core::VR::UI, uid));
    });
    let found = read(folder.path()).unwrap();
    let told = found.left_out.join("\n");
    for expected in [
        "notes.txt is not a DICOM file",
        "empty.dcm is not a DICOM file",
        "ct_002.dcm is a damaged DICOM file: PixelData says 100352 bytes",
        "ct_003.dcm has no picture: it is a “CT Image Storage” without pixels",
        "ct_004.dcm has no picture that can be shown: its number of rows is missing",
        "ct_005.dcm has pixels that can't be read: they need 1792000 bytes, and 100352 are there",
        "smaller.dcm is 256 x 256 pixels, and its series 224 x 224",
    ] {
        assert!(told.contains(expected), "{expected}\n{told}");
    }
    assert_eq!(found.left_out.len(), 7, "{told}");
    let frames: Vec<usize> = found.series.iter().map(|series| series.frames.len()).collect();
    assert_eq!(frames, [phantom::SLICES - 4, phantom::PICTURES]);
}

#[test]
fn missing_tags_that_can_be_done_without_are_done_without() {
    let folder = tempfile::tempdir().unwrap();
    let whole = phantom();
    let mut file = open_file(whole.path().join("ct_020.dcm")).unwrap();
    for tag in [
        tags::PIXEL_SPACING,
        tags::WINDOW_CENTER,
        tags::WINDOW_WIDTH,
        tags::SERIES_DESCRIPTION,
        tags::SERIES_INSTANCE_UID,
        tags::INSTANCE_NUMBER,
        tags::IMAGE_POSITION_PATIENT,
    ] {
        assert!(file.remove_element(tag), "{tag}");
    }
    file.write_to_file(folder.path().join("bare.dcm")).unwrap();
    let found = read(folder.path()).unwrap();
    let [series] = found.series.as_slice() else { panic!("{found:?}") };
    assert_eq!((series.title.as_str(), series.frames[0].plane.spacing_mm), ("CT Untitled", None));
    // From air to metal.
    assert!((series.window.width - 3400.0).abs() < 40.0, "{:?}", series.window);
}

#[test]
fn what_does_not_fit_into_memory_is_left_out_and_the_rest_shown() {
    let folder = phantom();
    let mut room = 10;
    let refused = file::read(&folder.path().join("ct_001.dcm"), &mut room);
    assert!(matches!(refused, Err(Unfit::Full)));
    assert_eq!(room, 10);
}

#[test]
fn slices_are_ordered_by_their_place() {
    let folder = phantom();
    fs::rename(folder.path().join("ct_001.dcm"), folder.path().join("zz.dcm")).unwrap();
    let found = read(folder.path()).unwrap();
    let again = read(phantom().path()).unwrap();
    assert_eq!(found.series[0].frames[0].pixels, again.series[0].frames[0].pixels);
}
