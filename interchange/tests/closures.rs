//! Closed mechanisms as people write them: rounded numbers, idle spins, free platforms.

use overact_codegen::{Checked, Source, check};
use overact_interchange::{Imported, Options, import};

/// Import of a text and the check of its description.
fn imported_with(name: &str, text: &str, options: &Options) -> (Imported, Checked) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("a file");
    let imported = import(&path, options).unwrap_or_else(|errors| panic!("{}", shown(&errors)));
    let source = Source::new("made.toml", imported.text.clone());
    match check(&source) {
        Ok(checked) => (imported, checked),
        Err(errors) => panic!("{}\n{}", errors.render_plain(&source), imported.text),
    }
}

fn imported(text: &str) -> (Imported, Checked) {
    imported_with("robot.xml", text, &Options::default())
}

/// Messages of a rejected file.
fn refused(text: &str, options: &Options) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.xml");
    std::fs::write(&path, text).expect("a file");
    shown(&import(&path, options).expect_err("a file that is rejected"))
}

fn shown(errors: &overact_interchange::Errors) -> String {
    let each = errors.0.iter();
    each.map(|(source, errors)| errors.render_plain(source))
        .collect()
}

const MASS: &str = r#"<inertial pos="0.1 0 0.05" mass="1" diaginertia=".01 .02 .02"/>"#;

/// A planar four-bar whose coupler pin has a given axis, and whose closure is off the plane.
fn four_bar(axis: &str, offset: f64) -> String {
    format!(
        r#"<mujoco model="bar"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 1 0"/>
 <body name="coupler" pos="0 0 .1">{MASS}<joint name="coupler" axis="{axis}"/><site name="p" pos=".3 0 .1"/></body></body>
<body name="rocker" pos=".3 0 0">{MASS}<joint name="rocker" axis="0 1 0"/><site name="s" pos="0 {offset} .2"/></body>
</worldbody><equality><connect name="loop" site1="p" site2="s"/></equality>
<actuator><motor joint="crank"/></actuator></mujoco>"#
    )
}

#[test]
fn tilted_axes_of_planar_loops_are_made_parallel_and_reported() {
    for tilt in [
        "0 1 2e-9", "2e-8 1 0", "5e-8 1 0", "0 1 1e-7", "0 1 3e-7", "0 1 1e-6", "1e-3 1 0",
    ] {
        let (imported, checked) = imported(&four_bar(tilt, 0.0));
        let mechanism = &checked.mechanism;
        assert_eq!((mechanism.dof(), mechanism.actuated().len()), (1, 1));
        assert_eq!(imported.misfits.len(), 1, "{tilt}");
        assert_eq!(imported.misfits[0].name, "coupler");
        assert!(imported.text.contains("Misfit of the loops: `coupler`"));
    }
    let (exact, _) = imported(&four_bar("0 1 0", 0.0));
    assert!(exact.misfits.is_empty());
}

#[test]
fn closures_off_the_plane_are_shifted_within_the_tolerance() {
    let (imported, _) = imported(&four_bar("0 1 0", 3e-4));
    let misfit = &imported.misfits[0];
    assert_eq!(misfit.name, "loop");
    assert!((misfit.length - 3e-4).abs() < 1e-12, "{misfit:?}");
    let text = four_bar("0 1 0", 3e-3);
    let message = refused(&text, &Options::default());
    assert!(message.contains("3.00e-3 m"), "{message}");
    assert!(message.contains("--closure-tolerance"), "{message}");
    let options = Options {
        closure_tolerance: Some(0.02),
        ..Options::default()
    };
    let (imported, _) = imported_with("robot.xml", &text, &options);
    assert!(imported.text.contains("--closure-tolerance 0.02"));
    let strict = Options {
        closure_tolerance: Some(0.0),
        ..Options::default()
    };
    refused(&four_bar("0 1 0", 3e-4), &strict);
}

