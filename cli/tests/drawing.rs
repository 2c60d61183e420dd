//! Drawings: those of `docs/robots` are fresh, and every robot's is a sound SVG text.

mod common;

use common::{Bench, robot};
use std::{collections::BTreeMap, fs, path::Path};

/// Names of the library's robots.
fn robots() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let entries = fs::read_dir(folder).expect("the robots");
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
        .filter_map(|name| Some(name.strip_suffix(".toml")?.to_owned()))
        .collect();
    names.sort();
    assert!(!names.is_empty());
    names
}

/// Every element is closed in its order, and numbers are numbers.
fn assert_sound(svg: &str, name: &str) {
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    assert!(
        !svg.contains("http") || svg.matches("http").count() == 1,
        "{name}: only its own namespace"
    );
    let mut open: Vec<&str> = Vec::new();
    for tag in svg.split('<').skip(1) {
        let inside = tag.split('>').next().unwrap_or_default();
        let word = inside
            .split([' ', '/'])
            .find(|w| !w.is_empty())
            .unwrap_or_default();
        if inside.starts_with('/') {
            assert_eq!(open.pop(), Some(word), "{name}");
        } else if !inside.ends_with('/') {
            open.push(word);
        }
    }
    assert!(open.is_empty(), "{name}: {open:?}");
}

#[test]
fn drawings_of_the_library_are_fresh() {
    let bench = Bench::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/robots");
    for name in robots() {
        bench.good(&["inspect", &robot(&format!("{name}.toml")), "--svg", "a.svg"]);
        let drawing = bench.read("a.svg");
        assert_sound(&drawing, &name);
        let kept = fs::read_to_string(folder.join(format!("{name}.svg"))).unwrap_or_default();
        assert!(
            kept == drawing,
            "docs/robots/{name}.svg: renew it with `overact inspect robots/{name}.toml --svg docs/robots/{name}.svg`"
        );
    }
    let kept = fs::read_dir(folder).expect("the drawings").count();
    assert_eq!(kept, robots().len(), "no drawing without a robot");
}

/// What a drawing has to show, counted in the text.
#[test]
fn a_drawing_shows_legs_joints_and_platform() {
    let bench = Bench::new();
    let cases = [
        (
            "dualv",
            BTreeMap::from([(">M<", 5), ("class=\"ov-plate\"", 2), (">leg", 4)]),
        ),
        (
            "hexapod",
            BTreeMap::from([
                (">M<", 7),
                ("class=\"ov-plate\"", 2),
                (">leg", 6),
                ("class=\"ov-base\"", 1),
            ]),
        ),
        (
            "rx90",
            BTreeMap::from([(">M<", 7), ("class=\"ov-plate\"", 0), (">6<", 1)]),
        ),
    ];
    for (name, counts) in cases {
        bench.good(&["inspect", &robot(&format!("{name}.toml")), "--svg", "a.svg"]);
        let drawing = bench.read("a.svg");
        for (text, count) in counts {
            // The legend shows each symbol once more.
            assert_eq!(drawing.matches(text).count(), count, "{text} in {name}");
        }
    }
}
