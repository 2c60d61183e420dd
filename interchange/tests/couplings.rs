//! Chains of coupled joints: factors and offsets are composed, in any order of the file.

use overact_interchange::{Errors, Options, import};

/// Description of a file without its comments and name.
fn imported(name: &str, text: &str) -> Result<String, Errors> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, text).expect("a file");
    let text = import(&file, &Options::default())?.text;
    let kept = text.lines().filter(|line| !line.starts_with('#'));
    Ok(kept.map(|line| format!("{line}\n")).collect())
}

/// Errors of a file with their lines.
fn errors(name: &str, text: &str) -> String {
    let errors = imported(name, text).expect_err(text);
    let mut all = String::new();
    for (source, diagnostics) in &errors.0 {
        for error in diagnostics {
            let span = error.span.as_ref().expect("a place");
            let help = error.help.as_deref().expect("a way out");
            let line = source.position(span).line;
            all += &format!("{line}: {} ({help})\n", error.message);
        }
    }
    all
}

const INERTIAL: &str = "<inertial><origin xyz='0.1 0.02 -0.03'/><mass value='2'/>\
    <inertia ixx='0.02' iyy='0.03' izz='0.04' ixy='0' ixz='0' iyz='0'/></inertial>";

/// URDF with links a, b, c, d in a row, and joints j1, j2, … in the given order, one per line.
fn row(order: &[usize], mimics: [&str; 4]) -> String {
    let links = ["base", "a", "b", "c", "d"];
    let mut text = String::from("<robot name='row'><link name='base'/>");
    for link in &links[1..] {
        text += &format!("<link name='{link}'>{INERTIAL}</link>");
    }
    for &at in order {
        let (parent, child, mimic) = (links[at - 1], links[at], mimics[at - 1]);
        text += &format!(
            "\n<joint name='j{at}' type='revolute'><parent link='{parent}'/><child link='{child}'/>\
             <origin xyz='0.3 0 0.05' rpy='0.3 -0.2 0.7'/><axis xyz='0 1 0'/>{mimic}</joint>"
        );
    }
    text + "</robot>"
}

#[test]
fn urdf_mimic_chains_compose_in_any_file_order() {
    let chain = [
        "",
        "<mimic joint='j1' multiplier='-2' offset='0.25'/>",
        "<mimic joint='j2' multiplier='1.5' offset='0.125'/>",
        "<mimic joint='j3' multiplier='0.5' offset='-1'/>",
    ];
    // j3 = 1.5 (-2 j1 + 0.25) + 0.125, j4 = 0.5 j3 - 1.
    let composed = [
        "",
        chain[1],
        "<mimic joint='j1' multiplier='-3' offset='0.5'/>",
        "<mimic joint='j1' multiplier='-1.5' offset='-0.75'/>",
    ];
    let expected = imported("row.urdf", &row(&[1, 2, 3, 4], composed)).expect("a row");
    assert!(expected.contains("-1.5 * q_j1"), "{expected}");
    for order in [[1, 2, 3, 4], [4, 3, 2, 1], [3, 1, 4, 2], [2, 4, 1, 3]] {
        let found = imported("row.urdf", &row(&order, chain)).expect("a row");
        assert_eq!(found, expected, "{order:?}");
    }
}

/// MJCF with four hinges in a row and equality constraints between them.
fn hinges(equalities: &[&str]) -> String {
    let mut text = String::from("<mujoco model='row'><compiler angle='radian'/><worldbody>\n");
    for at in 1..=4 {
        text += &format!(
            "<body pos='0.3 0 0'><joint name='j{at}' axis='0 1 0' ref='0.{at}'/>\
             <inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.02 0.02'/>"
        );
    }
    text += &"</body>".repeat(4);
    text += "</worldbody><actuator><motor joint='j1'/></actuator><equality>";
    for equality in equalities {
        text += &format!("\n<joint {equality}/>");
    }
    text + "</equality></mujoco>"
}

#[test]
fn mjcf_equality_chains_compose_in_any_file_order() {
    let chain = [
        "joint1='j4' joint2='j3' polycoef='-1 0.5 0 0 0'",
        "joint1='j3' joint2='j2' polycoef='0.125 1.5 0 0 0'",
        "joint1='j2' joint2='j1' polycoef='0.25 -2 0 0 0'",
    ];
    let composed = [
        "joint1='j2' joint2='j1' polycoef='0.25 -2'",
        "joint1='j3' joint2='j1' polycoef='0.5 -3'",
        "joint1='j4' joint2='j1' polycoef='-0.75 -1.5'",
    ];
    let expected = imported("row.xml", &hinges(&composed)).expect("a row");
    assert_eq!(
        imported("row.xml", &hinges(&chain)).expect("a row"),
        expected
    );
    let backwards: Vec<&str> = chain.into_iter().rev().collect();
    assert_eq!(
        imported("row.xml", &hinges(&backwards)).expect("a row"),
        expected
    );
    // Missing coefficients are MuJoCo's defaults 0 1 0 0 0.
    let all = |second: &str| hinges(&[second, composed[1], composed[2]]);
    assert_eq!(
        imported("row.xml", &all("joint1='j2' joint2='j1' polycoef='0.25'")).expect("a row"),
        imported("row.xml", &all("joint1='j2' joint2='j1' polycoef='0.25 1'")).expect("a row"),
    );
}

