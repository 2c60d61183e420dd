//! Closed mechanisms that are rejected: their joints are named, at their line, with a way out.

use overact_interchange::{Options, import};

const MASS: &str = r#"<inertial pos="0.1 0 0.05" mass="1" diaginertia=".01 .02 .02"/>"#;

/// Import of an MJCF file with its joints at some positions.
fn read(text: &str, home: &[(&str, f64)]) -> Result<String, String> {
    let options = Options {
        home: home
            .iter()
            .map(|(name, at)| ((*name).to_owned(), *at))
            .collect(),
        ..Options::default()
    };
    import_text(text, &options)
}

/// Import of an MJCF file, or its messages.
fn import_text(text: &str, options: &Options) -> Result<String, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.xml");
    std::fs::write(&path, text).expect("a file");
    import(&path, options)
        .map(|own| own.text)
        .map_err(|errors| {
            let each = errors.0.iter();
            each.map(|(source, errors)| errors.render_plain(source))
                .collect()
        })
}

/// Import of an MJCF file with the coordinates of a list.
fn read_with(text: &str, coordinates: Option<&str>) -> Result<String, String> {
    let options = Options {
        coordinates: coordinates.map(|list| list.split(',').map(str::to_owned).collect()),
        ..Options::default()
    };
    import_text(text, &options)
}

