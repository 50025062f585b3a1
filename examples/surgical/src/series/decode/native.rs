//! Uncompressed pixels, and the order of their samples.

use super::Samples;
use super::pieces::Bits;
use crate::series::form::{Colours, Form};
use crate::series::guard::Numbers;

/// The order of bytes.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    pub is_big_endian: bool,
    /// Whether bytes are written in pairs, which big-endian files swap.
    pub are_words: bool,
}

/// Number of bits of a frame.
pub fn bits_of_frame(form: &Form, numbers: Numbers) -> usize {
    let values = match form.colours {
        // Two brightnesses and one of each difference for two pixels.
        Colours::Ybr422 if numbers == Numbers::Whole => form.pixels().saturating_mul(2),
        _ => form.values(),
    };
    values.saturating_mul(form.allocated as usize)
}

/// The numbers of a frame.
pub fn decode(bits: &Bits, form: &Form, numbers: Numbers, order: Order) -> Samples {
    let pixels = form.pixels();
    let value = |index: usize| match numbers {
        Numbers::Whole => sample(form, whole(bits, index, form.allocated, order)),
        Numbers::Float => f32::from_bits(whole(bits, index, 32, order) as u32),
        Numbers::Double => f64::from_bits(whole(bits, index, 64, order)) as f32,
    };
    let values = (0..form.values()).map(|at| {
        let (pixel, part) = (at / form.samples, at % form.samples);
        value(match form.colours {
            // In the order Y1, Y2, Cb, Cr.
            Colours::Ybr422 if part == 0 => pixel / 2 * 4 + pixel % 2,
            Colours::Ybr422 => pixel / 2 * 4 + part + 1,
            _ if form.is_planar => part * pixels + pixel,
            _ => at,
        })
    });
    Samples { values: values.collect(), colours: form.colours, bits: form.stored }
}

/// The significant bits of a stored number, as its value.
pub fn sample(form: &Form, raw: u64) -> f32 {
    let low = form.high + 1 - form.stored;
    signed(raw >> low, form.stored, form.is_signed) as f32
}

/// The number in the lowest `bits` of `raw`, in two's complement if it is signed; 1 to 32 bits.
pub fn signed(raw: u64, bits: u32, is_signed: bool) -> i64 {
    let spare = 64 - bits;
    if is_signed { ((raw << spare) as i64) >> spare } else { ((raw << spare) >> spare) as i64 }
}

/// The number at this index, of `size` bits; missing bytes are zero.
fn whole(bits: &Bits, index: usize, size: u32, order: Order) -> u64 {
    let first = bits.first + index * size as usize;
    let byte = |at: usize| {
        let at = if order.is_big_endian && order.are_words && size <= 8 { at ^ 1 } else { at };
        u64::from(bits.bytes.get(at).copied().unwrap_or_default())
    };
    if size == 1 {
        return byte(first / 8) >> (first % 8) & 1;
    }
    let (start, count) = (first / 8, size as usize / 8);
    (0..count).fold(0, |number, at| {
        let place = if order.is_big_endian { count - 1 - at } else { at };
        number | byte(start + at) << (8 * place)
    })
}
