//! Each supported kind of pixels, by a small picture of known values.

use std::io::Write;

use dicom_core::VR;
use dicom_dictionary_std::{tags, uids};
use flate2::Compression;
use flate2::write::DeflateEncoder;

use super::make::{BIG_ENDIAN, Maker};
use super::shown;
use crate::series::file::Part;
use crate::series::unfit::Unfit;
use crate::series::{Pixels, opposite};

const EXPLICIT: &str = uids::EXPLICIT_VR_LITTLE_ENDIAN;
const IMPLICIT: &str = uids::IMPLICIT_VR_LITTLE_ENDIAN;

/// The grey values of all frames.
fn greys(part: &Part) -> Vec<f32> {
    let values = part.series.frames.iter().flat_map(|frame| match &frame.pixels {
        Pixels::Grey(values) => values.clone(),
        Pixels::Colour(colours) => panic!("{colours:?}"),
    });
    values.collect()
}

/// The colours of all frames.
fn colours(part: &Part) -> Vec<[u8; 3]> {
    let values = part.series.frames.iter().flat_map(|frame| match &frame.pixels {
        Pixels::Grey(values) => panic!("{values:?}"),
        Pixels::Colour(colours) => colours.clone(),
    });
    values.collect()
}

fn why(read: Result<Part, Unfit>) -> String {
    read.unwrap_err().to_string()
}

#[test]
fn samples_of_each_size_are_read_in_each_order_of_bytes() {
    for uid in [EXPLICIT, IMPLICIT, BIG_ENDIAN] {
        let is_big = uid == BIG_ENDIAN;
        let eight = Maker::picture(uid, [3, 1], 8);
        // Big-endian files swap the bytes of words and not those of bytes.
        let words: &[u8] = if is_big { &[8, 7, 0, 9] } else { &[7, 8, 9] };
        assert_eq!(greys(&shown(&eight.clone().pixels(VR::OW, words)).unwrap()), [7.0, 8.0, 9.0], "{uid}");
        if uid != IMPLICIT {
            assert_eq!(greys(&shown(&eight.pixels(VR::OB, &[7, 8, 9])).unwrap()), [7.0, 8.0, 9.0], "{uid}");
        }
        let words = Maker::picture(uid, [2, 1], 16).numbers(tags::PIXEL_DATA, VR::OW, &[258, 65_000]);
        assert_eq!(greys(&shown(&words).unwrap()), [258.0, 65_000.0], "{uid}");
        let long: u32 = 16_000_001;
        let bytes = if is_big { long.to_be_bytes() } else { long.to_le_bytes() };
        let long = Maker::picture(uid, [1, 1], 32).pixels(VR::OW, &bytes);
        assert_eq!(greys(&shown(&long).unwrap()), [16_000_001.0], "{uid}");
    }
}

#[test]
fn bits_that_do_not_count_are_left_out_of_signed_numbers() {
    // 12 bits of 16, up to bit 13, with other bits around them.
    let picture = Maker::picture(EXPLICIT, [3, 1], 12).number(tags::HIGH_BIT, 13);
    let stored = [0xc000 | 5 << 2 | 3, 0x3ffc, 0x2000];
    let file = picture.clone().numbers(tags::PIXEL_DATA, VR::OW, &stored);
    assert_eq!(greys(&shown(&file).unwrap()), [5.0, 4095.0, 2048.0]);
    let file = picture.number(tags::PIXEL_REPRESENTATION, 1).numbers(tags::PIXEL_DATA, VR::OW, &stored);
    assert_eq!(greys(&shown(&file).unwrap()), [5.0, -1.0, -2048.0]);
}

#[test]
fn frames_of_single_bits_begin_inside_bytes() {
    // Twice three by three bits: the second frame begins with the second bit of the second byte.
    let picture = |uid| Maker::picture(uid, [3, 3], 1).text(tags::NUMBER_OF_FRAMES, VR::IS, "2");
    let expected = [1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0, 0, 0, 0, 1].map(|bit: u8| f32::from(bit));
    let bytes = [0b0101_0101, 0b0001_1101, 0b10];
    assert_eq!(greys(&shown(&picture(EXPLICIT).pixels(VR::OB, &bytes)).unwrap()), expected);
    let turned = [bytes[1], bytes[0], 0, bytes[2]];
    assert_eq!(greys(&shown(&picture(BIG_ENDIAN).pixels(VR::OW, &turned)).unwrap()), expected);
}

