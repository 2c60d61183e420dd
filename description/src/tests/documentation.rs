//! `robots/README.md` documents exactly the keys that the reader knows.
//!
//! The known keys come from the reader: an unknown key is answered with a list of them.

use super::listed;
use crate::diagnostic::Source;
use crate::expressions::dimension::UNITS;
use crate::expressions::function::FUNCTIONS;
use overact_core::StandardParameter;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A robot with an unknown key in every table; each is named after the section that documents it.
const UNKNOWN: &str = r#"
zzzz0 = 1
name = "Unknown"
[platform]
zzzz1 = 1
motion = "fixed axis"
axis = { zzzz2 = 1, direction = "x" }
[platform.payload]
zzzz3 = 1
[leg.slide]
zzzz4 = 1
[leg.slide.base]
zzzz5 = 1
[leg.slide.end]
zzzz6 = 1
[[leg.slide.joint]]
zzzz7 = 1
type = "prismatic"
alpha = "90 deg"
actuated = true
[[leg.slide.motor]]
zzzz16 = 1
turns = "q1"
[[place]]
zzzz8 = 1
name = "slide"
shape = "slide"
[identification]
zzzz9 = 1
[data]
zzzz10 = 1
time = "t"
positions = ["q"]
torques = ["f"]
[controller]
zzzz15 = 1
reference = ["qd"]
position_gain = 1
velocity_gain = 1
[prior]
zzzz17 = 1
[excitation]
zzzz18 = 1
[[spring]]
zzzz19 = 1
name = "gas"
from = { zzzz20 = 1, body = "ground" }
to = { body = "platform" }
force = "l"
[payload.box]
zzzz21 = 1
[experiment]
zzzz11 = 1
[experiment.drives]
zzzz12 = 1
[[experiment.run]]
zzzz13 = 1
name = "run"
fundamental = 1
terms = [{ zzzz14 = 1, coordinate = "x", harmonic = 1, amplitude = 1 }]
"#;

/// Headings, in the order of the unknown keys, and the text before the keys there.
const SECTIONS: [(&str, &str); 22] = [
    ("## The robot", ""),
    ("### `[platform]`", ""),
    ("### `[platform]`", "axis."),
    ("### `[platform.payload]`", ""),
    ("### `[leg.NAME]`: a leg, written once", ""),
    ("### `[leg.NAME.base]`", ""),
    ("### `[leg.NAME.end]`", ""),
    ("### `[[leg.NAME.joint]]`: its joints, from the base on", ""),
    ("### `[[place]]`: placements", ""),
    ("## `[identification]`", ""),
    ("## `[data]`: a measured log", ""),
    ("## `[experiment]`: a virtual experiment", ""),
    ("### `[experiment.drives]`", ""),
    ("### `[[experiment.run]]`", ""),
    ("### A term", ""),
    ("## `[controller]`: the loops of the drives", ""),
    (
        "### `[[leg.NAME.motor]]`: motors that turn several joints",
        "",
    ),
    ("## `[prior]`: prior values and bounds", ""),
    ("## `[excitation]`: limits of exciting runs", ""),
    (
        "### `[[spring]]`: springs and dampers between two points",
        "",
    ),
    (
        "### `[[spring]]`: springs and dampers between two points",
        "from.",
    ),
    ("### `[payload.NAME]`: payloads on bodies", ""),
];

/// Keys of cables, which a leg with joints does not have.
const CABLES: [&str; 3] = ["drum", "minimum", "pulley"];

fn folder(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn documentation() -> String {
    fs::read_to_string(folder("../robots/README.md")).expect("the documentation")
}

/// The known keys of each table.
fn known() -> Vec<Vec<String>> {
    let errors = listed(UNKNOWN);
    let keys = |index: usize| {
        let message = format!("unknown key `zzzz{index}`; known keys: ");
        let keys = errors.iter().find_map(|e| e.split_once(&message));
        let (_, keys) = keys.unwrap_or_else(|| panic!("{message} in {errors:#?}"));
        keys.split(", ").map(str::to_owned).collect()
    };
    (0..SECTIONS.len()).map(keys).collect()
}

/// The lines of a section, without its subsections.
fn section<'t>(text: &'t str, heading: &str) -> Vec<&'t str> {
    let mut lines = text.lines().skip_while(|line| *line != heading);
    assert!(lines.next().is_some(), "no section {heading}");
    lines.take_while(|line| !line.starts_with('#')).collect()
}

/// The keys in the first column of a section's tables.
fn rows(text: &str, heading: &str) -> BTreeSet<String> {
    let first = |line: &&str| {
        line.strip_prefix("| `")?
            .split_once("` |")
            .map(|(key, _)| key.to_owned())
    };
    let lines = section(text, heading);
    // The tables under `| motion |` or `| symbols |` contain values, not keys.
    let header = |line: &&str| line.starts_with("| ") && !line.starts_with("| `");
    let mut is_keys = false;
    let mut keys = BTreeSet::new();
    for line in &lines {
        if header(line) && !line.starts_with("| each") {
            is_keys = line.starts_with("| key |");
        }
        keys.extend(first(line).filter(|_| is_keys));
    }
    keys
}

