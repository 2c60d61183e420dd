//! Files that are wrong, or say what can't be said: each error at its place, with a way out.

use overact_interchange::{Options, import};
use std::fs;

/// What is said of a file.
fn refused(name: &str, text: &str) -> String {
    refused_with(name, text, &Options::default())
}

fn refused_with(name: &str, text: &str, options: &Options) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    fs::write(&file, text).expect("a file");
    let errors = import(&file, options).expect_err(text);
    let mut all = String::new();
    for (source, diagnostics) in &errors.0 {
        for error in diagnostics {
            let line = error
                .span
                .as_ref()
                .map_or(0, |span| source.position(span).line);
            let help = error.help.clone().unwrap_or_default();
            assert!(
                !help.is_empty() || error.message.contains("can't be read"),
                "{}",
                error.message
            );
            all.push_str(&format!("{line}: {} ({help})\n", error.message));
        }
    }
    all
}

/// A robot of URDF with two links, a joint of a type between them, and more.
fn two_links(kind: &str, more: &str) -> String {
    format!(
        "<robot name='r'>\n<link name='a'/>\n<link name='b'><inertial><mass value='1'/></inertial></link>\n\
         <joint name='j' type='{kind}'>\n<parent link='a'/><child link='b'/></joint>\n{more}\n</robot>"
    )
}

fn one_body(body: &str, more: &str) -> String {
    format!(
        "<mujoco>\n<worldbody>\n<body name='b'>{body}\n<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body>\n</worldbody>\n{more}</mujoco>"
    )
}

#[test]
fn xml_is_read_without_entities_and_without_a_network() {
    let text = "<?xml version='1.0'?>\n<!DOCTYPE robot [<!ENTITY a 'aaaa'>]>\n<robot name='&a;'/>";
    let said = refused("robot.urdf", text);
    assert!(said.contains("document type and its entities"), "{said}");
    let said = refused("robot.urdf", "<robot name='r'>\n<link name='a'>\n</robot>");
    assert!(said.starts_with("3: this is no XML"), "{said}");
    assert!(refused("robot.urdf", "<collada/>").contains("neither MJCF nor URDF"));
    let deep =
        "<mujoco>".to_owned() + &"<body>".repeat(5000) + &"</body>".repeat(5000) + "</mujoco>";
    assert!(refused("deep.xml", &deep).contains("deep"));
}

#[test]
fn joints_that_cannot_be_said_are_named() {
    let said = refused("robot.urdf", &two_links("floating", ""));
    assert!(
        said.starts_with("4: the joint `j` is `floating`") && said.contains("--fix-base"),
        "{said}"
    );
    assert!(refused("robot.urdf", &two_links("planar", "")).contains("`planar`"));
    assert!(refused("robot.urdf", &two_links("fixed", "")).contains("no joint that moves"));
    let said = refused("robot.xml", &one_body("<freejoint/>", ""));
    assert!(
        said.starts_with("3: ") && said.contains("--fix-base"),
        "{said}"
    );
    let tendon = "<tendon>\n<fixed name='t'/></tendon>";
    let said = refused("robot.xml", &one_body("<joint name='j'/>", tendon));
    assert!(
        said.contains("<fixed>: forces and couplings of tendons"),
        "{said}"
    );
}

#[test]
fn what_is_missing_is_named_with_what_is_near() {
    let more = "<joint name='k' type='revolute'><parent link='b'/><child link='bb'/></joint>";
    let said = refused("robot.urdf", &two_links("revolute", more));
    assert!(said.starts_with("6: there is no link `bb`"), "{said}");
    let actuator = "<actuator>\n<motor joint='elbov'/></actuator>";
    let said = refused("robot.xml", &one_body("<joint name='elbow'/>", actuator));
    assert!(
        said.contains("7: there is no joint `elbov`") && said.contains("elbow"),
        "{said}"
    );
    let equality = "<equality>\n<connect body1='b' body2='c' anchor='0 0 0'/></equality>";
    let said = refused("robot.xml", &one_body("<joint name='elbow'/>", equality));
    assert!(said.contains("there is no body `c`"), "{said}");
    let options = Options {
        actuated: Some(vec!["k".to_owned()]),
        ..Options::default()
    };
    assert!(
        refused_with("robot.urdf", &two_links("revolute", ""), &options).contains("no joint `k`")
    );
}

