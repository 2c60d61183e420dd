//! Contents that an import omits are reported, or the file is rejected.

use overact_interchange::{Account, Imported, Options, import};
use std::path::Path;

/// Imports the first of several files in their own folder.
fn imported(files: &[(&str, &str)]) -> Imported {
    let folder = written(files);
    import(&folder.path().join(files[0].0), &Options::default()).expect("a robot")
}

fn written(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

/// Reported entries: line, element, attribute and count.
fn reported(account: &Account) -> Vec<String> {
    let shown = |entry: &overact_interchange::Entry| {
        assert!(!entry.reason.is_empty());
        format!("{}: {} ×{}", entry.line, entry.subject(), entry.count)
    };
    account.reported.iter().map(shown).collect()
}

/// Errors of a file with their lines.
fn errors(name: &str, text: &str) -> String {
    let folder = written(&[(name, text)]);
    let errors = import(&folder.path().join(name), &Options::default()).expect_err(text);
    let mut all = String::new();
    for (source, diagnostics) in &errors.0 {
        for error in diagnostics {
            let span = error.span.as_ref().expect("a place");
            assert!(error.help.is_some(), "{}", error.message);
            all += &format!("{}: {}\n", source.position(span).line, error.message);
        }
    }
    all
}

/// MJCF with one hinge, and attributes and elements in several places.
fn hinge(
    compiler: &str,
    option: &str,
    body: &str,
    joint: &str,
    actuator: &str,
    more: &str,
) -> String {
    format!(
        "<mujoco><compiler angle='radian' {compiler}/>\n<option {option}/>\n<worldbody><body {body}>\n\
         <joint name='j' axis='0 1 0' {joint}/><inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.02 0.02'/>\n\
         {more}</body></worldbody><actuator>\n<motor joint='j' {actuator}/></actuator></mujoco>"
    )
}

#[test]
fn unsupported_attributes_are_reported_unless_neutral() {
    let text = hinge(
        "",
        "density='1.2' viscosity='1e-5' timestep='0.001'",
        "gravcomp='1' user='3'",
        "springyield='0.2' solreflimit='0.01 1'",
        "kp='3'",
        "<plugin plugin='p'><config key='a' value='b'/></plugin><camera name='c'/>",
    );
    let text = text.replace("kp=", "ctrlrange=");
    let found = imported(&[("robot.xml", &text)]);
    assert_eq!(
        reported(&found.account),
        [
            "2: option density ×1",
            "2: option viscosity ×1",
            "4: joint springyield ×1",
            "5: plugin ×1"
        ]
    );
    assert!(
        found.text.contains("# - line 4: joint springyield: "),
        "{}",
        found.text
    );
    let text = hinge(
        "settotalmass='-1'",
        "density='0' viscosity='0.0'",
        "gravcomp='0' mocap='false'",
        "springyield='0'",
        "armature='0'",
        "",
    );
    let found = imported(&[("robot.xml", &text)]);
    assert_eq!(reported(&found.account), [""; 0]);
    assert!(!found.text.contains("Not used"), "{}", found.text);
}

#[test]
fn unknown_names_are_reported_and_counted() {
    let text = hinge("", "", "weight='2'", "dampign='3'", "", "<mass/>\n<mass/>");
    let found = imported(&[("robot.xml", &text)]);
    assert_eq!(
        reported(&found.account),
        ["3: body weight ×1", "4: joint dampign ×1", "5: mass ×2"]
    );
    let mut all = found.account.reported.iter();
    let misspelt = all.find(|entry| entry.attribute.as_deref() == Some("dampign"));
    let reason = &misspelt.expect("an entry").reason;
    assert!(reason.ends_with("did you mean `damping`?"), "{reason}");
}

#[test]
fn attributes_without_effect_are_ignored_with_a_reason() {
    let found = imported(&[("robot.xml", &hinge("", "timestep='0.001'", "", "", "", ""))]);
    let ignored = &found.account.ignored;
    assert_eq!(ignored.len(), 1, "{ignored:?}");
    assert_eq!(ignored[0].subject(), "option timestep");
    let honoured = &found.account.honoured;
    let mass = honoured
        .iter()
        .find(|entry| entry.subject() == "inertial mass");
    assert_eq!(mass.map(|entry| (entry.line, entry.count)), Some((4, 1)));
}

/// URDF with two links, a joint and additional elements.
fn two_links(more: &str) -> String {
    format!(
        "<robot name='r' xmlns:drake='d'><link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\n\
         <joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>\n{more}\n</robot>"
    )
}

#[test]
fn unsupported_loops_and_couplings_reject_the_file() {
    for (more, expected) in [
        (
            "<gazebo>\n<joint name='l' type='revolute'/></gazebo>",
            "4: the joint has no <parent>",
        ),
        (
            "<gazebo>\n<joint name='l' type='screw'><parent>a</parent><child>b</child></joint></gazebo>",
            "4: a joint of <gazebo> of type `screw` is not supported",
        ),
        (
            "<drake:linear_bushing_rpy/>",
            "3: <linear_bushing_rpy>: bushings",
        ),
        (
            "<transmission><type>transmission_interface/DifferentialTransmission</type><joint name='j'/></transmission>",
            "3: the transmission needs two elements <joint>",
        ),
        (
            "<ros2_control>\n<transmission><plugin>pal_transmissions/HalfDifferentialTransmission</plugin>\
             <joint name='j'/></transmission></ros2_control>",
            "4: a transmission of type `HalfDifferentialTransmission` couples",
        ),
        (
            "<transmission><joint name='k'/></transmission>",
            "3: there is no joint `k`",
        ),
        (
            "<transmission><actuator name='m'/><actuator name='n'/><joint name='j'/></transmission>",
            "3: a transmission of type `several joints` couples",
        ),
    ] {
        let message = errors("robot.urdf", &two_links(more));
        assert!(message.starts_with(expected), "{more}: {message}");
    }
    let at_a_site = hinge("", "", "", "", "site='s'", "");
    assert!(errors("robot.xml", &at_a_site).starts_with("6: `site` of <motor>: "));
}

#[test]
fn urdf_extensions_are_reported_or_ignored() {
    let more = "<gazebo reference='b'><material>Red</material><springStiffness>3</springStiffness></gazebo>\n\
        <gazebo reference='j'><springStiffness>0</springStiffness><unheard_of/></gazebo>\n\
        <transmission name='t'><type>transmission_interface/SimpleTransmission</type><joint name='j'/>\
        <actuator name='m'/></transmission>";
    let found = imported(&[("robot.urdf", &two_links(more))]);
    assert_eq!(
        reported(&found.account),
        ["3: springStiffness ×1", "4: unheard_of ×1"]
    );
}

#[test]
fn a_loop_yaml_file_with_another_name_is_reported() {
    let robot = two_links("");
    let yaml = "name_mot: [j]\nclosed_loop: [['a', 'b']]\n";
    let unrelated = "closed_loop: [['x', 'y']]\n";
    let found = imported(&[
        ("robot.urdf", &robot),
        ("other.yaml", yaml),
        ("stranger.yaml", unrelated),
    ]);
    let reported = &found.account.reported;
    assert_eq!(reported.len(), 1, "{reported:?}");
    assert_eq!(reported[0].subject(), "other.yaml closed_loop");
    assert!(reported[0].reason.contains("`robot.yaml`"), "{reported:?}");
}

#[test]
fn unused_yaml_and_par_keys_are_reported() {
    let found = imported(&[
        ("robot.urdf", &two_links("")),
        ("robot.yaml", "name_mot: [j]\nrotor_inertia: [0.1]\n"),
    ]);
    assert_eq!(reported(&found.account), ["2: yaml rotor_inertia ×1"]);
    let table = "NL = 1\nNJ = 1\nNF = 1\nant = {0}\nsigma = {0}\nb = {0}\nd = {0}\nr = {0}\ngamma = {0}\n\
        alpha = {0}\ntheta = {t1}\nM = {1}\nIA = {0.1}\nFX = {3}\nFY = {0}\nQP = {v1}\nW0 = {0,0,1}\nHM = {1}\n";
    let found = imported(&[("robot.par", table)]);
    assert_eq!(
        reported(&found.account),
        ["14: par FX ×1", "17: par W0 ×1", "18: par HM ×1"]
    );
}

#[test]
fn unused_sdformat_elements_are_reported() {
    let text = "<sdf version='1.9'><model name='m'>\n<link name='a'><kinematic>true</kinematic>\
        <velocity_decay><linear>0.1</linear></velocity_decay><visual name='v'/></link>\n\
        <joint name='j' type='revolute'><parent>world</parent><child>a</child><axis><xyz>0 0 1</xyz>\
        <limit><effort>3</effort></limit></axis></joint>\n<plugin name='p' filename='libp.so'><x/></plugin></model></sdf>";
    let found = imported(&[("robot.sdf", text)]);
    assert_eq!(
        reported(&found.account),
        ["2: kinematic ×1", "2: linear ×1", "4: plugin ×1"]
    );
}

#[test]
fn springs_of_loops_are_honoured() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/ankle.xml");
    let text = std::fs::read_to_string(path).expect("an ankle");
    let joint = "<joint name=\"pitch\"";
    assert!(text.contains(joint));
    let text = text.replace(joint, &format!("{joint} stiffness=\"3\" springref=\"10\""));
    let found = imported(&[("ankle.xml", &text)]);
    assert!(reported(&found.account).is_empty());
    assert!(
        found.text.contains("spring = \"q - (10 deg)\""),
        "{}",
        found.text
    );
    assert!(
        found.text.contains("k_pitch_skeleton = 3"),
        "{}",
        found.text
    );
    let honoured = &found.account.honoured;
    assert!(
        honoured
            .iter()
            .any(|entry| entry.subject() == "joint stiffness")
    );
}

