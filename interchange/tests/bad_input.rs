//! Invalid or unsupported files: each error has a location and advice.

use overact_interchange::{Options, import};
use std::fs;

/// Error messages of a file.
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

/// URDF with two links, a joint of a type, and additional elements.
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
fn xml_entities_and_deep_nesting_are_rejected() {
    let text = "<?xml version='1.0'?>\n<!DOCTYPE robot [<!ENTITY a 'aaaa'>]>\n<robot name='&a;'/>";
    let message = refused("robot.urdf", text);
    assert!(
        message.contains("document type and its entities"),
        "{message}"
    );
    let message = refused("robot.urdf", "<robot name='r'>\n<link name='a'>\n</robot>");
    assert!(message.starts_with("3: this is not valid XML"), "{message}");
    assert!(refused("robot.urdf", "<collada/>").contains("neither MJCF nor URDF"));
    let deep =
        "<mujoco>".to_owned() + &"<body>".repeat(5000) + &"</body>".repeat(5000) + "</mujoco>";
    assert!(refused("deep.xml", &deep).contains("deep"));
}

#[test]
fn unsupported_joints_and_tendons_are_rejected_by_name() {
    let message = refused("robot.urdf", &two_links("floating", ""));
    assert!(
        message.starts_with("4: the joint `j` is `floating`") && message.contains("--fix-base"),
        "{message}"
    );
    assert!(refused("robot.urdf", &two_links("planar", "")).contains("`planar`"));
    assert!(refused("robot.urdf", &two_links("fixed", "")).contains("no joint that moves"));
    let message = refused("robot.xml", &one_body("<freejoint/>", ""));
    assert!(
        message.starts_with("3: ") && message.contains("--fix-base"),
        "{message}"
    );
    let tendon = "<tendon>\n<spatial name='t' stiffness='1'/></tendon>";
    let message = refused("robot.xml", &one_body("<joint name='j'/>", tendon));
    assert!(
        message.contains("the tendon `t` exerts forces along a path"),
        "{message}"
    );
}

#[test]
fn unknown_names_are_rejected_with_suggestions() {
    let more = "<joint name='k' type='revolute'><parent link='b'/><child link='bb'/></joint>";
    let message = refused("robot.urdf", &two_links("revolute", more));
    assert!(message.starts_with("6: there is no link `bb`"), "{message}");
    let actuator = "<actuator>\n<motor joint='elbov'/></actuator>";
    let message = refused("robot.xml", &one_body("<joint name='elbow'/>", actuator));
    assert!(
        message.contains("7: there is no joint `elbov`") && message.contains("elbow"),
        "{message}"
    );
    let equality = "<equality>\n<connect body1='b' body2='c' anchor='0 0 0'/></equality>";
    let message = refused("robot.xml", &one_body("<joint name='elbow'/>", equality));
    assert!(message.contains("there is no body `c`"), "{message}");
    let options = Options {
        actuated: Some(vec!["k".to_owned()]),
        ..Options::default()
    };
    assert!(
        refused_with("robot.urdf", &two_links("revolute", ""), &options).contains("no joint `k`")
    );
}

#[test]
fn cyclic_joints_and_invalid_numbers_are_rejected() {
    let circle = "<robot name='r'><link name='o'/><link name='a'/><link name='b'/>\n\
        <joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>\n\
        <joint name='k' type='revolute'><parent link='b'/><child link='a'/></joint></robot>";
    assert!(refused("robot.urdf", circle).contains("cycle"));
    let text = two_links("revolute", "").replace("value='1'", "value='1kg'");
    assert!(refused("robot.urdf", &text).contains("`value` of `mass` must be a finite number"));
    let text = two_links("revolute", "").replace("value='1'", "value='nan'");
    assert!(refused("robot.urdf", &text).contains("finite"));
    let axis = two_links("revolute", "").replace("<child", "<axis xyz='0 0 0'/><child");
    assert!(refused("robot.urdf", &axis).contains("no direction"));
}

#[test]
fn missing_and_cyclic_includes_are_rejected() {
    let message = refused(
        "robot.xml",
        "<mujoco>\n<include file='other.xml'/></mujoco>",
    );
    assert!(
        message.starts_with("2: `") && message.contains("can't be read"),
        "{message}"
    );
    let message = refused(
        "robot.xml",
        "<mujoco>\n<include file='robot.xml'/></mujoco>",
    );
    assert!(
        message.starts_with("2: `robot.xml` includes itself"),
        "{message}"
    );
}