#[test]
fn fractions_are_read_without_what_is_no_number() {
    let floats: Vec<u8> = [0.5_f32, f32::NAN, -2.25].iter().flat_map(|value| value.to_le_bytes()).collect();
    let part =
        shown(&Maker::picture(EXPLICIT, [3, 1], 32).bytes(tags::FLOAT_PIXEL_DATA, VR::OF, &floats)).unwrap();
    let values = greys(&part);
    assert_eq!((values[0], values[2]), (0.5, -2.25));
    assert!(values[1].is_nan());
    assert_eq!((part.series.window.level, part.series.window.width), (-0.875, 2.75));
    let doubles: Vec<u8> = [1e-3_f64, 7.0].iter().flat_map(|value| value.to_be_bytes()).collect();
    let file = Maker::picture(BIG_ENDIAN, [2, 1], 32).bytes(tags::DOUBLE_FLOAT_PIXEL_DATA, VR::OD, &doubles);
    assert_eq!(greys(&shown(&file).unwrap()), [1e-3, 7.0]);
}

#[test]
fn colours_are_read_in_each_arrangement() {
    let expected = [[255, 0, 10], [1, 2, 3]];
    let file = Maker::colours(EXPLICIT, [2, 1], "RGB").pixels(VR::OB, &[255, 0, 10, 1, 2, 3]);
    assert_eq!(colours(&shown(&file).unwrap()), expected);
    let file = Maker::colours(EXPLICIT, [2, 1], "RGB")
        .number(tags::PLANAR_CONFIGURATION, 1)
        .pixels(VR::OB, &[255, 1, 0, 2, 10, 3]);
    assert_eq!(colours(&shown(&file).unwrap()), expected);
    // Pure red, and grey.
    let file = Maker::colours(EXPLICIT, [2, 1], "YBR_FULL").pixels(VR::OB, &[76, 85, 255, 90, 128, 128]);
    assert_eq!(colours(&shown(&file).unwrap()), [[254, 0, 0], [90, 90, 90]]);
    // Two brightnesses share their colour differences.
    let file = Maker::colours(EXPLICIT, [2, 1], "YBR_FULL_422").pixels(VR::OB, &[76, 90, 128, 128]);
    assert_eq!(colours(&shown(&file).unwrap()), [[76; 3], [90; 3]]);
    // Of 16 bits, the higher half is shown.
    let file = Maker::picture(EXPLICIT, [1, 1], 16)
        .number(tags::SAMPLES_PER_PIXEL, 3)
        .text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "RGB")
        .numbers(tags::PIXEL_DATA, VR::OW, &[0xff00, 0x80ff, 0x00ff]);
    assert_eq!(colours(&shown(&file).unwrap()), [[255, 128, 0]]);
}

/// A picture with a palette of three colours, numbered from 10.
fn palette(bits: u16, tables: [&[u16]; 3]) -> Maker {
    let descriptor = [3, 10, bits];
    Maker::picture(EXPLICIT, [4, 1], 8)
        .text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "PALETTE COLOR")
        .numbers(tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR, VR::US, &descriptor)
        .numbers(tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR, VR::US, &descriptor)
        .numbers(tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR, VR::US, &descriptor)
        .numbers(tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DATA, VR::OW, tables[0])
        .numbers(tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DATA, VR::OW, tables[1])
        .numbers(tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DATA, VR::OW, tables[2])
        .pixels(VR::OB, &[9, 10, 11, 200])
}

#[test]
fn palettes_give_each_number_its_colour() {
    // Numbers beyond an end have the colour of that end.
    let expected = [[255, 0, 7], [255, 0, 7], [2, 128, 8], [3, 255, 9]];
    let deep = palette(16, [&[0xff00, 0x0200, 0x0300], &[0, 0x8000, 0xffff], &[0x0700, 0x0800, 0x0900]]);
    assert_eq!(colours(&shown(&deep).unwrap()), expected);
    let packed = palette(8, [&[0x02ff, 0x0003], &[0x8000, 0x00ff], &[0x0807, 0x0009]]);
    assert_eq!(colours(&shown(&packed).unwrap()), expected);
    let apart = palette(16, [&[255, 2, 3], &[0, 128, 255], &[7, 8, 9]]);
    assert_eq!(colours(&shown(&apart).unwrap()), expected, "16 bits are told and 8 are used");
    assert!(why(shown(&palette(16, [&[1], &[2], &[3]]))).contains("palette has 1 of 3 colours"));
}

