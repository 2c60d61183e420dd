//! Contents of drawings; `library.rs` tests that those in `docs/robots` are up to date and
//! well-formed.

mod common;

use common::{Bench, robot};
use overact_tier::is_full;
use std::collections::BTreeMap;

/// Elements that a drawing must show, counted in the text.
#[test]
fn a_drawing_shows_legs_joints_and_platform() {
    let bench = Bench::new();
    let mut cases = vec![
        (
            "dualv",
            BTreeMap::from([(">M<", 5), ("class=\"ov-plate\"", 2), (">leg", 4)]),
        ),
        (
            "delta",
            BTreeMap::from([
                (">M<", 4),
                ("class=\"ov-plate\"", 2),
                (">leg", 3),
                ("class=\"ov-base\"", 1),
            ]),
        ),
        (
            "rx90",
            BTreeMap::from([(">M<", 7), ("class=\"ov-plate\"", 0), (">6<", 1)]),
        ),
    ];
    // The functions of a hexapod take seconds to derive.
    if is_full() {
        cases.push((
            "hexapod",
            BTreeMap::from([
                (">M<", 7),
                ("class=\"ov-plate\"", 2),
                (">leg", 6),
                ("class=\"ov-base\"", 1),
            ]),
        ));
    }
    for (name, counts) in cases {
        bench.good(&[
            "inspect",
            &robot(&format!("{name}.toml")),
            "--effort",
            "none",
            "--svg",
            "a.svg",
        ]);
        let drawing = bench.read("a.svg");
        for (text, count) in counts {
            // The legend shows each symbol once more.
            assert_eq!(drawing.matches(text).count(), count, "{text} in {name}");
        }
    }
}
