//! Export of parameters to their file: only changed values differ, and a new import gives these
//! parameters.

use overact_codegen::{Source, description};
use overact_interchange::{Exported, Options, export, import};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/models")
        .join(name)
}

/// Parameters that an import gives the virtual robot.
fn parameters(file: &Path) -> BTreeMap<String, f64> {
    let text = import(file, &Options::default()).expect("a robot").text;
    let description = description::parse(&Source::new("made.toml", text)).expect("a description");
    let experiment = description.experiment.expect("an experiment");
    let named = experiment.parameters.into_iter();
    named.map(|one| (one.name.value, one.value)).collect()
}

fn exported(file: &Path, values: &BTreeMap<String, f64>, folder: &Path) -> Exported {
    let lines: Vec<String> = values
        .iter()
        .map(|(name, value)| format!("{name} = {value:?}\n"))
        .collect();
    let path = folder.join("parameters.toml");
    fs::write(&path, format!("[parameters]\n{}", lines.concat())).expect("a file");
    export(file, &path, &Options::default()).expect("an export")
}

/// Masses and moments of a body with another size and density in the same axes, and other friction.
fn others(values: &BTreeMap<String, f64>) -> BTreeMap<String, f64> {
    let factor = |name: &str| match name.split('_').next() {
        Some("m") => 1.25,
        Some("mx" | "my" | "mz") => 1.25 * 1.1,
        Some("ia") => 0.75,
        Some("fv") => 3.0,
        Some("fs") => 0.5,
        _ => 1.25 * 1.1 * 1.1,
    };
    values
        .iter()
        .map(|(name, value)| (name.clone(), factor(name) * value))
        .collect()
}

fn round_trip(name: &str) -> (String, Exported) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = model(name);
    let before = parameters(&file);
    let text = fs::read_to_string(&file).expect("the file");
    let same = exported(&file, &before, folder.path());
    assert_eq!(same.text, text, "what does not differ does not change");
    assert!(same.changed.is_empty() && same.notes.is_empty(), "{same:?}");
    let wanted = others(&before);
    let made = exported(&file, &wanted, folder.path());
    let again = folder.path().join(name);
    fs::write(&again, &made.text).expect("a file");
    let after = parameters(&again);
    for name in wanted.keys().chain(after.keys()) {
        let [value, found] = [&wanted, &after].map(|all| all.get(name).copied().unwrap_or(0.0));
        assert!(
            (found - value).abs() <= 1e-12 * value.abs().max(1e-3),
            "{name}: {found} for {value}"
        );
    }
    (text, made)
}

#[test]
fn mjcf_export_round_trips() {
    let (text, made) = round_trip("ankle.xml");
    assert!(made.notes.is_empty(), "{:?}", made.notes);
    let pairs = || text.lines().zip(made.text.lines());
    assert_eq!(text.lines().count(), made.text.lines().count());
    for (before, after) in pairs().filter(|(before, after)| before != after) {
        assert!(
            before.contains("<inertial") || before.contains("<joint"),
            "{before} became {after}"
        );
    }
    let line = |part: &str| {
        pairs()
            .find(|(before, _)| before.contains(part))
            .map(|(_, after)| after.trim().to_owned())
    };
    // Values from a default class are written to the joint itself.
    let expected = "<joint name=\"left_motor\" axis=\"0 1 0\" armature=\"0.0075\" damping=\"0.6\" frictionloss=\"0.15\"/>";
    assert_eq!(line("name=\"left_motor\"").as_deref(), Some(expected));
    let foot = line("mass=\"0.8\"").expect("the foot");
    assert!(
        foot.contains("fullinertia=") && !foot.contains("euler") && !foot.contains("diaginertia"),
        "{foot}"
    );
    assert_eq!(
        line("name=\"shank\"").as_deref(),
        Some("<body name=\"shank\" pos=\"0 0 0.4\">")
    );
}

