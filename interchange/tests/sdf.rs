//! SDFormat files: the same robot as in another format, closed loops, and unsupported contents.

use overact_codegen::{Checked, Source, check};
use overact_interchange::{Options, import};
use std::{
    fs,
    path::{Path, PathBuf},
};

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/models")
        .join(name)
}

/// Text of the description and result of its check.
fn made(path: &Path, options: &Options) -> (String, Checked) {
    let error_text = |errors: overact_interchange::Errors| {
        let all = errors.0.iter();
        let texts: Vec<String> = all
            .map(|(source, errors)| errors.render_plain(source))
            .collect();
        texts.concat()
    };
    let imported = import(path, options).map_err(error_text);
    let text = imported
        .unwrap_or_else(|error_text| panic!("{error_text}"))
        .text;
    let source = Source::new("made.toml", text.clone());
    match check(&source) {
        Ok(checked) => (text, checked),
        Err(errors) => panic!("{}\n{text}", errors.render_plain(&source)),
    }
}

/// Description and check of an SDFormat text.
fn written(text: &str, options: &Options) -> (String, Checked) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.sdf");
    fs::write(&path, text).expect("a file");
    made(&path, options)
}

/// Lines of a description without comments and the file name.
fn kept(text: &str) -> Vec<&str> {
    let is_kept = |line: &&str| !line.starts_with('#') && !line.starts_with("s");
    text.lines().filter(is_kept).collect()
}

fn driven(names: &[&str]) -> Options {
    Options {
        actuated: Some(names.iter().map(|&name| name.to_owned()).collect()),
        ..Options::default()
    }
}

#[test]
fn sdformat_and_urdf_give_the_same_arm() {
    let (urdf, _) = made(&model("arm.urdf"), &Options::default());
    let (sdf, _) = made(&model("arm.sdf"), &Options::default());
    let sdf = sdf.replace("hand__grip", "grip");
    let (urdf, own) = (kept(&urdf), kept(&sdf));
    assert_eq!(urdf.len(), own.len());
    for (urdf, own) in urdf.into_iter().zip(own) {
        let value = |line: &str| line.split_once(" = ")?.1.parse::<f64>().ok();
        match (value(urdf), value(own)) {
            (Some(a), Some(b)) => {
                assert!((a - b).abs() < 1e-13 * a.abs().max(1e-2), "{urdf} {own}")
            }
            _ => assert_eq!(urdf, own),
        }
    }
    assert!(
        sdf.contains("include uri: `model://sun` is not read"),
        "{sdf}"
    );
    assert!(
        sdf.contains(
            "plugin: `libdrives.so` is not read, so the joints that it drives are unknown"
        ),
        "{sdf}"
    );
}

#[test]
fn sdformat_loops_are_closed_by_their_joints() {
    let (text, checked) = made(
        &model("five_bar.sdf"),
        &driven(&["left_motor", "right_motor"]),
    );
    let mechanism = &checked.mechanism;
    let sizes = (
        mechanism.dof(),
        mechanism.actuated().len(),
        mechanism.legs.len(),
    );
    assert_eq!(sizes, (2, 2, 2));
    assert!(text.contains("gravity = [0, 0, -9.81]"), "{text}");
    // Seven digits of a right angle and ten of 60 degrees are exact: no fractions of a degree
    // remain.
    for line in text
        .lines()
        .filter(|line| line.starts_with("theta") || line.starts_with("rotation"))
    {
        let angles = line
            .split([' ', '"', '[', ','])
            .filter_map(|word| word.parse::<f64>().ok());
        for angle in angles {
            assert_eq!(angle % 30.0, 0.0, "{line}");
        }
    }
    assert!(text.contains("d = 0.2\n"), "{text}");
    // Without motor names, the actuated joints of a loop are unknown.
    assert!(
        error_text(&fs::read_to_string(model("five_bar.sdf")).expect("a file"))
            .contains("--actuated")
    );
}

