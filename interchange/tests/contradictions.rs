//! Files that contradict themselves or MuJoCo's rules, and names that are nearly equal.

use overact_interchange::{Imported, Options, import};
use std::{fs, path::Path};

const MASS: &str = r#"<inertial pos="0.1 0.02 0" mass="1" diaginertia=".02 .02 .01"/>"#;

/// Errors of the first of several files, by line; empty if it is accepted.
fn result(files: &[(&str, &str)], options: &Options) -> Result<Imported, String> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    }
    let imported = import(&folder.path().join(files[0].0), options);
    imported.map_err(|errors| {
        let mut all = String::new();
        for (source, diagnostics) in &errors.0 {
            for error in diagnostics {
                let span = error.span.as_ref();
                let line = span.map_or(0, |span| source.position(span).line);
                all += &format!("{line}: {}\n", error.message);
            }
        }
        all
    })
}

fn read(name: &str, text: &str) -> Result<Imported, String> {
    result(&[(name, text)], &Options::default())
}

#[track_caller]
fn assert_rejected(text: &str, message: &str) {
    let errors = read("robot.xml", text).expect_err(text);
    assert_eq!(errors, format!("{message}\n"));
}

/// MJCF of a hinged body with a head, attributes, contents, and elements after it.
fn body(head: &str, attributes: &str, contents: &str, rest: &str) -> String {
    format!(
        "<mujoco model='m'>{head}\n<worldbody>\n<body name='a' {attributes}>\n{contents}\n<joint name='j' axis='0 1 0'/></body>\n\
         </worldbody>\n{rest}</mujoco>"
    )
}

#[test]
fn attributes_that_exclude_each_other_are_rejected() {
    assert_rejected(
        &body("", "quat='1 0 0 0' euler='1 2 3'", MASS, ""),
        "3: `body` has both `quat` and `euler`, which exclude each other",
    );
    let inertial = |more: &str| {
        let own = format!("<inertial pos='0 0 0' mass='1' fullinertia='1 1 1 0 0 .1' {more}/>");
        body("", "", &own, "")
    };
    assert!(read("robot.xml", &inertial("")).is_ok());
    assert_rejected(
        &inertial("diaginertia='1 1 1'"),
        "4: `inertial` has both `fullinertia` and `diaginertia`, which exclude each other",
    );
    assert_rejected(
        &inertial("euler='0 0 1'"),
        "4: `inertial` has both `fullinertia` and `euler`, which exclude each other",
    );
}

#[test]
fn sizes_of_geoms_are_positive() {
    let geom = |own: &str| body("", "", &format!("<geom {own}/>"), "");
    assert!(read("robot.xml", &geom("type='sphere' size='.1 -1 0'")).is_ok());
    for shape in [
        "type='box' size='-1 1 1'",
        "size='0'",
        "type='capsule' size='.1 -.1'",
    ] {
        assert_rejected(&geom(shape), "4: a size of the geom is not positive");
    }
    assert_rejected(
        &geom("type='capsule' size='.1' fromto='1 2 3 1 2 3'"),
        "4: `fromto` of the geom has no length",
    );
}

#[test]
fn default_classes_have_one_meaning() {
    assert_rejected(
        &body(
            "<default class='arm'><joint damping='3'/></default>",
            "",
            MASS,
            "",
        ),
        "1: the outermost default class is `main`, not `arm`",
    );
    let twice = "<default><default class='x'/>\n<default class='x'/></default>";
    assert_rejected(
        &body(twice, "", MASS, ""),
        "2: two default classes have the name `x`",
    );
    let main = "<default class='main'><joint damping='3'/></default><default><joint armature='1'/></default>";
    let imported = read("robot.xml", &body(main, "", MASS, "")).expect("one class");
    let has = |text: &str| imported.text.contains(text);
    assert!(has("fv_j = 3") && has("ia_j = 1"), "{}", imported.text);
}

#[test]
fn a_connect_needs_its_anchor() {
    let rest = "<equality><connect body1='a'/></equality>";
    assert_rejected(&body("", "", MASS, rest), "7: `connect` has no `anchor`");
}

/// MJCF of a slider-crank whose crank has two joints or whose joints have no names.
fn slider_crank(crank: &str, coupler: &str, first: &str) -> String {
    format!(
        "<mujoco model='m'><worldbody>\n<body name='base'>{MASS}{first}\n\
         <body {crank} pos='0 0 .2'>{MASS}<joint axis='0 1 0'/>\n<body {coupler} pos='.4 0 .1'>{MASS}<joint axis='0 1 0'/>\
         </body></body></body></worldbody>\n<equality><connect body1='base_1' anchor='0 0 -.3'/></equality></mujoco>"
    )
}

#[test]
fn given_names_precede_those_of_bodies_without_one() {
    // `base` has two joints, between which a body without a name moves; `base_1` is another body.
    let first = "<joint name='j' axis='0 1 0'/><joint name='joint3' axis='0 0 1'/>";
    let actuated = Some(vec!["j".to_owned(), "joint3".to_owned()]);
    let options = Options {
        actuated,
        ..Options::default()
    };
    let texts = ["base_1", "other"].map(|name| {
        let text = slider_crank("", &format!("name='{name}'"), first);
        let text = text.replace("body1='base_1'", &format!("body1='{name}'"));
        let imported = result(&[("robot.xml", &text)], &options);
        imported.unwrap_or_else(|errors| panic!("{errors}")).text
    });
    // Only the names differ.
    let lines = |text: &str| -> Vec<String> {
        let numbers = text.lines().filter(|line| line.contains(" = "));
        let own = numbers.filter(|line| !line.contains("name") && !line.starts_with('#'));
        own.map(|line| line.replace("other", "base_1")).collect()
    };
    let [clash, plain] = &texts;
    assert_eq!(lines(clash), lines(plain));
}

