//! Contents that do not fit the robot or its surroundings: keyframes, meshes and YAML files
//! elsewhere, closures of one body, counts of a table, hollow shapes.

use overact_interchange::{Imported, Options, import};
use std::path::Path;

/// Import of a file, or its messages.
fn read(path: &Path, options: &Options) -> Result<Imported, String> {
    import(path, options).map_err(|errors| {
        let each = errors.0.iter();
        each.map(|(source, errors)| errors.render_plain(source))
            .collect()
    })
}

fn read_text(name: &str, text: &str, options: &Options) -> Result<Imported, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("a file");
    read(&path, options)
}

/// Reports as text.
fn reports(imported: &Imported) -> Vec<String> {
    let each = imported.account.reported.iter();
    each.map(|own| format!("{}: {}: {}", own.line, own.subject(), own.reason))
        .collect()
}

const MASS: &str = r#"<inertial pos="0.1 0 0.05" mass="1" diaginertia=".01 .02 .02"/>"#;

/// A four-bar, with more elements.
fn bar(equality: &str, more: &str) -> String {
    format!(
        r#"<mujoco model="bar"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 -1 0"/>
 <body name="coupler" pos="0 0 .1">{MASS}<joint name="coupler" axis="0 -1 0"/></body></body>
<body name="rocker" pos=".3 0 0">{MASS}<joint name="rocker" axis="0 -1 0"/><site name="s" pos="0 0 .05"/></body>
</worldbody><equality><connect body1="coupler" body2="rocker" anchor=".3 0 .1"/>{equality}</equality>
<actuator><motor joint="crank"/></actuator>
{more}</mujoco>"#
    )
}

#[test]
fn mismatched_keyframes_are_reported() {
    let with = |positions: &str| {
        let key = format!(r#"<keyframe><key name="home" qpos="{positions}"/></keyframe>"#);
        let found = read_text("robot.xml", &bar("", &key), &Options::default());
        reports(&found.expect("a robot"))
    };
    let short = with("0.2 0.1");
    assert!(
        short[0].starts_with("7: key qpos: 2 numbers, and the joints have 3"),
        "{short:?}"
    );
    let words = with("0.2 zero 0.1");
    assert!(words[0].contains("not a list of numbers"), "{words:?}");
    assert!(with("0 0 0").is_empty());
}

#[test]
fn keyframes_skip_the_coordinates_of_a_fixed_base() {
    let text = format!(
        r#"<mujoco model="bar"><compiler angle="radian"/><worldbody><body name="base"><freejoint/>{MASS}
<body name="crank">{MASS}<joint name="crank" axis="0 -1 0"/>
 <body name="coupler" pos=".1 0 0">{MASS}<joint name="coupler" axis="0 -1 0"/><site name="p" pos=".3 0 0"/></body></body>
<body name="rocker" pos=".3 0 0">{MASS}<joint name="rocker" axis="0 -1 0"/><site name="s" pos=".2 0 0"/></body></body>
</worldbody><equality><connect name="loop" site1="p" site2="s"/></equality>
<actuator><motor joint="crank"/></actuator>
<keyframe><key qpos="0 0 .5 1 0 0 0 1 -.6 1.5"/></keyframe></mujoco>"#
    );
    let options = Options {
        fix_base: true,
        ..Options::default()
    };
    let found = read_text("robot.xml", &text, &options).expect("a robot");
    assert!(reports(&found).is_empty(), "{:?}", reports(&found));
    assert!(found.text.contains("keyframe"), "{}", found.text);
}

#[test]
fn closures_within_one_body_are_reported_or_rejected() {
    let same = r#"<connect name="own" body1="rocker" body2="rocker" anchor="0 0 .1"/>"#;
    let found = read_text("robot.xml", &bar(same, ""), &Options::default()).expect("a robot");
    let found = reports(&found);
    assert!(
        found[0].contains("connects `rocker` to itself"),
        "{found:?}"
    );
    let other = r#"<connect name="own" site1="s" site2="t"/>"#;
    let text = bar(other, "").replace("<site name=\"s\"", "<site name=\"t\"/><site name=\"s\"");
    let message = read_text("robot.xml", &text, &Options::default()).expect_err("an error");
    assert!(
        message.contains("two places of one body, `rocker`, that are 5.00e-2 m"),
        "{message}"
    );
    assert!(message.contains("robot.xml:5:"), "{message}");
}

/// A URDF of one joint.
const ARM: &str = "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>\
     <joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>";

#[test]
fn a_yaml_path_that_is_a_folder_or_pipe_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, yaml) = (
        folder.path().join("robot.urdf"),
        folder.path().join("robot.yaml"),
    );
    std::fs::write(&path, ARM).expect("a file");
    read(&path, &Options::default()).expect("a robot");
    let refused = || {
        let message = read(&path, &Options::default()).expect_err("an error");
        assert!(
            message.contains("robot.yaml` is not a regular file"),
            "{message}"
        );
        assert!(message.contains("help: "), "{message}");
    };
    std::fs::create_dir(&yaml).expect("a folder");
    refused();
    std::fs::remove_dir(&yaml).expect("an empty folder");
    let made = std::process::Command::new("mkfifo").arg(&yaml).status();
    if made.is_ok_and(|status| status.success()) {
        refused();
    }
}

