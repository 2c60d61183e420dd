//! The output of `overact import` passes `check`, also with inconsistent inertias.

mod common;

use common::Bench;
use overact_tier::by_tier;
use std::{fs, path::Path};

fn model(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../interchange/tests/models");
    fs::read_to_string(folder.join(name)).expect("a model")
}

/// Description of an imported file.
fn imported(name: &str, text: &str, options: &[&str]) -> (Bench, String) {
    let bench = Bench::new();
    bench.write(name, text);
    bench.good(&[&["import", name, "-o", "my.toml"], options].concat());
    bench.good(&["check", "my.toml"]);
    let text = bench.read("my.toml");
    (bench, text)
}

#[test]
fn impossible_moments_of_inertia_are_left_out_of_the_prior() {
    // A rod of 2 kg with its centre 0.15 m from the frame's origin has more than 0.02 kg m² about
    // it, a crank of 1 kg at 0.1 m more than 0.003 kg m².
    let lengths = ["--value", "L1=0.2,D3=0.5,L2=0.52,L3=0.25"];
    let table = model("arm.par");
    let (_, text) = imported("arm.par", &table, &lengths);
    assert!(text.contains("LEFT OUT"), "{text}");
    assert!(
        text.contains("of `j1_skeleton`, `j3_link3`, which are not"),
        "{text}"
    );
    let (robot, prior) = text.split_once("[prior.values]").expect("a prior");
    assert!(robot.contains("xx_j3_link3 = 0.01"), "{text}");
    assert!(!prior.contains("xx_j3_link3"), "{text}");
    assert!(prior.contains("m_j3_link3 = 2.0"), "{text}");
    // Consistent moments become a prior.
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
fn point_masses_and_plates_are_left_out_of_the_prior() {
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

/// A head on six arms with a rod each in MJCF: the head is carried by the first rod, and the other
/// rods are tied to it.
fn head_on_rods() -> String {
    let places: Vec<[[f64; 3]; 3]> = (0..6_u8)
        .map(|leg| {
            let turn = f64::from(leg / 2) * 120.0;
            let side = if leg % 2 == 0 { -1.0 } else { 1.0 };
            let around = |radius: f64, degrees: f64, height: f64| {
                let angle = (turn + side * degrees).to_radians();
                [radius * angle.cos(), radius * angle.sin(), height]
            };
            let (hip, elbow) = (around(0.16, 20.0, 0.0), around(0.24, 22.0, 0.02));
            [hip, elbow, around(0.12, 45.0, 0.3)]
        })
        .collect();
    let between =
        |a: &[f64; 3], b: &[f64; 3]| format!("{} {} {}", b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    let head = [0.0, 0.0, 0.3];
    let (mut bodies, mut ties, mut motors) = (String::new(), String::new(), String::new());
    for (leg, [hip, elbow, end]) in places.iter().enumerate() {
        let (arm, rod) = (between(hip, elbow), between(elbow, end));
        let axis = format!("{} {} 0", -hip[1], hip[0]);
        let carried = match leg {
            0 => format!(
                "<body name='head' pos='{}'><joint name='neck' type='ball' pos='{}'/>\
                 <inertial pos='0 0 0.05' mass='0.6' diaginertia='0.002 0.003 0.004'/></body>",
                between(elbow, &head),
                between(&head, end)
            ),
            _ => {
                ties += &format!("<connect body1='rod{leg}' body2='head' anchor='{rod}'/>\n");
                String::new()
            }
        };
        bodies += &format!(
            "<body name='arm{leg}' pos='{} {} {}'><joint name='motor{leg}' axis='{axis}' range='-12 12' armature='0.001'/>\
             <inertial pos='0 0 0' mass='0.05' diaginertia='1e-5 1e-5 1e-5'/>\
             <body name='rod{leg}' pos='{arm}'><joint name='ball{leg}' type='ball'/>\
             <inertial pos='0 0 0' mass='0.02' diaginertia='1e-5 1e-5 1e-5'/>{carried}</body></body>\n",
            hip[0], hip[1], hip[2]
        );
        motors += &format!("<motor joint='motor{leg}'/>\n");
    }
    format!(
        "<mujoco model='head'><worldbody>{bodies}</worldbody>\
         <equality>{ties}</equality><actuator>{motors}</actuator></mujoco>"
    )
}

/// The skeleton contains a rod, which spins in the file and not in the description.
///
/// Joint limits must hold for the description's motion.
#[test]
fn runs_keep_the_joint_limits_of_a_spinning_rod_skeleton() {
    let (bench, text) = imported("head.xml", &head_on_rods(), &[]);
    assert!(
        text.contains("\"neck_3\""),
        "the head is in the skeleton: {text}"
    );
    // At least one period of each run.
    let duration = text.lines().find(|line| line.starts_with("duration = "));
    let short = text.replace(duration.expect("a duration"), "duration = \"4 s\"");
    bench.write("short.toml", &short);
    bench.good(&["simulate", "short.toml", "-o", "log.csv"]);
    for run in ["first", "second", "held_out"] {
        let log = bench.read(&format!("log_{run}.csv"));
        let mut rows = log.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let header = rows.next().expect("a header");
        let is_motor: Vec<bool> = header.iter().map(|name| name.starts_with("q_")).collect();
        assert_eq!(is_motor.iter().filter(|is| **is).count(), 6, "{header:?}");
        let mut largest = 0.0_f64;
        for row in rows {
            for (value, is) in row.iter().zip(&is_motor) {
                if *is {
                    largest = largest.max(value.parse::<f64>().expect("a number").abs());
                }
            }
        }
        let degrees = largest.to_degrees();
        assert!((6.0..12.0).contains(&degrees), "{run}: {degrees}");
    }
}

/// Torques of an imported robot at states, by the inputs of its inverse dynamics; masses are the
/// file's.
fn torques(name: &str, text: &str, options: &[&str], inputs: [&str; 3]) -> Vec<f64> {
    let (bench, toml) = imported(name, text, options);
    let (_, values) = toml.split_once("[experiment.parameters]").expect("values");
    let (values, _) = values.split_once("[prior").unwrap_or((values, ""));
    let count = match inputs[0] {
        "pose" => 2,
        _ => 4,
    };
    let numbers = |state: usize, input: usize| -> Vec<f64> {
        let number = |at: usize| (1.7 * (state * 7 + input * 3 + at) as f64).sin() * 0.3;
        (0..count).map(number).collect()
    };
    let state = |state: usize| {
        let own = inputs.iter().enumerate();
        let pairs = own.map(|(at, name)| ((*name).to_owned(), numbers(state, at).into()));
        serde_json::Value::Object(pairs.collect())
    };
    let states: Vec<serde_json::Value> = (0..5).map(state).collect();
    bench.write("states.json", &serde_json::Value::from(states).to_string());
    let asked = |function: &'static str, more: &[&'static str]| {
        let own = ["evaluate", "my.toml", function, "--states", "states.json"];
        bench.json(&[&own[..], more].concat())
    };
    // Parameters that the file does not give are zero.
    let document = asked("idm_red_platform", &[]);
    let names = document["parameters"].as_array().expect("names").iter();
    let names = names.map(|name| name.as_str().expect("a name"));
    let is_absent = |name: &&str| !values.contains(&format!("\n{name} = "));
    let zeros: String = names
        .filter(is_absent)
        .map(|name| format!("{name} = 0\n"))
        .collect();
    bench.write("values.toml", &format!("[parameters]{values}\n{zeros}"));
    let document = asked("inverse_dynamics", &["--parameters", "values.toml"]);
    let mut all = Vec::new();
    for result in document["results"].as_array().expect("results") {
        let (_, values) = result
            .as_object()
            .and_then(|o| o.iter().next())
            .expect("values");
        all.extend(
            values
                .as_array()
                .expect("numbers")
                .iter()
                .map(common::number),
        );
    }
    all
}

fn are_same(a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
    assert!(largest > 0.1, "{a:?}");
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < 1e-9 * largest, "{a} {b}");
    }
}