#[test]
fn a_palette_in_segments_is_expanded() {
    // A constant, a linear segment, and the first of them again.
    let segments = [0, 1, 0x1000, 1, 3, 0x4000, 2, 1, 0, 0];
    let file = Maker::picture(EXPLICIT, [5, 1], 8)
        .text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "PALETTE COLOR")
        .numbers(tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR, VR::US, &[5, 0, 16])
        .numbers(tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR, VR::US, &[5, 0, 16])
        .numbers(tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR, VR::US, &[5, 0, 16])
        .numbers(tags::SEGMENTED_RED_PALETTE_COLOR_LOOKUP_TABLE_DATA, VR::OW, &segments)
        .numbers(tags::SEGMENTED_GREEN_PALETTE_COLOR_LOOKUP_TABLE_DATA, VR::OW, &segments)
        .numbers(tags::SEGMENTED_BLUE_PALETTE_COLOR_LOOKUP_TABLE_DATA, VR::OW, &segments)
        .pixels(VR::OB, &[0, 1, 2, 3, 4]);
    assert_eq!(colours(&shown(&file).unwrap()), [0x10, 0x20, 0x30, 0x40, 0x10].map(|grey| [grey; 3]));
}

#[test]
fn a_modality_scales_by_a_line_or_by_a_table() {
    let file = Maker::picture(EXPLICIT, [2, 1], 8)
        .text(tags::RESCALE_INTERCEPT, VR::DS, "-1024")
        .text(tags::RESCALE_SLOPE, VR::DS, "2.5")
        .pixels(VR::OB, &[0, 4]);
    assert_eq!(greys(&shown(&file).unwrap()), [-1024.0, -1014.0]);
    let table = Maker::new(EXPLICIT).numbers(tags::LUT_DESCRIPTOR, VR::US, &[3, 5, 16]).numbers(
        tags::LUT_DATA,
        VR::OW,
        &[100, 200, 300],
    );
    let file = Maker::picture(EXPLICIT, [4, 1], 8)
        .sequence(tags::MODALITY_LUT_SEQUENCE, &[table])
        .pixels(VR::OB, &[0, 5, 6, 99]);
    assert_eq!(greys(&shown(&file).unwrap()), [100.0, 100.0, 200.0, 300.0]);
}

#[test]
fn the_least_value_is_white_where_the_file_says_so() {
    let file =
        |name| Maker::picture(EXPLICIT, [1, 1], 8).text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, name);
    for (name, is_inverted) in [("MONOCHROME1", true), ("MONOCHROME2", false)] {
        let part = shown(&file(name).pixels(VR::OB, &[3])).unwrap();
        assert_eq!(part.series.is_inverted, is_inverted);
    }
}

/// A run of one value, or literal values, in run-length encoding.
fn runs(segments: &[&[u8]]) -> Vec<u8> {
    let mut starts = vec![segments.len() as u32];
    let mut at = 64;
    for segment in segments {
        starts.push(at);
        at += segment.len() as u32;
    }
    starts.resize(16, 0);
    let table: Vec<u8> = starts.iter().flat_map(|word| word.to_le_bytes()).collect();
    [table, segments.concat()].concat()
}

#[test]
fn runs_are_read_for_samples_of_each_size() {
    // Four pixels: 0x0102 three times and 0x0304; bytes come in planes, the higher one first.
    let words = runs(&[&[(-2_i8) as u8, 1, 0, 3], &[(-2_i8) as u8, 2, 0, 4]]);
    let file = Maker::picture(uids::RLE_LOSSLESS, [4, 1], 16).pieces(&[], &[&words]);
    assert_eq!(greys(&shown(&file).unwrap()), [258.0, 258.0, 258.0, 772.0]);
    let long = runs(&[&[0, 1], &[0, 0], &[0, 0], &[0, 2, 0x80]]);
    let file = Maker::picture(uids::RLE_LOSSLESS, [1, 1], 32).pieces(&[], &[&long]);
    assert_eq!(greys(&shown(&file).unwrap()), [16_777_218.0]);
    let planes = runs(&[&[1, 9, 8], &[1, 7, 6], &[1, 5, 4]]);
    let file = Maker::colours(uids::RLE_LOSSLESS, [2, 1], "RGB")
        .text(tags::NUMBER_OF_FRAMES, VR::IS, "2")
        .pieces(&[], &[&planes, &planes]);
    assert_eq!(colours(&shown(&file).unwrap()), [[9, 7, 5], [8, 6, 4], [9, 7, 5], [8, 6, 4]]);
}

