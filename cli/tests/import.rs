//! What `overact import` writes passes its check, with values that no body has, too.

mod common;

use common::Bench;
use std::{fs, path::Path};

fn model(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../interchange/tests/models");
    fs::read_to_string(folder.join(name)).expect("a model")
}

/// The description of a file.
fn imported(name: &str, text: &str, options: &[&str]) -> (Bench, String) {
    let bench = Bench::new();
    bench.write(name, text);
    bench.good(&[&["import", name, "-o", "my.toml"], options].concat());
    bench.good(&["check", "my.toml"]);
    let text = bench.read("my.toml");
    (bench, text)
}

#[test]
fn moments_that_no_body_has_are_no_prior() {
    // A rod of 2 kg whose centre is 0.15 m from the frame's origin has more than 0.02 kg m² about it, a crank of 1 kg
    // at 0.1 m more than 0.003 kg m².
    let lengths = ["--value", "L1=0.2,D3=0.5,L2=0.52,L3=0.25"];
    let table = model("arm.par");
    let (_, text) = imported("arm.par", &table, &lengths);
    assert!(text.contains("LEFT OUT"), "{text}");
    assert!(
        text.contains("of `j1_skeleton`, `j3_link3`: no body"),
        "{text}"
    );
    let (robot, prior) = text.split_once("[prior.values]").expect("a prior");
    assert!(robot.contains("xx_j3_link3 = 0.01"), "{text}");
    assert!(!prior.contains("xx_j3_link3"), "{text}");
    assert!(prior.contains("m_j3_link3 = 2.0"), "{text}");
    // With moments that it can have they are a prior.
    let (_, text) = imported(
        "arm.par",
        &table.replace("MX = {0.1,MX2,0.3}", "MX = {0.05,MX2,0.1}"),
        &lengths,
    );
    assert!(!text.contains("LEFT OUT"), "{text}");
    let (_, prior) = text.split_once("[prior.values]").expect("a prior");
    assert!(prior.contains("xx_j3_link3 = 0.01"), "{text}");
}

#[test]
fn masses_in_a_point_and_plates_are_no_prior() {
    let arm = model("arm.urdf");
    let given =
        r#"<inertia ixx="0.02" ixy="0.001" ixz="-0.002" iyy="0.025" iyz="0.0005" izz="0.018"/>"#;
    assert!(arm.contains(given));
    for other in [
        r#"<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>"#,
        r#"<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.04"/>"#,
        r#"<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="-0.01"/>"#,
    ] {
        let (_, text) = imported("arm.urdf", &arm.replace(given, other), &[]);
        let (_, prior) = text.split_once("[prior.values]").expect("a prior");
        assert!(!prior.contains("xx_yaw"), "{other}: {text}");
        assert!(prior.contains("m_yaw = 4.5"), "{other}: {text}");
    }
    let (_, text) = imported("arm.urdf", &arm, &[]);
    let (_, prior) = text.split_once("[prior.values]").expect("a prior");
    assert!(prior.contains("xx_yaw"), "{text}");
}
