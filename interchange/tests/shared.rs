//! Public robot models from a folder next to the repository are imported as valid descriptions, or
//! rejected by name.

use overact_codegen::{Source, check};
use overact_interchange::{Imported, Options, import};
use std::path::{Path, PathBuf};

/// Folder of the models, if it exists.
fn shared() -> Option<PathBuf> {
    let default_folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let folder = std::env::var_os("OVERACT_SHARED")
        .map_or(default_folder, PathBuf::from)
        .join("models");
    if !folder.is_dir() {
        eprintln!("skipped: there are no models in {}", folder.display());
        return None;
    }
    Some(folder)
}

/// Models with their degrees of freedom, motors, legs and joints.
const ACCEPTED: [(&str, [usize; 4]); 10] = [
    ("ankles/g1.xml", [2, 2, 3, 11]),
    ("ankles/tiangong.xml", [2, 2, 3, 8]),
    ("reachy_mini/reachy_mini.xml", [9, 9, 6, 24]),
    (
        "example-parallel-robots/5bar_linkage/robot.urdf",
        [2, 2, 2, 4],
    ),
    (
        "example-parallel-robots/5bar_linkage_iso3d/robot.urdf",
        [2, 2, 2, 5],
    ),
    (
        "example-parallel-robots/5bar_linkage_iso6d/robot.urdf",
        [2, 2, 2, 5],
    ),
    (
        "example-parallel-robots/robot_delta/robot.urdf",
        [2, 2, 4, 8],
    ),
    (
        "example-parallel-robots/talos_like/robot.urdf",
        [6, 6, 3, 9],
    ),
    (
        "example-parallel-robots/cassie_like/robot.urdf",
        [5, 5, 4, 11],
    ),
    (
        "example-parallel-robots/digit_like/robot.urdf",
        [6, 6, 6, 15],
    ),
];

/// Rejected models with a part of the reason.
const REFUSED: [(&str, &str); 1] = [(
    "example-parallel-robots/disney_like/robot.urdf",
    "the robot has 7 degrees of freedom, and 6 motors",
)];

#[test]
fn published_models_pass_check_with_known_sizes() {
    let Some(folder) = shared() else { return };
    for (name, sizes) in ACCEPTED {
        let Imported { text, .. } = import(&folder.join(name), &Options::default())
            .unwrap_or_else(|errors| panic!("{name}: {errors:?}"));
        let source = Source::new("made.toml", text);
        let checked = match check(&source) {
            Ok(checked) => checked.mechanism,
            Err(errors) => panic!("{name}: {}", errors.render_plain(&source)),
        };
        let found = [
            checked.dof(),
            checked.actuated().len(),
            checked.legs.len(),
            checked.joints().len(),
        ];
        assert_eq!(found, sizes, "{name}");
    }
}

#[test]
fn unsupported_published_models_are_rejected_with_a_reason() {
    let Some(folder) = shared() else { return };
    for (name, reason) in REFUSED {
        let errors = import(&folder.join(name), &Options::default()).expect_err(name);
        let rendered =
            |(source, errors): &(Source, overact_codegen::Diagnostics)| errors.render_plain(source);
        let text: String = errors.0.iter().map(rendered).collect();
        assert!(text.contains(reason), "{name}: {text}");
    }
}

#[test]
fn import_is_deterministic() {
    let Some(folder) = shared() else { return };
    let made = || {
        import(&folder.join("ankles/g1.xml"), &Options::default())
            .expect("an ankle")
            .text
    };
    assert_eq!(made(), made());
}

#[test]
fn included_files_give_the_same_robot() {
    let Some(folder) = shared().filter(|_| overact_tier::is_full()) else {
        return;
    };
    let made = |name: &str| {
        let options = Options {
            name: Some("mini".to_owned()),
            ..Options::default()
        };
        let text = import(&folder.join(name), &options).expect("a robot").text;
        // Comments and the name of the file differ.
        let kept = text.lines().filter(|line| !line.starts_with(['#', 's']));
        kept.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(
        made("reachy_mini/scene.xml"),
        made("reachy_mini/reachy_mini.xml")
    );
}