/// The small pictures in `streams`, compressed by other programs: 12 x 10 pixels, or 40 x 36.
macro_rules! stream {
    ($name:literal) => {
        include_bytes!(concat!("streams/", $name)).as_slice()
    };
}

/// Asserts that all values are within `by` of the original ones.
fn assert_near(values: &[f32], expected: impl Fn(usize, usize) -> i32, columns: usize, by: f32) {
    for (at, value) in values.iter().enumerate() {
        let expected = expected(at % columns, at / columns) as f32;
        assert!((value - expected).abs() <= by, "{value} is not {expected} at {at}");
    }
}

#[test]
fn grey_jpeg_is_read_in_each_process() {
    let twelve = |x: usize, y: usize| (300 * x + 20 * y) as i32;
    let cases = [
        (uids::JPEG_EXTENDED12_BIT, stream!("jpeg_12"), 1.0),
        (uids::JPEG_LOSSLESS_SV1, stream!("jpeg_lossless"), 0.0),
        (uids::JPEGLS_LOSSLESS, stream!("jpegls"), 0.0),
    ];
    for (uid, bytes, by) in cases {
        let file = Maker::picture(uid, [12, 10], 12).pieces(&[], &[bytes]);
        assert_near(&greys(&shown(&file).unwrap()), twelve, 12, by);
        let larger = Maker::picture(uid, [13, 10], 12).pieces(&[], &[bytes]);
        assert!(why(shown(&larger)).contains("they are 12 x 10"), "{uid}");
    }
    let file = Maker::picture(uids::JPEG_BASELINE8_BIT, [12, 10], 8).pieces(&[], &[stream!("jpeg_8")]);
    assert_near(&greys(&shown(&file).unwrap()), |x, y| (20 * x + y) as i32, 12, 2.0);
}

#[test]
fn jpeg_in_colours_is_read_whatever_its_transform() {
    for (name, bytes, by) in [("RGB", stream!("jpeg_rgb"), 2), ("YBR_FULL", stream!("jpeg_ybr"), 6)] {
        let file = Maker::colours(uids::JPEG_BASELINE8_BIT, [12, 10], name).pieces(&[], &[bytes]);
        for (at, colour) in colours(&shown(&file).unwrap()).iter().enumerate() {
            let (x, y) = (20 * (at % 12) as i32, 20 * (at / 12) as i32);
            let apart =
                colour.iter().zip([x, y, 255 - x]).map(|(one, other)| (i32::from(*one) - other).abs());
            assert!(apart.max() <= Some(by), "{name}: {colour:?} at {at}");
        }
    }
}

#[test]
fn jpeg_2000_keeps_signs() {
    let uid = uids::JPEG2000_LOSSLESS;
    let value = |x: usize, y: usize| (100 * x + 2 * y) as i32;
    let file = Maker::picture(uid, [40, 36], 12).pieces(&[], &[stream!("jpeg2000_12")]);
    assert_near(&greys(&shown(&file).unwrap()), value, 40, 0.0);
    let file = Maker::picture(uid, [40, 36], 16)
        .number(tags::PIXEL_REPRESENTATION, 1)
        .pieces(&[], &[stream!("jpeg2000_signed")]);
    assert_near(&greys(&shown(&file).unwrap()), |x, y| value(x, y) - 1000, 40, 0.0);
    let file = Maker::colours(uid, [40, 36], "YBR_RCT").pieces(&[], &[stream!("jpeg2000_rgb")]);
    let expected = |at: usize| [6 * (at % 40), 7 * (at / 40), 255 - 6 * (at % 40)].map(|value| value as u8);
    for (at, colour) in colours(&shown(&file).unwrap()).iter().enumerate() {
        assert_eq!(*colour, expected(at), "{at}");
    }
}