#[test]
fn loops_that_cannot_close_are_rejected_by_name() {
    let model = "<mujoco>\n<worldbody>\n<body name='a'><joint name='j'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>\
        <site name='s' pos='1 0 0'/></body><site name='t' pos='3 0 0'/></worldbody>\n\
        <equality>\n<connect name='far' site1='s' site2='t'/></equality>\n<actuator><motor joint='j'/></actuator></mujoco>";
    let message = refused("robot.xml", model);
    assert!(
        message.starts_with("5: the loop of `far` can't close"),
        "{message}"
    );
    let message = refused(
        "robot.xml",
        &model
            .replace("<motor joint='j'/>", "")
            .replace("<actuator></actuator>", ""),
    );
    assert!(
        message.contains("does not say which joints of its loops are driven"),
        "{message}"
    );
}

/// Table of two joints with one line replaced.
fn table(line: &str, by: &str) -> String {
    let text = "(* Robotname = 'two' *)\nNL = 2\nNJ = 2\nNF = 2\nant = {0,1}\nsigma = {0,0}\nb = {0,0}\nd = {0,D2}\n\
        r = {0,0}\ngamma = {0,0}\nalpha = {0,pi/2}\nmu = {1,1}\ntheta = {t1,t2}\nM = {1,M2}\n";
    assert!(text.contains(line));
    text.replace(line, by)
}

#[test]
fn invalid_par_tables_are_rejected_at_their_line() {
    let message = refused("two.par", &table("", ""));
    assert!(
        message.starts_with("8: `D2` has no value") && message.contains("--value D2="),
        "{message}"
    );
    for (line, by, expected) in [
        ("{0,D2}", "{0,0", "8: a list is not closed"),
        ("'two' *)", "'two'", "1: a comment is not closed"),
        ("NF = 2", "NL = 2", "4: `NL` occurs twice"),
        (
            "NF = 2",
            "NF = 3",
            "4: the table has NF = 3 frames; NL = 2 links and NJ = 2 joints have 2",
        ),
        ("NL = 2", "NL = 2.5", "2: `NL` is not an integer"),
        (
            "{0,1}",
            "{0,2}",
            "5: frame 2 has the antecedent 2 and sigma 0",
        ),
        ("{0,1}", "{0}", "5: `ANT` has no value for frame 2"),
        ("{0,pi/2}", "{0,pi//2}", "11: `pi//2` is not an expression"),
        (
            "{t1,t2}",
            "{t1,2*t2}",
            "13: the position of joint 2 is `2*t2`, not a variable plus a constant",
        ),
        (
            "{t1,t2}",
            "{t1,0}",
            "13: the position of joint 2 is `0`, which has 0 variables",
        ),
        (
            "NF = 2",
            "is_floating = 1",
            "4: a moving base is not supported",
        ),
        ("M = {1,M2}", "what", "14: this line belongs to no key"),
        ("M = {1,M2}", "a b = 1", "14: this is not a key"),
    ] {
        let message = refused("two.par", &table(line, by).replace("D2", "0"));
        assert!(message.starts_with(expected), "{by}: {message}");
    }
    // Files in no known format are reported without a line.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.par");
    fs::write(&file, [0_u8, 159, 146, 150]).expect("a file");
    let errors = import(&file, &Options::default()).expect_err("no text");
    let message = errors.0[0].1.iter().map(|error| error.message.clone());
    assert!(message.collect::<String>().contains("can't be read"));
}

#[test]
fn huge_axes_are_normalised() {
    let model = |axis: &str| {
        let text =
            two_links("revolute", "").replace("</joint>", &format!("<axis xyz='{axis}'/></joint>"));
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("robot.urdf");
        fs::write(&file, text).expect("a file");
        import(&file, &Options::default()).expect("a robot").text
    };
    let short = model("0 1 0");
    for long in ["0 1e155 0", "0 1e160 0", "0 1e160 1", "0 1e308 0"] {
        assert_eq!(model(long), short, "{long}");
    }
}

#[test]
fn out_of_range_numbers_and_sizes_are_rejected() {
    let text = two_links("revolute", "");
    let far = text.replace("<mass", "<origin xyz='1e200 0 0'/><mass");
    let message = refused("robot.urdf", &far);
    assert!(
        message.starts_with("3: `b` has a number beyond 1e15"),
        "{message}"
    );
    let placed = text.replace("</joint>", "<origin xyz='0 0 -1e100'/></joint>");
    assert!(refused("robot.urdf", &placed).contains("`b` has a number beyond"));
    let damped = text.replace("</joint>", "<dynamics damping='1e300'/></joint>");
    assert!(refused("robot.urdf", &damped).starts_with("4: the joint `j` has a number"));
    let chain = |count: usize| {
        let one = |at: usize| {
            format!(
                "<link name='l{at}'/><joint name='k{at}' type='revolute'><parent link='l{}'/><child link='l{at}'/></joint>",
                at - 1
            )
        };
        let all: String = (1..=count).map(one).collect();
        format!("<robot name='r'><link name='l0'/>{all}</robot>")
    };
    assert!(refused("robot.urdf", &chain(201)).contains("201 joints that move, more than 200"));
    assert!(
        refused("robot.urdf", &chain(2001)).contains("2001 elements of joints, more than 2000")
    );
}