#[test]
fn includes_are_relative_to_the_first_file_or_to_their_own() {
    let main =
        "<mujoco model='m'><worldbody>\n<include file='parts/arm.xml'/></worldbody></mujoco>";
    let arm = "<mujocoinclude><include file='hand.xml'/></mujocoinclude>";
    let hand = |name: &str| {
        format!("<mujocoinclude><body>{MASS}<joint name='{name}'/></body></mujocoinclude>")
    };
    let files = [("robot.xml", main), ("parts/arm.xml", arm)];
    let (near, first) = (hand("near"), hand("first"));
    let both = [files[0], files[1], ("parts/hand.xml", near.as_str())];
    let imported = result(&both, &Options::default()).expect("an include");
    assert!(imported.text.contains("name = \"near\""));
    let all = [both[0], both[1], both[2], ("hand.xml", first.as_str())];
    let imported = result(&all, &Options::default()).expect("an include");
    assert!(imported.text.contains("name = \"first\""));
    let outside = arm.replace("hand.xml", "../../hand.xml");
    let errors = result(
        &[files[0], ("parts/arm.xml", &outside)],
        &Options::default(),
    );
    assert!(errors.expect_err("outside").contains("outside the folder"));
}

#[test]
fn a_transmission_couples_two_different_joints() {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>"
        )
    };
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/></joint>"
        )
    };
    let (links, joints) = (
        ["a", "b", "c"].map(link).concat(),
        joint("j", "a", "b") + &joint("k", "b", "c"),
    );
    let text = format!(
        "<robot name='r'>{links}{joints}\n<transmission name='t'><type>transmission_interface/DifferentialTransmission</type>\
         <joint name='j'/><joint name='j'/><actuator name='m'/><actuator name='n'/></transmission></robot>"
    );
    let errors = read("robot.urdf", &text).expect_err("one joint");
    assert_eq!(errors, "2: a transmission couples `j` to itself\n");
}

#[test]
fn values_of_unknown_symbols_and_foreign_options_are_rejected() {
    let arm = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/arm.par");
    let arm = fs::read_to_string(arm).expect("a table");
    let with = |names: &[&str]| Options {
        values: names.iter().map(|name| ((*name).to_owned(), 0.1)).collect(),
        ..Options::default()
    };
    let errors = |names: &[&str]| {
        let errors = result(&[("arm.par", &arm)], &with(names));
        errors.expect_err("a symbol")
    };
    assert_eq!(
        errors(&["L1", "LL"]),
        "0: `--value`: the file has no symbol `LL`\n"
    );
    assert_eq!(
        errors(&["L1", "L1"]),
        "0: `--value` gives two values of `L1`\n"
    );
    let text = body("", "", MASS, "");
    let errors = result(&[("robot.xml", &text)], &with(&["L1"]));
    let expected = "0: `--value` is an option for .par files only\n";
    assert_eq!(errors.expect_err("an option"), expected);
    let options = Options {
        model: Some("m".to_owned()),
        ..Options::default()
    };
    let errors = result(&[("robot.xml", &text)], &options);
    let expected = "0: `--model` is an option for SDFormat only\n";
    assert_eq!(errors.expect_err("an option"), expected);
}

#[test]
fn files_in_utf_16_are_rejected_with_the_encoding() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.xml");
    let units = body("", "", MASS, "").encode_utf16().collect::<Vec<_>>();
    let bytes = units.iter().flat_map(|unit| unit.to_le_bytes());
    fs::write(
        &path,
        [0xff, 0xfe].into_iter().chain(bytes).collect::<Vec<u8>>(),
    )
    .expect("a file");
    let errors = import(&path, &Options::default()).expect_err("UTF-16");
    let (_, diagnostics) = &errors.0[0];
    let message = &diagnostics.iter().next().expect("an error").message;
    assert!(message.contains("save it as UTF-8"), "{message}");
}

#[test]
fn the_ground_is_called_world_only() {
    let named = |name: &str| body("", "", MASS, "").replace("name='a'", &format!("name='{name}'"));
    assert!(read("robot.xml", &named("ground")).is_ok());
    assert_rejected(&named("world"), "3: two bodies have the name `world`");
    let connect = "<equality><connect body1='a' body2='ground' anchor='0 0 0'/></equality>";
    let errors = read("robot.xml", &body("", "", MASS, connect)).expect_err("an error");
    assert!(errors.contains("there is no body `ground`"), "{errors}");
}

#[test]
fn limits_without_a_range_and_negative_values_are_reported() {
    let joint = |attributes: &str| {
        body("", "", MASS, "").replace("name='j'", &format!("name='j' {attributes}"))
    };
    for (attributes, reason) in [
        ("limited='true' range='1 -1'", "lower limit is not below"),
        ("armature='-1'", "rotor inertia is negative"),
        ("damping='-1'", "damping is negative"),
    ] {
        let found =
            read("robot.xml", &joint(attributes)).unwrap_or_else(|errors| panic!("{errors}"));
        let reported = &found.account.reported;
        assert_eq!(reported.len(), 1, "{reported:?}");
        assert!(reported[0].reason.contains(reason), "{reported:?}");
    }
}