#[track_caller]
fn refused(text: &str, parts: &[&str]) {
    let message = read(text, &[]).expect_err("a file that is rejected");
    for part in parts {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_link_on_three_rods_makes_a_joint_dependent() {
    // Stephenson's six-bar on a link of its longest path: three rods hold the plate.
    let text = format!(
        r#"<mujoco model="triad"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 1 0"/>
 <body name="rod" pos=".03 0 .18">{MASS}<joint name="rod" axis="0 1 0"/>
  <body name="plate" pos=".22 0 .02">{MASS}<joint name="plate" axis="0 1 0"/></body></body>
 <body name="link" pos=".07 0 .11">{MASS}<joint name="link" axis="0 1 0"/></body></body>
<body name="rocker" pos=".33 0 0">{MASS}<joint name="rocker" axis="0 1 0"/></body>
</worldbody><equality><connect name="first" body1="link" body2="plate" anchor=".17 0 .01"/>
<connect name="second" body1="rocker" body2="plate" anchor="0 0 .13"/></equality>
<actuator><motor joint="crank"/></actuator></mujoco>"#
    );
    // The motor is the coordinate, or the joint that is named.
    for named in [None, Some("rocker"), Some("rod")] {
        let own = read_with(&text, named).expect("a robot");
        let joints = own
            .split("[[leg.")
            .filter(|joint| joint.contains("dependent = true"));
        let joints: Vec<&str> = joints.collect();
        assert!(!joints.is_empty(), "{own}");
        let coordinate = named.unwrap_or("crank");
        let name = format!("name = \"{coordinate}\"");
        assert!(joints.iter().all(|joint| !joint.contains(&name)), "{own}");
        let skeleton = own.split("\n[leg.").next().unwrap_or_default();
        assert!(skeleton.contains(&name), "{own}");
    }
    // Two coordinates are one too many.
    let message = read_with(&text, Some("rod,link")).expect_err("a file that is rejected");
    assert!(message.contains("leave `--coordinates` out"), "{message}");
}

#[test]
fn loops_singular_at_zero_need_another_home() {
    // A palletiser: the lever drives the forearm by a parallelogram, in line at zero.
    let text = format!(
        r#"<mujoco model="arm"><worldbody>
<body name="arm">{MASS}<joint name="arm" axis="0 -1 0"/>
 <body name="forearm" pos=".4 0 0">{MASS}<joint name="forearm" axis="0 -1 0"/></body></body>
<body name="lever">{MASS}<joint name="lever" axis="0 -1 0"/>
 <body name="rod" pos="-.1 0 0">{MASS}<joint name="rod" axis="0 -1 0"/></body></body>
</worldbody><equality><connect body1="rod" body2="forearm" anchor=".4 0 0"/></equality>
<actuator><motor joint="arm"/><motor joint="lever"/></actuator></mujoco>"#
    );
    refused(&text, &["at home, where loops are folded", "--home JOINT="]);
    let home = [
        ("arm", 0.9),
        ("lever", -0.3),
        ("forearm", -1.2),
        ("rod", 1.2),
    ];
    let text = read(&text, &home).expect("a robot");
    assert!(text.contains("`rod`"), "{text}");
}

#[test]
fn undriven_joints_are_rejected_by_name() {
    let text = format!(
        r#"<mujoco model="five"><worldbody>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/>
 <body name="a2" pos="0 0 .2">{MASS}<joint name="a2" axis="0 1 0"/></body></body>
<body name="b" pos=".3 0 0">{MASS}<joint name="b" axis="0 1 0"/>
 <body name="b2" pos="0 0 .2">{MASS}<joint name="b2" axis="0 1 0"/></body></body>
<body name="free" pos="1 0 0">{MASS}<joint name="turntable" axis="0 0 1"/></body>
</worldbody><equality><connect body1="a2" body2="b2" anchor=".15 0 .2"/></equality>
<actuator><motor joint="a"/><motor joint="b"/></actuator></mujoco>"#
    );
    let joints =
        "3 degrees of freedom, and 2 motors: with the motors at rest, `turntable` can still move";
    refused(&text, &[joints, "robot.xml:6:", "--actuated JOINT"]);
    let driven = text.replace(
        r#"<motor joint="b"/>"#,
        r#"<motor joint="b"/><motor joint="turntable"/>"#,
    );
    read(&driven, &[]).expect("a robot");
}

#[test]
fn fully_stretched_loops_are_rejected() {
    // Two cranks whose rod is exactly as long as the largest distance between their pins.
    let text = format!(
        r#"<mujoco model="reach"><worldbody>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/></body>
<body name="b" pos="1 0 0">{MASS}<joint name="b" axis="0 1 0"/></body>
<body name="rod" pos="-.1 0 0">{MASS}<joint name="rod" axis="0 1 0"/></body>
<body name="table" pos="2 0 0">{MASS}<joint name="table" axis="0 0 1"/></body>
</worldbody><equality><connect body1="rod" body2="b" anchor="1.2 0 0"/><connect body1="a" body2="b" anchor=".5 0 0"/></equality>
<actuator><motor joint="table"/></actuator></mujoco>"#
    );
    let message = read(&text, &[]);
    assert!(message.is_err(), "{message:?}");
    // Three hinges in line, of which the middle one is displaced only to second order.
    let text = format!(
        r#"<mujoco model="line"><worldbody>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/></body>
<body name="b" pos="1 0 0">{MASS}<joint name="b" axis="0 1 0"/></body>
<body name="table" pos="2 0 0">{MASS}<joint name="table" axis="0 0 1"/></body>
</worldbody><equality><connect body1="a" body2="b" anchor=".4 0 0"/></equality>
<actuator><motor joint="table"/><motor joint="a"/></actuator></mujoco>"#
    );
    refused(&text, &["`a` and `b` can't move", "robot.xml:2:", "--home"]);
}

#[test]
fn joints_that_closures_hold_are_rejected_by_name() {
    let text = format!(
        r#"<mujoco model="held"><worldbody>
<body name="arm">{MASS}<joint name="arm" axis="0 1 0"/>
 <body name="hand" pos="0 0 .1">{MASS}<joint name="hand" axis="0 1 0"/></body></body>
</worldbody><equality><connect body1="hand" body2="arm" anchor=".1 .2 0"/></equality>
<actuator><motor joint="arm"/></actuator></mujoco>"#
    );
    let held = "the closures hold `hand` in place while other joints move";
    refused(&text, &[held, "robot.xml:3:", "remove the joint"]);
}

#[test]
fn impossible_home_positions_are_rejected() {
    let text = format!(
        r#"<mujoco model="arm"><worldbody>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/>
 <body name="b" pos=".4 0 0">{MASS}<joint name="b" axis="0 1 0"/>
  <body name="c" pos=".4 0 0">{MASS}<joint name="c" type="ball"/></body></body></body>
</worldbody><equality><joint joint1="b" joint2="a"/></equality>
<actuator><motor joint="a"/></actuator></mujoco>"#
    );
    let refused = |home: &[(&str, f64)], words: &str| {
        let message = read(&text, home).expect_err("a home that is rejected");
        assert!(message.contains(words), "{words}: {message}");
    };
    let twice = "`--home` names the joint `a` twice";
    refused(&[("a", 0.1), ("a", 0.2)], twice);
    let coupled = "`--home` sets `b`, which is coupled to `a`";
    refused(&[("b", 0.1)], coupled);
    refused(&[("c", 0.1)], "`--home` sets the ball joint `c`");
    let beyond = "the home position 1e300 of `a` is beyond 1e6";
    refused(&[("a", 1e300)], beyond);
}

#[test]
fn misspelt_elements_are_named_if_the_import_fails() {
    let text = format!(
        r#"<mujoco model="open"><worldbody>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/>
 <body name="b" pos=".4 0 0">{MASS}<joint name="b" axis="0 1 0"/></body></body>
<body name="c" pos="0 0 .1">{MASS}<joint name="c" axis="0 1 0"/>
 <body name="d" pos=".4 0 0">{MASS}<joint name="d" axis="0 1 0"/></body></body>
</worldbody><equality><conect body1="b" body2="d" anchor=".1 0 0"/>
<connect body1="b" body2="a" anchor="0 0 0"/></equality>
<actuator><motor joint="a"/></actuator></mujoco>"#
    );
    refused(
        &text,
        &[
            "`conect` is unknown and was not read",
            "robot.xml:6:",
            "did you mean `connect`?",
        ],
    );
}