#[test]
fn meshes_outside_the_folder_are_read_only_with_an_option() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("a folder");
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("part.obj"), tetrahedron).expect("a file");
    let path = inner.join("robot.xml");
    let text = r#"<mujoco><asset><mesh name="part" file="../part.obj"/></asset><worldbody>
<body name="b"><joint name="j" axis="0 1 0"/><geom type="mesh" mesh="part"/></body></worldbody></mujoco>"#;
    std::fs::write(&path, text).expect("a file");
    let found = read(&path, &Options::default()).expect("a robot");
    assert!(
        reports(&found)[0].contains("outside the folder"),
        "{:?}",
        reports(&found)
    );
    assert!(!found.text.contains("m_j = "), "{}", found.text);
    let options = Options {
        include_outside: true,
        ..Options::default()
    };
    let found = read(&path, &options).expect("a robot");
    assert!(reports(&found).is_empty(), "{:?}", reports(&found));
    assert!(found.text.contains("m_j = 166.6"), "{}", found.text);
}

#[test]
fn inconsistent_par_counts_are_rejected() {
    let table = |links: usize, joints: usize, frames: usize| {
        let text = format!("NL = {links}\nNJ = {joints}\nNF = {frames}\n");
        read_text("robot.par", &text, &Options::default()).expect_err("an error")
    };
    let message = table(2, 3, 3);
    assert!(
        message.contains("NF = 3 frames") && message.contains("= 4"),
        "{message}"
    );
    assert!(message.contains("robot.par:3:"), "{message}");
    let message = table(3, 2, 1);
    assert!(
        message.contains("fewer joints than links: NJ = 2, NL = 3"),
        "{message}"
    );
    let message = table(2000, 2000, 2000);
    assert!(message.contains("2000 joints, more than 1000"), "{message}");
    assert!(table(0, 0, 0).contains("no links"));
}

#[test]
fn hollow_shape_inertias_match_mujoco() {
    // Masses and largest moments of MuJoCo 4.0 for a surface density of 7 kg/m^2.
    let shapes = [
        ("sphere", ".1", 0.8796459430051422, 0.005864306286700948),
        (
            "capsule",
            ".05 .2",
            1.0995574287564276,
            0.024190263432641412,
        ),
        (
            "cylinder",
            ".05 .2",
            0.9896016858807849,
            0.017295122056481316,
        ),
        ("box", ".1 .2 .3", 6.16, 0.3789333333333334),
        (
            "ellipsoid",
            ".1 .2 .3",
            3.428035333360212,
            0.12652622417863313,
        ),
    ];
    for (kind, size, mass, moment) in shapes {
        let text = format!(
            "<mujoco><worldbody><body name='b'><joint name='j' axis='1 0 0'/>\
             <geom type='{kind}' size='{size}' shellinertia='true' density='7'/></body></worldbody></mujoco>"
        );
        let found = read_text("robot.xml", &text, &Options::default()).expect("a robot");
        let value = |name: &str| {
            let mut lines = found.text.lines();
            let line = lines.find_map(|line| line.strip_prefix(&format!("{name} = ")));
            let word = line.unwrap_or_else(|| panic!("{name}: {}", found.text));
            word.parse::<f64>().expect("a number")
        };
        assert!((value("m_j") - mass).abs() < 1e-12 * mass, "{kind}");
        let moments = ["xx_j", "yy_j", "zz_j"].map(value);
        let largest = moments.into_iter().fold(0.0, f64::max);
        // The wall of an ellipsoid is a small difference.
        let tolerance = if kind == "ellipsoid" { 1e-8 } else { 1e-12 };
        assert!(
            (largest - moment).abs() < tolerance * moment,
            "{kind}: {largest}"
        );
    }
}

