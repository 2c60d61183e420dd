//! Files of other programs whose descriptions are invalid are rejected in terms of the file.

use overact_interchange::Options;
use overact_robot::{Error, import};

/// A slider and a coupled finger, with a motor on one of them.
fn gripper(driven: &str) -> String {
    format!(
        "<mujoco><worldbody><body name='palm'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>\n\
         <joint name='wrist' axis='0 0 1'/>\n\
         <body name='left'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>\n\
         <joint name='leader' type='slide' axis='0 1 0'/></body>\n\
         <body name='right'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>\n\
         <joint name='follower' type='slide' axis='0 -1 0'/></body></body></worldbody>\n\
         <equality><joint joint1='follower' joint2='leader' polycoef='0 1 0 0 0'/></equality>\n\
         <actuator><motor joint='wrist'/><motor joint='{driven}'/></actuator></mujoco>"
    )
}

/// A crank and a slider at dead centre, where its motor moves nothing.
const DEAD_CENTRE: &str = "<mujoco><worldbody>\n\
    <body name='crank'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><joint name='crank' axis='0 1 0'/>\n\
    <body name='rod' pos='.1 0 0'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><joint name='rod' axis='0 1 0'/></body></body>\n\
    <body name='piston' pos='.5 0 0'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><joint name='piston' type='slide' axis='1 0 0'/></body>\n\
    </worldbody><equality><connect body1='rod' body2='piston' anchor='.4 0 0'/></equality>\n\
    <actuator><motor joint='piston'/></actuator></mujoco>";

fn imported(text: &str) -> Result<String, Error> {
    let file = std::env::temp_dir().join(format!(
        "overact_import_{}_{}.xml",
        std::process::id(),
        text.len()
    ));
    std::fs::write(&file, text).expect("a file");
    let found = import(&file, &Options::default());
    std::fs::remove_file(&file).expect("removed");
    found.map(|found| found.text)
}

fn refused(text: &str) -> (String, Option<usize>, String) {
    let problems = imported(text).expect_err("no valid description").problems();
    let first = &problems[0];
    let help = first.help.clone().unwrap_or_default();
    (
        format!("{}: {}", first.code, first.message),
        first.line,
        help,
    )
}

#[test]
fn a_motor_on_a_follower_is_refused_at_its_joint() {
    assert!(imported(&gripper("leader")).is_ok());
    let (message, line, help) = refused(&gripper("follower"));
    assert!(
        message.starts_with("OA118") && message.contains("joint `follower`"),
        "{message}"
    );
    assert_eq!(line, Some(6), "{message}");
    assert!(help.contains("--actuated"), "{help}");
}

#[test]
fn a_singular_configuration_is_refused_with_the_option_that_helps() {
    let (message, line, help) = refused(DEAD_CENTRE);
    assert!(
        message.starts_with("OA203") && message.contains("`crank`"),
        "{message}"
    );
    assert_eq!(line, Some(2), "{message}");
    assert!(
        help.contains("--home") && help.contains("--actuated"),
        "{help}"
    );
}