/// A joint of a type between the world and a link, with more contents of joint and model.
fn one_joint(kind: &str, inside: &str, more: &str) -> String {
    format!(
        "<sdf version='1.11'>\n<model name='m'>\n<link name='a'>\n<pose>0.1 0.2 0.3 0 0 0</pose></link>\n\
         <joint name='j' type='{kind}'>\n<parent>world</parent><child>a</child>{inside}</joint>\n{more}</model></sdf>"
    )
}

const Z: &str = "<axis><xyz>0 0 1</xyz></axis>";

#[test]
fn two_axis_joints_become_two_joints() {
    let two = "<axis><xyz>1 0 0</xyz><dynamics><damping>0.5</damping></dynamics></axis><axis2><xyz>0 1 0</xyz></axis2>";
    for kind in ["universal", "revolute2"] {
        let (text, checked) = written(&one_joint(kind, two, ""), &Options::default());
        assert_eq!(checked.mechanism.dof(), 2);
        assert!(
            text.contains("name = \"j_1\"") && text.contains("name = \"j_2\""),
            "{text}"
        );
        assert!(
            text.contains("fv_j_1 = 0.5") && text.contains("m_j_2 = 1"),
            "{text}"
        );
    }
    // A ball joint has no motor; it is allowed in loops only.
    let ball = one_joint("ball", "", "");
    assert!(error_text(&ball).starts_with("5: the ball joint `j`"));
    let five_bar = fs::read_to_string(model("five_bar.sdf")).expect("a file");
    let tip = "name=\"tip\" type=\"revolute\"";
    assert!(five_bar.contains(tip));
    let five_bar = five_bar.replace(tip, "name=\"tip\" type=\"ball\"");
    let (_, checked) = written(&five_bar, &driven(&["left_motor", "right_motor"]));
    assert_eq!(checked.mechanism.dof(), 2);
}

#[test]
fn screw_joints_become_helical_joints() {
    let screw = |pitch: &str| {
        let inside = format!(
            "<axis><xyz>0 0 1</xyz><dynamics><damping>0.5</damping></dynamics></axis>{pitch}"
        );
        one_joint("screw", &inside, "")
    };
    let plain = screw("<screw_thread_pitch>0.005</screw_thread_pitch>");
    let (text, checked) = written(&plain, &Options::default());
    assert_eq!(checked.mechanism.dof(), 1);
    assert!(
        text.contains("name = \"j\"\ntype = \"helical\"\npitch = 0.005\n"),
        "{text}"
    );
    assert!(
        text.contains("fv_j = 0.5") && text.contains("m_j = 1"),
        "{text}"
    );
    // The deprecated `thread_pitch` is in rad/m, for a left-handed thread.
    let (old, _) = written(
        &screw("<thread_pitch>-1256.6370614359173</thread_pitch>"),
        &Options::default(),
    );
    assert_eq!(kept(&text), kept(&old));
    // The same screw, described from the body to the world.
    let against = plain.replace(
        "<parent>world</parent><child>a</child>",
        "<pose relative_to='a'/><parent>a</parent><child>b</child>",
    ) + "";
    let against = against.replace("</model>", "<link name='b'/><joint name='k' type='fixed'><parent>world</parent><child>b</child></joint></model>");
    let (text, _) = written(&against, &Options::default());
    assert!(
        text.contains("type = \"helical\"\npitch = 0.005\n"),
        "{text}"
    );
}

