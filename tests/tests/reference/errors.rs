//! The numeric reference reports errors instead of wrong numbers.

use nalgebra::DVector;
use overact_tests::reference::{Dynamics, Error, Motion, State, robots};

#[test]
fn poses_out_of_reach_are_errors() {
    let still = DVector::zeros(3);
    let found = State::solve(&robots::dualv(), &[0.6, 0.0, 0.0], &still, &still);
    assert!(
        matches!(found, Err(Error::NoConvergence { .. })),
        "{found:?}"
    );
}

#[test]
fn planar_legs_can_not_follow_a_spatial_platform() {
    let mut robot = robots::dualv();
    robot.motion = Motion::Spatial;
    robot.home = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let still = DVector::zeros(6);
    let found = State::solve(&robot, &robot.home, &still, &still);
    assert!(
        matches!(found, Err(Error::Inconsistent { .. })),
        "{found:?}"
    );
}

#[test]
fn undetermined_links_are_errors() {
    let mut robot = robots::five_bar();
    // A platform point in the middle of the chain leaves the rest of the leg free.
    robot.legs[0].end = overact_tests::reference::End::Point {
        joint: 0,
        along: [true; 3],
        attachment: nalgebra::Vector3::zeros(),
    };
    let still = DVector::zeros(2);
    let start = DVector::from_vec(vec![2.0, -1.0, 1.0, 1.0]);
    let found = State::with_joints(&robot, &robot.home, &start, &still, &still);
    assert!(found.is_err(), "{found:?}");
}

#[test]
fn a_robot_without_enough_motors_is_singular() -> Result<(), Error> {
    let mut robot = robots::dualv();
    robot.legs[0].joints[0].actuated = false;
    robot.legs[1].joints[0].actuated = false;
    let still = DVector::zeros(3);
    let push = DVector::from_vec(vec![1.0, 2.0, 3.0]);
    let state = State::solve(&robot, &robot.home, &still, &push)?;
    let found = Dynamics::new(&robot, &state)?.idm_red_platform();
    assert!(matches!(found, Err(Error::Singular(_))), "{found:?}");
    Ok(())
}
