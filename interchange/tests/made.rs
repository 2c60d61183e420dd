//! Files of each format are imported as valid descriptions.

use overact_codegen::{Source, check};
use overact_interchange::{Options, import};
use std::path::{Path, PathBuf};

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/models")
        .join(name)
}

/// Text of the description and result of its check.
fn made(name: &str, options: &Options) -> (String, overact_codegen::Checked) {
    let imported = import(&model(name), options).expect("a robot that can be said");
    let source = Source::new("made.toml", imported.text.clone());
    match check(&source) {
        Ok(checked) => (imported.text, checked),
        Err(errors) => panic!("{}\n{}", errors.render_plain(&source), imported.text),
    }
}

#[test]
fn a_urdf_tree_becomes_a_serial_arm() {
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
fn mjcf_loops_become_chains_on_a_skeleton() {
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

#[test]
fn a_motor_on_a_chain_body_becomes_a_branch() {
    let (text, checked) = made("leg.xml", &Options::default());
    let mechanism = &checked.mechanism;
    assert_eq!((mechanism.dof(), mechanism.actuated().len()), (3, 3));
    assert_eq!(mechanism.coordinates(), ["hip", "knee", "foot.ankle"]);
    assert!(
        text.contains("A branch on `tarsus`, a body of a chain"),
        "{text}"
    );
    let experiment = checked.description.experiment.expect("an experiment");
    let names = experiment.runs[0].terms.iter();
    assert!(
        names
            .clone()
            .any(|term| term.coordinate.value == "foot.ankle")
    );
}

/// The four-bar of the table, with values for its symbolic lengths.
fn of_table() -> Options {
    let lengths = [("L1", 0.2), ("D3", 0.5), ("L2", 0.52), ("L3", 0.25)];
    Options {
        values: lengths
            .map(|(name, value)| (name.to_owned(), value))
            .to_vec(),
        ..Options::default()
    }
}

#[test]
fn opensymoro_tables_with_loops_are_imported() {
    let (text, checked) = made("arm.par", &of_table());
    let mechanism = &checked.mechanism;
    assert_eq!(
        (
            mechanism.dof(),
            mechanism.actuated().len(),
            mechanism.legs.len()
        ),
        (1, 1, 2)
    );
    assert!(text.contains("name = \"LoopArm\""), "{text}");
    assert!(text.contains("gravity = [0, 0, -9.81]"), "{text}");
    // The rocker's numbers are values; the rod's symbols are parameters without values.
    assert!(text.contains("m_j3_") && text.contains(" = 2.0"), "{text}");
    // The rod is connected to the joint that closes the loop.
    assert!(!text.contains("m_j4_"), "{text}");
    let joints = mechanism.legs.iter().flat_map(|leg| &leg.joints);
    let rod = joints.into_iter().find(|joint| joint.name == "j4");
    let parameters = &rod.expect("the rod's joint").parameters;
    assert!(parameters.len() >= 10, "{parameters:?}");
}

#[test]
fn imported_runs_stay_within_the_joint_limits() {
    for (name, coordinates) in [("arm.urdf", 4), ("ankle.xml", 2)] {
        let (text, checked) = made(name, &Options::default());
        let experiment = checked.description.experiment.expect("an experiment");
        assert_eq!(experiment.runs.len(), 3, "{text}");
        for run in &experiment.runs {
            assert_eq!(run.terms.len(), 5 * coordinates);
        }
        assert!(experiment.torque_noise.iter().all(|noise| *noise > 0.0));
    }
    // The slide's range is 0 to 0.2 m: home is in the middle, and runs stay within the range.
    let (text, checked) = made("arm.urdf", &Options::default());
    assert!(text.contains("home = { reach = 0.1 }"), "{text}");
    let experiment = checked.description.experiment.expect("an experiment");
    for run in &experiment.runs {
        let own = run.terms.iter().filter(|term| term.index == 2);
        let largest = (0..1000).map(|at| {
            let phase = |harmonic: f64| f64::from(at) / 1000.0 * std::f64::consts::TAU * harmonic;
            let values = own
                .clone()
                .map(|term| term.amplitude * (phase(f64::from(term.harmonic)) + term.phase).sin());
            values.sum::<f64>().abs()
        });
        let largest = largest.fold(0.0, f64::max);
        assert!((0.02..=0.1001).contains(&largest), "{largest}");
    }
}

#[test]
fn coupled_joints_keep_their_offset() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = |offset: &str| {
        let link = |name: &str| {
            format!(
                "<link name='{name}'><inertial><origin xyz='0.1 0 0'/><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>"
            )
        };
        let body = format!(
            "<robot name='r'><link name='o'/>{}{}<joint name='j' type='revolute'><parent link='o'/><child link='a'/>\
             <axis xyz='0 0 1'/></joint><joint name='k' type='revolute'><origin xyz='1 0 0'/><parent link='a'/>\
             <child link='b'/><axis xyz='0 0 1'/><mimic joint='j' multiplier='0.5'{offset}/></joint></robot>",
            link("a"),
            link("b")
        );
        let path = folder.path().join("follow.urdf");
        std::fs::write(&path, body).expect("a file");
        import(&path, &Options::default()).expect("a robot").text
    };
    // The centre of mass is 0.1 m along x of a body that is rotated by 0.3 rad when the leader is
    // at zero.
    let output = text(" offset='0.3'");
    assert!(output.contains("theta = \"0.5 * q_j\""), "{output}");
    let value = |name: &str| {
        let line = output
            .lines()
            .find_map(|line| line.strip_prefix(name))
            .expect(name);
        line.trim_start_matches(" = ")
            .parse::<f64>()
            .expect("a number")
    };
    assert!(
        (value("mx_k") - 0.1 * 0.3_f64.cos()).abs() < 1e-15,
        "{output}"
    );
    assert!(
        (value("my_k") - 0.1 * 0.3_f64.sin()).abs() < 1e-15,
        "{output}"
    );
    assert!(text("").contains("mx_k = 0.1\n"));
}