#[test]
fn sdformat_and_urdf_arms_have_equal_torques() {
    let inputs = ["joints", "joint_velocities", "joint_accelerations"];
    let urdf = torques("arm.urdf", &model("arm.urdf"), &[], inputs);
    let sdf = model("arm.sdf");
    are_same(&urdf, &torques("arm.sdf", &sdf, &[], inputs));
    // A slide's axis may be anywhere: other frames, the same robot.
    let slide = "<joint name=\"reach\" type=\"prismatic\">";
    assert!(sdf.contains(slide));
    let elsewhere = sdf.replace(slide, &format!("{slide}<pose relative_to=\"__model__\"/>"));
    are_same(&urdf, &torques("arm.sdf", &elsewhere, &[], inputs));
}

#[test]
fn tendon_motors_have_the_torques_of_mujoco() {
    let robot = "<mujoco model='row'><compiler angle='radian'/><worldbody>\n\
        <body><inertial pos='0.05 0 0.01' mass='2' diaginertia='0.1 0.1 0.1'/><joint name='j1' axis='0 1 0' armature='0.1' damping='0.4'/>\n\
        <body pos='0.3 0 0'><inertial pos='0.05 0 0' mass='3' diaginertia='0.1 0.1 0.1'/><joint name='j2' axis='0 1 0'/>\n\
        <body pos='0.3 0 0'><inertial pos='0.05 0.1 0' mass='1' diaginertia='0.1 0.1 0.1'/><joint name='j3' axis='1 0 0'/>\n\
        <body pos='0.2 0 0'><inertial pos='0 0.1 0.1' mass='1' diaginertia='0.1 0.1 0.1'/><joint name='j4' axis='0 0 1'/>\n\
        </body></body></body></body></worldbody>\n\
        <tendon><fixed name='t' damping='0.5' armature='0.02'><joint joint='j2' coef='1'/><joint joint='j3' coef='-0.5'/></fixed>\n\
        <fixed name='s' damping='0.3'><joint joint='j1' coef='2'/></fixed></tendon>\n\
        <actuator><motor joint='j1' gear='20' armature='0.001'/><motor tendon='t' gear='3' armature='0.1' damping='0.2'/><motor joint='j3'/></actuator></mujoco>";
    let inputs = ["joints", "joint_velocities", "joint_accelerations"];
    let found = torques("row.xml", robot, &[], inputs);
    // `qfrc_inverse` of MuJoCo 4.0 at the first state.
    let expected = [
        -26.73818316092,
        -10.46278052938,
        2.126432090413,
        0.2774809902168,
    ];
    are_same(&found[..4], &expected);
}