#[test]
fn rods_without_length_are_rejected() {
    let with = |end: &str| {
        let text = format!(
            r#"<mujoco><worldbody>
<body name="shank">{MASS}<joint name="pitch" axis="0 1 0"/>
 <body name="foot">{MASS}<joint name="roll" axis="1 0 0"/></body></body>
<body name="left" pos="0 .03 .2">{MASS}<joint name="left" axis="0 1 0"/>
 <body name="left_rod" pos="-.05 0 0">{MASS}<joint type="ball"/></body></body>
<body name="right" pos="0 -.03 .2">{MASS}<joint name="right" axis="0 1 0"/>
 <body name="right_rod" pos="-.05 0 0">{MASS}<joint type="ball"/></body></body>
</worldbody><equality><connect body1="left_rod" body2="foot" anchor="0 0 -.2"/>
<connect body1="right_rod" body2="foot" anchor="0 0 {end}"/></equality>
<actuator><motor joint="left"/><motor joint="right"/></actuator></mujoco>"#
        );
        read_text("robot.xml", &text, &Options::default())
    };
    assert!(with("-.2").is_ok());
    for end in ["0", "-1e-9", "-2.1e-8"] {
        let errors = with(end).expect_err(end);
        assert!(
            errors.contains("both ends of `right_rod` are at the same point"),
            "{errors}"
        );
    }
}

#[test]
fn open_welds_between_neighbours_are_rejected() {
    let with = |relative: &str| {
        let text = format!(
            r#"<mujoco><worldbody>
<body name="upper">{MASS}<joint name="shoulder" axis="0 1 0"/>
 <body name="lower" pos=".2 0 0">{MASS}<joint name="elbow" axis="1 0 0"/></body></body>
</worldbody><equality><weld body1="lower" body2="upper" relpose="{relative} 1 0 0 0"/></equality>
<actuator><motor joint="shoulder"/></actuator></mujoco>"#
        );
        read_text("robot.xml", &text, &Options::default())
    };
    assert!(with("-.2 0 0").is_ok(), "{:?}", with("-.2 0 0").err());
    let errors = with(".2 0 0").expect_err("open by 0.4 m");
    assert!(
        errors.contains("4.00e-1 m remain open, and the tolerance is 4.00e-4 m"),
        "{errors}"
    );
}

#[test]
fn welds_without_scale_of_torques_hold_points() {
    let with = |scale: &str| {
        let equality = format!(r#"<weld body1="coupler" body2="rocker" anchor="0 0 .2" {scale}/>"#);
        let text = bar("", "").replace(
            r#"<connect body1="coupler" body2="rocker" anchor=".3 0 .1"/>"#,
            &equality,
        );
        assert_ne!(text, bar("", ""));
        read_text("robot.xml", &text, &Options::default())
    };
    let held = with(r#"torquescale="0""#).expect("a four-bar");
    let closed = read_text("robot.xml", &bar("", ""), &Options::default()).expect("a four-bar");
    let coordinates = |imported: &Imported| imported.text.matches("actuated = true").count();
    assert_eq!(coordinates(&held), coordinates(&closed));
    let rigid = with("");
    assert_ne!(rigid.map(|own| own.text).ok(), Some(held.text));
}
