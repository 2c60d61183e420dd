//! Contents that import would lose silently: each is used, reported, or an error at its line.

use overact_interchange::{Imported, Options, import};

/// Imports a file; errors are listed with their lines.
fn read(name: &str, text: &str) -> Result<Imported, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, text).expect("a file");
    import(&file, &Options::default()).map_err(|errors| {
        let mut all = String::new();
        for (source, diagnostics) in &errors.0 {
            for error in diagnostics {
                let span = error.span.as_ref().expect("a place");
                assert!(error.help.is_some(), "{}", error.message);
                all += &format!("{}: {}\n", source.position(span).line, error.message);
            }
        }
        all
    })
}

/// Reported entries: line and subject.
fn reported(name: &str, text: &str) -> Vec<String> {
    let found = read(name, text).unwrap_or_else(|errors| panic!("{text}: {errors}"));
    let entries = found.account.reported.iter();
    let shown = entries.map(|entry| format!("{}: {}", entry.line, entry.subject()));
    shown.collect()
}

fn refused(name: &str, text: &str) -> String {
    match read(name, text) {
        Ok(_) => panic!("not refused: {text}"),
        Err(errors) => errors,
    }
}

fn gravity(name: &str, text: &str) -> String {
    let found = read(name, text).unwrap_or_else(|errors| panic!("{text}: {errors}"));
    let mut lines = found.text.lines();
    let line = lines.find(|line| line.starts_with("gravity = "));
    line.expect("gravity").to_owned()
}

fn mjcf(head: &str, body: &str) -> String {
    format!(
        "<mujoco>{head}\n<worldbody><body name='b'><joint name='j' axis='0 1 0'/>\n{body}</body></worldbody></mujoco>"
    )
}

const INERTIAL: &str = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";

fn urdf(link: &str, joint: &str, more: &str) -> String {
    format!(
        "<robot name='r'><link name='a'/><link name='b'>\n{link}</link>\n\
         <joint name='j' type='revolute'><parent link='a'/><child link='b'/>\n{joint}</joint>\n{more}</robot>"
    )
}

const URDF_INERTIAL: &str =
    "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>";

fn sdf(version: &str, world: &str, link: &str, joint: &str) -> String {
    format!(
        "<sdf version='{version}'><world name='w'>{world}\n<model name='m'><link name='a'>\n{link}</link>\n\
         <joint name='j' type='revolute'><parent>world</parent><child>a</child>\n{joint}</joint></model></world></sdf>"
    )
}

const AXIS: &str = "<axis><xyz>0 0 1</xyz></axis>";

fn par(line: &str, by: &str) -> String {
    let text = "NL = 2\nNJ = 2\nNF = 2\nant = {0,1}\nsigma = {0,0}\nb = {0,0}\nd = {0,0.5}\nr = {0,0}\n\
        gamma = {0,0}\nalpha = {0,pi/2}\ntheta = {t1,t2}\nXX = {1,1}\nYY = {1,1}\nZZ = {1,1}\nM = {1,1}\n";
    assert!(text.contains(line));
    text.replace(line, by)
}

#[test]
fn physics_gravity_is_read_until_sdformat_1_5_and_reported_later() {
    let physics = "<physics type='ode'><gravity>0 0 -1.62</gravity><max_step_size>0.1</max_step_size></physics>";
    for version in ["1.4", "1.5"] {
        let text = sdf(version, physics, "", AXIS);
        assert_eq!(gravity("r.sdf", &text), "gravity = [0, 0, -1.62]");
        assert_eq!(reported("r.sdf", &text), [""; 0]);
    }
    let text = sdf("1.6", physics, "", AXIS);
    assert_eq!(gravity("r.sdf", &text), "gravity = [0, 0, -9.8]");
    assert_eq!(reported("r.sdf", &text), ["1: gravity"]);
    let both = format!("<gravity>0 0 -3</gravity>{physics}");
    assert_eq!(
        reported("r.sdf", &sdf("1.5", &both, "", AXIS)),
        ["1: gravity"]
    );
}

#[test]
fn the_mjcf_gravity_flag_acts_in_any_order() {
    let (vector, flag) = (
        "<option gravity='0 0 -5'/>",
        "<option><flag gravity='disable'/></option>",
    );
    for head in [format!("{vector}{flag}"), format!("{flag}{vector}")] {
        assert_eq!(
            gravity("r.xml", &mjcf(&head, INERTIAL)),
            "gravity = [0, 0, 0]"
        );
    }
    let enabled = format!("{flag}{vector}<option><flag gravity='enable'/></option>");
    assert_eq!(
        gravity("r.xml", &mjcf(&enabled, INERTIAL)),
        "gravity = [0, 0, -5.0]"
    );
    let unknown = mjcf("<option><flag gravity='off'/></option>", INERTIAL);
    assert!(refused("r.xml", &unknown).starts_with("1: `off` is not a value of `gravity`"));
}