#[test]
fn joints_in_a_circle_and_numbers_that_are_none_are_found() {
    let circle = "<robot name='r'><link name='o'/><link name='a'/><link name='b'/>\n\
        <joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>\n\
        <joint name='k' type='revolute'><parent link='b'/><child link='a'/></joint></robot>";
    assert!(refused("robot.urdf", circle).contains("circle"));
    let text = two_links("revolute", "").replace("value='1'", "value='1kg'");
    assert!(refused("robot.urdf", &text).contains("`value` of `mass` has to be 1 finite numbers"));
    let text = two_links("revolute", "").replace("value='1'", "value='nan'");
    assert!(refused("robot.urdf", &text).contains("finite"));
    let axis = two_links("revolute", "").replace("<child", "<axis xyz='0 0 0'/><child");
    assert!(refused("robot.urdf", &axis).contains("no direction"));
}

#[test]
fn includes_that_are_missing_or_go_in_a_circle_are_found() {
    let said = refused(
        "robot.xml",
        "<mujoco>\n<include file='other.xml'/></mujoco>",
    );
    assert!(
        said.starts_with("2: `") && said.contains("can't be read"),
        "{said}"
    );
    let said = refused(
        "robot.xml",
        "<mujoco>\n<include file='robot.xml'/></mujoco>",
    );
    assert!(said.starts_with("2: `robot.xml` includes itself"), "{said}");
}

#[test]
fn loops_that_cannot_close_are_named() {
    let model = "<mujoco>\n<worldbody>\n<body name='a'><joint name='j'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>\
        <site name='s' pos='1 0 0'/></body><site name='t' pos='3 0 0'/></worldbody>\n\
        <equality>\n<connect name='far' site1='s' site2='t'/></equality>\n<actuator><motor joint='j'/></actuator></mujoco>";
    let said = refused("robot.xml", model);
    assert!(
        said.starts_with("5: the loop of `far` can't close"),
        "{said}"
    );
    let said = refused(
        "robot.xml",
        &model
            .replace("<motor joint='j'/>", "")
            .replace("<actuator></actuator>", ""),
    );
    assert!(
        said.contains("does not say which joints of its loops are driven"),
        "{said}"
    );
}

/// A table of two joints, with one line in the place of another.
fn table(line: &str, by: &str) -> String {
    let text = "(* Robotname = 'two' *)\nNL = 2\nNJ = 2\nNF = 2\nant = {0,1}\nsigma = {0,0}\nb = {0,0}\nd = {0,D2}\n\
        r = {0,0}\ngamma = {0,0}\nalpha = {0,pi/2}\nmu = {1,1}\ntheta = {t1,t2}\nM = {1,M2}\n";
    assert!(text.contains(line));
    text.replace(line, by)
}

#[test]
fn tables_that_say_no_robot_are_told_at_their_line() {
    let said = refused("two.par", &table("", ""));
    assert!(
        said.starts_with("8: `D2` has no value") && said.contains("--value D2="),
        "{said}"
    );
    for (line, by, expected) in [
        ("{0,D2}", "{0,0", "8: a list has no end"),
        ("'two' *)", "'two'", "1: a comment has no end"),
        ("NF = 2", "NL = 2", "4: `NL` stands here twice"),
        (
            "NF = 2",
            "NF = 3",
            "2: 2 links, 2 joints and 3 frames make no robot",
        ),
        ("NL = 2", "NL = 2.5", "2: `NL` is no whole number"),
        ("{0,1}", "{0,2}", "5: frame 2 stands on 2 with sigma 0"),
        ("{0,1}", "{0}", "5: `ANT` has no value for frame 2"),
        ("{0,pi/2}", "{0,pi//2}", "11: `pi//2` is no expression"),
        (
            "{t1,t2}",
            "{t1,2*t2}",
            "13: the position of joint 2 is `2*t2`, no variable and a constant",
        ),
        (
            "{t1,t2}",
            "{t1,0}",
            "13: the position of joint 2 is `0`, which has 0 variables",
        ),
        (
            "NF = 2",
            "is_floating = 1",
            "4: a base that moves can't be said",
        ),
        ("M = {1,M2}", "what", "14: this belongs to no key"),
        ("M = {1,M2}", "a b = 1", "14: this is no key"),
    ] {
        let said = refused("two.par", &table(line, by).replace("D2", "0"));
        assert!(said.starts_with(expected), "{by}: {said}");
    }
    // What is neither: bytes of something else are told without a line.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.par");
    fs::write(&file, [0_u8, 159, 146, 150]).expect("a file");
    let errors = import(&file, &Options::default()).expect_err("no text");
    let said = errors.0[0].1.iter().map(|error| error.message.clone());
    assert!(said.collect::<String>().contains("can't be read"));
}