/// The five-bar robot of `five_bar.sdf`, cut at its tip.
fn cut_five_bar() -> String {
    let link = |name: &str, mass: f64, [xx, yy]: [f64; 2]| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.1 0 0'/><mass value='{mass}'/>\
             <inertia ixx='{xx}' ixy='0' ixz='0' iyy='{yy}' iyz='0' izz='{yy}'/></inertial></link>"
        )
    };
    let joint = |name: &str, ends: [&str; 2], at: &str, pitch: &str, more: &str| {
        format!(
            "<joint name='{name}' type='revolute'><parent link='{}'/><child link='{}'/><axis xyz='0 1 0'/>\
             <origin xyz='{at}' rpy='0 {pitch} 0'/>{more}</joint>",
            ends[0], ends[1]
        )
    };
    let friction = |v: &str| format!("<dynamics damping='{v}' friction='0.1'/>");
    let (right, third) = ("-1.5707963267948966", "0.5235987755982988");
    [
        "<robot name='five_bar'><link name='base'/>".to_owned(),
        link("left_crank", 0.5, [0.0001, 0.002]),
        link("right_crank", 0.6, [0.0001, 0.002]),
        link("left_rod", 0.3, [0.00005, 0.001]),
        link("right_rod", 0.35, [0.00005, 0.001]),
        joint("left_motor", ["base", "left_crank"], "-0.1 0 0", right, &friction("0.2")),
        joint("right_motor", ["base", "right_crank"], "0.1 0 0", right, &friction("0.3")),
        joint("left_elbow", ["left_crank", "left_rod"], "0.2 0 0", third, ""),
        joint("right_elbow", ["right_crank", "right_rod"], "0.2 0 0", &format!("-{third}"), ""),
        "<loop name='tip' type='revolute'><predecessor link='left_rod'><origin xyz='0.2 0 0'/></predecessor>\
         <successor link='right_rod'><origin xyz='0.2 0 0'/></successor><axis xyz='0 1 0'/></loop></robot>"
            .to_owned(),
    ]
    .concat()
}

#[test]
fn joint_closed_and_cut_loops_have_equal_torques() {
    let motors = "left_motor,right_motor";
    let options = ["--actuated", motors, "--coordinates", motors];
    let inputs = ["pose", "twist", "acceleration"];
    let urdf = torques("five_bar.urdf", &cut_five_bar(), &options, inputs);
    let sdf = torques("five_bar.sdf", &model("five_bar.sdf"), &options, inputs);
    are_same(&urdf, &sdf);
}

/// A spatial loop with closed-form joints for the lengths of the file.
///
/// For slightly changed lengths, from which the columns of length errors are computed, Newton's
/// method is needed.
#[test]
fn imported_spatial_loops_are_identified() {
    let names = ["5bar_linkage_iso6d", "5bar_linkage_iso3d"];
    for name in by_tier([&names[..1], &names]) {
        let path = format!("models/example-parallel-robots/{name}/robot.urdf");
        let Some(path) = common::shared(&path) else {
            return;
        };
        let bench = Bench::new();
        bench.good(&["import", &path, "-o", "my.toml"]);
        let message = bench.good(&["identify", "my.toml"]);
        assert!(message.contains("zz_"), "{message}");
    }
}

