//! Files of other programs whose first description would be invalid are described in another way.

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

#[test]
fn a_driven_coupled_joint_becomes_the_leader() {
    let text = imported(&gripper("leader")).expect("a description");
    assert!(text.contains("q_leader"), "{text}");
    let text = imported(&gripper("follower")).expect("a description");
    assert!(text.contains("q_follower"), "{text}");
    assert_eq!(text.matches("actuated = true").count(), 2, "{text}");
}

#[test]
fn the_home_pose_is_moved_off_a_dead_centre() {
    let text = imported(DEAD_CENTRE).expect("a description");
    assert!(text.contains("# Home is moved"), "{text}");
}