#[test]
fn mimics_and_gearboxes_couple_axes() {
    let mimic = |joint: &str| {
        format!(
            "<link name='b'><pose relative_to='a'/></link><joint name='k' type='prismatic'><parent>a</parent><child>b</child>\
         <axis><xyz>1 0 0</xyz><mimic joint='{joint}' axis='axis'><multiplier>0.25</multiplier><offset>0.1</offset>\
         <reference>0.2</reference></mimic></axis></joint>"
        )
    };
    let (text, checked) = written(&one_joint("revolute", Z, &mimic("j")), &Options::default());
    assert_eq!(checked.mechanism.dof(), 1);
    // 0.25 (q - 0.2) + 0.1; the body's frame contains the constant.
    assert!(text.contains("r = \"0.25 m/rad * q_j\""), "{text}");
    assert!(text.contains("mz_k = 0.05\n"), "{text}");
    assert!(
        error_text(&one_joint("revolute", Z, &mimic("l")))
            .contains("no axis `axis` of a joint `l` to couple to")
    );
    assert!(error_text(&one_joint("revolute", Z, &mimic("k"))).contains("in a cycle: `k`, `k`"));
    let gears = |reference: &str| {
        format!(
            "<link name='b'/><link name='c'/>\
         <joint name='k' type='revolute'><parent>a</parent><child>b</child>{Z}</joint>\
         <joint name='l' type='revolute'><parent>c</parent><child>a</child><pose relative_to='c'/>{Z}</joint>\
         <joint name='g' type='gearbox'><parent>b</parent><child>c</child><gearbox_ratio>3</gearbox_ratio>\
         <gearbox_reference_body>{reference}</gearbox_reference_body>{Z}<axis2><xyz>0 0 1</xyz></axis2></joint>"
        )
    };
    let (text, checked) = written(&one_joint("revolute", Z, &gears("a")), &Options::default());
    assert_eq!(checked.mechanism.dof(), 2);
    // The wheels counter-rotate; the second joint is described from its wheel to the frame.
    assert!(text.contains("q_k"), "{text}");
    assert!(
        text.contains("= \"3.0 * q_k\"") || text.contains("= \"3 * q_k\""),
        "{text}"
    );
    assert!(
        error_text(&one_joint("revolute", Z, &gears("b")))
            .contains("the gearbox `g` needs a revolute joint")
    );
}

/// Error messages of a file.
fn error_text(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.sdf");
    fs::write(&file, text).expect("a file");
    let errors = import(&file, &Options::default()).expect_err(text);
    let mut all = String::new();
    for (source, diagnostics) in &errors.0 {
        for error in diagnostics {
            let span = error.span.as_ref();
            let line = span.map_or(0, |span| source.position(span).line);
            let help = error.help.clone().unwrap_or_default();
            assert!(!help.is_empty(), "{}", error.message);
            all.push_str(&format!("{line}: {} ({help})\n", error.message));
        }
    }
    all
}

fn assert_all_rejected(cases: &[(String, &str)]) {
    let differ: Vec<String> = cases
        .iter()
        .map(|(text, expected)| (error_text(text), expected))
        .filter(|(found, expected)| !found.starts_with(*expected))
        .map(|(found, expected)| format!("{expected} …\n{found}"))
        .collect();
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}

fn joint(kind: &str, inside: &str) -> String {
    one_joint(kind, inside, "")
}

#[test]
fn unsupported_axes_are_rejected_at_their_line() {
    let parallel = format!("{Z}<axis2><xyz>0 0 -1</xyz></axis2>");
    let still = format!("{Z}\n<screw_thread_pitch>0</screw_thread_pitch>");
    let turn = |xyz: &str| joint("revolute", &format!("<axis>\n{xyz}</axis>"));
    assert_all_rejected(&[
        (
            joint("plane", Z),
            "5: the joint `j` is `plane`, which is not supported",
        ),
        (joint("revolute", ""), "5: the joint `j` has no <axis>"),
        (turn("<xyz>0 0 0</xyz>"), "7: the axis has no direction"),
        (turn("<xyz>0 nan 1</xyz>"), "7: <xyz> must be 3 finite"),
        (
            turn("<xyz expressed_in='b'>0 0 1</xyz>"),
            "7: there is no link",
        ),
        (joint("universal", Z), "5: the joint `j` has no <axis2>"),
        (
            joint("universal", &parallel),
            "5: the two axes of the joint",
        ),
        (joint("screw", Z), "5: the screw `j` has no pitch"),
        (
            joint("screw", &still),
            "7: the pitch of the screw `j` is zero",
        ),
        (
            joint("gearbox", Z),
            "3: no joint leads from the world to `a`",
        ),
        (joint("fixed", ""), "0: the robot has no joint that moves"),
    ]);
}