#[test]
fn sdformat_mimic_chains_compose_in_any_file_order() {
    let joint = |name: &str, ends: [&str; 2], mimic: &str| {
        format!(
            "<joint name='{name}' type='revolute'><parent>{}</parent><child>{}</child>\
             <axis><xyz>0 1 0</xyz>{mimic}</axis></joint>",
            ends[0], ends[1]
        )
    };
    let mimic = |leader: &str, factor: &str, offset: &str| {
        format!(
            "<mimic joint='{leader}'><multiplier>{factor}</multiplier><offset>{offset}</offset>\
             <reference>0</reference></mimic>"
        )
    };
    let model = |second: String, third: String, is_backwards: bool| {
        let mut joints = [
            joint("j1", ["world", "a"], ""),
            joint("j2", ["a", "b"], &second),
            joint("j3", ["b", "c"], &third),
        ];
        if is_backwards {
            joints.reverse();
        }
        let links = ["a", "b", "c"]
            .map(|link| format!("<link name='{link}'><pose>0.1 0.2 0.3 0 0 0</pose></link>"));
        format!(
            "<sdf version='1.11'><model name='row'>{}{}</model></sdf>",
            links.concat(),
            joints.concat()
        )
    };
    let second = mimic("j1", "-2", "0.25");
    let expected = model(second.clone(), mimic("j1", "-3", "0.5"), false);
    let expected = imported("row.sdf", &expected).expect("a row");
    for is_backwards in [false, true] {
        let chain = model(second.clone(), mimic("j2", "1.5", "0.125"), is_backwards);
        assert_eq!(imported("row.sdf", &chain).expect("a row"), expected);
    }
}

#[test]
fn coupling_cycles_are_rejected_at_their_first_relation() {
    let cycle = [
        "<mimic joint='j3'/>",
        "<mimic joint='j1'/>",
        "<mimic joint='j2'/>",
        "<mimic joint='j3'/>",
    ];
    let message = errors("row.urdf", &row(&[4, 2, 3, 1], cycle));
    assert!(
        message.starts_with("3: joints are coupled in a cycle: `j2`, `j1`, `j3`, `j2`"),
        "{message}"
    );
    assert_eq!(message.lines().count(), 1, "{message}");
    let message = errors(
        "row.urdf",
        &row(&[1, 2, 3, 4], ["<mimic joint='j1'/>", "", "", ""]),
    );
    assert!(
        message.starts_with("2: joints are coupled in a cycle: `j1`, `j1`"),
        "{message}"
    );
    let message = errors(
        "row.xml",
        &hinges(&["joint1='j1' joint2='j2'", "joint1='j2' joint2='j1'"]),
    );
    assert!(
        message.starts_with("3: joints are coupled in a cycle"),
        "{message}"
    );
}

#[test]
fn a_joint_coupled_to_two_joints_is_rejected() {
    let message = errors(
        "row.xml",
        &hinges(&["joint1='j2' joint2='j1'", "joint1='j2' joint2='j3'"]),
    );
    assert!(
        message.starts_with("4: `j2` is coupled to two joints, `j1` and `j3`"),
        "{message}"
    );
    let message = errors(
        "row.xml",
        &hinges(&["joint1='j2' joint2='j1'", "joint1='j2' joint2='j1'"]),
    );
    assert_eq!(
        message,
        "4: `j2` is coupled to `j1` twice (remove one of the two relations)\n"
    );
}

#[test]
fn nonlinear_equalities_are_rejected() {
    let message = errors(
        "row.xml",
        &hinges(&["joint1='j2' joint2='j1' polycoef='0 1 0.5 0 0'"]),
    );
    assert!(
        message.starts_with("3: ") && message.contains("polycoef"),
        "{message}"
    );
}

/// A gripper with a four-bar for each finger, whose cranks are coupled.
fn gripper(actuator: &str) -> String {
    let mass = "<inertial pos='0.01 0 0.02' mass='0.1' diaginertia='1e-4 1e-4 1e-4'/>";
    let finger = |name: &str, side: f64| {
        let at = |x: f64| side * x;
        format!(
            "<body name='crank_{name}' pos='{} 0 0'>{mass}<joint name='driver_{name}' axis='0 {side} 0'/>\n\
             <body name='coupler_{name}' pos='{} 0 .06'>{mass}<joint name='coupler_{name}' axis='0 1 0'/></body></body>\n\
             <body name='rocker_{name}' pos='{} 0 .03'>{mass}<joint name='rocker_{name}' axis='0 1 0'/></body>\n",
            at(0.03),
            at(0.04),
            at(0.01)
        )
    };
    let closure = |name: &str, side: f64| {
        format!(
            "<connect body1='coupler_{name}' body2='rocker_{name}' anchor='{} 0 .04'/>",
            side * -0.02
        )
    };
    format!(
        "<mujoco model='gripper'><compiler angle='radian'/><worldbody>{}{}</worldbody>\n\
         <equality>{}{}<joint joint1='driver_l' joint2='driver_r'/></equality>\n\
         <tendon><fixed name='split'><joint joint='driver_r' coef='0.5'/><joint joint='driver_l' coef='0.5'/></fixed></tendon>\n\
         <actuator>{actuator}</actuator></mujoco>",
        finger("r", 1.0),
        finger("l", -1.0),
        closure("r", 1.0),
        closure("l", -1.0)
    )
}

#[test]
fn a_gripper_of_two_coupled_four_bars_has_one_coordinate() {
    for (actuator, coordinate) in [
        ("<motor joint='driver_r'/>", "driver_r"),
        ("<motor joint='driver_l'/>", "driver_l"),
        ("<motor tendon='split'/>", "driver_r"),
    ] {
        let text = imported("gripper.xml", &gripper(actuator)).expect("a gripper");
        let source = overact_codegen::Source::new("gripper.toml", text.clone());
        let checked = match overact_codegen::check(&source) {
            Ok(checked) => checked.mechanism,
            Err(errors) => panic!("{actuator}: {}\n{text}", errors.render_plain(&source)),
        };
        assert_eq!(checked.coordinates(), [coordinate], "{actuator}");
        assert_eq!(checked.actuator_names().len(), 1, "{actuator}");
    }
}