#[test]
fn frames_in_several_pieces_are_put_together() {
    let bytes = stream!("jpeg_lossless");
    let (head, tail) = bytes.split_at(100);
    let frames = |count: &str| {
        Maker::picture(uids::JPEG_LOSSLESS_SV1, [12, 10], 12).text(tags::NUMBER_OF_FRAMES, VR::IS, count)
    };
    let one = greys(&shown(&frames("1").pieces(&[], &[head, tail])).unwrap());
    let two = [one.clone(), one].concat();
    // By the table of frame offsets, with 8 bytes before each piece; and without one, by the starts of frames.
    let second = (bytes.len() + 2 * 8) as u32;
    for table in [[0, second].as_slice(), &[]] {
        let file = frames("2").pieces(table, &[head, tail, head, tail]);
        assert_eq!(greys(&shown(&file).unwrap()), two, "{table:?}");
    }
    assert!(why(shown(&frames("3").pieces(&[], &[head, tail]))).contains("3 frames in 2 pieces"));
    assert!(why(shown(&frames("2").pieces(&[], &[head, tail, tail]))).contains("it says 2"));
}

#[test]
fn a_deflated_file_is_read() {
    let file = Maker::picture(uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN, [2, 1], 8).pixels(VR::OB, &[5, 6]);
    let mut deflate = DeflateEncoder::new(Vec::new(), Compression::best());
    deflate.write_all(file.elements()).unwrap();
    let bytes = file.with_data(&deflate.finish().unwrap());
    assert_eq!(greys(&super::read_bytes(&bytes).unwrap()), [5.0, 6.0]);
}

#[test]
fn a_file_is_read_without_its_preamble_its_mark_or_all_that_says_how_it_is_written() {
    for uid in [EXPLICIT, IMPLICIT, BIG_ENDIAN] {
        let file = Maker::new(uid)
            .text(tags::MODALITY, VR::CS, "OT")
            .raw(Maker::picture(uid, [2, 1], 8).pixels(VR::OB, &[5, 6]).elements());
        let whole = file.file();
        let without_mark = [&whole[..128], &whole[132..]].concat();
        for bytes in [&whole, &whole[132..], &whole[128..], &without_mark] {
            let read = super::read_bytes(bytes).unwrap();
            assert_eq!(read.series.frames.len(), 1, "{uid}");
        }
        let read = super::read_bytes(file.elements()).unwrap();
        assert_eq!(read.series.title, "OT Untitled", "{uid}");
    }
}

#[test]
fn a_file_that_is_written_in_another_way_than_it_says_is_read() {
    let implicit = Maker::picture(IMPLICIT, [2, 1], 8).pixels(VR::OW, &[5, 6]);
    let bytes = Maker::new(EXPLICIT).with_data(implicit.elements());
    assert_eq!(greys(&super::read_bytes(&bytes).unwrap()), [5.0, 6.0]);
}

#[test]
fn formats_that_are_not_read_are_named_in_words() {
    let cases = [
        (uids::MPEG2MPML, "MPEG2 Main Profile / Main Level"),
        (uids::HTJ2K_LOSSLESS, "High-Throughput JPEG 2000"),
        (uids::JPEGXL_LOSSLESS, "JPEG XL"),
        (uids::EXPLICIT_VR_LITTLE_ENDIAN, "colours as “CMYK”"),
    ];
    for (uid, name) in cases {
        let file = Maker::colours(uid, [2, 1], "CMYK").pixels(VR::OB, &[0; 8]);
        let why = why(shown(&file));
        assert!(why.contains("in a format that is not read") && why.contains(name), "{why}");
    }
    let file = Maker::colours(uids::JPEGLS_LOSSLESS, [12, 10], "RGB").pieces(&[], &[stream!("jpegls_rgb")]);
    assert!(why(shown(&file)).ends_with("JPEG-LS in colours"));
    let unknown = Maker::picture("1.2.3.4", [1, 1], 8).pixels(VR::OB, &[0]);
    assert!(why(shown(&unknown)).contains("an unknown one with the identifier 1.2.3.4"));
    let plan = Maker::new(EXPLICIT).text(tags::SOP_CLASS_UID, VR::UI, uids::RT_PLAN_STORAGE);
    assert_eq!(why(shown(&plan)), "has no picture: it is a “RT Plan Storage” without pixels");
}

