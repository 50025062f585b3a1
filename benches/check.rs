//! The time for reading and checking a layout, for which a user waits after saving a file.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use underfoot::floor::{Floor, Geometry};
use underfoot::schema::{Kinds, parse_layout};
use underfoot_scene::ergonomics;

/// A layout of 500 controls on 24 x 24 tiles, each in an entry of its own; `wrong` puts an error into each.
fn page(wrong: bool) -> String {
    let kinds = ["button", "heavy_button", "round_button", "soft_button", "slider", "fader", "switch"];
    let mut text =
        String::from("Layout(version: 1, regions: [(id: \"all\", at: (0, 0), size: (24, 24))], widgets: [\n");
    for index in 0..500 {
        let (column, row) = (index % 23, index / 23);
        let size = if wrong { 0.3 } else { 0.7 };
        let kind = kinds[index % kinds.len()];
        let at = format!("({column}.1, {row}.1)");
        text.push_str(&format!(
            "    (id: \"control_{index}\", kind: \"{kind}\", at: {at}, size: ({size}, {size}), label: \"{index}\"),\n"
        ));
    }
    text + "])\n"
}

/// The work of `underfoot check` on one file after reading it.
fn check(text: &str, kinds: &Kinds, floor: &Floor) -> usize {
    match parse_layout(text, "page.ron", kinds, &floor.geometry) {
        Ok(loaded) => {
            let mut problems = loaded.warnings;
            problems.merge(ergonomics::locate(&loaded.places, &ergonomics::review(&loaded.layout, floor)));
            problems.to_string().len()
        }
        Err(problems) => problems.to_string().len(),
    }
}

fn checks(c: &mut Criterion) {
    let floor = Floor::of(Geometry::of_paper_tiles(24, 24).unwrap_or_default());
    let kinds = Kinds::builtin();
    let (good, poor) = (page(false), page(true));
    assert_eq!(check(&good, &kinds, &floor), 0, "nothing to say of the good one");
    assert!(check(&poor, &kinds, &floor) > 500, "much to say of the poor one");
    let mut group = c.benchmark_group("check");
    group.bench_function("500 controls, all well", |b| b.iter(|| check(black_box(&good), &kinds, &floor)));
    group.bench_function("500 controls, each too small", |b| {
        b.iter(|| check(black_box(&poor), &kinds, &floor));
    });
    group.finish();
}

criterion_group!(benches, checks);
criterion_main!(benches);