#[test]
fn a_coupling_factor_of_zero_is_rejected() {
    let more = "<link name='c'/><joint name='k' type='revolute'><parent link='b'/><child link='c'/>\n<mimic joint='j' multiplier='0'/></joint>";
    let message = refused("robot.urdf", &two_links("revolute", more));
    assert!(
        message.starts_with("6: the joint `k` is coupled to another with the factor 0"),
        "{message}"
    );
}

#[test]
fn deeply_nested_expressions_and_attributes_are_rejected() {
    let table = "NL = 1\nNJ = 1\nNF = 1\nant = {0}\nsigma = {0}\nb = {0}\nd = {0}\nr = {0}\ngamma = {0}\ntheta = {t1}\n";
    for deep in [
        "1^".repeat(100_000),
        "(".repeat(100_000),
        "sin(".repeat(100_000),
    ] {
        let message = refused("robot.par", &format!("{table}alpha = {{{deep}1}}\n"));
        assert!(
            message.contains("is not an expression"),
            "{}",
            &message[..200]
        );
    }
    let folder = tempfile::tempdir().expect("a folder");
    let bodies = |inside: &str| {
        let (open, close) = ("<body>".repeat(390), "</body>".repeat(390));
        format!("<mujoco><worldbody>{open}{inside}{close}</worldbody></mujoco>")
    };
    fs::write(folder.path().join("inner.xml"), bodies("")).expect("a file");
    let file = folder.path().join("outer.xml");
    fs::write(&file, bodies("<include file='inner.xml'/>")).expect("a file");
    let errors = import(&file, &Options::default()).expect_err("too deep");
    assert!(format!("{errors:?}").contains("more than 400 deep"));
    let attributes: String = (0..10_000).map(|at| format!(" a{at}=''")).collect();
    let message = refused("robot.urdf", &format!("<robot{attributes}/>"));
    assert!(message.contains("more than 5000 attributes"), "{message}");
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_included() {
    let anywhere = Options {
        include_outside: true,
        ..Options::default()
    };
    for device in ["/dev/zero", "."] {
        let message = refused_with(
            "robot.xml",
            &format!("<mujoco>\n<include file='{device}'/></mujoco>"),
            &anywhere,
        );
        assert!(
            message.starts_with("2: ") && message.contains("not a regular file"),
            "{message}"
        );
    }
}

/// Files outside the robot's folder may be secret; their contents must not be in messages.
#[cfg(unix)]
#[test]
fn files_outside_the_folder_are_included_only_with_an_option() {
    let outer = tempfile::tempdir().expect("a folder");
    let inner = outer.path().join("robot");
    fs::create_dir(&inner).expect("a folder");
    let secret = outer.path().join("secret.xml");
    fs::write(&secret, "not for others").expect("a file");
    std::os::unix::fs::symlink(&secret, inner.join("link.xml")).expect("a link");
    let absolute = secret.display().to_string();
    for name in [
        absolute.as_str(),
        "../secret.xml",
        "link.xml",
        "/no/such.xml",
    ] {
        let file = inner.join("robot.xml");
        fs::write(&file, format!("<mujoco><include file='{name}'/></mujoco>")).expect("a file");
        let errors = import(&file, &Options::default()).expect_err("a file outside");
        let each = errors.0.iter();
        let message: String = each.map(|(source, own)| own.render_plain(source)).collect();
        assert!(message.contains("is outside the folder"), "{message}");
        assert!(!message.contains("not for others"), "{message}");
    }
}

/// An option or a link allows more files; their contents must not be in messages either.
#[cfg(unix)]
#[test]
fn messages_never_show_contents_of_files_outside_the_folder() {
    let outer = tempfile::tempdir().expect("a folder");
    let inner = outer.path().join("robot");
    fs::create_dir(&inner).expect("a folder");
    let anywhere = Options {
        include_outside: true,
        ..Options::default()
    };
    let secret = outer.path().join("secret");
    let robot = inner.join("robot.xml");
    fs::write(&robot, "<mujoco><include file='../secret'/></mujoco>").expect("a file");
    let contents = [
        "confidential: x\nsecond",
        "<mujoco><confidential/>\n<worldbody><joint type='confidential'/><body><joint axis='confidential'/></body></worldbody></mujoco>",
        "<mujoco><option confidential='1'/>\n<worldbody><confidential/></worldbody></mujoco>",
    ];
    for text in contents {
        fs::write(&secret, text).expect("a file");
        let message = match import(&robot, &anywhere) {
            Ok(imported) => format!("{:?}", imported.account),
            Err(errors) => {
                let each = errors.0.iter();
                each.map(|(source, own)| own.render_plain(source)).collect()
            }
        };
        assert!(!message.contains("confidential"), "{message}");
    }
    // A YAML file next to a URDF may be a link.
    let urdf = inner.join("robot.urdf");
    fs::write(&urdf, "<robot name='r'><link name='a'/></robot>").expect("a file");
    std::os::unix::fs::symlink(&secret, inner.join("robot.yaml")).expect("a link");
    fs::write(&secret, "confidential").expect("a file");
    let errors = import(&urdf, &Options::default()).expect_err("no YAML");
    let each = errors.0.iter();
    let message: String = each.map(|(source, own)| own.render_plain(source)).collect();
    assert!(
        message.contains("contents are not shown") && !message.contains("confidential"),
        "{message}"
    );
}

/// A pipe without a writer would block whoever opens it.
#[cfg(unix)]
#[test]
fn a_pipe_next_to_a_urdf_is_not_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("other.yaml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo").success());
    let file = folder.path().join("robot.urdf");
    let text = "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/>\
                <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
                <joint name='j' type='continuous'><parent link='a'/><child link='b'/>\
                <axis xyz='0 0 1'/></joint></robot>";
    fs::write(&file, text).expect("a file");
    assert!(import(&file, &Options::default()).is_ok());
}