/// A picture of three frames of one pixel, with groups for all of them and for each.
fn enhanced(shared: &Maker, own: &[Maker]) -> Part {
    let file = Maker::picture(EXPLICIT, [1, 1], 8)
        .text(tags::NUMBER_OF_FRAMES, VR::IS, "3")
        .sequence(tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, std::slice::from_ref(shared))
        .sequence(tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE, own)
        .pixels(VR::OB, &[1, 2, 3]);
    shown(&file).unwrap()
}

#[test]
fn frames_have_what_their_groups_say() {
    let empty = Maker::new(EXPLICIT);
    let measures = |text| {
        let inside = Maker::new(EXPLICIT).text(tags::PIXEL_SPACING, VR::DS, text);
        Maker::new(EXPLICIT).sequence(tags::PIXEL_MEASURES_SEQUENCE, &[inside])
    };
    let plane = Maker::new(EXPLICIT).text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, "0\\1\\0\\0\\0\\-1");
    let scale = Maker::new(EXPLICIT).text(tags::RESCALE_INTERCEPT, VR::DS, "10").text(
        tags::RESCALE_SLOPE,
        VR::DS,
        "1",
    );
    let shared = measures("0.5\\0.25")
        .sequence(tags::PLANE_ORIENTATION_SEQUENCE, &[plane])
        .sequence(tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE, &[scale]);
    let part = enhanced(&shared, &[empty.clone(), measures("2\\3"), empty]);
    let spacings: Vec<_> = part.series.frames.iter().map(|frame| frame.plane.spacing_mm).collect();
    // Files give the distance between rows first; here the distance to the right comes first.
    assert_eq!(spacings, [Some([0.25, 0.5]), Some([3.0, 2.0]), Some([0.25, 0.5])]);
    let towards = part.series.frames[1].plane.towards.clone().unwrap();
    assert_eq!(towards, ["P", "F"], "a picture seen from the left");
    assert_eq!(greys(&part), [11.0, 12.0, 13.0]);
}

#[test]
fn letters_name_the_sides_of_the_body() {
    let towards = |text: &str| {
        let file = Maker::picture(EXPLICIT, [1, 1], 8)
            .text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, text)
            .pixels(VR::OB, &[1]);
        shown(&file).unwrap().series.frames[0].plane.towards.clone()
    };
    let letters = |right: &str, down: &str| Some([right.to_owned(), down.to_owned()]);
    assert_eq!(towards("1\\0\\0\\0\\1\\0"), letters("L", "P"), "a slice across, seen from the feet");
    assert_eq!(
        towards("1\\0\\0\\0\\0\\-1"),
        letters("L", "F"),
        "a slice from side to side, seen from in front"
    );
    // By 20 degrees, and by 10, which is below the limit for a letter.
    assert_eq!(towards("0.94\\0.342\\0\\0\\0\\-1"), letters("LP", "F"));
    assert_eq!(towards("-0.985\\0.174\\0\\0\\0\\-1"), letters("R", "F"));
    assert_eq!(towards("0\\0\\0\\0\\0\\0"), None);
    assert_eq!(["LP", "F", "A"].map(opposite), ["RA", "H", "P"]);
    let told = Maker::picture(EXPLICIT, [1, 1], 8)
        .text(tags::PATIENT_ORIENTATION, VR::CS, "A\\FR")
        .pixels(VR::OB, &[1]);
    assert_eq!(shown(&told).unwrap().series.frames[0].plane.towards, letters("A", "FR"));
}

#[test]
fn the_patient_is_named_with_the_day() {
    let file = |name: &str, day: &str| {
        Maker::new(EXPLICIT)
            .text(tags::SPECIFIC_CHARACTER_SET, VR::CS, "ISO_IR 192")
            .text(tags::STUDY_DATE, VR::DA, day)
            .text(tags::PATIENT_NAME, VR::PN, name)
            .text(tags::PATIENT_ID, VR::LO, "A 17")
            .raw(Maker::picture(EXPLICIT, [1, 1], 8).pixels(VR::OB, &[1]).elements())
    };
    let line = |name, day| shown(&file(name, day)).unwrap().series.about;
    assert_eq!(line("Doe^Jané^^Dr", "20240517"), "Doe, Jané, Dr   A 17   2024-05-17");
    assert_eq!(line("^^^^=山田^太郎", "2024.05.17"), "山田, 太郎   A 17   2024-05-17");
    assert_eq!(line("\u{202e}x\u{7}", "May"), "x   A 17");
}