#[test]
fn moving_links_with_a_shape_but_no_mass_are_reported() {
    let shape = "<visual><geometry/></visual>";
    let text = two_links("")
        .replace(
            "<link name='a'/>",
            &format!("<link name='a'>{shape}</link>"),
        )
        .replace("<inertia ixx='1' iyy='1' izz='1'/>", "");
    let found = imported(&[("robot.urdf", &text)]);
    assert_eq!(reported(&found.account), ["1: inertial inertia ×1"]);
    let more = format!(
        "<link name='c'>{shape}</link><joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>\n\
         <link name='frame'/><joint name='l' type='fixed'><parent link='b'/><child link='frame'/></joint>"
    );
    let found = imported(&[("robot.urdf", &two_links(&more))]);
    assert_eq!(reported(&found.account), ["3: link inertial ×1"]);
}

#[test]
fn unsupported_ball_joint_torques_are_reported() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/ankle.xml");
    let text = std::fs::read_to_string(path).expect("an ankle");
    let ball = "<joint name=\"left_ball\"";
    assert!(text.contains(ball));
    let text = text.replace(ball, &format!("{ball} frictionloss=\"0.1\""));
    let found = imported(&[("ankle.xml", &text)]);
    let message = reported(&found.account);
    assert_eq!(message.len(), 1, "{message:?}");
    assert!(message[0].ends_with("joint frictionloss ×1"), "{message:?}");
}