#[test]
fn contents_of_the_urdf_mujoco_extension_are_reported() {
    let more = "<mujoco><compiler meshdir='m' balanceinertia='true' inertiafromgeom='auto' foo='1'/>\n\
        <option gravity='0 0 -1.62' timestep='0.1' density='0'><flag gravity='disable' contact='disable'/></option>\n\
        <actuator/></mujoco>";
    assert_eq!(
        reported("r.urdf", &urdf(URDF_INERTIAL, "", more)),
        [
            "5: compiler balanceinertia",
            "5: compiler foo",
            "6: option gravity",
            "6: flag gravity",
            "7: actuator"
        ]
    );
    let usual =
        "<mujoco><option gravity='0 0 -9.81'><flag gravity='enable'/></option><size/></mujoco>";
    assert_eq!(reported("r.urdf", &urdf(URDF_INERTIAL, "", usual)), [""; 0]);
}

#[test]
fn empty_text_is_neutral_only_without_attributes_and_children() {
    let more = "<gazebo reference='b'><turnGravityOff value='true'/>\n<gravity/>\n\
        <kinematic><x/></kinematic>\n<velocity_decay><linear>0</linear><angular>1</angular></velocity_decay></gazebo>";
    assert_eq!(
        reported("r.urdf", &urdf(URDF_INERTIAL, "", more)),
        ["5: turnGravityOff", "7: kinematic", "8: angular"]
    );
    let text = mjcf("<option density=''/>", INERTIAL);
    assert_eq!(reported("r.xml", &text), ["1: option density"]);
    let moved =
        "<gazebo><pose>0 0 0 1.57 0 0</pose></gazebo><gazebo><pose>0 0 0 0 0 0</pose></gazebo>";
    assert_eq!(
        reported("r.urdf", &urdf(URDF_INERTIAL, "", moved)),
        ["5: pose"]
    );
}

#[test]
fn duplicate_elements_are_rejected_at_their_line() {
    let twice = |text: &str| format!("{text}\n{text}");
    for (text, expected) in [
        (
            urdf(&twice(URDF_INERTIAL), "", ""),
            "3: <link> has a second <inertial>",
        ),
        (
            urdf(
                "<inertial><mass value='1'/>\n<mass value='2'/></inertial>",
                "",
                "",
            ),
            "3: <inertial> has a second <mass>",
        ),
        (
            urdf("<inertial><inertia/>\n<inertia/></inertial>", "", ""),
            "3: <inertial> has a second <inertia>",
        ),
        (
            urdf("", &twice("<mimic joint='k'/>"), ""),
            "5: <joint> has a second <mimic>",
        ),
        (
            urdf("", &twice("<axis xyz='0 0 1'/>"), ""),
            "5: <joint> has a second <axis>",
        ),
        (
            urdf("", &twice("<origin xyz='0 0 1'/>"), ""),
            "5: <joint> has a second <origin>",
        ),
        (
            urdf("", &twice("<dynamics damping='1'/>"), ""),
            "5: <joint> has a second <dynamics>",
        ),
    ] {
        let message = refused("r.urdf", &text);
        assert!(message.starts_with(expected), "{message}");
    }
    for (text, expected) in [
        (
            sdf("1.9", "", &twice("<pose>0 0 0 0 0 0</pose>"), AXIS),
            "4: <link> has a second <pose>",
        ),
        (
            sdf(
                "1.9",
                "",
                "<inertial><mass>1</mass>\n<mass>2</mass></inertial>",
                AXIS,
            ),
            "4: <inertial> has a second <mass>",
        ),
        (
            sdf("1.9", "", "", &twice(AXIS)),
            "6: <joint> has a second <axis>",
        ),
        (
            sdf("1.9", &twice("<gravity>0 0 -1</gravity>"), "", AXIS),
            "2: <world> has a second <gravity>",
        ),
    ] {
        let message = refused("r.sdf", &text);
        assert!(message.starts_with(expected), "{message}");
    }
    let message = refused("r.xml", &mjcf("", &twice(INERTIAL)));
    assert!(
        message.starts_with("4: <body> has a second <inertial>"),
        "{message}"
    );
    let framed = format!("{INERTIAL}\n<frame>{INERTIAL}</frame>");
    let message = refused("r.xml", &mjcf("", &framed));
    assert!(
        message.starts_with("4: a body has a second <inertial>"),
        "{message}"
    );
}

#[test]
fn sdformat_booleans_may_be_capitalised_and_mjcf_booleans_not() {
    let turned = |word: &str| {
        sdf(
            "1.9",
            "",
            &format!("<pose degrees='{word}'>0 0 1 90 0 0</pose>"),
            "<axis><xyz expressed_in='__model__'>0 0 1</xyz></axis>",
        )
    };
    let expected = read("r.sdf", &turned("true")).expect("a robot").text;
    for word in ["True", "TRUE", "1"] {
        assert_eq!(
            read("r.sdf", &turned(word)).expect("a robot").text,
            expected
        );
    }
    let message = refused("r.sdf", &turned("yes"));
    assert!(
        message.starts_with("3: `yes` is neither true nor false"),
        "{message}"
    );
    let message = refused("r.xml", &mjcf("", "<geom size='0.1' shellinertia='True'/>"));
    assert!(
        message.starts_with("3: `True` is not a value of `shellinertia`"),
        "{message}"
    );
}