#[test]
fn unsupported_joint_ends_are_rejected_at_their_line() {
    let fixed = |old: &str, new: &str| joint("fixed", Z).replace(old, new);
    let more = |more: &str| one_joint("revolute", Z, more);
    assert_all_rejected(&[
        (
            fixed(">a<", ">world<"),
            "6: the child of the joint `j` is the",
        ),
        (
            fixed(">world<", ">a<"),
            "5: the joint `j` connects a body to",
        ),
        (
            fixed(">world<", ">aa<"),
            "6: there is no link, joint, frame or model `aa` (did you mean `a`?)",
        ),
        (
            fixed("<parent>world</parent>", ""),
            "5: the joint `j` has no <parent>",
        ),
        (
            more("<link name='b'/>"),
            "7: no joint leads from the world to `b`",
        ),
        (
            more("<link name='a'/>"),
            "7: two elements have the name `a`",
        ),
        (more("<link name='world'/>"), "7: `world` can't be the name"),
        (more("<static>true</static>"), "2: the model `m` is static"),
    ]);
}

#[test]
fn unsupported_frames_and_files_are_rejected_at_their_line() {
    let more = |more: &str| one_joint("revolute", Z, more);
    let uri = |uri: &str| more(&format!("<include>\n<uri>{uri}</uri></include>"));
    let pose = |pose: &str| more(&format!("<frame name='f'>\n<pose {pose}</pose></frame>"));
    let pair = "<frame name='f' attached_to='g'/>\n<frame name='g' attached_to='f'/>";
    let circle = "7: the pose of `f` refers to frames in a cycle";
    assert_all_rejected(&[
        (uri("model://arm"), "8: `model://arm` is not read"),
        (uri("../arm.sdf"), "8: `../arm.sdf` is not read"),
        (uri("robot.sdf"), "8: `robot.sdf` includes itself"),
        (more("<include/>"), "7: <include> names no file"),
        (more(pair), circle),
        (pose("relative_to='f'>"), circle),
        (pose(">0 0 0 0 0"), "8: <pose> must be 6 finite numbers"),
        (
            pose(">0 1e20 0 0 0 0"),
            "8: <pose> has a number beyond 1e15",
        ),
        (
            pose("rotation_format='quat_xyzw'>0 0 0 0 0 0 0"),
            "8: a quaternion of length zero",
        ),
    ]);
}

#[test]
fn invalid_documents_are_rejected_at_their_line() {
    let robot = joint("revolute", Z);
    let mass = |mass: &str| {
        let inertial = format!("<inertial>\n<mass>{mass}</mass></inertial><pose>");
        robot.replace("<pose>", &inertial)
    };
    let two = "<sdf version='1.9'>\n<model name='a'/><model name='b'/></sdf>";
    let entity = "<!DOCTYPE sdf [<!ENTITY a 'b'>]>\n<sdf version='1.9'>&a;</sdf>";
    assert_all_rejected(&[
        (mass("-1"), "4: a mass is negative"),
        (mass("inf"), "5: <mass> must be a finite number"),
        (
            robot.replace("'1.11'", "'1.2'"),
            "1: SDFormat of version `1.2`",
        ),
        (
            robot.replace(" version='1.11'", ""),
            "1: the file has no version",
        ),
        ("<sdf version='1.9'/>".to_owned(), "1: there is no <model>"),
        (
            "<sdf version='1.9'>\n<model>".to_owned(),
            "1: this is not valid XML",
        ),
        (entity.to_owned(), "1: this is not valid XML"),
        (
            two.to_owned(),
            "1: there are 2 models: `a`, `b` (choose the robot: `--model a`)",
        ),
    ]);
}

