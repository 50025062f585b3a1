//! The shipped layouts and kinds, and everything that can be wrong with a file.

use underfoot::floor::Geometry;
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};

#[test]
fn every_shipped_layout_reads_without_a_warning() {
    let kinds = Kinds::builtin();
    assert!(kinds.get("button").is_some());
    for name in builtin_layouts() {
        let text = builtin_layout(name).unwrap();
        match parse_layout(text, name, &kinds, &Geometry::default()) {
            Ok(loaded) => assert!(loaded.warnings.is_empty(), "{}", loaded.warnings),
            Err(problems) => panic!("{problems}"),
        }
    }
}