#[test]
fn included_files_are_limited_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let blanks = " ".repeat(9 << 20);
    fs::write(
        folder.path().join("large.xml"),
        format!("<mujoco>{blanks}</mujoco>"),
    )
    .expect("a file");
    let file = folder.path().join("outer.xml");
    fs::write(
        &file,
        format!(
            "<mujoco>{}</mujoco>",
            "<include file='large.xml'/>".repeat(3)
        ),
    )
    .expect("a file");
    let errors = import(&file, &Options::default()).expect_err("too large");
    assert!(format!("{errors:?}").contains("may have 16777216 bytes together"));
}

#[test]
fn stretched_loops_with_fixed_closure_frames_are_rejected() {
    // A pendulum of two links whose tip is held by two more links; frame 6 is fixed to the body of
    // frame 5.
    let table = |d: &str| {
        format!(
            "NL = 5\nNJ = 7\nNF = 9\nant = {{0,1,0,0,0,3,5,2,8}}\nsigma = {{0,0,0,0,0,0,0,2,2}}\nb = {{0,0,0,0,0,0,0,0,0}}\n\
             d = {d}\nr = {{0,0,0,0,0,0,0,0,0}}\ngamma = {{0,0,0,0,0,0,0,0,0}}\nalpha = {{0,0,0,0,0,0,0,0,0}}\n\
             mu = {{1,0,0,1,0,0,0,0,0}}\ntheta = {{t1,t2,t3,t4,t5,t6,t7,0,0}}\n"
        )
    };
    // The loops are open by less than the tolerance, and then at their full reach.
    let message = refused("robot.par", &table("{0,0.3,0.6,1.0,0.8,0.2,0.25,0.3,0.1}"));
    assert!(
        message.starts_with("12: ") && message.contains("can't move"),
        "{message}"
    );
}

#[test]
fn unknown_file_formats_are_rejected_with_the_supported_ones() {
    for (text, expected) in [
        ("", "1: the file is empty"),
        ("\n \n", "1: the file is empty"),
        (
            "solid robot\n",
            "1: the file is neither XML nor a .par table",
        ),
    ] {
        let message = refused("robot.urdf", text);
        assert!(
            message.starts_with(expected) && message.contains("URDF (<robot>)"),
            "{message}"
        );
    }
}

#[test]
fn common_mistakes_are_rejected_with_the_correction() {
    let mass = |value: &str| {
        two_links("revolute", "").replace("mass value='1'", &format!("mass value='{value}'"))
    };
    for value in ["1 kg", "0,5"] {
        let message = refused("robot.urdf", &mass(value));
        assert!(
            message.contains("a decimal point, without units"),
            "{value}: {message}"
        );
    }
    let message = refused(
        "robot.xml",
        "<mujoco><worldbody><body><joint/><geom type='capsul' size='1 1'/></body></worldbody></mujoco>",
    );
    assert!(
        message.contains("`capsul` is not a value of `type` of `geom`"),
        "{message}"
    );
    let message = refused("two.par", &table("gamma = {0,0}\n", ""));
    assert!(message.contains("the table has no `GAMMA`"), "{message}");
    let message = refused("two.par", &table("{0,pi/2}", "{0,90 deg}"));
    assert!(message.contains("angles in rad"), "{message}");
}