#[test]
fn urdf_export_round_trips() {
    let (text, made) = round_trip("arm.urdf");
    assert!(made.text.contains("rpy=") && text.contains("rpy="));
    let comments = |text: &str| {
        text.lines()
            .filter(|line| line.contains("<!--"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(comments(&text), comments(&made.text));
}

#[test]
fn parameters_without_a_place_in_urdf_are_noted() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = model("arm.urdf");
    let mut values = parameters(&file);
    values.insert("ia_yaw".to_owned(), 0.2);
    values.insert("off_yaw".to_owned(), 0.0);
    let made = exported(&file, &values, folder.path());
    assert_eq!(
        made.notes,
        ["URDF has no place for ia_yaw = 0.2: left out."]
    );
    // A negative mass is written and reported.
    values.remove("ia_yaw");
    values.insert("m_reach".to_owned(), -1.0);
    let made = exported(&file, &values, folder.path());
    assert!(
        made.notes
            .iter()
            .any(|note| note.contains("is not physically consistent")),
        "{:?}",
        made.notes
    );
}

#[test]
fn unknown_parameter_names_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("parameters.toml");
    fs::write(&path, "[parameters]\nm_lift = 1\nm_lyft = 1\n").expect("a file");
    let errors = export(&model("arm.urdf"), &path, &Options::default()).expect_err("a wrong name");
    let (source, errors) = &errors.0[0];
    let message = errors.render_plain(source);
    assert!(
        message.contains("parameters.toml:3") && message.contains("m_lyft"),
        "{message}"
    );
}

#[test]
fn values_of_included_files_are_exported_to_those_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.xml");
    fs::write(&file, "<mujoco>\n<include file='parts/arm.xml'/>\n<actuator><motor joint='j'/></actuator></mujoco>").expect("a file");
    fs::create_dir(folder.path().join("parts")).expect("a folder");
    let part = "<mujoco><worldbody>\n<body name='b'><joint name='j' axis='0 1 0'/>\n<!-- kept -->\n\
        <inertial mass='2' pos='0.1 0 0' diaginertia='1 1 1'/></body></worldbody></mujoco>";
    fs::write(folder.path().join("parts/arm.xml"), part).expect("a file");
    let mut values = parameters(&file);
    values.insert("m_j".to_owned(), 4.0);
    values.insert("fv_j".to_owned(), 0.5);
    let made = exported(&file, &values, folder.path());
    assert_eq!(made.text, fs::read_to_string(&file).expect("the file"));
    let (path, text) = &made.included[0];
    assert!(path.ends_with("parts/arm.xml"));
    assert!(
        text.contains("<!-- kept -->") && text.contains("damping=\"0.5\""),
        "{text}"
    );
    assert!(
        text.contains("mass='4.0'") && text.contains("pos='0.05 0 0'"),
        "{text}"
    );
}

/// Exports other values and imports the result: the same parameters.
fn text_round_trip(text: &str) -> Exported {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.xml");
    fs::write(&file, text).expect("a file");
    let before = parameters(&file);
    let same = exported(&file, &before, folder.path());
    assert_eq!(same.text, text, "what does not differ does not change");
    let wanted = others(&before);
    let made = exported(&file, &wanted, folder.path());
    fs::write(&file, &made.text).expect("a file");
    let after = parameters(&file);
    for name in wanted.keys().chain(after.keys()) {
        let [value, found] = [&wanted, &after].map(|all| all.get(name).copied().unwrap_or(0.0));
        assert!(
            (found - value).abs() <= 1e-12 * value.abs().max(1e-3),
            "{name}: {found} for {value}\n{}",
            made.text
        );
    }
    made
}

#[test]
fn actuator_and_tendon_values_are_not_exported_twice() {
    let text = "<mujoco><worldbody><body name='a'><joint name='x' axis='0 1 0' armature='0.4' damping='2' frictionloss='3'/>\
        <inertial mass='2' pos='0.1 0 0' diaginertia='1 1 1'/></body>\
        <body name='b'><joint name='y' axis='0 1 0' damping='2'/>\
        <inertial mass='2' pos='0.1 0 0' diaginertia='1 1 1'/></body></worldbody>\
        <tendon><fixed name='t' armature='0.01' damping='0.2' frictionloss='0.3'><joint joint='x' coef='2'/></fixed></tendon>\
        <actuator><motor joint='x' gear='3' armature='0.01' damping='0.02'/><motor joint='y'/></actuator></mujoco>";
    let made = text_round_trip(text);
    assert!(made.notes.is_empty(), "{:?}", made.notes);
}

#[test]
fn joint_inertia_below_the_actuator_inertia_is_noted() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.xml");
    let text = "<mujoco><worldbody><body name='a'><joint name='x' axis='0 1 0' armature='0.4'/>\
        <inertial mass='2' pos='0.1 0 0' diaginertia='1 1 1'/></body></worldbody>\
        <actuator><motor joint='x' gear='3' armature='0.1'/></actuator></mujoco>";
    fs::write(&file, text).expect("a file");
    let values = BTreeMap::from([("ia_x".to_owned(), 0.5)]);
    let made = exported(&file, &values, folder.path());
    assert!(made.text.contains("armature='0'"), "{}", made.text);
    assert!(
        made.notes[0].contains("ia_x = 0.5 is less than"),
        "{:?}",
        made.notes
    );
}

#[test]
fn compiler_settings_are_replaced_by_explicit_values() {
    let text = "<mujoco><compiler settotalmass='7' boundmass='0.01'/><worldbody>\
        <body name='a'><joint name='x' axis='0 1 0' springdamper='0.3 0.8'/>\
        <inertial mass='2' pos='0.1 0 0' diaginertia='1 1 1'/>\
        <body name='b' pos='0.2 0 0'><joint name='y' axis='0 1 0'/>\
        <geom type='box' size='0.1 0.2 0.3' pos='0.1 0 0.1'/></body></body></worldbody>\
        <actuator><motor joint='x'/><motor joint='y'/></actuator></mujoco>";
    let made = text_round_trip(text);
    assert_eq!(made.notes.len(), 2, "{:?}", made.notes);
    assert!(!made.text.contains("settotalmass"), "{}", made.text);
}