/// A planar five-bar of URDF whose first leg is rotated by a rounded right angle.
fn five_bar(angle: &str) -> String {
    let link = |name: &str| {
        format!(
            r#"<link name="{name}"><inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>"#
        )
    };
    let joint = |name: &str, parent: &str, child: &str, origin: &str, axis: &str| {
        format!(
            r#"<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/><origin {origin}/><axis xyz="{axis}"/></joint>"#
        )
    };
    let links: String = ["base", "a1", "a2", "b1", "b2"].map(link).concat();
    let joints = [
        joint("a", "base", "a1", &format!(r#"xyz="0 0 0" rpy="{angle} 0 0""#), "0 0 1"),
        joint("a_", "a1", "a2", r#"xyz="0 .2 0" rpy="0 0 .9""#, "0 0 1"),
        joint("b", "base", "b1", r#"xyz=".3 0 0" rpy="0 -1.5707963267948966 0""#, "0 -1 0"),
        joint("b_", "b1", "b2", r#"xyz=".2 0 0" rpy="0 -.6 0""#, "0 -1 0"),
        r#"<joint name="fA" type="fixed"><parent link="a2"/><child link="tA"/><origin xyz=".25 0 0"/></joint><link name="tA"/>"#.to_owned(),
        r#"<joint name="fB" type="fixed"><parent link="b2"/><child link="tB"/><origin xyz=".25 0 0"/></joint><link name="tB"/>"#.to_owned(),
    ];
    format!(r#"<robot name="five">{links}{}</robot>"#, joints.concat())
}

#[test]
fn a_planar_five_bar_with_rounded_angles_keeps_both_degrees_of_freedom() {
    for angle in ["1.570796", "1.5708", "1.57"] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("robot.urdf");
        std::fs::write(&path, five_bar(angle)).expect("a file");
        let pairs = "closed_loop: [['tA','tB']]\ntype: ['3d']\nname_mot: ['a','b']\n";
        std::fs::write(folder.path().join("robot.yaml"), pairs).expect("a file");
        let imported = import(&path, &Options::default())
            .unwrap_or_else(|errors| panic!("{angle}: {}", shown(&errors)));
        let source = Source::new("made.toml", imported.text.clone());
        let checked = check(&source).expect("a valid description");
        assert_eq!(checked.mechanism.dof(), 2, "{angle}");
        assert!(!imported.misfits.is_empty(), "{angle}");
    }
}

/// A four-bar whose configuration zero is open or outside of the limits, with a keyframe.
fn four_bar_with(crank: &str, rocker: &str, more: &str) -> String {
    format!(
        r#"<mujoco model="bar"><compiler angle="radian"/><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 -1 0" {crank}/>
 <body name="coupler" pos=".1 0 0">{MASS}<joint name="coupler" axis="0 -1 0"/><site name="p" pos=".3 0 0"/></body></body>
<body name="rocker" pos=".3 0 0">{MASS}<joint name="rocker" axis="0 -1 0" {rocker}/><site name="s" pos=".2 0 0"/></body>
</worldbody><equality><connect name="loop" site1="p" site2="s"/></equality>
<actuator><motor joint="crank"/></actuator>{more}</mujoco>"#
    )
}

/// Home position of a joint in the text of a description.
fn home_of(text: &str, joint: &str) -> f64 {
    let words: Vec<&str> = text.split_whitespace().collect();
    let at = words
        .windows(2)
        .position(|pair| pair[0].trim_matches(['`', '{']) == joint && pair[1] == "=");
    let value = words[at.expect("a home") + 2].trim_matches(['}', ',']);
    value.parse().expect("a number")
}

#[test]
fn the_motor_is_the_coordinate_and_the_keyframe_the_home_pose() {
    let key = r#"<keyframe><key name="other" qpos="0 0 0"/><key name="home" qpos="1 -.6 1.5"/></keyframe>"#;
    let (imported, checked) = imported(&four_bar_with("", "", key));
    assert_eq!(checked.mechanism.coordinates(), ["crank"]);
    assert!(imported.text.contains("keyframe"), "{}", imported.text);
    let home = home_of(&imported.text, "crank");
    assert!((home - 1.0).abs() < 0.3, "{home}");
}

#[test]
fn the_home_pose_is_within_the_joint_limits() {
    for (range, sign) in [("0.3 2.8", 1.0), ("-2.8 -0.3", -1.0)] {
        let limited = format!(r#"range="{range}" limited="true""#);
        let text = four_bar_with(r#"range="0.2 1.8" limited="true""#, &limited, "");
        let (imported, _) = imported(&text);
        let home = home_of(&imported.text, "rocker");
        assert!(home * sign > 0.29, "{range}: {home}");
    }
}

#[test]
fn the_home_of_a_slider_crank_is_moved_off_its_dead_centre() {
    let text = format!(
        r#"<mujoco model="dead"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 1 0"/>
 <body name="rod" pos=".1 0 0">{MASS}<joint name="rod" axis="0 1 0"/></body></body>
<body name="piston" pos=".5 0 0">{MASS}<joint name="piston" type="slide" axis="1 0 0"/></body>
</worldbody><equality><connect body1="rod" body2="piston" anchor=".4 0 0"/></equality>
<actuator><motor joint="piston"/></actuator></mujoco>"#
    );
    let (imported, checked) = imported(&text);
    assert_eq!(checked.mechanism.dof(), 1);
    assert!(imported.text.contains("Home is moved"), "{}", imported.text);
}

/// A plate held by two cranks, as a free body.
#[test]
fn a_free_body_on_two_cranks_becomes_a_coupler() {
    let text = format!(
        r#"<mujoco model="plate"><worldbody>
<body name="a" pos="-.1 0 0">{MASS}<joint name="a" axis="0 1 0"/></body>
<body name="b" pos=".1 0 0">{MASS}<joint name="b" axis="0 1 0"/></body>
<body name="plate" pos="0 0 .2">{MASS}<freejoint/></body></worldbody>
<equality><connect body1="a" body2="plate" anchor="0 0 .2"/><connect body1="b" body2="plate" anchor="0 0 .25"/></equality>
<actuator><motor joint="a"/></actuator></mujoco>"#
    );
    let (imported, checked) = imported(&text);
    assert_eq!(checked.mechanism.coordinates(), ["a"]);
    assert_eq!(imported.spins, ["plate"]);
}

#[test]
fn a_free_base_without_closures_to_the_ground_is_rejected() {
    let text = format!(
        r#"<mujoco><worldbody><body name="base">{MASS}<freejoint name="float"/>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/></body>
<body name="b" pos=".3 0 0">{MASS}<joint name="b" axis="0 1 0"/></body></body></worldbody>
<equality><connect body1="a" body2="b" anchor=".1 0 0"/></equality>
<actuator><motor joint="a"/></actuator></mujoco>"#
    );
    let message = refused(&text, &Options::default());
    assert!(
        message.contains("free joint") && message.contains("--fix-base"),
        "{message}"
    );
}

/// A platform on six legs; `leg` gives the joints of a leg with its slide.
fn hexapod(leg: &str) -> String {
    let (mut legs, mut connects, mut motors) = (String::new(), String::new(), String::new());
    for at in 0..6 {
        let base =
            std::f64::consts::FRAC_PI_3 * f64::from(at / 2 * 2) + [0.2, 1.9][at as usize % 2] - 0.5;
        let top =
            std::f64::consts::FRAC_PI_3 * f64::from(at / 2 * 2) + [0.7, 1.3][at as usize % 2] - 0.5;
        let [x, y] = [0.4 * base.cos(), 0.4 * base.sin()];
        let [u, v] = [0.2 * top.cos() - x, 0.2 * top.sin() - y];
        let first = leg.replace('#', &at.to_string());
        legs += &format!(
            r#"<body name="low{at}" pos="{x} {y} 0">{MASS}{first}<body name="up{at}" pos="{} {} .25">{MASS}<joint name="s{at}" type="slide" axis="{u} {v} .5"/><site name="t{at}" pos="{} {} .25"/></body></body>"#,
            0.5 * u,
            0.5 * v,
            0.5 * u,
            0.5 * v
        );
        connects += &format!(
            r#"<connect body1="up{at}" body2="plate" anchor="{} {} .25"/>"#,
            0.5 * u,
            0.5 * v
        );
        motors += &format!(r#"<motor joint="s{at}"/>"#);
    }
    format!(
        r#"<mujoco model="six"><compiler angle="radian"/><worldbody>
<body name="plate" pos="0 0 .5">{MASS}<freejoint/></body>{legs}</worldbody>
<equality>{connects}</equality><actuator>{motors}</actuator></mujoco>"#
    )
}

#[test]
fn a_free_platform_on_six_legs_has_six_coordinates() {
    let universal = r##"<joint name="u#" axis="1 0 0"/><joint name="w#" axis="0 1 0"/>"##;
    let (imported, checked) = imported(&hexapod(universal));
    let mechanism = &checked.mechanism;
    assert_eq!((mechanism.dof(), mechanism.actuated().len()), (6, 6));
    assert!(imported.spins.is_empty());
}

#[test]
fn free_spins_of_legs_between_two_balls_are_removed() {
    let (imported, checked) = imported(&hexapod(r##"<joint name="b#" type="ball"/>"##));
    let mechanism = &checked.mechanism;
    assert_eq!((mechanism.dof(), mechanism.actuated().len()), (6, 6));
    assert_eq!(imported.spins.len(), 6, "{:?}", imported.spins);
}
