//! Large files: limits on elements, errors and notes.

use overact_interchange::{Errors, Options, import};
use std::fs;

fn errors_of(files: &[(&str, &str)]) -> Errors {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    import(&folder.path().join(files[0].0), &Options::default()).expect_err("errors")
}

fn messages(errors: &Errors) -> Vec<String> {
    let all = errors.0.iter().flat_map(|(_, errors)| errors.iter());
    all.map(|error| error.message.clone()).collect()
}

const BODY: &str = "<body name='b'><joint name='j' axis='0 1 0'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body>";

fn mjcf(more: &str) -> String {
    format!("<mujoco><worldbody>{BODY}</worldbody>{more}</mujoco>")
}

#[test]
fn too_many_loop_closures_are_rejected() {
    let closures = |count: usize| {
        let all = "<connect body1='b' anchor='0 0 0'/>\n".repeat(count);
        mjcf(&format!(
            "<equality>{all}</equality><actuator><motor joint='j'/></actuator>"
        ))
    };
    let error_messages = |count| messages(&errors_of(&[("robot.xml", &closures(count))]));
    assert_eq!(
        error_messages(201),
        ["the robot has 201 loop closures, more than 200"]
    );
    assert_eq!(
        error_messages(3_000),
        ["the file has 3000 loop closures, more than 2000"]
    );
}

#[test]
fn notes_on_many_unknown_names_are_aggregated() {
    let unknown: String = (0..20_000).map(|at| format!("<u{at} a='1'/>\n")).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.xml");
    fs::write(&file, mjcf(&unknown)).expect("a file");
    let found = import(&file, &Options::default()).expect("a robot");
    let reported = &found.account.reported;
    assert_eq!(reported.len(), 201);
    let last = &reported[200];
    assert_eq!(
        (last.subject().as_str(), last.count, last.line),
        ("further names", 19_800, 201)
    );
    let sum: usize = reported.iter().map(|entry| entry.count).sum();
    assert_eq!(sum, 20_000);
    assert!(found.text.lines().count() < 400);
}

#[test]
fn the_number_of_errors_and_suggestions_is_limited() {
    let motors: String = (0..1_000)
        .map(|at| format!("<motor joint='joint_{at}x'/>\n"))
        .collect();
    let bodies: String = (0..150)
        .map(|at| format!("<body><joint name='joint_{at}' axis='0 1 0'/></body>"))
        .collect();
    let text =
        format!("<mujoco><worldbody>{bodies}</worldbody><actuator>\n{motors}</actuator></mujoco>");
    let errors = errors_of(&[("robot.xml", &text)]);
    let all = messages(&errors);
    assert_eq!(all.len(), 201);
    assert_eq!(all[200], "800 more errors are not shown");
    let help = errors.0[0].1.iter().filter_map(|error| error.help.as_ref());
    let suggested = help.filter(|help| help.starts_with("did you mean")).count();
    assert_eq!(suggested, 50);
}

#[test]
fn repeated_includes_are_not_mistaken_for_cycles() {
    let twice = |at: usize| {
        format!("<mujoco><include file='{at}.xml'/>\n<include file='{at}.xml'/></mujoco>")
    };
    let texts: Vec<(String, String)> = (0..12)
        .map(|at| (format!("{at}.xml"), twice(at + 1)))
        .chain([("12.xml".to_owned(), "<mujoco/>".to_owned())])
        .collect();
    let files: Vec<(&str, &str)> = texts
        .iter()
        .map(|(a, b)| (a.as_str(), b.as_str()))
        .collect();
    assert_eq!(
        messages(&errors_of(&files)),
        ["more than 500 files are included, counting repetitions"]
    );
    let chain = |at: usize| format!("<mujoco><include file='{at}.xml'/></mujoco>");
    let texts: Vec<(String, String)> = (0..40)
        .map(|at| (format!("{at}.xml"), chain(at + 1)))
        .chain([("40.xml".to_owned(), "<mujoco/>".to_owned())])
        .collect();
    let files: Vec<(&str, &str)> = texts
        .iter()
        .map(|(a, b)| (a.as_str(), b.as_str()))
        .collect();
    assert_eq!(
        messages(&errors_of(&files)),
        ["includes are nested more than 30 deep"]
    );
}

#[test]
fn too_many_elements_are_reported_once() {
    let leaf = format!("<mujoco>{}</mujoco>", "<option/>".repeat(200_000));
    let root = format!(
        "<mujoco>{}</mujoco>",
        "<include file='leaf.xml'/>".repeat(8)
    );
    let errors = errors_of(&[("robot.xml", &root), ("leaf.xml", &leaf)]);
    assert_eq!(messages(&errors).len(), 1, "{:?}", messages(&errors));
}

/// A pipe without a writer would block whoever opens it.
#[cfg(unix)]
#[test]
fn pipes_folders_and_devices_are_rejected_as_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("robot.xml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo").success());
    let inputs = [
        pipe.as_path(),
        folder.path(),
        std::path::Path::new("/dev/zero"),
    ];
    for input in inputs {
        let errors = import(input, &Options::default()).expect_err("no file");
        let error_messages = messages(&errors).concat();
        assert!(
            error_messages.contains("can't be read: it is ")
                && error_messages.ends_with("not a regular file"),
            "{error_messages}"
        );
    }
}

/// As after `overact import <(xacro robot.xacro)`.
#[cfg(target_os = "linux")]
#[test]
fn inherited_pipes_are_read() {
    use std::{io::Write, os::fd::AsRawFd};
    let (reader, mut writer) = std::io::pipe().expect("a pipe");
    writer.write_all(mjcf("").as_bytes()).expect("room");
    drop(writer);
    let path = format!("/dev/fd/{}", reader.as_raw_fd());
    let found = import(path.as_ref(), &Options::default());
    assert!(found.is_ok(), "{found:?}");
}