#[test]
fn a_floating_base_is_fixed_on_request() {
    let text = one_joint(
        "revolute",
        Z,
        "<link name='b'><pose>0 0 1 0 0 0</pose></link>",
    )
    .replace("world", "b");
    assert!(error_text(&text).contains("--fix-base"));
    let options = Options {
        fix_base: true,
        ..Options::default()
    };
    let (made, checked) = written(&text, &options);
    assert_eq!(checked.mechanism.dof(), 1);
    assert!(
        made.contains("No joint leads from the world to `b`; it is fixed here at its position."),
        "{made}"
    );
}

#[test]
fn models_of_worlds_and_of_included_files_are_equal() {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, text).expect("a file");
        path
    };
    // An old file whose axes are in its model's frame, rotated in another.
    let part = |version: &str| {
        format!(
            "<sdf version='{version}'><model name='part'><link name='a'/><link name='b'><pose>0 0 0 0 0 1.5707963</pose></link>\
         <joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"
        )
    };
    let whole = |merge: &str| {
        format!(
            "<sdf version='1.9'><world name='w'><model name='other'><link name='o'/></model><model name='m'>\
         <include merge='{merge}'><uri>parts/one</uri><name>arm</name><pose>0 0 0.5 0 0 0</pose></include>\
         <joint name='foot' type='fixed'><parent>world</parent><child>{}</child></joint></model></world></sdf>",
            if merge == "true" { "a" } else { "arm::a" }
        )
    };
    let chosen = Options {
        model: Some("m".to_owned()),
        ..Options::default()
    };
    let mut texts = Vec::new();
    for (version, merge) in [("1.4", "true"), ("1.4", "false"), ("1.6", "true")] {
        put("parts/one/model.sdf", &part(version));
        let path = put("whole.sdf", &whole(merge));
        let errors = import(&path, &Options::default()).expect_err("two models");
        assert!(
            errors.0[0]
                .1
                .iter()
                .any(|error| error.message == "there are 2 models: `other`, `m`")
        );
        let (text, checked) = made(&path, &chosen);
        assert_eq!(checked.mechanism.dof(), 1);
        assert!(text.contains("`--model m`"), "{text}");
        texts.push(text.replace("arm__", ""));
    }
    assert_eq!(kept(&texts[0]), kept(&texts[1]));
    // Since 1.5 the axis is in the joint frame, which the child rotates.
    assert_ne!(kept(&texts[0]), kept(&texts[2]));
}

/// A truncated file or a replaced value gives an error or another robot.
#[test]
fn damaged_sdformat_files_never_panic() {
    let text = fs::read_to_string(model("five_bar.sdf")).expect("a file");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.sdf");
    let mut refused = 0;
    let mut try_it = |text: &str| {
        fs::write(&path, text).expect("a file");
        refused += usize::from(import(&path, &driven(&["left_motor", "right_motor"])).is_err());
    };
    let ends = (0..text.len())
        .step_by(211)
        .filter(|&at| text.is_char_boundary(at));
    for at in ends {
        try_it(&text[..at]);
    }
    // Texts between two elements.
    let mut places = Vec::new();
    let mut start = 0;
    for (at, letter) in text.char_indices() {
        match letter {
            '>' => start = at + 1,
            '<' if !text[start..at].trim().is_empty() => places.push(start..at),
            _ => {}
        }
    }
    assert!(places.len() > 40);
    let others = [
        "nan",
        "1e300",
        "-1",
        "",
        "0 0 0",
        "world",
        "left_rod",
        "tip",
        "\u{e9}&#10;x",
    ];
    for (at, place) in places.iter().enumerate() {
        let other = others[at % others.len()];
        try_it(&format!(
            "{}{other}{}",
            &text[..place.start],
            &text[place.end..]
        ));
    }
    assert!(refused > 50, "{refused}");
}