/// URDF of joints about y in a row; `more` is in the last joint.
fn row(count: usize, more: &str) -> String {
    let joint = |at: usize| {
        let inside = if at == count { more } else { "" };
        format!(
            "<link name='l{at}'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\n\
             <joint name='j{at}' type='revolute'><parent link='l{}'/><child link='l{at}'/><origin xyz='0.1 0 0'/>\
             <axis xyz='0 1 0'/>{inside}</joint>",
            at - 1
        )
    };
    let joints: String = (1..=count).map(joint).collect();
    format!("<robot name='row'><link name='l0'/>{joints}</robot>")
}

#[test]
fn a_description_rejected_by_check_is_not_written() {
    let crank = "<mujoco><worldbody><body><joint name='crank' axis='0 1 0'/>\
        <inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.01 0.01'/>\n\
        <body name='slider' pos='0.2 0 0'><joint name='rail' type='slide' axis='1 0 0'/>\
        <inertial pos='0 0 0' mass='1' diaginertia='0.01 0.01 0.01'/></body></body></worldbody>\n\
        <equality><connect body1='slider' anchor='0 0 0'/></equality>\
        <actuator><motor joint='crank'/></actuator></mujoco>";
    let coupled = "<mimic joint='j1'/>";
    for (text, options, expected) in [
        (
            row(101, ""),
            &[][..],
            "leg `robot` has 101 independent joints, more than 100",
        ),
        // Two motors of one coordinate.
        (
            row(2, coupled),
            &["--actuated", "j1,j2"],
            "joint `j2`: a coupled joint cannot be actuated",
        ),
        (
            row(2, "<mimic joint='j1' multiplier='0'/>"),
            &[],
            "with the factor 0",
        ),
        (
            row(2, "<mimic joint='j1' multiplier='1e-300'/>"),
            &[],
            "joint `j2`: the factor",
        ),
        (
            row(2, "<origin rpy='1e200 0 0'/>").replacen("<origin xyz='0.1 0 0'/>", "", 2),
            &[],
            "beyond 1e6 rad",
        ),
        (
            row(2, "").replacen("xyz='0.1", "xyz='1e200", 1),
            &[],
            "beyond 1e15",
        ),
        (
            row(2, "").replacen("xyz='0 1 0'", "xyz='0 0 0'", 1),
            &[],
            "the axis has no direction",
        ),
        // The loop leaves no motion.
        (crank.to_owned(), &[], "robot.xml"),
    ] {
        let bench = Bench::new();
        let name = if text.starts_with("<mujoco") {
            "robot.xml"
        } else {
            "robot.urdf"
        };
        bench.write(name, &text);
        let arguments = ["import", name, "-o", "my.toml"];
        let message = bench.bad(&[&arguments, options].concat());
        assert!(
            message.contains(expected) && message.contains(name),
            "{message}"
        );
        assert_eq!(bench.files(), [name]);
    }
}

#[test]
fn axes_are_normalised() {
    let bench = Bench::new();
    let import = |axis: &str| {
        let text = row(2, "").replacen("xyz='0 1 0'", &format!("xyz='{axis}'"), 1);
        bench.write("robot.urdf", &text);
        bench.good(&["import", "robot.urdf"])
    };
    let expected = import("0 1 0");
    for axis in ["0 1e160 0", "0 1e-3 0"] {
        assert_eq!(import(axis), expected, "{axis}");
    }
}

/// An MJCF hinge with attributes that import does not use.
const INCOMPLETE: &str = "<mujoco model='arm'><compiler angle='radian'/><option timestep='0.001' density='1'/>\n\
    <worldbody><body name='a'><joint name='j' axis='0 1 0' springyield='0.1'/>\n\
    <inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.02 0.02'/><strange/><strange/></body></worldbody>\n\
    <actuator><motor joint='j'/></actuator></mujoco>";

