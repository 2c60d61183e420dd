//! Files of each format become descriptions that pass their check.

use overact_codegen::{Source, check};
use overact_interchange::{Options, import};
use std::path::{Path, PathBuf};

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/models")
        .join(name)
}

/// The text and what its check finds.
fn made(name: &str, options: &Options) -> (String, overact_codegen::Checked) {
    let imported = import(&model(name), options).expect("a robot that can be said");
    let source = Source::new("made.toml", imported.text.clone());
    match check(&source) {
        Ok(checked) => (imported.text, checked),
        Err(errors) => panic!("{}\n{}", errors.render_plain(&source), imported.text),
    }
}

#[test]
fn a_tree_of_urdf_is_an_arm() {
    let (text, checked) = made("arm.urdf", &Options::default());
    let mechanism = &checked.mechanism;
    assert!(mechanism.is_tree());
    assert_eq!(mechanism.dof(), 4);
    let names: Vec<&str> = mechanism.legs[0]
        .joints
        .iter()
        .map(|j| j.name.as_str())
        .collect();
    assert_eq!(names, ["yaw", "lift", "reach", "grip"]);
    assert!(text.contains("fv_yaw = 0.4"), "{text}");
    assert!(
        text.contains("m_reach = 1.5"),
        "the tool's mass is part of the slider's: {text}"
    );
}

#[test]
fn loops_of_mjcf_are_chains_on_a_skeleton() {
    let (text, checked) = made("ankle.xml", &Options::default());
    let mechanism = &checked.mechanism;
    assert_eq!(
        (
            mechanism.dof(),
            mechanism.actuated().len(),
            mechanism.legs.len()
        ),
        (2, 2, 3)
    );
    assert_eq!(mechanism.coordinates(), ["pitch", "roll"]);
    assert!(text.contains("ia_left_motor_left_crank = 0.01"), "{text}");
    assert!(text.contains("gear 2"), "{text}");
    assert!(text.contains("spins freely"), "{text}");
}