#[test]
fn the_manual_documents_exactly_the_accepted_keys() {
    let text = documentation();
    let headings: Vec<&str> = text.lines().filter(|line| line.starts_with('#')).collect();
    for (section, keys) in SECTIONS.iter().zip(known()) {
        let (heading, before) = section;
        let rows = rows(&text, heading);
        for key in &keys {
            // A table key has a section instead.
            let opening = format!("[{key}");
            let has_section = before.is_empty()
                && headings.iter().any(|line| {
                    line.split_once(&opening)
                        .is_some_and(|(_, rest)| rest.starts_with([']', '.']))
                });
            let row = format!("{before}{key}");
            assert!(
                rows.contains(&row) || has_section,
                "`{row}` is missing under {heading}"
            );
        }
        let undocumented: Vec<&String> = rows
            .iter()
            .filter(|row| match row.strip_prefix(before) {
                Some(key) if !before.is_empty() => !keys.iter().any(|known| known == key),
                _ => before.is_empty() && !row.contains('.') && !keys.contains(row),
            })
            .collect();
        assert!(
            undocumented.is_empty(),
            "no keys: {undocumented:?} under {heading}"
        );
    }
}

#[test]
fn cable_keys_are_documented() {
    let rows = rows(&documentation(), "#### Cables");
    for key in CABLES {
        assert!(rows.contains(key), "`{key}` is missing");
    }
}

/// All tables are in the tests above; keys of other tables would not have to be documented.
#[test]
fn all_tables_of_the_reader_are_tested() {
    let mut known: BTreeSet<String> = known().into_iter().flatten().collect();
    known.extend(CABLES.map(str::to_owned));
    // Coordinates of homes are in the table of motions; a file of parameters is no description.
    known.extend(
        [
            "x",
            "y",
            "z",
            "phi",
            "rx",
            "ry",
            "rz",
            "parameters",
            "robot",
        ]
        .map(str::to_owned),
    );
    let mut seen = 0;
    let folders = ["src", "src/robot", "src/experiments", "src/toml_text"];
    let entries = folders.map(|name| fs::read_dir(folder(name)).expect("the reader"));
    for entry in entries.into_iter().flatten() {
        let path = entry.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "rs") {
            continue;
        }
        let code = fs::read_to_string(&path).expect("a module");
        for call in ["get(\"", "require(\""] {
            for rest in code.split(call).skip(1) {
                let key = rest.split('"').next().unwrap_or_default();
                assert!(
                    known.contains(key),
                    "`{key}` of {} is read in a table that this test does not visit",
                    path.display()
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 20, "the reader asks for keys in another way: {seen}");
}

#[test]
fn accepted_words_of_values_are_documented() {
    let text = documentation();
    let quoted: BTreeSet<&str> = text
        .split('`')
        .skip(1)
        .step_by(2)
        .flat_map(|code| code.split([' ', ',']))
        .map(|word| word.trim_matches('"'))
        .collect();
    let words = UNITS.iter().chain(&FUNCTIONS).copied();
    let all = StandardParameter::ALL.iter();
    let symbols = all.chain(&StandardParameter::DIRECTED).map(|p| p.name());
    let others = [
        "inertia",
        "friction",
        "k",
        "fst",
        "fl",
        "fq",
        "all",
        "revolute",
        "prismatic",
        "fixed",
        "rigid",
        "point",
    ];
    for word in words.chain(symbols).chain(others) {
        assert!(quoted.contains(word), "`{word}`");
    }
    for motion in [
        "fixed axis",
        "point",
        "planar",
        "translation",
        "schoenflies",
        "spherical",
        "spatial",
    ] {
        assert!(text.contains(&format!("| `{motion}` |")), "{motion}");
    }
}

/// Pictures exist, and the first example is a description.
#[test]
fn pictures_exist_and_the_first_example_is_valid() {
    let text = documentation();
    let pictures: Vec<&str> = text
        .split("](../docs/")
        .skip(1)
        .filter_map(|t| t.split(')').next())
        .collect();
    assert!(pictures.len() > 8, "{pictures:?}");
    for link in pictures {
        let (file, _) = link.split_once('#').unwrap_or((link, ""));
        assert!(folder("../docs").join(file).is_file(), "{link}");
    }
    let example = text
        .split("```toml\n")
        .nth(1)
        .and_then(|t| t.split("```").next());
    let source = Source::new("example.toml", example.expect("an example"));
    let description =
        crate::parse(&source).unwrap_or_else(|errors| panic!("{}", errors.render_plain(&source)));
    let joints = description.legs.iter().flat_map(|leg| &leg.joints);
    assert_eq!(joints.filter(|joint| joint.actuated).count(), 2);
}