#[test]
fn unused_content_is_reported_on_stderr_and_in_the_file_header() {
    let bench = Bench::new();
    bench.write("arm.xml", INCOMPLETE);
    let outcome = bench.run(&["import", "arm.xml", "-o", "my.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let notes: Vec<&str> = outcome.err.lines().collect();
    assert_eq!(notes.len(), 3, "{notes:?}");
    for (note, start) in notes.iter().zip([
        "note: arm.xml:1: option density: reported: forces of a fluid",
        "note: arm.xml:2: joint springyield: reported: the softness",
        "note: arm.xml:3: strange: reported: not in the specification",
    ]) {
        assert!(note.starts_with(start), "{note}");
    }
    assert!(notes[2].ends_with("(2 times)"), "{notes:?}");
    assert!(
        bench
            .read("my.toml")
            .contains("# - line 2: joint springyield: ")
    );
    let quiet = bench.run(&["-q", "import", "arm.xml"]);
    assert_eq!((quiet.code, quiet.err.as_str()), (Some(0), ""));
}

#[test]
fn the_json_of_an_import_lists_the_treatment_of_each_element() {
    let bench = Bench::new();
    bench.write("arm.xml", INCOMPLETE);
    let document = bench.json(&["import", "arm.xml", "-o", "my.toml"]);
    assert_eq!(document["robot"], "arm");
    assert_eq!(document["description"], bench.read("my.toml"));
    let has = |list: &str, element: &str, attribute: Option<&str>| {
        let all = document[list].as_array().expect("a list");
        let is_expected = |entry: &&serde_json::Value| {
            entry["element"] == element && entry["attribute"].as_str() == attribute
        };
        let entry = all.iter().find(is_expected).expect("an entry");
        assert!(
            entry["line"].is_u64() && entry["reason"].is_string(),
            "{entry}"
        );
    };
    has("honoured", "inertial", Some("mass"));
    has("ignored", "option", Some("timestep"));
    has("reported", "joint", Some("springyield"));
    has("reported", "strange", None);
    for list in ["misfits", "spins"] {
        assert!(document[list].is_array(), "{list}");
    }
}

/// A crank drives a rocker by a rod between two ball joints, and a coupler on two pins, one of
/// which is off their plane.
const RODS: &str = "<mujoco model='rods'><worldbody>\n\
    <body name='crank'><inertial pos='0 0 .05' mass='1' diaginertia='.01 .02 .02'/><joint name='crank' axis='0 1 0'/>\n\
    <body name='rod' pos='0 0 .1'><inertial pos='.1 0 0' mass='.2' diaginertia='.001 .002 .002'/><joint name='hip' type='ball'/></body>\n\
    <body name='coupler' pos='0 0 .1'><inertial pos='.1 0 0' mass='.2' diaginertia='.001 .002 .002'/><joint name='pin' axis='0 1 0'/><site name='p' pos='.3 0 .1'/></body></body>\n\
    <body name='rocker' pos='.1 .2 0'><inertial pos='0 0 .05' mass='1' diaginertia='.01 .02 .02'/><joint name='rocker' axis='1 0 0'/></body>\n\
    <body name='second' pos='.3 0 0'><inertial pos='0 0 .05' mass='1' diaginertia='.01 .02 .02'/><joint name='second' axis='0 1 0'/><site name='s' pos='0 3e-4 .2'/></body>\n\
    </worldbody><equality>\n\
    <connect name='ball' body1='rod' body2='rocker' anchor='.2 .1 .1'/>\n\
    <connect name='bar' site1='p' site2='s'/></equality>\n\
    <actuator><motor joint='crank'/></actuator></mujoco>";

#[test]
fn changes_of_loops_and_spins_of_rods_are_in_the_json_and_on_stderr() {
    let bench = Bench::new();
    bench.write("rods.xml", RODS);
    let document = bench.json(&["import", "rods.xml", "-o", "my.toml"]);
    assert_eq!(document["spins"], serde_json::json!(["rod"]), "{document}");
    let misfits = common::list(&document["misfits"]);
    assert_eq!(misfits.len(), 1, "{misfits:?}");
    let misfit = &misfits[0];
    assert_eq!(
        (&misfit["file"], &misfit["line"], &misfit["name"]),
        (&"rods.xml".into(), &9.into(), &"bar".into())
    );
    assert!((common::number(&misfit["length"]) - 3e-4).abs() < 1e-9);
    assert_eq!(common::number(&misfit["angle"]), 0.0);
    let message = bench.run(&["import", "rods.xml", "-o", "my.toml"]).err;
    assert!(
        message.starts_with("note: rods.xml:9: `bar` is changed by "),
        "{message}"
    );
}

#[test]
fn contents_without_effect_are_printed_on_request() {
    let bench = Bench::new();
    bench.write("arm.xml", INCOMPLETE);
    let plain = bench.run(&["import", "arm.xml", "-o", "my.toml"]).err;
    assert!(!plain.contains(": ignored: "), "{plain}");
    let all = bench.run(&["import", "--ignored", "arm.xml", "-o", "my.toml"]);
    assert_eq!(all.code, Some(0), "{}", all.err);
    assert!(all.err.starts_with(&plain), "{}", all.err);
    assert!(
        all.err
            .contains("note: arm.xml:1: option timestep: ignored: settings of the simulation\n"),
        "{}",
        all.err
    );
}
