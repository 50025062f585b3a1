//! Files with claims beyond their size.

use std::io::Write;

use dicom_core::{Tag, VR};
use dicom_dictionary_std::{tags, uids};
use flate2::Compression;
use flate2::write::DeflateEncoder;
use proptest::prelude::*;

use super::make::{BIG_ENDIAN, Maker, OPEN};
use super::{read_bytes, shown};
use crate::series::unfit::Unfit;

const EXPLICIT: &str = uids::EXPLICIT_VR_LITTLE_ENDIAN;
const IMPLICIT: &str = uids::IMPLICIT_VR_LITTLE_ENDIAN;
const ITEM: Tag = Tag(0xfffe, 0xe000);

fn is_damaged(file: &Maker) -> String {
    match shown(file) {
        Err(Unfit::Damaged(why)) => why,
        other => panic!("{other:?}"),
    }
}

fn has_bad_pixels(file: &Maker) -> String {
    match shown(file) {
        Err(Unfit::Pixels(why)) => why,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_length_beyond_the_file_is_told_with_its_element() {
    for uid in [EXPLICIT, IMPLICIT, BIG_ENDIAN] {
        let file = Maker::picture(uid, [2, 1], 8).head(tags::PIXEL_DATA, VR::OB, 0xffff_fffe).raw(&[1, 2]);
        assert_eq!(is_damaged(&file), "PixelData says 4294967294 bytes, and 2 are left", "{uid}");
        let file = Maker::new(uid).head(tags::PATIENT_NAME, VR::UT, 0x7fff_ffff).raw(b"Doe");
        assert_eq!(is_damaged(&file), "PatientName says 2147483647 bytes, and 3 are left", "{uid}");
    }
}

#[test]
fn a_length_that_is_not_told_is_no_allocation() {
    for uid in [EXPLICIT, IMPLICIT, BIG_ENDIAN] {
        // A text, words, and pixels that are not in pieces.
        for (tag, vr) in [(tags::PATIENT_NAME, VR::UT), (tags::LUT_DATA, VR::OW), (tags::PIXEL_DATA, VR::OW)]
        {
            let file = Maker::new(uid).head(tag, vr, OPEN).raw(&[7; 600]);
            is_damaged(&file);
        }
    }
}

#[test]
fn a_length_inside_a_sequence_stays_inside() {
    for uid in [EXPLICIT, IMPLICIT, BIG_ENDIAN] {
        let inside = Maker::new(uid).head(tags::PIXEL_SPACING, VR::UT, 1000).raw(b"1\\1 ");
        let group = Maker::new(uid).sequence(tags::PIXEL_MEASURES_SEQUENCE, &[inside]);
        let file = Maker::picture(uid, [2, 1], 8)
            .sequence(tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, &[group])
            .pixels(VR::OW, &[0; 2000]);
        assert_eq!(is_damaged(&file), "PixelSpacing says 1000 bytes, and 4 are left", "{uid}");
    }
}

#[test]
fn sequences_in_sequences_end_somewhere() {
    for uid in [EXPLICIT, IMPLICIT, BIG_ENDIAN] {
        let mut file = Maker::new(uid);
        for _ in 0..100_000 {
            file = file.head(tags::PIXEL_MEASURES_SEQUENCE, VR::SQ, OPEN).head(ITEM, VR::UN, OPEN);
        }
        assert_eq!(is_damaged(&file), "its sequences are nested more than 32 deep", "{uid}");
    }
}

#[test]
fn a_file_has_no_more_elements_than_fit_into_memory() {
    let mut item = Maker::new(IMPLICIT);
    for _ in 0..1_000_000 {
        item = item.raw(&[0x28, 0, 0x30, 0, 0, 0, 0, 0]);
    }
    let file = Maker::new(IMPLICIT).sequence(tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, &[item]);
    assert_eq!(is_damaged(&file), "it has more than 1000000 elements");
}

#[test]
fn deflated_zeros_are_not_inflated_without_end() {
    let mut deflate = DeflateEncoder::new(Vec::new(), Compression::fast());
    let zeros = vec![0; 1 << 20];
    for _ in 0..257 {
        deflate.write_all(&zeros).unwrap();
    }
    let file = Maker::new(uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN).with_data(&deflate.finish().unwrap());
    let unfit = read_bytes(&file).unwrap_err();
    assert_eq!(unfit.to_string(), "is a damaged DICOM file: it becomes more than 256 MiB inflated");
}

#[test]
fn frames_that_are_not_there_are_not_made_room_for() {
    let picture = |size, frames: &str| {
        Maker::picture(EXPLICIT, size, 8).text(tags::NUMBER_OF_FRAMES, VR::IS, frames).pixels(VR::OB, &[0; 8])
    };
    assert!(matches!(shown(&picture([65_535, 65_535], "1")), Err(Unfit::Full)));
    assert!(matches!(shown(&picture([2, 1], "2147483647")), Err(Unfit::Full)));
    assert_eq!(has_bad_pixels(&picture([2, 2], "1000000")), "they need 4000000 bytes, and 8 are there");
}

#[test]
fn pieces_stay_inside_the_file() {
    let picture = Maker::picture(uids::RLE_LOSSLESS, [2, 1], 8).head(tags::PIXEL_DATA, VR::OB, OPEN);
    let table = picture.clone().head(ITEM, VR::UN, 0xffff_fff0);
    assert_eq!(is_damaged(&table), "an item says 4294967280 bytes, and 0 are left");
    let open = picture.clone().head(ITEM, VR::UN, 0).head(ITEM, VR::UN, OPEN).raw(&[0; 100]);
    assert_eq!(is_damaged(&open), "its compressed pixels are not in pieces of known length");
    let ends = picture.head(ITEM, VR::UN, 0).head(ITEM, VR::UN, 8).raw(&[0; 8]);
    assert_eq!(has_bad_pixels(&ends), "the table of runs is cut");
}

#[test]
fn runs_are_no_more_than_their_bytes_can_hold() {
    let table = |count: u32, start: u32| {
        let mut words = [0; 16];
        (words[0], words[1]) = (count, start);
        words.iter().flat_map(|word: &u32| word.to_le_bytes()).collect::<Vec<u8>>()
    };
    let file = |size, bytes: &[u8]| Maker::picture(uids::RLE_LOSSLESS, size, 8).pieces(&[], &[bytes]);
    let many = table(u32::MAX, 64);
    assert_eq!(has_bad_pixels(&file([2, 1], &many)), "there are 4294967295 segments of runs, where 1 belong");
    let beyond = table(1, 1 << 31);
    assert_eq!(has_bad_pixels(&file([2, 1], &beyond)), "a segment of runs is cut");
    let short = [table(1, 64), vec![0x81, 7]].concat();
    assert_eq!(has_bad_pixels(&file([400, 1], &short)), "a segment of runs is too short for as many pixels");
    assert_eq!(
        has_bad_pixels(&file([2049, 2049], &short)),
        "4198401 of them can't be in 66 compressed bytes"
    );
}

/// A JPEG 2000 codestream of one component with 8 bits that has headers and no data.
fn codestream(size: u32, tile: u32, block: u8, precincts: &[u8]) -> Vec<u8> {
    let levels = precincts.len().saturating_sub(1) as u8;
    let long = |numbers: &[u32]| numbers.iter().flat_map(|number| number.to_be_bytes()).collect::<Vec<u8>>();
    let segment = |mark: u8, inside: &[u8]| {
        [&[0xff, mark], (inside.len() as u16 + 2).to_be_bytes().as_slice(), inside].concat()
    };
    let sizes = [&[0, 0], long(&[size, size, 0, 0, tile, tile, 0, 0]).as_slice(), &[0, 1, 7, 1, 1]].concat();
    let is_small = u8::from(!precincts.is_empty());
    let coding = [&[is_small, 0, 0, 1, 0, levels, block, block, 0, 1], precincts].concat();
    let steps = vec![64; 3 * usize::from(levels) + 1];
    let part = segment(0x90, &[0, 0, 0, 0, 0, 0, 0, 1]);
    let quantised = [vec![0x40], steps].concat();
    let heads = [segment(0x51, &sizes), segment(0x52, &coding), segment(0x5c, &quantised), part];
    [vec![0xff, 0x4f], heads.concat(), vec![0xff, 0x93, 0x80, 0xff, 0xd9]].concat()
}

#[test]
fn jpeg_2000_is_bounded_by_what_the_file_says() {
    let file = |size, stream: &[u8]| Maker::picture(uids::JPEG2000, [size; 2], 8).pieces(&[], &[stream]);
    let whole = codestream(64, 64, 4, &[]);
    assert!(shown(&file(64, &whole)).is_ok(), "a picture without data is grey");
    let huge = codestream(1 << 30, 1 << 30, 4, &[]);
    assert!(has_bad_pixels(&file(64, &huge)).starts_with("they are 1073741824 x 1073741824"));
    for stream in
        [codestream(2000, 7, 4, &[]), codestream(2000, 2000, 4, &[0]), codestream(2000, 2000, 4, &[1, 0])]
    {
        let why = has_bad_pixels(&file(2000, &stream));
        assert_eq!(why, "JPEG 2000 in too many small parts");
    }
    // A tile part with a length below that of its own header would never end.
    let mut looped = whole;
    let at = looped.windows(2).position(|mark| mark == [0xff, 0x90]).unwrap();
    looped[at + 6..at + 10].copy_from_slice(&[0, 0, 0, 2]);
    assert!(has_bad_pixels(&file(64, &looped)).contains("head of a JPEG 2000"));
}

#[test]
fn a_jpeg_does_not_go_over_its_picture_without_end() {
    let bytes = include_bytes!("streams/jpeg_8");
    let scan = bytes.windows(2).position(|mark| mark == [0xff, 0xda]).unwrap();
    let scans = [bytes.as_slice(), &bytes[scan..].repeat(200)].concat();
    let file = Maker::picture(uids::JPEG_BASELINE8_BIT, [12, 10], 8).pieces(&[], &[&scans]);
    assert_eq!(has_bad_pixels(&file), "its JPEG goes over the picture 201 times");
}

/// Whole files of several kinds.
fn wholes() -> Vec<Vec<u8>> {
    let group = |uid| {
        let measures = Maker::new(uid).text(tags::PIXEL_SPACING, VR::DS, "1\\2");
        Maker::new(uid).sequence(tags::PIXEL_MEASURES_SEQUENCE, &[measures])
    };
    let natives = [EXPLICIT, IMPLICIT, BIG_ENDIAN].map(|uid| {
        Maker::picture(uid, [4, 2], 16)
            .text(tags::NUMBER_OF_FRAMES, VR::IS, "2")
            .sequence(tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, &[group(uid)])
            .pixels(VR::OW, &[9; 32])
    });
    let runs =
        [[1, 0, 0, 0, 64, 0, 0, 0].as_slice(), [0; 56].as_slice(), [0xfd, 7, 3, 1, 2, 3, 4].as_slice()]
            .concat();
    let packed: [(&str, [u16; 2], u16, &[u8]); 7] = [
        (uids::RLE_LOSSLESS, [4, 2], 8, &runs),
        (uids::JPEG_BASELINE8_BIT, [12, 10], 8, include_bytes!("streams/jpeg_8")),
        (uids::JPEG_EXTENDED12_BIT, [12, 10], 12, include_bytes!("streams/jpeg_12")),
        (uids::JPEG_LOSSLESS_SV1, [12, 10], 12, include_bytes!("streams/jpeg_lossless")),
        (uids::JPEGLS_LOSSLESS, [12, 10], 12, include_bytes!("streams/jpegls")),
        (uids::JPEG2000_LOSSLESS, [40, 36], 12, include_bytes!("streams/jpeg2000_12")),
        (uids::JPEG2000_LOSSLESS, [40, 36], 16, include_bytes!("streams/jpeg2000_signed")),
    ];
    let packed = packed.map(|(uid, size, bits, bytes)| Maker::picture(uid, size, bits).pieces(&[], &[bytes]));
    let files: Vec<Vec<u8>> = natives.iter().chain(&packed).map(Maker::file).collect();
    for file in &files {
        read_bytes(file).unwrap();
    }
    files
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The reader shows or refuses a damaged file; it neither fails nor loops for ever.
    #[test]
    fn damaged_files_are_shown_or_refused(
        kind in 0_usize..10,
        changes in proptest::collection::vec((0.0_f64..1.0, any::<u8>()), 1..6),
        cut in proptest::option::weighted(0.2, 0.0_f64..1.0),
    ) {
        thread_local! {
            static WHOLES: Vec<Vec<u8>> = wholes();
        }
        let mut bytes = WHOLES.with(|wholes| wholes[kind].clone());
        for (place, value) in changes {
            // Behind the preamble, which is not read.
            let at = 128 + (place * (bytes.len() - 128) as f64) as usize;
            bytes[at] = value;
        }
        if let Some(share) = cut {
            bytes.truncate((share * bytes.len() as f64) as usize);
        }
        let _ = read_bytes(&bytes);
    }
}