#[test]
fn par_keys_ignore_case_and_extra_values_are_reported() {
    let text = par("NL", "NL").to_lowercase();
    assert!(read("r.par", &text).is_ok());
    assert_eq!(
        reported("r.par", &par("d = {0,0.5}", "d = {0,0.5,3}")),
        ["7: par D"]
    );
    assert_eq!(
        reported("r.par", &par("M = {1,1}", "M = {1,1,0,M4,2}")),
        ["15: par M"]
    );
}

#[test]
fn nonlinear_par_positions_are_rejected() {
    let message = refused("r.par", &par("{t1,t2}", "{t1,sin(t1)}"));
    assert!(
        message.starts_with("11: the position of joint 2 is `sin(t1)`, which is not linear"),
        "{message}"
    );
}

#[test]
fn height_fields_are_reported_as_unknown_inertia() {
    let field = |mass: &str| {
        mjcf(
            "<asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/></asset>",
            &format!("<geom type='hfield' hfield='h' {mass}/><geom size='0.1'/>"),
        )
    };
    assert_eq!(reported("r.xml", &field("")), ["3: geom"]);
    assert_eq!(reported("r.xml", &field("mass='0'")), [""; 0]);
}

#[test]
fn unexpected_text_and_missing_values_are_reported() {
    let link = "<inertial><mass>2</mass><inertia ixx='1' iyy='1'/></inertial>";
    let found = reported("r.urdf", &urdf(link, "<axis/>", ""));
    for expected in ["2: mass", "2: mass value", "2: inertia izz", "4: axis xyz"] {
        assert!(
            found.iter().any(|entry| entry == expected),
            "{expected}: {found:?}"
        );
    }
    let text = mjcf("", &format!("{INERTIAL}\nstray"));
    assert_eq!(reported("r.xml", &text), ["4: body"]);
    let second = format!("{AXIS}\n<axis2><xyz>0 1 0</xyz></axis2>");
    assert_eq!(
        reported("r.sdf", &sdf("1.9", "", "", &second)),
        ["6: axis2"]
    );
}

#[test]
fn negative_masses_are_rejected_at_their_line() {
    for (name, text, line) in [
        ("r.xml", mjcf("", &INERTIAL.replace("'1'", "'-1'")), 3),
        ("r.xml", mjcf("", "<geom size='0.1' mass='-1'/>"), 3),
        (
            "r.urdf",
            urdf(&URDF_INERTIAL.replacen("'1'", "'-1'", 1), "", ""),
            2,
        ),
        (
            "r.sdf",
            sdf("1.9", "", "<inertial><mass>-1</mass></inertial>", AXIS),
            3,
        ),
        ("r.par", par("M = {1,1}", "M = {1,-1}"), 15),
    ] {
        let message = refused(name, &text);
        assert!(
            message.starts_with(&format!("{line}: a mass is negative")),
            "{message}"
        );
    }
    let message = refused("r.xml", &mjcf("", "<geom size='0.1' density='-1'/>"));
    assert!(message.starts_with("3: a density is negative"), "{message}");
}

#[test]
fn impossible_inertias_are_kept_and_reported_with_their_body() {
    let heavy = INERTIAL.replace("1 1 1", "1 1 3");
    let text = mjcf("", &heavy);
    let found = read("r.xml", &text).expect("a robot");
    let [entry] = &found.account.reported[..] else {
        panic!("{:?}", found.account.reported)
    };
    assert!(
        entry.reason.starts_with("`b`: ") && entry.reason.contains("one exceeds the sum"),
        "{entry:?}"
    );
    for (name, text) in [
        (
            "r.urdf",
            urdf(&URDF_INERTIAL.replace("izz='1'", "izz='3'"), "", ""),
        ),
        ("r.par", par("ZZ = {1,1}", "ZZ = {1,3}")),
        ("r.xml", mjcf("", &INERTIAL.replace("1 1 1", "1 1 -1"))),
    ] {
        let found = reported(name, &text);
        assert!(
            found.len() == 1 && found[0].ends_with("inertia"),
            "{found:?}"
        );
    }
    // Thin rods and plates are at the limit.
    for diagonal in ["0 1 1", "1 1 2", "0.35 0.66 1.03"] {
        let text = mjcf("", &INERTIAL.replace("1 1 1", diagonal));
        assert_eq!(reported("r.xml", &text), [""; 0]);
    }
}

#[test]
fn xacro_files_are_rejected_at_their_first_macro() {
    let text = |more: &str| {
        urdf(URDF_INERTIAL, "", more).replace(
            "<robot",
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'",
        )
    };
    let message = refused("r.urdf", &text("<xacro:property name='l' value='1'/>"));
    assert!(message.starts_with("5: this is a xacro file"), "{message}");
    assert!(read("r.urdf", &text("<!-- <xacro:arm/> -->")).is_ok());
}
